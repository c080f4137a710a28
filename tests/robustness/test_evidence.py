"""What the audit gathers of every kind of scene, and that each check objects to a wrong state."""

from dataclasses import replace
from functools import cache
from time import thread_time

import pytest
from helpers import UNIT_VOLUME, droplet

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.driver.evaluate import Outcome, conclude
from iga_membrane.driver.result_file import result
from iga_membrane.solvers.predictor import first, settings_of
from iga_membrane.terms import BodyDensity
from iga_membrane.verification.audit import audit
from iga_membrane.verification.evidence import Audit
from iga_membrane.verification.trimmed_audit import trimmed_audit

COARSE = iga.Discretization(elements=16)
BALL = iga.Sphere(contact_angle=140.0, radius=1.0, center=(0.0, 0.0, -1.0))


def cell(angle):
    sphere = replace(BALL, contact_angle=angle)
    mesh = iga.Discretization(elements=32)
    return iga.asperity_cell(sphere, size=4.0, pressure=0.2, shape="circle", discretization=mesh)


def sheet(**options):
    return iga.liquid_sheet(size=5.0, boundary="circle", discretization=COARSE, **options)


def leaning(model):
    mesh = iga.Discretization(elements=8, model=model)
    plane = iga.Plane(contact_angle=100.0)
    return iga.sessile_droplet(
        plane, volume=UNIT_VOLUME, gravity=[0.2, 0.0, -1.0], hold="xy", discretization=mesh
    )


def with_particle():
    grain = iga.Sphere(contact_angle=90.0, radius=0.3, center=(0.0, 0.0, 1.4))
    plane = iga.Plane(contact_angle=120.0)
    mesh = iga.Discretization(elements=20, model="half")
    return iga.sessile_droplet(
        plane, volume=UNIT_VOLUME, gravity=1.0, particles=[grain], discretization=mesh
    )


def on_asperities():
    lattice = iga.SphereLattice(180.0, 0.25, 0.7)
    mesh = iga.Discretization(elements=40)
    return iga.sessile_droplet(lattice, volume=UNIT_VOLUME, gravity=1.0, discretization=mesh)


def on_sphere():
    ball = replace(BALL, contact_angle=100.0)
    return iga.sessile_droplet(
        ball, volume=UNIT_VOLUME, gravity=0.5, hold="xy", discretization=COARSE
    )


def film(**options):
    return iga.film_between_rings(radius=1.0, half_height=0.4, **options)


STANDS = {"residual", "volume", "force", "angle", "penetration"}
HANGS = {"residual", "line"}
KINDS = {
    "droplet": (lambda: droplet(120, 1.0, elements=12), STANDS | {"line"}),
    "droplet, leaning": (lambda: leaning("half"), STANDS | {"line", "sideways"}),
    "droplet at 180 degrees": (lambda: droplet(180, 1.0, elements=20), STANDS | {"line"}),
    "droplet on a sphere": (on_sphere, STANDS | {"line"}),
    "droplet on asperities": (on_asperities, STANDS),
    "droplet with a particle": (with_particle, STANDS | {"line", "sideways", "indentation"}),
    "cell": (lambda: cell(140.0), STANDS - {"volume"} | {"line"}),
    "cell at 180 degrees": (lambda: cell(180.0), STANDS - {"volume"}),
    "sheet": (lambda: sheet(pressure=0.2), HANGS),
    "sheet of a volume": (lambda: sheet(volume=2.0), HANGS | {"volume"}),
    "sheet on a particle": (
        lambda: sheet(particle=replace(BALL, contact_angle=80.0)),
        HANGS | {"angle", "penetration"},
    ),
    "film": (film, HANGS),
    "film of a volume": (lambda: film(volume=2.0), HANGS | {"volume"}),
}


class State:
    """A solved scene in its own scale, and its audit with something changed."""

    def __init__(self, scene):
        if scene.free_edge is not None:
            scene = replace(scene, surface=iga.solve(scene).surface, free_edge=None)
        self.scene, self.assembly, options = scene, Assembly(scene), iga.SolverOptions()
        started = thread_time()
        found = first(scene, self.assembly, settings_of(scene, options, started))
        self.surface = found.surface
        self.line_load = self.assembly.line_load(found.multipliers)
        outcome = Outcome(scene, found, [])
        self.solution = conclude(outcome, self.assembly, options, started)
        assert self.solution.success

    def audit(self, *, scene=None, surface=None, body=None):
        scene, surface = scene or self.scene, surface or self.surface
        body, assembly = body or self.solution.body, self.assembly
        motion = assembly.motion(surface)
        if assembly.contact.passes:
            contact = Assembly(replace(scene, surface=self.solution.surface)).contact
            contact.hold(self.surface.points)
            return trimmed_audit(scene, surface, motion, body, contact)
        contact = assembly.contact
        return audit(scene, surface, motion, body, self.line_load, assembly.points, contact)


@cache
def state(kind):
    return State(KINDS[kind][0]())


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_not_gathered_is_not_zero(kind):
    solution, expected = state(kind).solution, KINDS[kind][1]
    found = solution.audit
    assert set(found.gathered) == expected
    record = result(solution)["audit"]
    assert set(record) == set(found.defects)
    for name, value in record.items():
        assert (value is None) == (name not in expected), name
        assert getattr(found, name) == value
        assert (f"{name} n/a" in solution.summary()) == (value is None)


def test_an_audit_that_found_nothing_to_check_says_so():
    nothing = Audit(None)
    assert nothing.gathered == ()
    assert not any(check.objects for check in nothing.checks())
    unchecked = replace(state("film").solution, audit=nothing)
    assert unchecked.summary().count("n/a") == len(nothing.checks())
    assert "audit                    n/a" in replace(unchecked, audit=None).summary()


def swollen(state):
    """Stretched upwards: neither in equilibrium nor of the volume."""
    return state.audit(surface=state.surface.moved(state.surface.points * [1.0, 1.0, 1.5]))


def overloaded(state):
    """Under another pressure and weight than the state was found at."""
    (x, y, z), even = state.solution.body.gradient, state.solution.body.constant
    return state.audit(body=BodyDensity(even - 1.0, (x, y, 0.7 * z)))


def lowered(state):
    """Sunk into its solid."""
    return state.audit(surface=state.surface.moved(state.surface.points - [0.0, 0.0, 0.1]))


def pushed_aside(state):
    """Under a body force along x."""
    x, y, z = state.solution.body.gradient
    body = BodyDensity(state.solution.body.constant, (x + 0.1, y, z))
    return state.audit(body=body)


def of_another_angle(state):
    """On solids of a smaller contact angle."""
    turned = [turned_by(term, -15.0) for term in state.scene.terms]
    return state.audit(scene=replace(state.scene, terms=turned))


def turned_by(term, degrees):
    """A contact line's term with another contact angle; any other term itself."""
    if isinstance(term, iga.PlaneContactLine):
        return replace(term, contact_angle=term.contact_angle + degrees)
    for name in {"sphere", "solid"} & set(vars(term)):
        solid = getattr(term, name)
        return replace(term, **{name: replace(solid, contact_angle=solid.contact_angle + degrees)})
    return term


WRONG = [
    (swollen, {"residual", "volume"}),
    (overloaded, {"residual", "force", "line"}),
    (lowered, {"penetration", "indentation"}),
    (pushed_aside, {"sideways"}),
    (of_another_angle, {"angle"}),
]


LYING = ("droplet on asperities", "cell at 180 degrees")
"""Kinds that have no term of a contact angle."""


def cases():
    """Every wrong state of every kind, with the checks that must object to it."""
    for kind, (_, gathered) in KINDS.items():
        for wrong, names in WRONG:
            due = names & gathered
            if wrong is of_another_angle and kind in LYING:
                due = set()
            if kind == "cell":
                due = due - {"penetration"}  # it passes through its sphere wherever it is
            if due:
                yield pytest.param(kind, wrong, due, id=f"{kind}, {wrong.__name__}")


@pytest.mark.parametrize(("kind", "wrong", "due"), list(cases()))
def test_every_check_objects_to_a_wrong_state(kind, wrong, due):
    depth = 1e-2
    assert not any(check.objects for check in state(kind).audit().checks(depth))
    assert due <= {check.name for check in wrong(state(kind)).checks(depth) if check.objects}


@pytest.mark.parametrize("kind", LYING)
def test_a_membrane_that_stands_off_its_solid_is_not_at_180_degrees(kind):
    found, net = state(kind), state(kind).surface.points
    aside = found.surface.moved(net * [1.4, 1.4, 1.0] - [0.0, 0.0, 0.05])
    assert found.audit(surface=aside).angle > 10 * found.audit().angle > 0.0
