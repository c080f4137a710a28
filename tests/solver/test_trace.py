"""Paths of equilibria: there and back, stops, limit points in brackets, what is refused."""

import numpy as np
import pytest
from helpers import particle_sheet

import iga_membrane as iga
from iga_membrane.reference import catenoid
from iga_membrane.reference.catenoid import LIMIT


def film(half_height):
    mesh = iga.Discretization("bspline", 4, 10)
    return iga.film_between_rings(half_height=half_height, discretization=mesh)


@pytest.mark.parametrize("boundary", ["circle", pytest.param("square", marks=pytest.mark.slow)])
def test_a_sheet_comes_back_to_where_it_started(boundary):
    angles = (150.0, 120.0, 90.0, 60.0, 30.0, 60.0, 90.0, 120.0, 150.0)
    path = iga.trace(lambda angle: particle_sheet(angle, boundary=boundary), angles)
    lines = [s.measures["F_CL"] for s in path.solutions]
    assert path.success
    assert lines[4:] == pytest.approx(lines[4::-1], abs=1e-6)
    # and every state on the way is the one that a direct solve finds
    direct = iga.solve(particle_sheet(90, boundary=boundary)).measures["F_CL"]
    assert lines[2] == pytest.approx(direct, abs=1e-6)
    assert lines[:5] == sorted(lines[:5])


def test_the_history_holds_every_value_with_its_measures():
    values = (0.3, 0.45, 0.5)
    path = iga.trace(film, values, parameter="rings.half_height")
    assert path.parameter == "rings.half_height"
    assert path.values == values
    stops = [step for step in path.end.load_steps if step.measures is not None]
    assert [step.value for step in stops] == list(values)
    for step, solution in zip(stops, path.solutions, strict=True):
        assert step.status is None
        assert step.measures == solution.measures
        exact = catenoid(step.value)["neck_radius"]
        assert step.measures["neck_radius"] == pytest.approx(exact, rel=1e-5)


def test_measures_belong_to_the_values_that_were_asked_for_only():
    path = iga.trace(film, (0.1, 0.6))
    between = [step for step in path.end.load_steps if 0.0 < step.load < 1.0]
    assert between
    assert all(step.measures is None for step in between)
    assert [s.scene.description["rings"]["half_height"] for s in path.solutions] == [0.1, 0.6]


def test_a_path_through_the_limit_stops_at_it():
    path = iga.trace(film, (0.5, 0.6, 0.7), parameter="rings.half_height", on_fail="return")
    assert not path.success
    assert path.values == (0.5, 0.6)
    assert len(path.solutions) == 2
    assert path.end.status is iga.Status.LIMIT_POINT
    bracket = path.bracket
    assert bracket.parameter == "rings.half_height"
    assert bracket.lo <= LIMIT * (1 + 1e-6)
    assert bracket.hi >= LIMIT * (1 - 1e-6)
    assert bracket.hi - bracket.lo <= 1e-3
    assert (bracket.index_lo, bracket.index_hi) == (0, 1)


def test_a_path_that_stops_short_is_an_error_unless_asked_otherwise():
    with pytest.raises(
        iga.SolveError, match=r"LIMIT_POINT: no equilibrium beyond height"
    ) as caught:
        iga.trace(film, (0.6, 0.7), parameter="height")
    assert caught.value.solution.bracket.lo < LIMIT


def test_the_limit_is_approached_without_losing_iterations_or_digits():
    shares = np.array([0.9, 0.99, 0.999, 0.9999])
    path = iga.trace(lambda h: iga.film_between_rings(half_height=h), shares * LIMIT)
    stops = [step for step in path.end.load_steps if step.measures is not None]
    assert path.success
    assert max(step.iterations for step in stops) <= 3 * stops[0].iterations
    softest = [s.lambda_min for s in path.solutions]
    assert softest == sorted(softest, reverse=True)
    assert softest[-1] > 0.0
    for share, solution in zip(shares, path.solutions, strict=True):
        exact = catenoid(share * LIMIT)["neck_radius"]
        assert solution.measures["neck_radius"] == pytest.approx(exact, rel=1e-5)


def test_every_load_reached_is_reported():
    seen = []
    path = iga.trace(film, (0.3, 0.4, 0.5), report=seen.append)
    assert seen == [step.load for step in path.end.load_steps[1:]]
    assert seen[-1] == 1.0


@pytest.mark.parametrize("values", [[], [0.5]])
def test_a_path_needs_two_values(values):
    with pytest.raises(iga.SceneError, match="a path needs two or more"):
        iga.trace(film, values)


def test_a_value_that_is_no_number_is_named():
    with pytest.raises(iga.SceneError, match=r"values\[1\] = nan"):
        iga.trace(film, [0.5, float("nan")])


def test_a_path_whose_first_scene_has_no_equilibrium_has_no_solutions():
    path = iga.trace(film, (0.7, 0.8), on_fail="return")
    assert path.values == ()
    assert not path.success
    assert not path.end.success
