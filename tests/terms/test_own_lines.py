"""Lines and areas that pay for something of the user's own: line tension against Boruvka's and
Neumann's angle, a second tension against Young's."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.optimize import brentq

import iga_membrane as iga
from iga_membrane.terms import AreaTerm, LineTerm, Scale

VOLUME = 4.19


@dataclass(frozen=True)
class LineTension(LineTerm):
    """Energy tau times the length of the membrane's edge."""

    tau: float
    edge: str = "xi2=0"
    name = "line_tension"

    @property
    def strength(self):
        return self.tau

    def scaled(self, scale: Scale):
        return replace(self, tau=self.tau / scale.force)

    def energy(self, table, points, strength, body):
        d = table.d @ points[table.functions]
        return strength * float((np.linalg.norm(d, axis=-1) * table.weights).sum())

    def forces(self, table, points, strength, body):
        d = table.d @ points[table.functions]
        t = d / np.linalg.norm(d, axis=-1)[..., None]
        return strength * np.einsum("eqa,eqi,eq->eai", table.d, t, table.weights)

    def hessian(self, table, points, strength, body):
        d = table.d @ points[table.functions]
        size = np.linalg.norm(d, axis=-1)
        t = d / size[..., None]
        across = (np.eye(3) - t[..., :, None] * t[..., None, :]) / size[..., None, None]
        w = strength * table.weights
        return np.einsum("eqa,eqb,eqij,eq->eaibj", table.d, table.d, across, w, optimize=True)


@dataclass(frozen=True)
class Film(AreaTerm):
    """A second energy per area, of a film on the liquid."""

    excess: float
    name = "film"

    def tension(self):
        return self.excess

    def scaled(self, scale: Scale):
        return Film(self.excess / scale.tension)


def droplet(angle=120.0, gravity=0.0, **given):
    mesh = iga.Discretization(elements=12)
    return iga.sessile_droplet(
        iga.Plane(angle), volume=VOLUME, gravity=gravity, discretization=mesh, **given
    )


def with_terms(scene, *own, first=False):
    terms = [*own, *scene.terms] if first else [*scene.terms, *own]
    return iga.solve(replace(scene, terms=terms, ramp=None))


def cap(cosine):
    """Radius of the foot of a cap of the volume and an angle."""
    angle = np.arccos(cosine)
    shape = np.pi * (2 + np.cos(angle)) * (1 - np.cos(angle)) ** 2 / 3
    return (VOLUME / shape) ** (1 / 3) * np.sin(angle)


def same(one, two):
    for name, value in one.measures.items():
        assert two.measures[name] == pytest.approx(value, rel=1e-8), name


@pytest.mark.parametrize("first", [False, True])
def test_a_line_without_tension_changes_nothing(first):
    scene = droplet(gravity=1.0)
    same(iga.solve(scene), with_terms(scene, LineTension(0.0), first=first))


@pytest.mark.parametrize("first", [False, True])
@pytest.mark.parametrize(("angle", "tau"), [(120.0, 0.05), (70.0, 0.2), (100.0, -0.1)])
def test_line_tension_turns_the_contact_angle(angle, tau, first):
    """``cos(theta) = cos(theta_Y) - tau / (gamma r)``."""
    young = np.cos(np.radians(angle))
    radius = brentq(lambda r: cap(young - tau / r) - r, 0.6, 3.0)
    found = with_terms(droplet(angle), LineTension(tau), first=first)
    m, exact = found.measures, np.degrees(np.arccos(young - tau / radius))
    assert m["contact_radius"] == pytest.approx(radius, rel=1e-6)
    assert m["contact_angle_measured"] == pytest.approx(exact, abs=1e-3)
    assert m["A_wet"] == pytest.approx(np.pi * radius**2, rel=1e-6)
    assert m["E_surf"] == pytest.approx(m["A_LG"] - young * m["A_wet"], rel=1e-12)
    assert m["energy"] - m["E_surf"] == pytest.approx(2 * np.pi * radius * tau, rel=1e-6)
    assert found.contact["support_force"] == pytest.approx(0.0, abs=1e-4)


def test_line_tension_on_a_sphere_counts_the_curvature_of_the_line_on_it():
    """There ``tau`` times the geodesic curvature, ``cos(alpha) / (R sin(alpha))``."""
    sphere, tau = iga.Sphere(80.0, 2.0, (0.0, 0.0, -2.0)), 0.1
    mesh = iga.Discretization(elements=12)
    scene = iga.sessile_droplet(sphere, volume=VOLUME, discretization=mesh)
    found = with_terms(scene, LineTension(tau))
    alpha = np.radians(found.measures["alpha_deg"])
    bend = np.cos(alpha) / (2.0 * np.sin(alpha))
    angle = np.degrees(np.arccos(np.cos(np.radians(80.0)) - tau * bend))
    assert found.measures["contact_angle_measured"] == pytest.approx(angle, abs=1e-2)


@pytest.mark.parametrize("first", [False, True])
def test_a_film_on_the_liquid_adds_to_its_tension(first):
    """Young's cosine falls by the ratio of the tensions; the wetted area is that of the disc."""
    excess = 0.1
    found = with_terms(droplet(), Film(excess), first=first)
    m, cosine = found.measures, -0.5 / (1.0 + excess)
    assert m["contact_radius"] == pytest.approx(cap(cosine), rel=1e-6)
    assert m["A_wet"] == pytest.approx(np.pi * m["contact_radius"] ** 2, rel=1e-12)
    radius = m["contact_radius"] / np.sqrt(1.0 - cosine**2)
    assert m["pressure"] == pytest.approx(2.0 * (1.0 + excess) / radius, rel=1e-6)
    middle = found.surface.at([0.1, 0.5])
    assert found.laplace_residual(middle) == pytest.approx(0.0, abs=1e-3)


@dataclass(frozen=True)
class Wrong(LineTension):
    """Its forces are those of another tension: no success may come of it."""

    name = "wrong"

    def forces(self, table, points, strength, body):
        return 0.9 * super().forces(table, points, strength, body)


def test_the_audit_finds_forces_that_are_not_those_of_the_energy(monkeypatch):
    """Independently of the check before the solve."""
    from iga_membrane.driver import solve as module

    monkeypatch.setattr(module, "check_own_terms", lambda *given: None)
    scene = droplet()
    found = iga.solve(replace(scene, terms=[*scene.terms, Wrong(0.2)], ramp=None), on_fail="return")
    assert not found.success
