"""Full collections wait until the editor rests."""

import gc
import weakref
from collections.abc import Iterator

import pytest

from stippler.editor.garbage_collection import _ENOUGH, Garbage


class Ring:
    """Refers to itself, so that only the collector frees it."""

    def __init__(self) -> None:
        self.itself = self


@pytest.fixture
def garbage() -> Iterator[Garbage]:
    kept = Garbage()
    yield kept
    kept.close()


def grow_old() -> "weakref.ref[Ring]":
    """Make a ring that has outlived the collections of young objects before it is dropped."""
    ring = Ring()
    gc.collect(1)
    return weakref.ref(ring)


def test_what_is_dropped_goes_at_rest_once_there_is_enough(garbage: Garbage) -> None:
    gc.collect()
    ring = grow_old()
    garbage.rest()
    assert ring() is not None
    for _ in range(_ENOUGH):
        gc.collect(1)
    assert ring() is not None
    garbage.rest()
    assert ring() is None


def test_no_allocation_brings_a_full_collection(garbage: Garbage) -> None:
    gc.collect()
    ring = grow_old()
    kept = [[k] for k in range(200_000)]
    assert len(kept) == 200_000
    assert ring() is not None


def test_what_was_set_aside_is_looked_at_now_and_then(garbage: Garbage) -> None:
    ring = Ring()
    dropped = weakref.ref(ring)
    for k in range(41):
        for _ in range(_ENOUGH):
            gc.collect(1)
        garbage.rest()
        if k == 0:
            del ring
    assert dropped() is None


def test_closing_leaves_collection_as_it_was() -> None:
    before = gc.get_threshold()
    Garbage().close()
    assert gc.get_threshold() == before
    assert gc.get_freeze_count() == 0
