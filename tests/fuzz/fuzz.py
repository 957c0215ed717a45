"""Coverage-guided fuzzing of a reader: ``python -m tests.fuzz.fuzz READER [atheris options]``.

An input that a reader neither reads nor refuses is kept below ``out/fuzz/READER/faults``, one for
each kind of fault, and the run goes on; it ends with 1 if there was any. One that takes longer than
five seconds or more than a gigabyte ends it at once, and is kept as libFuzzer does.
"""

import atexit
import importlib
import json
import pkgutil
import random
import re
import sys
import traceback
from pathlib import Path

import atheris

import stippler.kernels

for module in pkgutil.walk_packages(stippler.kernels.__path__, "stippler.kernels."):
    importlib.import_module(module.name)  # numba compiles no instrumented code
with atheris.instrument_imports(include=["stippler", "zipfile", "json", "tifffile"]):
    from tests.fuzz import readers
    from tests.fuzz.seeds import seeds

OUT = Path("out") / "fuzz"
_PLAIN = re.compile(r"[\w .-]+", re.ASCII).fullmatch
_ODD = (
    None, True, False, 0, 1, -1, 2, 255, 2**31, 2**53, 2**63, -(2**63), 0.0, -0.5, 1.5, 1e-300,
    1e300, "", "a", "\ud800", "\0", [], {}, [[]], [None], [0, 0], {"a": 1}, "POLYGON EMPTY",
)  # fmt: skip


class Faults:
    """Keeps one input for each kind of fault."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.kinds: dict[str, int] = {}

    def take(self, data: bytes, error: BaseException) -> None:
        """Note a fault; where it came from tells kinds apart."""
        frames = traceback.extract_tb(error.__traceback__)[-3:]
        places = [f"{Path(frame.filename).stem}-{frame.lineno}" for frame in frames]
        kind = "_".join([type(error).__name__, *places])
        self.kinds[kind] = self.kinds.get(kind, 0) + 1
        if self.kinds[kind] == 1:
            self._folder.mkdir(parents=True, exist_ok=True)
            (self._folder / kind).write_bytes(data)
            (self._folder / f"{kind}.txt").write_text("".join(traceback.format_exception(error)))


def changed_json(data: bytes, most: int, seed: int) -> bytes:
    """Change a value somewhere in a JSON document, or bytes of what is no JSON."""
    text, mark, raw = data.partition(b"\0")
    dice = random.Random(seed)
    try:
        document = json.loads(text)
    except (ValueError, RecursionError):
        return atheris.Mutate(data, most)
    if dice.random() < 0.2:
        return atheris.Mutate(data, most)
    if mark and dice.random() < 0.3 and raw:
        return text + mark + atheris.Mutate(raw, max(most - len(text) - 1, 1))
    for _ in range(dice.choice((1, 1, 1, 2, 4))):
        document = _changed(document, dice)
    out = json.dumps(document, separators=(",", ":")).encode() + mark + raw
    return out if len(out) <= most else data[:most]


def _changed(value, dice):
    """Return a value with something changed in it, at any depth."""
    if not isinstance(value, dict | list) or not value or dice.random() < 0.1:
        return _other(value, dice)
    if isinstance(value, list):
        k = dice.randrange(len(value))
        chance = dice.random()
        if chance < 0.1:
            return value[:k] + value[k + 1 :]
        if chance < 0.2:
            return [*value, value[k]]
        return [*value[:k], _changed(value[k], dice), *value[k + 1 :]]
    key = dice.choice(list(value))
    chance = dice.random()
    if chance < 0.08:
        return {k: v for k, v in value.items() if k != key}
    if chance < 0.16:
        return {
            (dice.choice(("0", "1", "a", "-1")) if k == key else k): v for k, v in value.items()
        }
    return {**value, key: _changed(value[key], dice)}


def _other(value, dice):
    if type(value) in (int, float) and dice.random() < 0.5:
        return value + dice.choice((1, -1, 0.5, value, -2 * value))
    if isinstance(value, str) and value and dice.random() < 0.4:
        k = dice.randrange(len(value))
        return value[:k] + dice.choice(("", "9", "(", ",", "é")) + value[k + 1 :]
    return dice.choice(_ODD)


def main() -> None:
    name, *options = sys.argv[1:]
    folder = OUT / name / "corpus"
    folder.mkdir(parents=True, exist_ok=True)
    for k, seed in enumerate(seeds(name)):
        (folder / f"seed-{k}").write_bytes(seed)
    words = OUT / name / "words"
    words.write_text("".join(f'"{word}"\n' for word in readers.tokens(name) if _PLAIN(word)))
    faults = Faults(OUT / name / "faults")

    def once(data: bytes) -> None:
        try:
            readers.read(name, data)
        except Exception as error:  # noqa: BLE001 - that is what is looked for
            faults.take(data, error)

    longest = max(4096, *(2 * len(seed) for seed in seeds(name)))
    standard = [f"-max_len={longest}", "-timeout=5", "-rss_limit_mb=1024"]
    standard += [f"-dict={words}"] if words.stat().st_size else []
    given = [sys.argv[0], *standard, f"-artifact_prefix={OUT / name}/", *options, str(folder)]
    atheris.Setup(
        given, once, **({"custom_mutator": changed_json} if name in readers.OF_JSON else {})
    )
    atexit.register(lambda: sys.stderr.write(f"faults: {faults.kinds}\n"))
    atheris.Fuzz()


if __name__ == "__main__":
    main()
