"""Bridges between wetting solids against an independent axisymmetric solution."""

from functools import lru_cache
from itertools import product

import numpy as np
import pytest
from helpers import some

import iga_membrane as iga
from iga_membrane.reference import bridge_between, limit_of_stability

PLANE = np.inf
ROUND = iga.Discretization(model="eighth")
"""The witness knows bodies of revolution only."""
SEED = 20261130
"""Of the generated members."""


def scene(radii, angles, gap, volume, **more):
    """A bridge over z = 0 with its lower solid's point on the axis in the origin."""
    one, two = radii
    upper = iga.Sphere(angles[1], two, (0.0, 0.0, two + gap))
    if np.isinf(one):
        return iga.sessile_droplet(iga.Plane(angles[0]), volume=volume, particles=[upper], **more)
    lower = iga.Sphere(angles[0], one, (0.0, 0.0, -one))
    return iga.sessile_droplet(None, volume=volume, particles=[lower, upper], **more)


def member(number, wet=(False, False)):
    """One of the kind, with the witness's solution: radii, contact angles of 0.5 to 90 degrees, or
    0 where it is ``wet``, a gap and a volume."""
    rng = np.random.default_rng((SEED, number))
    while True:
        radii = float(rng.choice([PLANE, 1.0, 1.0, 3.0])), float(rng.choice([0.3, 1.0, 2.0]))
        spread = rng.uniform(0.5, 90.0, 2), np.exp(rng.uniform(np.log(0.5), np.log(30.0), 2))
        angles = tuple(float(a) * (not w) for a, w in zip(spread[number % 2], wet, strict=True))
        gap, volume = (float(10.0 ** rng.uniform(-3.0, top)) for top in (0.0, 0.3))
        try:
            return radii, angles, gap, volume, bridge_between(radii, angles, gap, volume)
        except ValueError:
            continue  # no bridge there


def agrees(found, witness):
    """Forces within 1e-6, pressures within 1e-5."""
    assert found.success, found.message
    pull = np.array(found.forces[-1].effective)
    np.testing.assert_allclose(pull, [0.0, 0.0, -witness.force], atol=1e-6 * abs(witness.force))
    allowed = 1e-5 * max(abs(witness.pressure), 1.0 / witness.neck_radius)
    assert found.measures["pressure"] == pytest.approx(witness.pressure, abs=allowed)


@pytest.mark.parametrize("number", some(range(40), range(4)))
def test_forces_and_pressures_between_any_two_solids(number):
    *asked, witness = member(number)
    agrees(iga.solve(scene(*asked)), witness)


WET = [(True, True), (True, False), (False, True)]


@pytest.mark.parametrize(("number", "wet"), some(product(range(12), WET), {0, 4, 8}))
def test_perfectly_wet_solids(number, wet):
    """At 0 degrees the membrane leaves its solid tangentially, at a place that is found."""
    *asked, witness = member(number, wet)
    found = iga.solve(scene(*asked))
    agrees(found, witness)
    assert found.measures["energy"] == pytest.approx(witness.E_surf, rel=1e-6)


def test_the_balance_of_a_perfectly_wet_bridge_is_that_of_its_neck():
    """Without weight every level carries ``gamma l - p A``; published limit of the force."""
    found = iga.solve(scene((1.0, 1.0), (0.0, 0.0), 0.05, 0.01))
    assert 2.9729 < abs(found.forces[1].effective[2]) < 2.98
    assert found.audit.defects["force"] < 1e-9
    assert abs(found.audit.defects["angle"]) < 1e-12


@pytest.mark.parametrize(
    "make",
    [
        lambda: iga.sessile_droplet(iga.Plane(0.0), volume=1.0),
        lambda: iga.sessile_droplet(iga.Sphere(0.0, 1.0), volume=1.0),
        lambda: iga.sessile_droplet(
            iga.Plane(90.0), volume=4.0, particles=[iga.Sphere(0.0, 0.2, (0.5, 0.0, 1.0))]
        ),
        lambda: iga.liquid_sheet(iga.Sphere(0.0, 1.0), size=5.0),
        lambda: iga.asperity_cell(iga.Sphere(0.0, 1.0), size=3.0, pressure=0.1),
        lambda: iga.SphereLattice(0.0, 1.0, 3.0),
    ],
    ids=["plane", "sphere", "particle", "sheet", "cell", "lattice"],
)
def test_perfectly_wet_solids_that_nothing_bridges_are_refused(make):
    with pytest.raises(iga.SceneError, match=r"contact_angle.* = 0.*must be > 0"):
        make()


def test_a_perfectly_wet_bridge_in_leaning_gravity_is_refused():
    with pytest.raises(iga.SceneError, match="leans across the axis"):
        scene((1.0, 1.0), (0.0, 0.0), 0.1, 0.05, gravity=(0.1, 0.0, 0.0))


@pytest.mark.parametrize(
    "asked",
    some(
        [
            (((1.0, 1.0), (0.5, 0.5), 0.001, 0.001),),
            (((PLANE, 1.0), (0.5, 0.5), 0.05, 0.01),),
            (((1.0, 4.0), (0.655, 1.294), 0.1947, 0.2009),),
            (((50.0, 50.0), (110.0, 60.0), 0.6, 1.0),),
            (((PLANE, 1.0), (40.0, 40.0), 0.3, 1.0),),
        ],
        {0, 1, 3},
    ),
)
def test_nearly_tangent_lines_thin_gaps_and_flat_spheres(asked):
    agrees(iga.solve(scene(*asked)), bridge_between(*asked))


def test_weight_along_the_axis():
    asked = (0.8, 1.0), (50.0, 65.0), 0.15, 0.3
    witness = bridge_between(*asked, bond=1.2)
    agrees(iga.solve(scene(*asked, gravity=1.2)), witness)


@lru_cache
def limit():
    return limit_of_stability((1.0, 1.0), (60.0, 60.0), (0.5, 0.8), 0.1)


@pytest.mark.slow
@pytest.mark.parametrize(
    "gap", [0.698, *(pytest.param(gap, marks=pytest.mark.slow) for gap in (0.74, 0.9))]
)
def test_loss_of_stability_is_bracketed(gap):
    """Of the motion that is odd about the middle: symmetric bridges exist up to a gap of 0.817."""
    found = iga.solve(scene((1.0, 1.0), (60.0, 60.0), gap, 0.1), on_fail="return")
    assert found.status is iga.Status.LIMIT_POINT
    bracket = found.bracket
    assert bracket.parameter == "gap"
    assert bracket.lo <= limit() * (1.0 + 1e-4)
    assert bracket.hi >= limit() * (1.0 - 1e-4)
    assert bracket.hi - bracket.lo <= 1e-3 * limit()


@pytest.mark.slow
def test_path_in_the_gap_ends_at_the_loss_of_stability():
    """Of unequal spheres, at a fold."""
    asked = (1.0, 2.0), (45.0, 70.0)
    end = limit_of_stability(*asked, (0.2, 0.9), 0.1)

    def at(gap):
        return scene(*asked, gap, 0.1, discretization=ROUND)

    gaps = [0.1, 0.5 * end, 1.2 * end]
    path = iga.trace(at, gaps, parameter="gap", on_fail="return")
    assert len(path.solutions) == 2
    assert path.end.status is iga.Status.LIMIT_POINT
    assert path.bracket.lo == pytest.approx(end, rel=1e-3)
    assert path.bracket.hi == pytest.approx(end, rel=1e-3)


@pytest.mark.slow
def test_path_in_the_contact_angle_comes_through():
    def at(angle):
        return scene((1.0, 1.0), (angle, angle), 0.05, 0.02, discretization=ROUND)

    path = iga.trace(at, [40.0, 0.5], parameter="contact_angle")
    for angle, found in zip(path.values, path.solutions, strict=True):
        agrees(found, bridge_between((1.0, 1.0), (angle, angle), 0.05, 0.02))
