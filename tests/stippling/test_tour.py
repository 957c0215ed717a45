"""Tours: permutations without crossings, short beside what others find."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import cKDTree

from stippler.kernels.machine import pool
from stippler.stippling.tour import crossings, length_of, neighbours, tour

COORDINATES = st.floats(-100, 100, width=32) | st.integers(0, 4).map(float)


@settings(max_examples=60)
@given(
    arrays(np.float64, st.tuples(st.integers(0, 60), st.just(2)), elements=COORDINATES),
    st.booleans(),
    st.sampled_from([0.0, 2.0]),
)
def test_a_tour_is_a_permutation(points, closed, effort):
    order = tour(points, closed=closed, effort=effort)
    assert sorted(order) == list(range(len(points)))


@settings(max_examples=30)
@given(st.integers(8, 400), st.integers(0, 2**32 - 1), st.booleans())
def test_no_steps_cross(n, seed, closed):
    points = np.random.default_rng(seed).random((n, 2))
    order = tour(points, closed=closed, effort=1)
    assert len(crossings(points[order])) == 0
    if not closed:
        steps = np.hypot(*np.diff(points[order], axis=0).T)
        assert steps.max() <= np.hypot(*(points[order[0]] - points[order[-1]])) + 1e-12


@given(
    arrays(np.float64, st.tuples(st.integers(2, 60), st.just(2)), elements=COORDINATES),
)
def test_neighbours_are_the_nearest(points):
    near = neighbours(points, 8)
    k = min(9, len(points))
    truth, _ = cKDTree(points).query(points, k=k)
    for i, row in enumerate(near):
        row = row[row >= 0]
        assert i not in row
        away = np.hypot(*(points[row] - points[i]).T)
        np.testing.assert_allclose(away, np.sort(truth[i])[1:][: len(row)], atol=1e-9)
        assert len(row) == min(8, len(points) - 1)


def test_short_beside_or_tools():
    """Within 8 % of what OR-tools finds in a long search; ours is usually shorter."""
    from ortools.constraint_solver import pywrapcp, routing_enums_pb2

    points = np.random.default_rng(7).random((300, 2))
    ours = length_of(points, tour(points, closed=True, effort=20), closed=True)
    away = np.rint(1e6 * np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1)))
    away = away.astype(int)
    manager = pywrapcp.RoutingIndexManager(len(points), 1, 0)
    routing = pywrapcp.RoutingModel(manager)
    index = routing.RegisterTransitMatrix(away.tolist())
    routing.SetArcCostEvaluatorOfAllVehicles(index)
    parameters = pywrapcp.DefaultRoutingSearchParameters()
    found = routing_enums_pb2.LocalSearchMetaheuristic.GUIDED_LOCAL_SEARCH
    parameters.local_search_metaheuristic = found
    parameters.time_limit.seconds = 5
    theirs = routing.SolveWithParameters(parameters).ObjectiveValue() / 1e6
    assert ours < 1.08 * theirs


def test_short_beside_the_constant_of_random_points():
    """0.7124 sqrt(n A) is what the shortest tour of many random points tends to."""
    n = 5000
    points = np.random.default_rng(1).random((n, 2))
    shortest = 0.7124 * np.sqrt(n) * (1 + 0.33 / np.sqrt(n))
    assert length_of(points, tour(points, closed=True), closed=True) < 1.13 * shortest
    assert length_of(points, tour(points, closed=True, effort=2), closed=True) < 1.06 * shortest


def test_the_same_with_any_number_of_threads():
    points = np.random.default_rng(3).random((6000, 2))
    both = []
    for n in (1, 2):
        pool.set_threads(n)
        both.append(tour(points, effort=0.3))
    pool.set_threads(0)
    np.testing.assert_array_equal(*both)


def test_it_can_be_given_up():
    points = np.random.default_rng(3).random((3000, 2))
    order = tour(points, effort=1000, cancel=iter([False] * 4 + [True] * 99).__next__)
    assert sorted(order) == list(range(3000))


@pytest.mark.parametrize("n", [0, 1, 2, 3, 4, 5])
def test_few_points(n):
    points = np.random.default_rng(n).random((n, 2))
    assert sorted(tour(points, closed=True, effort=3)) == list(range(n))
