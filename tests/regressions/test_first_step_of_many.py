"""Before the first of 100,000 steps the rules of all were made, one by one: seven seconds."""

from stippler.stippling.spacing import RULES, rules_after


def test_rules_that_are_the_same_are_made_once() -> None:
    assert rules_after(0) is rules_after(30) is RULES
    assert rules_after(70) is rules_after(70)
    assert rules_after(100) is rules_after(99_999)
