"""A scene of which a field was replaced is solved as what it then is, or refused: never does it get
the answer of the scene before."""

from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest

import iga_membrane as iga
from iga_membrane.terms import Gravity, Volume

VOLUME = 4.0 * np.pi / 3.0
LIMITS = iga.SolverOptions(max_cpu_s=20.0)


def mesh(elements):
    return iga.Discretization(elements=elements)


def droplet(substrate, elements, *, weight=1.0, volume=VOLUME, gravity=(0.0, 0.0, -0.5), **more):
    return iga.sessile_droplet(
        substrate,
        volume=volume,
        gravity=[weight * g for g in gravity],
        discretization=mesh(elements),
        **more,
    )


def plane(**given):
    return droplet(iga.Plane(120.0), 8, **given)


def plane_at_180(**given):
    return droplet(iga.Plane(180.0), 8, **given)


def sphere(**given):
    return droplet(iga.Sphere(90.0, 1.5, (0.0, 0.0, -1.5)), 8, hold="xy", **given)


def lattice_at_180(**given):
    return droplet(iga.SphereLattice(180.0, 0.4, 0.9), 56, hold="xy", **given)


def lattice(**given):
    solid = iga.SphereLattice(150.0, 0.1, 0.3, offset=(0.15, 0.15))
    return droplet(solid, None, gravity=(0.0, 0.0, -1.0), hold="xy", **given)


def bridge(**given):
    pair = [iga.Sphere(60.0, 1.0, (0, 0, 1.4)), iga.Sphere(80.0, 0.6, (0, 0, -1.0))]
    return droplet(None, 8, gravity=(0.0, 0.0, -0.1), particles=pair, **given)


def with_a_particle(**given):
    grain = iga.Sphere(90.0, 0.2, (0.6, 0.0, 1.2), 1.0)
    return droplet(iga.Plane(150.0), None, hold="xy", particles=[grain], **given)


def free_particle(*, motion="vertical", **given):
    grain = iga.Sphere(70.0, 0.3, (0.0, 0.0, 1.2), 0.5, motion)
    return droplet(iga.Plane(120.0), None, hold="xy", particles=[grain], **given)


def sheet(*, weight=1.0, volume=0.4):
    grain = iga.Sphere(70.0, 0.5, (0.0, 0.0, -0.4), 2.0)
    return iga.liquid_sheet(
        grain,
        size=3.0,
        boundary="circle",
        gravity=0.3 * weight,
        liquid_weight=True,
        volume=volume,
        discretization=mesh(8),
    )


def film(*, volume=3.0):
    return iga.film_between_rings(half_height=0.5, volume=volume, discretization=mesh(8))


def cell():
    ball = iga.Sphere(120.0, 0.5, (0, 0, -0.5))
    return iga.asperity_cell(ball, size=2.0, pressure=0.4, discretization=mesh(24))


CHEAP = {f.__name__: f for f in (plane, sheet)}
DEAR = {
    f.__name__: f
    for f in (
        sphere,
        film,
        plane_at_180,
        lattice,
        lattice_at_180,
        bridge,
        with_a_particle,
        free_particle,
        cell,
    )
}
KINDS = CHEAP | DEAR
WEIGHTLESS, UNHELD = {"film", "cell"}, {"cell"}


@cache
def built(kind):
    return KINDS[kind]()


@cache
def solved(kind, **given):
    return iga.solve(KINDS[kind](**given), LIMITS, on_fail="return")


def heavier(scene, part):
    return [
        replace(t, acceleration=tuple(part * g for g in t.acceleration))
        if isinstance(t, Gravity)
        else t
        for t in scene.terms
    ]


def kind_of(scene):
    return "film" if scene.kind == "film_between_rings" else scene.kind


def larger(scene, part):
    """Ends of a film are those of its rings, those of a sheet are part of its volume."""
    return [
        replace(t, value=part * t.value, ends=t.ends if kind_of(scene) == "film" else part * t.ends)
        if isinstance(t, Volume)
        else t
        for t in scene.terms
    ]


def needs_supports(scene):
    """Closed membranes need none, nor those between walls, which move vertically."""
    return scene.surface.space.open_edges != () and scene.directions is None


REFUSED, SAME = "refused", "same"
"""What may come out: an error or no success; or the answer of the scene before."""


def changes(kind):
    """Name of a change to the fields that are replaced, and what may come out: arguments of the
    scene that is built with that change, or one of the above."""
    scene = built(kind)
    turned = iga.Sphere(33.0, 0.2, (0.1, 0.0, 0.3))
    found = {
        "no supports": (
            {"supports": ()},
            REFUSED if needs_supports(scene) else SAME,
        ),
        "units": ({"scale": replace(scene.units, length=2.0 * scene.units.length)}, SAME),
        "another frame": ({"scale": replace(scene.units, origin=(0.0, 0.0, 1.0))}, REFUSED),
        "even meridians": ({"grading": None}, SAME),
        "normals as directions": ({"directions": None}, SAME),
        "cartesian": ({"motion": "cartesian"}, REFUSED),
        "another solid": ({"substrate": iga.Plane(33.0)}, REFUSED),
        "another particle": ({"particles": (turned,)}, REFUSED),
        "no hold": ({"hold": "" if scene.hold else "xy"}, REFUSED),
        "another kind": (
            {"kind": "liquid_sheet" if scene.kind == "sessile_droplet" else "sessile_droplet"},
            REFUSED,
        ),
        "words": ({"description": {}, "warnings": ()}, SAME),
        "no recipe": ({"recipe": None}, SAME),
    }
    for way in ("ramp", "predictor", "start_from", "otherwise", "finer", "free_edge",
                "free_particles"):  # fmt: skip
        if getattr(scene, way) is not None:
            moving = way == "free_particles"
            found[f"without {way}"] = ({way: None}, {"motion": "fixed"} if moving else SAME)
    if kind not in WEIGHTLESS:
        found |= {
            "heavier": ({"terms": heavier(scene, 1.5)}, {"weight": 1.5}),
            "heavier without ramp": ({"terms": heavier(scene, 1.3), "ramp": None}, {"weight": 1.3}),
            "acceleration": ({"acceleration": (0.0, 0.0, -3.0)}, REFUSED),
            "density": ({"liquid_density": 3.0}, REFUSED),
        }
    if kind not in UNHELD:
        held = next(t for t in scene.terms if isinstance(t, Volume))
        volume = held.value if kind == "film" else held.value - held.ends
        found["larger"] = ({"terms": larger(scene, 1.1), "ramp": None}, {"volume": 1.1 * volume})
    return found


FIELDS = {
    "surface", "terms", "supports", "scale", "grading", "directions", "motion", "ramp", "predictor",
    "start_from", "otherwise", "finer", "free_edge", "free_particles", "substrate", "particles",
    "hold", "acceleration", "liquid_density", "kind", "description", "warnings", "recipe",
    "origin",
}  # fmt: skip


def test_every_field_of_a_scene_is_thought_of():
    """A new field must be given its changes here."""
    assert {f.name for f in fields(iga.Scene)} == FIELDS


TOLERANCE = 1e-3
"""Of what is measured, as meshes of the changed scene and of the fresh one differ; the old answer
is farther away than that."""


def outcome(kind, replaced):
    """The solution of a changed scene, None where it is refused."""
    try:
        scene = replace(built(kind), **replaced)
        return iga.solve(scene, LIMITS, on_fail="return")
    except iga.SceneError:
        return None


def check(kind, name):
    replaced, right = changes(kind)[name]
    found = outcome(kind, replaced)
    if found is None or not found.success:
        return
    assert right != REFUSED, f"{kind}, {name}: solved"
    exact = solved(kind) if right == SAME else solved(kind, **right)
    assert exact.success
    # the pole may lie in a particle, where a membrane goes on as it likes
    names = ("energy", "pressure", "A_LG") + ("height",) * (not exact.forces)
    for measure in names:
        if measure in exact.measures:
            value = exact.measures[measure]
            assert found.measures[measure] == pytest.approx(value, rel=TOLERANCE, abs=TOLERANCE)
    for key, value in exact.dimensionless.items():
        assert found.dimensionless[key] == pytest.approx(value, rel=10 * TOLERANCE)
    for one, two in zip(exact.forces, found.forces, strict=True):
        assert two.effective == pytest.approx(one.effective, abs=1e-3)


@pytest.mark.parametrize("kind", CHEAP)
def test_a_changed_scene_never_gets_the_old_ones_answer(kind):
    for name in changes(kind):
        check(kind, name)


@pytest.mark.parametrize("name", ["heavier", "no supports", "without free_edge"])
def test_an_edge_at_180_degrees_is_looked_for_in_the_changed_scene(name):
    check("plane_at_180", name)


@pytest.mark.slow
@pytest.mark.parametrize("kind", DEAR)
def test_a_changed_scene_never_gets_the_old_ones_answer_where_solves_are_dear(kind):
    for name in changes(kind):
        check(kind, name)
