"""The page on speed: its tables are those that topics print."""

import re

import pytest

from benchmarks.all import TOPICS
from benchmarks.figures import Figure
from benchmarks.page import PAGE, filled, marked


def test_every_table_of_the_page_is_a_topic_of_the_bench() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert len(marked(text)) == len(set(marked(text))) > 10
    assert set(marked(text)) <= set(TOPICS)
    n_tables = len(re.findall(r"^\|---", text, re.MULTILINE))
    assert n_tables == len(marked(text))


def test_a_table_is_replaced_and_all_else_stays() -> None:
    text = (
        "before\n\n<!-- bench one -->\n| old |\n|---|\n| 1 |\n\nafter | it\n\n<!-- bench two -->\n"
    )
    made = filled(text, "one", [Figure("a|b", 1.23456, "ms", 1.0, 0.5, note="of 3")])
    assert made.startswith("before\n\n<!-- bench one -->\n|")
    assert "| a/b | 1.23 ms | 1 ms | 0.5 ms | missed, of 3 |\n\nafter | it\n" in made
    assert "old" not in made
    assert filled(made, "one", [Figure("a|b", 1.23456, "ms", 1.0, 0.5, note="of 3")]) == made
    assert "<!-- bench two -->\n| |" in filled(made, "two", [])
    with pytest.raises(KeyError):
        filled(text, "three", [])
