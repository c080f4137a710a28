"""Verdicts of the whole body, whatever part of it is computed."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet, some
from scipy.linalg import eigh, null_space
from scipy.special import jn_zeros

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.dofs.boundary_conditions import Sector
from iga_membrane.initial.liquid import MODELS
from iga_membrane.solvers.neutral import neutral_motions
from iga_membrane.solvers.newton import NewtonOptions, newton
from iga_membrane.solvers.second_variation import SecondVariation

FILM = float(jn_zeros(1, 1)[0]) ** 2
"""rho g R^2 / gamma beyond which a flat round film of prescribed volume gives way sideways."""


def mesh(elements, model=None):
    return iga.Discretization(elements=elements, model=model)


def film(weight, model=None, radius=1.0, volume=0.0):
    return iga.liquid_sheet(
        size=2.0 * radius, boundary="circle", volume=volume, gravity=1.0, liquid_weight=True,
        liquid=iga.Liquid(1.0, weight / radius**2), discretization=mesh(6, model),
    )  # fmt: skip


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(("share", "radius"), [(0.98, 1.0), (1.02, 0.6)])
def test_a_film_gives_way_sideways_where_the_closed_form_says(share, radius, model):
    """Pinned at its rim, its softest motion that keeps the volume is J_1(j_11 r) cos(phi)."""
    found = iga.solve(film(share * FILM, model, radius), on_fail="return")
    assert found.stability_scope == "full"
    assert found.lambda_min == pytest.approx((1.0 - share) * FILM / radius**2, abs=1e-3)
    assert found.index == (2 if share > 1.0 else 0)
    stable = iga.Status.CONVERGED_STABLE
    assert found.status is (stable if share < 1.0 else iga.Status.CONVERGED_SADDLE)


@pytest.mark.slow
def test_a_film_that_no_volume_makes_stable_is_not_followed_to_none():
    """Its ramp is unstable from its first value on, 0, next to which no bracket is narrow."""
    found = iga.solve(film(1.1 * FILM, "full", volume=1e-3), on_fail="return")
    assert (found.status, found.index) == (iga.Status.CONVERGED_SADDLE, 2)
    tried = sorted(step.load for step in found.load_steps)
    assert 0.0 < tried[1] < 2.0 * iga.SolverOptions().min_load_step
    assert tried[1] > 0.25 * iga.SolverOptions().min_load_step


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize("elements", [6, 9, None])
@pytest.mark.parametrize(("ellipse", "turns"), [(0.0, 1), (0.01, 0)])
def test_rims_let_liquid_turn_if_they_are_round(ellipse, turns, elements, degree):
    """Of spline rings, which are not quite round, and of ellipses that differ by a hundredth."""
    space = iga.Discretization(elements=elements, degree=degree, model="full")
    scene = iga.film_between_rings(half_height=0.5, volume=4.0, discretization=space)
    local = scene.local_surface()
    surface = local.moved(local.points * [1.0 + ellipse, 1.0, 1.0])
    found = neutral_motions(scene, Assembly(scene), surface, np.array([4.0, 0.0, 0.0, 0.0]), "")
    assert len(found) == turns
    for motion in found:
        assert np.abs(motion / motion[5]) == pytest.approx([0, 0, 0, 0, 0, 1], abs=1e-3)


def test_the_verdict_within_a_model_is_asked_for():
    found = iga.solve(film(1.02 * FILM), iga.SolverOptions(stability="model"))
    assert found.stability_scope == "eighth"
    assert found.index == 0
    with pytest.raises(iga.SceneError, match=r"solver\.stability = 'sector'"):
        iga.SolverOptions(stability="sector")


def test_a_saddle_beyond_the_model_is_not_followed_down_in_silence():
    options = iga.SolverOptions(follow_instability=True)
    found = iga.solve(film(1.02 * FILM), options, on_fail="return")
    assert found.status is iga.Status.CONVERGED_SADDLE
    assert 'take discretization.model = "half"' in found.message
    # the mode is odd in x and even in y
    mode = found.surface.moved(found.mode)
    xi = np.array([[phi, 0.4] for phi in (0.3, np.pi - 0.3, -0.3)]) % [2.0 * np.pi, 1.0]
    one, across, beside = mode.at(xi, 1).position[:, 2]
    assert across == pytest.approx(-one, rel=1e-6)
    assert beside == pytest.approx(one, rel=1e-6)
    assert abs(one) > 1e-2


def between_spheres():
    low, high = iga.Sphere(60.0, 1.0, (0.0, 0.0, -1.3)), iga.Sphere(80.0, 0.7, (0.0, 0.0, 1.0))
    return iga.sessile_droplet(None, volume=1.0, particles=[low, high], discretization=mesh(5))


KINDS = {
    "droplet on a sphere": lambda: iga.sessile_droplet(
        iga.Sphere(110.0, 1.3, (0.0, 0.0, -1.3)), volume=UNIT_VOLUME, gravity=0.6,
        discretization=mesh(6),
    ),
    "square film": lambda: iga.liquid_sheet(size=2.0, pressure=0.4, discretization=mesh(6)),
    "square film, one element across its middle": lambda: iga.liquid_sheet(
        size=2.0, pressure=0.4, discretization=mesh(5)
    ),
    "square sheet on a particle": lambda: iga.liquid_sheet(
        iga.Sphere(70.0, 1.0, (0.0, 0.0, 0.2)), size=6.0, discretization=mesh(6)
    ),
    "film between rings": lambda: iga.film_between_rings(
        half_height=0.5, discretization=mesh(6, "eighth")
    ),
    "bridge": between_spheres,
    "cell": lambda: iga.asperity_cell(
        iga.Sphere(130.0, 1.0, (0.0, 0.0, -1.0)), size=3.0, pressure=0.4, discretization=mesh(14)
    ),
    "quadratic polynomials": lambda: iga.liquid_sheet(
        size=2.0, boundary="circle", pressure=0.5,
        discretization=iga.Discretization("lagrange", 2, 5),
    ),
}  # fmt: skip


def spectrum(state, block, count=14):
    """The lowest eigenvalues of a block on the motions that keep the constraints."""
    border = state.border(block, "")
    # unknowns that rest have a stiffness of their own, and no mass
    moving = np.flatnonzero(state.mass(block).diagonal())
    kept = null_space(border[moving].T) if border.shape[1] else np.eye(len(moving))
    mass, matrix = (
        kept.T @ of.dense()[np.ix_(moving, moving)] @ kept
        for of in (state.mass(block), state.matrix(block))
    )
    return eigh(matrix, mass, eigvals_only=True)[:count]


@pytest.mark.parametrize("model", some(("half", "quarter", "eighth"), {0, 2}))
@pytest.mark.parametrize("name", KINDS)
def test_blocks_of_all_parities_are_the_whole_body(name, model):
    """Their eigenvalues, those of E twice, are those of the state in the full model."""
    scene = KINDS[name]()
    others = [s for s in scene.supports if not isinstance(s, Sector)]
    part, full = (replace(scene, supports=[*others, Sector(m)]) for m in (model, "full"))
    assembly, whole = Assembly(part), Assembly(full)
    options = NewtonOptions(near=np.inf)
    found = newton(assembly, part.local_surface(), None, part.meridian_grading, options)
    assert found.status is None
    surface, spines = found.surface, whole.spines
    multipliers = np.zeros(whole.multipliers)
    multipliers[: len(whole.held)] = found.multipliers[: len(whole.held)]
    edge = np.flatnonzero(spines.second < spines.spare)
    load = assembly.line_load(found.multipliers)[edge]
    multipliers[len(whole.held) + spines.held[spines.second[edge]]] = load
    for one in (assembly, whole):
        one.relaxed(surface, one.motion(surface))  # what is tied where solids cut elements
    state = SecondVariation(assembly, surface, found.multipliers)
    blocks = [
        np.tile(spectrum(state, block), block.parity.alike) for block in assembly.spines.blocks
    ]
    unfolded = SecondVariation(whole, surface, multipliers)
    expected = spectrum(unfolded, spines.blocks[0])
    together = np.sort(np.concatenate(blocks))[: len(expected)]
    # ties across cut elements are as strong as the median element at the solid says
    accuracy = 1e-6 if not whole.contact.passes else 2e-4
    np.testing.assert_allclose(together, expected, rtol=accuracy, atol=1e-7)


@pytest.mark.parametrize("model", MODELS)
def test_a_weightless_droplet_rolls_freely_on_its_sphere(model):
    sphere = iga.Sphere(100.0, 0.8, (0.0, 0.0, -0.8))
    scene = iga.sessile_droplet(sphere, volume=UNIT_VOLUME, discretization=mesh(6, model))
    found = iga.solve(scene)
    for axis in "xy":
        told = f"rotation about {axis} through (0, 0, -0.8)"
        assert any(told in text for text in found.warnings)


@pytest.mark.parametrize("model", MODELS)
def test_a_droplet_slides_freely_on_its_plane(model):
    found = iga.solve(droplet(100, 0.5, elements=6, model=model))
    (told,) = (text for text in found.warnings if "neutral" in text)
    assert "translation along x" in told
    assert "translation along y" in told
    assert "rotation" not in told  # the droplet does not see it
    held = iga.solve(droplet(100, 0.5, elements=6, model=model, hold="xy"))
    assert not any("neutral" in text for text in held.warnings)


@pytest.mark.slow
@pytest.mark.parametrize(("azimuth", "radius"), [(0.0, 0.25), (0.7, 0.22), (2.5, 0.3)])
def test_a_droplet_turns_freely_about_its_particle(azimuth, radius):
    """On a plane, beside its axis: about the vertical line through the particle's centre."""
    x, y = 0.5 * np.cos(azimuth), 0.5 * np.sin(azimuth)
    particle = iga.Sphere(62.0, radius, (float(x), float(y), 1.3))
    scene = iga.sessile_droplet(
        iga.Plane(120.0), volume=UNIT_VOLUME, gravity=0.1, particles=[particle]
    )
    found = iga.solve(scene)
    assert any(f"rotation about z through ({x:.4g}, {y:.4g}" in text for text in found.warnings)


@cache
def coarse_ring(model):
    turn = np.radians(120.0)

    def cap(t):
        polar = turn * (1.0 - t)
        return np.sin(polar), np.cos(polar) - np.cos(turn), -turn * np.cos(polar)

    start = iga.axisymmetric(iga.drop_space("bspline", 3, 8, around=8), cap)
    return iga.solve(replace(droplet(120.0, 1.0, model=model), surface=start, ramp=None))


@pytest.mark.parametrize("model", MODELS)
def test_a_coarse_ring_has_one_verdict_in_all_models(model):
    """Its spline is not quite round, and its smallest model has no motion of one parity: a turn
    about the axis is no motion that nothing resists, and nothing is counted of what is not there.
    """
    found = coarse_ring(model)
    assert found.index == 0
    assert found.lambda_min == pytest.approx(coarse_ring("full").lambda_min, rel=1e-6)
    assert "rotation" not in "".join(found.warnings)
