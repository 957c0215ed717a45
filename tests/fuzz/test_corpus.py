"""What fuzzing has found, read again; and a short round of changed bytes with a bound on time."""

import importlib.util
import random
import time
from pathlib import Path

import pytest

HERE = Path(__file__).parent
spec = importlib.util.spec_from_file_location("readers", HERE / "readers.py")
readers = importlib.util.module_from_spec(spec)
spec.loader.exec_module(readers)

CORPUS = HERE.parent / "corpus" / "fuzz"


@pytest.mark.parametrize("name", sorted(readers.READERS))
def test_every_file_found_is_read_or_refused(name):
    inputs = [path.read_bytes() for path in sorted((CORPUS / name).glob("*"))]
    inputs += readers.seeds(name)
    assert inputs, "a reader without an input to begin with"
    for data in inputs:
        readers.read(name, data)


@pytest.mark.parametrize("name", sorted(readers.READERS))
def test_changed_seeds_are_read_or_refused_soon(name):
    dice = random.Random(name)
    for seed in readers.seeds(name):
        for _ in range(200):
            data = bytearray(seed)
            for _ in range(dice.randint(1, 4)):
                at = dice.randrange(len(data))
                data[at] = dice.choice((0, 1, 0x7F, 0x80, 0xFF, dice.randrange(256)))
            if dice.random() < 0.3:
                data = data[: dice.randrange(len(data))]
            began = time.process_time()
            readers.read(name, bytes(data))
            assert time.process_time() - began < 2.0
