"""Values that were taken silently for others, or ended in an error of NumPy's."""

import numpy as np
import pytest
from shapely.geometry import LinearRing, box

import stippler
from stippler.errors import StipplerError

SQUARE = [(0, 0), (10, 0), (10, 10), (0, 10)]
DOTS = np.random.default_rng(0).random((50, 2)) * 10


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        ({"points": [["a", "b"]]}, "dots: is no array of numbers"),
        ({"points": [[1, 2], [3]]}, "dots: is no array of numbers"),
        ({"points": DOTS + 1j}, "dots: is no array of numbers"),
        ({"polygon": ["a"]}, "polygon: is no array of numbers"),
        ({"polygon": [[(0, 0), (1,)]]}, "compartment 0: is no array of numbers"),
        ({"polygon": LinearRing(SQUARE)}, "LinearRing is no polygon"),
        ({"polygon": np.array(SQUARE) * 1e149}, "compartment 0: reaches beyond"),
        ({"iterations": 1.5}, "iterations: 1.5 is no whole number"),
        ({"iterations": None}, "iterations: None is no whole number"),
        ({"tolerance_mm": np.nan}, "tolerance: nan is no length"),
        ({"over_relaxation": "a"}, "over-relaxation: "),
        ({"fixed": np.full(50, np.nan)}, "fixed: nan, for dot 0, is not true or false"),
        ({"fixed": ["no"] * 50}, "fixed: is no array of numbers"),
        ({"compartment_of_dot": [1] * 50}, "there is no compartment 1, named for dot 0"),
        ({"compartment_of_dot": [-1] * 50}, "there is no compartment -1"),
        ({"compartment_of_dot": [2**40] * 50}, "not a whole number"),
        ({"compartment_of_dot": [0.5] * 50}, "0.5, for dot 0, is not a whole number"),
        ({"density": np.full((4, 4), 1e308)}, "density: has to be between 0 and 1e"),
        ({"density": [[1, 2], [3]]}, "density: is no array of numbers"),
        ({"density": lambda x, y: x[:3]}, "density: the function returns shape"),
        ({"density": lambda x, y: "much"}, "density: is no array of numbers"),
    ],
)
def test_relax_names_what_is_wrong(arguments, match):
    with pytest.raises(StipplerError, match=match):
        stippler.relax(**({"points": DOTS, "polygon": SQUARE} | arguments))


def test_a_list_of_lists_of_corners_is_a_list_of_polygons():
    corners = [SQUARE, [(20, 0), (30, 0), (30, 10)]]
    dots = np.concatenate([DOTS, [(28.0, 3.0)]])
    shapes = [np.array(ring, float) for ring in corners]
    assert np.array_equal(stippler.relax(dots, corners), stippler.relax(dots, shapes))


@pytest.mark.parametrize(
    ("area", "n", "seed", "match"),
    [
        (SQUARE, 1.5, 1, "dots: 1.5 is no whole number"),
        (SQUARE, "a", 1, "dots: 'a' is no whole number"),
        (SQUARE, 5, -1, "seed: -1 is no seed"),
        (SQUARE, 5, 1.5, "seed: 1.5 is no whole number"),
        (np.array(SQUARE) * 1e200, 5, 1, "area: reaches beyond"),
        ([box(0, 0, 1, 1)], 5, 1, "area: is no array of numbers"),
    ],
)
def test_fill_names_what_is_wrong(area, n, seed, match):
    with pytest.raises(StipplerError, match=match):
        stippler.fill(area, n, "random", seed=seed)


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        ({"image": [[1, 2], [3]]}, "image: rows differ in length"),
        ({"dots": 1.5}, "dots: 1.5 is no whole number"),
        ({"iterations": "a"}, "iterations: 'a' is no whole number"),
        ({"seed": 1.5}, "seed: 1.5 is no whole number"),
        ({"size_range": (1,)}, r"size range: \(1,\) is no range of radii"),
        ({"size_range": 5}, "size range: 5 is no range of radii"),
        ({"size_range": (0.2, 0.1)}, "size range: 0.2:0.1 is no range of radii"),
    ],
)
def test_stipple_names_what_is_wrong(arguments, match):
    with pytest.raises(StipplerError, match=match):
        stippler.stipple(**({"image": np.zeros((5, 5))} | arguments))
