"""Coverage-guided fuzzing of every reader: ``python tests/fuzz/fuzz.py READER [atheris options]``.

What it finds goes to ``tests/corpus/fuzz/READER``, whose files the test suite reads each time.
"""

import sys
from pathlib import Path

import atheris

sys.path.insert(0, str(Path(__file__).parent))
with atheris.instrument_imports(include=["stippler", "zipfile", "json"]):
    import readers

CORPUS = Path(__file__).parents[1] / "corpus" / "fuzz"


def main() -> None:
    name, *options = sys.argv[1:]
    folder = CORPUS / name
    folder.mkdir(parents=True, exist_ok=True)
    for k, seed in enumerate(readers.seeds(name)):
        (folder / f"seed-{k}").write_bytes(seed)
    atheris.Setup(
        [sys.argv[0], str(folder), "-max_len=4096", "-timeout=10", "-rss_limit_mb=1024", *options],
        lambda data: readers.read(name, data),
    )
    atheris.Fuzz()


if __name__ == "__main__":
    main()
