"""The audit sees what is wrong with a state: each defect is put in by hand and measured."""

from dataclasses import replace

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.solvers.newton import NewtonOptions, newton
from iga_membrane.terms import BodyDensity
from iga_membrane.verification.audit import audit


class State:
    """A converged state in the scene's scale, and its audit with something changed."""

    def __init__(self, scene):
        self.scene, self.assembly = scene, Assembly(scene)
        self.result = newton(
            self.assembly, scene.local_surface(), None, scene.meridian_grading, NewtonOptions()
        )
        assert self.result.status is None

    def audit(self, *, scene=None, surface=None, body=None):
        surface = surface or self.result.surface
        return audit(
            scene or self.scene,
            surface,
            self.assembly.spines.on(surface),
            body or self.assembly.density(self.result.multipliers),
            self.assembly.line_load(self.result.multipliers),
            self.assembly.points,
            self.assembly.contact,
        )


@pytest.fixture(scope="module")
def drop():
    return State(droplet(120, 1.0, elements=12))


@pytest.fixture(scope="module")
def rough():
    lattice = iga.SphereLattice(180.0, 0.25, 0.7)
    mesh = iga.Discretization(elements=40)
    scene = iga.sessile_droplet(
        lattice, volume=UNIT_VOLUME, gravity=1.0, hold="xy", discretization=mesh
    )
    return State(scene)


def test_a_right_state_has_no_defects(drop, rough):
    right = drop.audit()
    assert max(abs(right.defects[name]) for name in right.gathered) <= 1e-4
    found = rough.audit()
    assert found.residual <= 1e-3
    assert found.volume <= 1e-8
    assert found.force <= 1e-3
    assert found.penetration <= 1e-2


def test_a_larger_drop_misses_its_volume_and_its_balance(drop, rough):
    for state, part in ((drop, 1.01), (rough, 1.003)):
        surface = state.result.surface
        found = state.audit(surface=surface.moved(part * surface.points))
        assert found.volume == pytest.approx(part**3 - 1.0, rel=1e-2)
        assert found.residual > 1e-3


@pytest.mark.parametrize("error", [0.01, -0.02])
def test_a_wrong_pressure_is_out_of_balance_by_as_much(drop, error):
    body = drop.assembly.density(drop.result.multipliers)
    wrong = BodyDensity(body.constant * (1.0 + error), body.gradient)
    found = drop.audit(body=wrong)
    assert found.residual > 1e-3
    solution = iga.solve(drop.scene)
    push = solution.measures["p_base"] * solution.measures["A_wet"]
    line = 2 * np.pi * solution.measures["contact_radius"] * np.sin(np.radians(120))
    # the excess over all vertical forces: push, line, weight
    scale = push * (1.0 + error) + line + UNIT_VOLUME
    assert found.force == pytest.approx(abs(error) * push / scale, rel=1e-2)
    assert found.line == pytest.approx(abs(error) * push / scale, rel=5e-2)


def test_a_wrong_weight_is_out_of_balance(drop, rough):
    for state in (drop, rough):
        body = state.assembly.density(state.result.multipliers)
        x, y, z = body.gradient
        found = state.audit(body=BodyDensity(body.constant, (x, y, 1.05 * z)))
        assert found.force > 5e-3
        assert found.residual > 1e-4


def test_a_push_to_the_side_is_seen(rough):
    body = rough.assembly.density(rough.result.multipliers)
    leaning = BodyDensity(body.constant, (0.02, 0.0, body.gradient[2]))
    free = replace(
        rough.scene,
        supports=[s for s in rough.scene.supports if not isinstance(s, iga.Sector)],
    )
    # the same state as a full model: only one sector of it is summed
    found = rough.audit(scene=free, body=leaning)
    assert found.sideways > 5e-3


def test_another_contact_angle_is_seen(drop):
    other = droplet(125, 1.0, elements=12)
    found = drop.audit(scene=other)
    expected = np.cos(np.radians(120)) - np.cos(np.radians(125))
    assert found.angle == pytest.approx(expected, rel=1e-3)


def test_a_sunken_membrane_is_seen_with_its_place(drop, rough):
    for state, depth, unit in ((drop, 0.02, 1.0), (rough, 0.01, 0.25)):
        surface = state.result.surface
        before = state.audit().penetration
        found = state.audit(surface=surface.moved(surface.points - [0.0, 0.0, depth]))
        assert found.penetration - before == pytest.approx(depth / unit, rel=0.15)
        assert len(found.deepest) == 3
        assert found.deepest[2] < 0.02
