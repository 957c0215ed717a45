"""Styles are declared once; whatever takes one is made from the declaration."""

from __future__ import annotations

import inspect
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

import stippler
from stippler.cli import app
from stippler.cli import run as main_run
from stippler.drawing.parameter import Kind, Parameter
from stippler.drawing.style import MAX_DOTS, PARAMETERS, Style
from stippler.drawing.style_presets import preset, preset_keys, presets
from stippler.errors import ParameterError


def values_of(about: Parameter) -> st.SearchStrategy[Any]:
    """Return values that a parameter may have."""
    if about.kind is Kind.CHOICE:
        found: st.SearchStrategy[Any] = st.sampled_from(about.values)
    elif about.kind is Kind.FLAG:
        found = st.booleans()
    elif about.kind is Kind.WHOLE:
        found = st.integers(int(about.low), int(about.high))
    elif about.kind is Kind.RANGE:
        ends = st.floats(0.001, 1e6)
        found = st.tuples(ends, ends).map(lambda pair: (min(pair), max(pair)))
    else:
        found = st.floats(max(about.low, -1e9), min(about.high, 1e9))
    return st.none() | found if about.may_lack else found


STYLES = st.fixed_dictionaries({about.name: values_of(about) for about in PARAMETERS})


@given(STYLES, st.text(max_size=20))
def test_every_style_comes_back_from_json(values: dict[str, Any], name: str) -> None:
    if values["sizes"] == "regions":
        values["first_dots"], values["spacing"] = "pulse-density", "even"
    if values["n_dots"] is not None:
        values["density_per_cm2"] = None
    values["tone_white"] *= 0.9 * values["tone_black"]
    style = Style(**values, name=name)
    assert Style.from_json(json.loads(json.dumps(style.to_json()))) == style


@pytest.mark.parametrize("about", PARAMETERS, ids=lambda about: about.name)
def test_what_is_no_value_is_refused_by_name(about: Parameter) -> None:
    wrong: list[Any] = ["\x00nonsense", [1, 2, 3], object()]
    if about.kind in (Kind.WHOLE, Kind.NUMBER):
        wrong += [about.low - 1, float("nan"), True]
        wrong += [about.high + 1] if about.high < 1e300 else []
    for value in wrong:
        with pytest.raises(ParameterError) as caught:
            Style(**{about.name: value})
        assert str(caught.value).startswith(about.said_name)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ({"n_dots": MAX_DOTS + 1}, r"dots: 20000001 is out of range; give 1 to 20,000,000"),
        ({"glitter": 1}, r"style: 'glitter' is unknown; one of n_dots, "),
        ({"name": 3}, r"style: 3 is no name"),
        ({"n_dots": 5, "density_per_cm2": 3.0}, r"density: stands beside a number of dots"),
        ({"tone_white": 0.5, "tone_black": 0.5}, r"tone white: 0.5 is not below 0.5"),
        ({"sizes": "regions", "spacing": "square"}, r"sizes: square has no regions"),
    ],
)
def test_a_bad_style_of_a_file_is_told_in_a_line(data: dict[str, Any], says: str) -> None:
    with pytest.raises(ParameterError, match=says):
        Style.from_json(data)


def test_python_and_the_command_line_take_just_these() -> None:
    words = {about.word for about in PARAMETERS}
    signature = inspect.signature(stippler.stipple)
    assert words <= set(signature.parameters)
    assert all(f"{word} : " in (stippler.stipple.__doc__ or "") for word in words)
    with pytest.raises(ParameterError, match="'glitter' is unknown"):
        stippler.stipple([[0.5]], glitter=True)
    import typer.main

    group: Any = typer.main.get_command(app)
    for command in ("edit", "render", "stats"):
        options = {flag for one in group.commands[command].params for flag in one.opts}
        assert {about.option for about in PARAMETERS} <= options


@pytest.mark.parametrize("key", preset_keys())
def test_every_style_that_comes_with_the_program_draws_and_has_a_swatch(key: str) -> None:
    one = presets()[key]
    assert one.style.name
    assert one.about.endswith(".")
    with Image.open(one.swatch) as swatch:
        assert swatch.mode == "L"
        assert 0.02 < (np.asarray(swatch) < 128).mean() < 0.98
    grey = np.full((30, 40), 0.4)
    drawing = stippler.stipple(grey, 120, 20.0, tone="linear", style=key, iterations=2)
    assert len(drawing.dots) == pytest.approx(120, abs=6)
    assert drawing.style_of(0).spacing == one.style.spacing
    assert drawing.style_of(0).density_per_cm2 is None  # the number that was given counts


def test_there_are_at_least_twelve_styles() -> None:
    assert len(presets()) >= 12
    with pytest.raises(ParameterError, match="'glass' is unknown; one of black-ground, "):
        preset("glass")


def test_a_style_on_the_command_line_counts_less_than_what_stands_beside_it(tmp_path: Path) -> None:
    Image.fromarray(np.full((30, 40), 120, np.uint8)).save(tmp_path / "grey.png")
    out = tmp_path / "out.stipple"
    args = ["render", str(tmp_path / "grey.png"), "-o", str(out), "--style", "fur", "--width", "20"]
    assert main_run([*args, "--dots", "90", "--jitter", "5"]) == 0
    style = stippler.open(out).style_of(0)
    assert (style.name, style.n_dots, style.jitter) == ("Fur", 90, 5.0)
    assert style.elongation == preset("fur").elongation
    assert main_run([*args, "--style", "glass"]) == 2
