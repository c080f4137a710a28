"""Statuses, stability and invariants of solves (Q3, Q5, Q6, Q9, Q10, L1, L2)."""

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet, pinned_cap, solved

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.solvers import newton as newton_module
from iga_membrane.solvers.newton import NewtonOptions

TENSION = iga.SurfaceTension(1.0)


def test_pinned_cap_passes_its_pressure_maximum_under_volume_control():
    for volume in (1.0, 2 * np.pi / 3, 4.0):
        scene = pinned_cap(1.0, [TENSION, iga.Volume(volume)], "eighth", elements=12, degree=4)
        solution = iga.solve(scene)
        height = np.roots([np.pi / 6, 0, np.pi / 2, -volume])
        height = height[np.isreal(height)].real[0]
        pressure = 4 * height / (1 + height**2)
        assert solution.multipliers["volume"] == pytest.approx(pressure, rel=1e-6)


def test_pinned_cap_under_pressure_is_solved_below_its_maximum_and_never_above():
    below = iga.solve(pinned_cap(1.0, [TENSION, iga.Pressure(1.9)], degree=4, elements=12))
    radius = 2 / 1.9
    exact = radius - np.sqrt(radius**2 - 1)
    assert below.surface.net[0, -1, 2] == pytest.approx(exact, rel=1e-6)
    above = iga.solve(pinned_cap(1.0, [TENSION, iga.Pressure(2.01)]), on_fail="return")
    assert not above.success


def test_large_pinned_cap_is_a_saddle_under_pressure_and_stable_under_volume():
    """The same sphere beyond the hemisphere: what is held decides its stability."""
    opening = np.radians(115.0)
    radius = 1 / np.sin(opening)
    held = pinned_cap(opening, [TENSION, iga.Pressure(2 / radius)], "eighth", elements=12)
    saddle = iga.solve(held, on_fail="return")
    assert saddle.status is iga.Status.CONVERGED_SADDLE
    assert saddle.index == 1
    assert saddle.lambda_min < 0
    height = radius * (1 - np.cos(opening))
    volume = np.pi * height * (3 + height**2) / 6
    assert iga.solve(pinned_cap(opening, [TENSION, iga.Volume(volume)], "eighth")).success


def test_flat_membrane_has_the_eigenvalues_of_a_drum():
    rim = [iga.Fixed(f"xi{i}={j}") for i in (1, 2) for j in (0, 1)]
    flat = iga.sheet(1.0, elements=8)
    middle = (np.abs(flat.points[:, :2]) < 0.4).all(axis=1, keepdims=True)
    scene = iga.Scene(flat.moved(flat.points + [0.0, 0.0, 1e-3] * middle), [TENSION], rim)
    assert iga.solve(scene).lambda_min == pytest.approx(2 * np.pi**2, rel=1e-4)


@pytest.mark.parametrize("bond", [0.5, 4.0])
def test_force_and_virial_balances_of_a_drop(bond):
    solution = solved(130, bond)
    m = solution.measures
    line = 2 * np.pi * m["contact_radius"] * np.sin(np.radians(130))
    weight = bond * UNIT_VOLUME
    assert m["A_wet"] * m["p_base"] - line == pytest.approx(weight, rel=1e-6)
    assert 2 * m["E_surf"] + 4 * m["E_grav"] == pytest.approx(
        3 * m["p_base"] * UNIT_VOLUME, rel=1e-8
    )


def test_pressure_is_the_derivative_of_energy_by_volume():
    def energy(volume):
        return iga.solve(
            iga.sessile_droplet(iga.Plane(contact_angle=110), volume=volume, gravity=1.0)
        ).measures["energy"]

    slope = (energy(4.001) - energy(3.999)) / 2e-3
    middle = iga.solve(iga.sessile_droplet(iga.Plane(contact_angle=110), volume=4.0, gravity=1.0))
    assert slope == pytest.approx(middle.measures["p_base"], rel=1e-6)


@pytest.mark.parametrize(
    ("length", "tension"), [(1e-9, 0.072), (1e-6, 0.072), (1e-3, 0.072), (1e3, 1e6), (2, 1e-6)]
)
def test_units_do_not_change_the_digits(length, tension):
    base = solved(150, 1.0)
    density = 1000.0
    solution = iga.solve(
        iga.sessile_droplet(
            iga.Plane(contact_angle=150),
            volume=UNIT_VOLUME * length**3,
            liquid=iga.Liquid(tension, density),
            gravity=tension / (density * length**2),
        )
    )
    assert abs(solution.newton_iterations - base.newton_iterations) <= 1
    for name, power in {"height": 1, "contact_radius": 1, "A_LG": 2, "volume": 3}.items():
        assert solution.measures[name] / length**power == pytest.approx(
            base.measures[name], rel=1e-10
        )
    for name, unit in {"energy": tension * length**2, "p_base": tension / length}.items():
        assert solution.measures[name] / unit == pytest.approx(base.measures[name], rel=1e-10)


@pytest.mark.parametrize(("shift", "tolerance"), [(0.0, 1e-10), (1e2, 1e-10), (1e6, 1e-8)])
def test_turned_and_shifted_scenes_have_the_same_numbers(shift, tolerance):
    base = solved(120, 1.0)
    rng = np.random.default_rng(int(shift))
    normal = rng.standard_normal(3)
    normal /= np.linalg.norm(normal)
    point = shift * rng.standard_normal(3)
    solution = iga.solve(
        iga.sessile_droplet(
            iga.Plane(contact_angle=120, point=point, normal=normal),
            volume=UNIT_VOLUME,
            gravity=-normal,
        )
    )
    lift = UNIT_VOLUME * normal @ point
    assert solution.measures["energy"] - lift == pytest.approx(
        base.measures["energy"], rel=tolerance * max(1.0, abs(lift))
    )
    for name in ("height", "p_base", "A_LG", "contact_radius"):
        assert solution.measures[name] == pytest.approx(base.measures[name], rel=tolerance)
    apex = solution.surface.net[0, -1] - point
    assert apex == pytest.approx(base.measures["height"] * normal, abs=tolerance + 1e-9 * shift)


@pytest.mark.parametrize("degrees", [5.0, 90.0])
def test_a_held_drop_on_a_tilted_plane_reports_the_force_that_holds_it(degrees):
    tilt = np.radians(degrees)
    gravity = (np.sin(tilt), 0.0, -np.cos(tilt))
    plane = iga.Plane(contact_angle=120)
    held = iga.solve(iga.sessile_droplet(plane, volume=UNIT_VOLUME, gravity=gravity, hold="x"))
    asked = UNIT_VOLUME * np.sin(tilt)
    assert held.hold_force == pytest.approx([-asked, 0, 0], rel=1e-9, abs=1e-12)


def test_full_model_pins_its_neutral_motions_and_says_so():
    solution = solved(120, 1.0, model="full", elements=8)
    assert solution.success
    assert any("pinned" in text for text in solution.warnings)
    assert np.abs(solution.hold_force).max() <= 1e-8


@pytest.mark.parametrize(
    "scene",
    [pinned_cap(1.0, [TENSION, iga.Volume(0.8)], "eighth", degree=4), droplet(120, 1.0)],
    ids=["pinned cap", "droplet"],
)
def test_newton_converges_quadratically_on_a_fixed_parametrization(scene):
    options = NewtonOptions(tolerance=1e-11)
    found = newton_module.newton(Assembly(scene), scene.local_surface(), None, None, options)
    steps = np.array([i.step for i in found.iterations])[-3:]
    assert np.log(steps[2] / steps[1]) / np.log(steps[1] / steps[0]) >= 1.8


def test_too_few_iterations_are_named_and_carry_the_state():
    with pytest.raises(iga.SolveError, match="MAX_ITER") as caught:
        iga.solve(
            pinned_cap(0.4, [TENSION, iga.Volume(3.5)], "eighth"),
            iga.SolverOptions(max_iterations=2),
        )
    solution = caught.value.solution
    assert solution.status is iga.Status.MAX_ITER
    assert len(solution.iterations) == 2
    assert np.isfinite(solution.surface.points).all()


def test_a_hessian_that_is_not_a_number_is_named(monkeypatch):
    from iga_membrane.terms import variations as vary

    def broken(table, at, tension, body):
        return np.full((*table.functions.shape, 3), np.nan)

    monkeypatch.setattr(vary, "forces", broken)
    solution = iga.solve(droplet(120, 1.0, elements=6), on_fail="return")
    assert solution.status is iga.Status.NONFINITE
    assert np.isfinite(solution.surface.points).all()


def test_load_stepping_goes_round_a_failed_direct_solve(monkeypatch):
    direct = newton_module.newton
    calls = []

    def fails_first(*arguments):
        calls.append(1)
        result = direct(*arguments)
        if len(calls) == 1:
            result.status, result.message = iga.Status.STALLED, "made to fail"
        return result

    monkeypatch.setattr("iga_membrane.solvers.predictor.newton", fails_first)
    seen = []
    solution = iga.solve(droplet(120, 3.0, elements=8), report=seen.append)
    assert solution.success
    assert seen[-1] == 1.0
    assert len(solution.load_steps) > 2
    base = solved(120, 3.0, elements=8)
    assert solution.measures["height"] == pytest.approx(base.measures["height"], rel=1e-5)


def test_an_independent_audit_finds_a_state_that_is_no_equilibrium(monkeypatch):
    """A solver that stops at its start must not pass."""
    from iga_membrane.solvers.newton import NewtonResult

    def idle(assembly, surface, multipliers, grading, options):
        return NewtonResult(surface, np.array([2.0]))

    monkeypatch.setattr("iga_membrane.solvers.predictor.newton", idle)
    solution = iga.solve(droplet(120, 3.0, elements=8), on_fail="return")
    assert not solution.success


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"tolerance": 0.0}, "solver.tolerance = 0"),
        ({"tolerance": 1e-15}, "solver.tolerance"),
        ({"max_iterations": 0}, "solver.max_iterations = 0"),
        ({"max_cpu_s": -1.0}, "solver.max_cpu_s"),
    ],
)
def test_bad_options_are_refused(options, message):
    with pytest.raises(iga.SceneError, match=message):
        iga.SolverOptions(**options)
