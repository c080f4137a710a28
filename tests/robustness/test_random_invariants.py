"""What holds for every scene, on random ones (Q2, Q3, Q5, Q6, Q8, Q9, Q15, Q17, Q21)."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from helpers import UNIT_VOLUME, particle_sheet

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.solvers.newton import NewtonOptions, newton

pytestmark = pytest.mark.slow

COUNT = 25
SEEDS = range(COUNT)


@dataclass(frozen=True)
class Drop:
    """A drop on a plane that is turned, moved and measured in units of its own; its liquid is
    pulled along ``pull`` of the plane's axes and held."""

    angle: float
    bond: float
    tilt: float = 0.0
    turn: np.ndarray = None
    shift: float = 0.0
    length: float = 1.0
    tension: float = 1.0
    volume: float = UNIT_VOLUME

    @property
    def axes(self):
        return np.eye(3) if self.turn is None else np.linalg.qr(self.turn)[0]

    @property
    def point(self):
        return self.shift * self.length * np.array([0.6, -0.48, 0.64])

    def scene(self):
        down = self.axes @ [np.sin(self.tilt), 0.0, -np.cos(self.tilt)]
        return iga.sessile_droplet(
            iga.Plane(self.angle, tuple(self.point), tuple(self.axes[:, 2])),
            volume=self.volume * self.length**3,
            liquid=iga.Liquid(self.tension, 1000.0),
            gravity=self.bond * self.tension / (1000.0 * self.length**2) * down,
            hold="xy" if self.tilt else "none",
        )


def random_drop(seed, **more):
    rng = np.random.default_rng(seed)
    return Drop(rng.uniform(25.0, 160.0), 10.0 ** rng.uniform(-1.5, 0.7), **more)


@pytest.fixture(scope="module", params=SEEDS)
def drop(request):
    asked = random_drop(request.param)
    return asked, iga.solve(asked.scene())


def test_weight_pressure_and_line_are_in_balance(drop):
    """Q6"""
    asked, solution = drop
    m = solution.measures
    weight = asked.bond * UNIT_VOLUME
    line = 2.0 * np.pi * m["contact_radius"] * np.sin(np.radians(asked.angle))
    assert abs(m["p_base"] * m["A_wet"] - line - weight) <= 1e-6 * max(weight, line)


def test_curvature_obeys_laplace(drop):
    """Q8"""
    _, solution = drop
    k = solution.surface.on(solution.surface.space.table(second=True))
    w = k.area_element * solution.surface.space.table(second=True).weights
    residual = solution.laplace_residual(k) / solution.measures["p_base"]
    assert np.sqrt((residual**2 * w).sum() / w.sum()) <= 1e-3


def test_the_contact_angle_is_that_of_the_tangents_everywhere(drop):
    """Q15"""
    asked, solution = drop
    around = np.linspace(0.0, 1.0, 101)
    normal = solution.surface.at(np.column_stack([around, np.zeros(101)])).normal
    measured = np.degrees(np.arccos(normal[:, 2]))
    assert abs(measured.mean() - asked.angle) <= 0.1
    assert np.abs(measured - asked.angle).max() <= 0.5


def test_pressure_is_the_slope_of_the_energy_by_the_volume(drop):
    """Q9"""
    asked, solution = drop
    high, low = (
        iga.solve(replace(asked, volume=UNIT_VOLUME + dv).scene()).measures["energy"]
        for dv in (1e-3, -1e-3)
    )
    assert (high - low) / 2e-3 == pytest.approx(solution.measures["p_base"], rel=1e-6)


@pytest.mark.parametrize(("shift", "tolerance"), [(1.0, 1e-10), (1e2, 1e-10), (1e6, 1e-8)])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_turned_and_shifted_drop_is_the_same(seed, shift, tolerance):
    """Q3: energy, pressure, shape, and the force that holds a drop on a tilted plane."""
    rng = np.random.default_rng([seed, 7])
    tilt = float(rng.choice([0.0, rng.uniform(0.01, 0.3)]))
    turn = rng.standard_normal((3, 3))
    turn *= np.sign(np.linalg.det(np.linalg.qr(turn)[0]))
    base = random_drop(seed, tilt=tilt)
    moved = random_drop(seed, tilt=tilt, turn=turn, shift=shift)
    one, two = iga.solve(base.scene()), iga.solve(moved.scene())
    weight = base.bond * UNIT_VOLUME
    down = moved.axes @ [np.sin(tilt), 0.0, -np.cos(tilt)]
    lift = -weight * down @ moved.point
    assert two.measures["energy"] - lift == pytest.approx(
        one.measures["energy"], rel=tolerance * max(1.0, abs(lift))
    )
    for name in ("height", "A_LG", "A_wet", "contact_radius"):
        assert two.measures[name] == pytest.approx(one.measures[name], rel=tolerance), name
    assert moved.axes.T @ two.hold_force == pytest.approx(
        np.array(one.hold_force), abs=tolerance * weight
    )


@pytest.mark.parametrize("seed", SEEDS)
def test_units_scale_energy_pressure_and_force(seed):
    """Q5: E ~ g s^2, p ~ g / s, F ~ g s."""
    rng = np.random.default_rng([seed, 8])
    s, g = 10.0 ** rng.uniform(-9.0, 6.0), 10.0 ** rng.uniform(-6.0, 6.0)
    tilt = float(rng.uniform(0.01, 0.3))
    one = iga.solve(random_drop(seed, tilt=tilt).scene())
    two = iga.solve(random_drop(seed, tilt=tilt, length=s, tension=g).scene())
    for name, unit in {"energy": g * s**2, "p_apex": g / s, "A_LG": s**2, "height": s}.items():
        assert two.measures[name] / unit == pytest.approx(one.measures[name], rel=1e-10), name
    assert np.array(two.hold_force) / (g * s) == pytest.approx(
        np.array(one.hold_force), rel=1e-10, abs=1e-12
    )
    assert abs(two.newton_iterations - one.newton_iterations) <= 1


@pytest.mark.parametrize("seed", SEEDS)
def test_newton_converges_at_its_order(seed):
    """Q2"""
    scene = random_drop(seed).scene()
    options = NewtonOptions(tolerance=1e-11)
    found = newton(Assembly(scene), scene.local_surface(), None, None, options)
    steps = np.array([i.step for i in found.iterations])
    steps = steps[steps > 1e-13][-3:]
    assert np.log(steps[2] / steps[1]) / np.log(steps[1] / steps[0]) >= 1.8


@pytest.mark.parametrize("seed", SEEDS)
def test_accepted_steps_never_raise_the_energy(seed, monkeypatch):
    """Q17: at the volume asked for, once it is filled."""
    from iga_membrane.solvers import newton as module

    search, fallen = module.search, []

    def watched(assembly, system, surface, displacement, direction, longest):
        part, moved = search(assembly, system, surface, displacement, direction, longest)
        if moved is not None:
            before, after = (assembly.energies(state) for state in (surface, moved))
            pairs = [e.total - direction.multipliers @ e.constraints for e in (before, after)]
            full = np.abs(before.constraints).max() <= 1e-8
            fallen.append((full, pairs[0] - pairs[1]))
        return part, moved

    monkeypatch.setattr(module, "search", watched)
    assert iga.solve(random_drop(seed).scene()).success
    assert len(fallen) >= 3
    assert min(drop for full, drop in fallen if full) >= -1e-11


@pytest.mark.parametrize("seed", SEEDS)
def test_the_line_force_is_that_of_its_place_on_the_particle(seed):
    """Q21"""
    rng = np.random.default_rng([seed, 9])
    angle, boundary = rng.uniform(10.0, 170.0), str(rng.choice(["circle", "square"]))
    center = (0.0, 0.0, rng.uniform(-1.1, -0.9))
    m = iga.solve(particle_sheet(angle, boundary=boundary, center=center)).measures
    theta, phi = np.radians([angle, m["phi_deg"]])
    share = m["F_CL"] / (2.0 * np.pi)
    assert share == pytest.approx(np.sin(phi) * np.sin(phi + theta), abs=1e-4)
    assert -(np.sin(0.5 * theta) ** 2) - 1e-4 <= share <= np.cos(0.5 * theta) ** 2 + 1e-4
