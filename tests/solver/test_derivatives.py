"""The self-check of derivatives names the term that is wrong, and only that one (N8)."""

import numpy as np
import pytest
from helpers import droplet, particle_sheet

import iga_membrane as iga
from iga_membrane.contact.obstacle import Obstacle
from iga_membrane.terms import PlaneContactLine
from iga_membrane.terms import variations as vary
from iga_membrane.verification import derivatives

LATTICE = iga.SphereLattice(150.0, 0.3, 0.9)
GRAIN = iga.Sphere(90.0, 0.4, (1.1, 0.0, 0.8))


def heavy(*, substrate=None, particles=(), **given):
    """A heavy droplet on a coarse mesh."""
    return iga.sessile_droplet(
        substrate or iga.Plane(110.0),
        volume=4.0,
        gravity=0.7,
        particles=particles,
        hold="x" if particles else "none",
        discretization=iga.Discretization(elements=given.pop("elements", 6)),
        **given,
    )


def cell(penalty, elements=24):
    """A membrane that lies on a sphere."""
    return iga.asperity_cell(
        iga.Sphere(180.0, 1.0),
        size=3.0,
        pressure=0.3,
        penalty=penalty,
        discretization=iga.Discretization(elements=elements),
    )


SCENES = {
    "plane": heavy,
    "sphere": lambda: heavy(substrate=iga.Sphere(70.0, 1.0, (0.0, 0.0, -1.0))),
    "lines inside": lambda: heavy(substrate=LATTICE, elements=24),
    "particle, passed through": lambda: heavy(particles=[GRAIN], elements=12),
    "particle, ended on": lambda: heavy(particles=[GRAIN], contact_line="conforming"),
    "sheet": lambda: particle_sheet(80.0, elements=6, pressure=0.1),
    "contact area": lambda: heavy(substrate=iga.SphereLattice(180.0, 0.3, 0.9), elements=24),
    "cell, exact contact": lambda: cell(None),
    "cell, soft penalty": lambda: cell(1e1),
    "cell, points come into contact": lambda: cell(1e3, elements=48),
}


@pytest.mark.parametrize("name", SCENES)
def test_all_derivatives_of_the_package_are_right(name):
    scene = SCENES[name]()
    found = iga.check_derivatives(scene)
    assert len(found) == len(scene.terms) + 1
    for term, errors in found.items():
        assert errors.right, (term, errors)


def test_contact_that_begins_within_a_difference_is_no_wrong_derivative(monkeypatch):
    """Differences that take points into contact see the jump of its stiffness, which grows with the
    penalty and falls with the step; those that take none are right to rounding."""

    def hessian(penalty, step):
        monkeypatch.setattr(derivatives, "STEPS", (step,))
        return iga.check_derivatives(cell(penalty))["Contact"].hessian

    for penalty, least in ((1e1, 3e-5), (1e3, 1e-3)):
        coarse, fine = (hessian(penalty, step) for step in (3e-2, 1e-2))
        assert least < fine < 0.5 * coarse
        assert hessian(penalty, 1e-4) < 1e-8


def test_a_hessian_of_contact_wrong_by_a_percent_is_named(monkeypatch):
    """No step makes it right, also where the energy is only once differentiable."""
    exact = Obstacle.hessian

    def wrong(self, *given):
        near, blocks = exact(self, *given)
        return near, 1.01 * blocks

    monkeypatch.setattr(Obstacle, "hessian", wrong)
    found = iga.check_derivatives(cell(1e2))
    assert [name for name, errors in found.items() if not errors.right] == ["Contact", "all terms"]
    assert found["Contact"].gradient < 1e-5 < 1e-4 < found["Contact"].hessian


def test_a_hessian_wrong_by_a_percent_is_named(monkeypatch):
    exact = PlaneContactLine.hessian
    monkeypatch.setattr(
        PlaneContactLine, "hessian", lambda self, *given: 1.01 * exact(self, *given)
    )
    found = iga.check_derivatives(heavy())
    assert [name for name, errors in found.items() if not errors.right] == [
        "PlaneContactLine",
        "all terms",
    ]
    assert found["PlaneContactLine"].gradient < 1e-8 < 1e-4 < found["PlaneContactLine"].hessian


def test_forces_wrong_by_a_percent_are_named(monkeypatch):
    exact = vary.forces

    def skewed(table, at, tension, body):
        heavier = type(body)(body.constant, tuple(1.01 * np.array(body.gradient)))
        return exact(table, at, tension, heavier)

    monkeypatch.setattr(vary, "forces", skewed)
    found = iga.check_derivatives(droplet(110.0, 1.0, elements=6))
    assert [name for name, errors in found.items() if not errors.right] == ["Gravity", "all terms"]
