"""What fuzzing has found, read again; and a short round of changed bytes with bounds on time and
memory.
"""

import random
import resource
import time
from pathlib import Path

import pytest

from tests.fuzz import readers
from tests.fuzz.seeds import seeds

CORPUS = Path(__file__).parent / "corpus"
MOST_S, MOST_MB = 2.0, 300


@pytest.mark.parametrize("name", sorted(readers.READERS))
def test_every_input_kept_is_read_or_refused(name):
    inputs = [path.read_bytes() for path in sorted((CORPUS / name).glob("*"))]
    for data in inputs + seeds(name):
        readers.read(name, data)


@pytest.mark.parametrize("name", sorted(readers.READERS))
def test_changed_inputs_are_read_or_refused_soon(name):
    dice = random.Random(name)
    inputs = [path.read_bytes() for path in sorted((CORPUS / name).glob("*"))]
    peak_kb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for seed in [data for data in inputs + seeds(name) if data]:
        for _ in range(max(400 // len(inputs + seeds(name)), 5)):
            data = bytearray(seed)
            for _ in range(dice.randint(1, 4)):
                at = dice.randrange(len(data))
                data[at] = dice.choice((0, 1, 0x7F, 0x80, 0xFF, dice.randrange(256)))
            if dice.random() < 0.3:
                data = data[: dice.randrange(len(data))]
            began = time.process_time()
            readers.read(name, bytes(data))
            assert time.process_time() - began < MOST_S
    grown_kb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - peak_kb
    assert grown_kb < MOST_MB << 10


def test_a_reader_that_may_not_fail_as_it_does_is_found(monkeypatch):
    def careless(data):
        return data[7]

    monkeypatch.setattr(readers, "READERS", {"careless": careless})
    with pytest.raises(IndexError):
        readers.read("careless", b"short")
