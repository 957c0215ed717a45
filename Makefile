# make run    the editor on a sample; without a display, the sample drawn into out/
# make test   every test, without a screen
# make check  lint, types, import contracts
# make bench  every performance figure
# make coverage   lines and branches of files/ and drawing/ that tests go through
# make soak   an hour of random use (MINUTES=60)
.PHONY: run test check bench soak coverage clean
.DEFAULT_GOAL := run

VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check
SAMPLE := assets/samples/ammonite.png

run: $(VENV)/ready
	@setup/system-libraries
	@$(BIN)/python -m stippler.warm
	@if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ] || [ "$$(uname -s)" = Darwin ]; then \
		$(BIN)/stippler edit $(SAMPLE); \
	else \
		mkdir -p out; \
		echo "No display: drawing $(SAMPLE) without a window."; \
		$(BIN)/stippler render $(SAMPLE) -o out/ammonite.svg --dots 60000 && \
		$(BIN)/stippler render $(SAMPLE) -o out/ammonite.png --dots 60000 && \
		echo "Look at out/ammonite.svg and out/ammonite.png."; \
	fi

test: $(VENV)/ready-dev
	@setup/system-libraries test
	@$(BIN)/python -m stippler.warm
	$(BIN)/python -m pytest -n 2 --dist loadfile

check: $(VENV)/ready-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: $(VENV)/ready-dev
	@setup/system-libraries test
	@$(BIN)/python -m stippler.warm
	$(BIN)/stippler bench

MINUTES := 60
soak: $(VENV)/ready-dev
	@setup/system-libraries test
	@$(BIN)/python -m stippler.warm
	$(BIN)/python -m benchmarks.soak $(MINUTES)

COVERING := tests/drawing tests/files tests/corpus tests/fuzz tests/regressions tests/editor tests/jobs \
	tests/brushes tests/analysis $(wildcard tests/stippling/test_*line*.py) $(wildcard tests/stippling/test_*border*.py) \
	$(wildcard tests/stippling/test_scale*.py) tests/stippling/test_patterns.py
coverage: $(VENV)/ready-dev
	@$(PIP) --group coverage
	@setup/system-libraries test
	$(BIN)/python -m coverage run -m pytest -q -p no:xdist -p tests.long.contexts $(COVERING)
	$(BIN)/python -m coverage report

$(VENV)/ready: pyproject.toml
	@echo "Setting up $(VENV) (once) ..."
	@[ -x $(BIN)/python ] || setup/environment $(VENV)
	@$(PIP) -e .
	@touch $@

$(VENV)/ready-dev: $(VENV)/ready
	@$(PIP) --group dev
	@touch $@

clean:
	rm -rf $(VENV) out dist build .mypy_cache .ruff_cache .pytest_cache .hypothesis tests/failed
