"""What people type as numbers is read as they mean it, or refused with a line."""

from __future__ import annotations

import contextlib
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.editor.numbers import parse_number
from stippler.errors import ParameterError


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("21 cm", "mm", 210.0),
        ("8.5 in", "mm", 215.9),
        ('8.5"', "mm", 215.9),
        ("1 in + 5 mm", "mm", 30.4),
        ("72pt", "mm", 25.4),
        ("0,5 m", "mm", 500.0),
        ("12,5", "mm", 12.5),
        (",5", "mm", 0.5),
        ("1,234.5", "mm", 1234.5),
        ("50k", "", 50_000.0),
        ("1.2 M", "", 1.2e6),
        ("2*15000", "", 30_000.0),
        ("2×15000", "", 30_000.0),
        ("20,000", "", 20_000.0),
        ("1,234,567", "", 1_234_567.0),
        ("(3 + 4) / 2", "", 3.5),
        ("-3", "°", -3.0),
        ("−45°", "°", -45.0),
        ("0.25 turn", "°", 90.0),
        ("50 %", "%", 50.0),
        ("1e-3", "mm", 0.001),
        ("(1 + 2) cm", "mm", 30.0),
        ("2 * -3", "", -6.0),
    ],
)
def test_it_is_read_as_it_is_meant(text: str, unit: str, value: float) -> None:
    assert parse_number(text, unit) == pytest.approx(value)


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("", "mm"),
        ("abc", ""),
        ("5 kg", "mm"),
        ("5 mm", ""),
        ("1,250", "mm"),  # 1250 or 1.25?
        ("1.2.3", "mm"),
        ("1.234,5", "mm"),
        ("3 4", ""),
        ("3 +", ""),
        ("(3", ""),
        ("3)", ""),
        ("1/0", ""),
        ("1e999", ""),
        ("nan", ""),
        ("inf", ""),
        ("(" * 50 + "1" + ")" * 50, ""),
        ("1" * 500, ""),
        ("__import__('os')", ""),
    ],
)
def test_what_is_none_is_refused_with_a_line(text: str, unit: str) -> None:
    with pytest.raises(ParameterError) as refused:
        parse_number(text, unit)
    assert "\n" not in str(refused.value)


@given(st.floats(-1e9, 1e9))
def test_what_fields_show_is_read_back(value: float) -> None:
    assert parse_number(f"{value:.4g} mm", "mm") == pytest.approx(value, rel=1e-3, abs=1e-300)


@given(st.text(max_size=30), st.sampled_from(["", "mm", "°", "%", "px"]))
def test_any_text_is_a_number_or_refused(text: str, unit: str) -> None:
    with contextlib.suppress(ParameterError):
        assert math.isfinite(parse_number(text, unit))
