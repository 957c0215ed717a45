import pytest

from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.style import Style
from stippler.jobs import preflight


def told(monkeypatch, tmp_path, *, free_kb=None, most=None, used=None):
    (tmp_path / "meminfo").write_text(
        "MemTotal: 9 kB\n" + (f"MemAvailable: {free_kb} kB\n" if free_kb is not None else "")
    )
    if most is not None:
        (tmp_path / "memory.max").write_text(f"{most}\n")
        (tmp_path / "memory.current").write_text(f"{used}\n")
    monkeypatch.setattr(preflight, "_MEMINFO", tmp_path / "meminfo")
    monkeypatch.setattr(preflight, "_GROUP", tmp_path)


def test_what_is_free_is_the_least_of_machine_and_container(monkeypatch, tmp_path):
    told(monkeypatch, tmp_path, free_kb=4096)
    assert preflight.available_bytes() == 4096 << 10
    told(monkeypatch, tmp_path, free_kb=4096, most=3 << 20, used=1 << 20)
    assert preflight.available_bytes() == 2 << 20
    told(monkeypatch, tmp_path, free_kb=4096, most="max", used=1)
    assert preflight.available_bytes() == 4096 << 10
    told(monkeypatch, tmp_path, free_kb=4096, most=1 << 20, used=2 << 20)
    assert preflight.available_bytes() == 0


def test_nothing_is_said_where_nothing_is_known(monkeypatch, tmp_path):
    told(monkeypatch, tmp_path)
    assert preflight.available_bytes() is None
    assert preflight.warning("stipple", 10**9, 10**9) == ""
    monkeypatch.setattr(preflight, "_MEMINFO", tmp_path / "none")
    assert preflight.available_bytes() is None


@pytest.mark.parametrize("job", ["stipple", "process", "fill", "relax", "export", "save"])
def test_a_job_that_does_not_fit_is_told_and_what_to_do(monkeypatch, tmp_path, job):
    told(monkeypatch, tmp_path, free_kb=1 << 20)  # a GB
    assert preflight.warning(job, 100_000, 1_000_000) == ""
    text = preflight.warning(job, 50_000_000, 1_000_000)
    assert "1.1 GB are free" in text
    assert preflight._DO[job] in text


def test_needs_grow_with_dots_and_pixels():
    for job in ("stipple", "process", "export"):
        needs = [preflight.needed_bytes(job, n, p) for n, p in ((0, 0), (10**6, 0), (10**6, 10**7))]
        assert needs == sorted(set(needs))


def test_areas_made_anew_are_told_of_by_the_largest_style(monkeypatch, tmp_path):
    drawing = Drawing.blank(Page(40.0, 30.0))
    told(monkeypatch, tmp_path, free_kb=1 << 20)
    small, large = Style(n_dots=1000), Style(n_dots=900_000)
    assert preflight.processing_warning(drawing, [small]) == ""
    told(monkeypatch, tmp_path, free_kb=1 << 19)
    assert "fewer areas" in preflight.processing_warning(drawing, [small, large])
