"""A made-up journal whose steps cannot all be undone afterwards; found by fuzzing, still open."""

from pathlib import Path

import pytest

from tests.fuzz import readers

CASE = Path(__file__).parents[1] / "fuzz" / "open" / "replay-undone-from-before"


@pytest.mark.xfail(raises=IndexError, strict=True, reason="the order of undone steps is not held")
def test_what_is_replayed_can_be_undone() -> None:
    readers.read("replay", CASE.read_bytes())
