"""A scene is data: it knows how it was asked for, and it goes into a state file whole."""

import dataclasses

import numpy as np
import pytest
from helpers import some

import iga_membrane as iga
from iga_membrane.io.scene_file import read_scene
from iga_membrane.problems.recipe import Recipe
from iga_membrane.records import decode, digest, encode

V = 4.0 * np.pi / 3.0
BALL = iga.Sphere(90.0, 1.0, (0.0, 0.0, -0.5))
MESH = iga.Discretization(elements=8)
LATTICE = iga.SphereLattice(180.0, 0.25, 0.7)


def drop(substrate, **given):
    return iga.sessile_droplet(substrate, **{"volume": V, "gravity": 1.0} | given)


def path_of(text):
    return read_scene(
        {
            "scene": "sessile_droplet",
            "liquid": {"volume": 1.0},
            "substrate": {"contact_angle": 90.0},
            "path": [{"parameter": text, "values": [1.0, 1.5]}],
        }
    ).scene


KINDS = {
    "plane": lambda: drop(iga.Plane(120.0), discretization=MESH),
    "tilted": lambda: drop(iga.Plane(100.0), gravity=(0.3, 0.0, -1.0), hold="x",
                           discretization=MESH),
    "edge at 180 degrees": lambda: drop(iga.Plane(180.0), discretization=MESH),
    "sphere": lambda: drop(iga.Sphere(70.0, 1.0, (0.0, 0.0, -1.0)), hold="xy",
                            discretization=MESH),
    "contact area": lambda: drop(LATTICE, discretization=iga.Discretization(elements=24)),
    "doubled mesh": lambda: drop(LATTICE),
    "lines on asperities": lambda: drop(iga.SphereLattice(150.0, 0.1, 0.4)),
    "below its predictor": lambda: drop(iga.SphereLattice(120.0, 0.1, 0.4)),
    "one asperity": lambda: drop(iga.SphereLattice(120.0, 1.0, 3.0), gravity=0.3),
    "point supports": lambda: drop(iga.SphereLattice(165.0, 0.02, 0.08)),
    "ends on a particle": lambda: drop(
        iga.Plane(110.0), hold="xy", particles=[iga.Sphere(90.0, 0.2, (0.6, 0.0, 1.2))]
    ),
    "passes through particles": lambda: drop(
        iga.Plane(110.0), hold="xy", contact_line="trimmed",
        particles=[iga.Sphere(50.0, 0.2, (0.6, 0.0, 1.2)), iga.Sphere(90.0, 0.2, (-0.6, 0.0, 1.2))],
    ),
    "particle that moves": lambda: drop(
        iga.Plane(110.0), hold="xy",
        particles=[iga.Sphere(90.0, 0.2, (0.6, 0.0, 1.2), motion="normal")],
    ),
    "free droplet": lambda: drop(None, gravity=0.0, hold="xyz",
                                 particles=[iga.Sphere(90.0, 0.5, (0.0, 0.0, -1.3))]),
    "wide bridge": lambda: drop(
        None, gravity=0.0, volume=0.5,
        particles=[iga.Sphere(60.0, 1.0, (0.0, 0.0, z)) for z in (-1.3, 1.3)],
    ),
    "perfectly wet bridge": lambda: drop(
        None, gravity=0.0, volume=0.05,
        particles=[iga.Sphere(0.0, 1.0, (0.0, 0.0, z)) for z in (-1.05, 1.05)],
    ),
    "sheet": lambda: iga.liquid_sheet(dataclasses.replace(BALL, contact_angle=70.0), size=5.0),
    "sheet under pressure": lambda: iga.liquid_sheet(None, size=1.0, pressure=0.5),
    "sheet with a volume": lambda: iga.liquid_sheet(None, size=1.0, boundary="circle", volume=0.1),
    "sheet at 180 degrees": lambda: iga.liquid_sheet(
        iga.Sphere(180.0, 1.0, (0.0, 0.0, -0.9)), size=5.0, boundary="circle"
    ),
    "sheet whose particle moves": lambda: iga.liquid_sheet(
        dataclasses.replace(BALL, motion="vertical"), size=5.0, boundary="circle"
    ),
    "cell": lambda: iga.asperity_cell(iga.Sphere(150.0, 1.0), size=3.0, pressure=0.2),
    "cell beyond its limit": lambda: iga.asperity_cell(
        iga.Sphere(180.0, 1.0), size=3.0, pressure=3.0, shape="circle"
    ),
    "film": lambda: iga.film_between_rings(half_height=0.5),
    "bridge between rings": lambda: iga.film_between_rings(half_height=0.8, volume=4.0),
    "whole membrane": lambda: drop(iga.Plane(120.0), membrane=iga.WholeMembrane()),
    "sheet with its wetted part": lambda: iga.liquid_sheet(
        BALL, size=5.0, boundary="circle", membrane=iga.WholeMembrane()
    ),
    "path of a scene file": lambda: path_of("liquid.volume"),
}  # fmt: skip


def functions_in(tree):
    """Functions that a record holds, which a file does not keep."""
    if isinstance(tree, dict):
        inside = [name for item in tree.values() for name in functions_in(item)]
        return [tree["function"], *inside] if "function" in tree else inside
    if isinstance(tree, list):
        return [name for item in tree for name in functions_in(item)]
    return []


def ways_of(scene):
    """Scenes that a scene may be solved by, those of its ways too."""
    if scene.ramp is not None:
        yield from (scene.ramp(load) for load in (0.0, 0.7))
    yield from (way.scene() for way in (scene.otherwise, scene.finer) if way is not None)
    if scene.free_particles is not None:
        yield scene.free_particles.scene_at(0.01 * np.ones(len(scene.free_particles.which)))
    if scene.free_edge is not None:
        place = scene.free_edge.place_of(scene.local_surface())
        yield scene.free_edge.fixed_at(scene, 1.01 * place)


@pytest.mark.parametrize("kind", KINDS)
def test_a_scene_is_data_and_comes_back_with_its_ways(kind):
    scene, arrays = KINDS[kind](), {}
    tree = encode(scene, arrays)
    assert functions_in(tree) == []
    back = decode(tree, arrays)
    assert digest(back) == digest(scene)
    ours, theirs = list(ways_of(scene)), list(ways_of(back))
    assert bool(ours) == (kind != "contact area")  # has a mesh of its own, and one start
    for one, two in zip(ours, theirs, strict=True):
        assert digest(one) == digest(two)
    if scene.start_from is not None:
        near = scene.predictor.local_surface()
        starts = [each.start_from(near).points for each in (scene, back)]
        assert np.array_equal(*starts)


@pytest.mark.parametrize(
    "kind", some(["plane", "edge at 180 degrees", "sphere", "sheet", "film", "cell"], {0, 1, 3})
)
def test_a_loaded_scene_is_solved_again(kind, tmp_path):
    solution = iga.solve(KINDS[kind]())
    solution.save(tmp_path / "state.npz")
    again = iga.solve(iga.load(tmp_path / "state.npz").scene)
    assert again.success
    assert again.measures == pytest.approx(solution.measures, rel=1e-8)


CHANGES = {
    "substrate.contact_angle": ("plane", 100.0, lambda s: s.substrate.contact_angle),
    "liquid.volume": ("plane", 3.0, lambda s: s.description["liquid"]["volume"]),
    "liquid.surface_tension": ("plane", 2.0, lambda s: s.units.tension),
    "gravity.acceleration": ("tilted", 0.5, lambda s: float(np.linalg.norm(s.acceleration))),
    "discretization.elements": ("plane", 10, lambda s: s.surface.space.bases[1].elements),
    "substrate.radius": ("contact area", 0.2, lambda s: s.substrate.radius),
    "particle[0].center[2]": ("ends on a particle", 1.21, lambda s: s.particles[0].center[2]),
    "particle[1].contact_angle": (
        "passes through particles", 80.0, lambda s: s.particles[1].contact_angle),
    "particle[0].radius": ("sheet", 0.8, lambda s: s.substrate.radius),
    "sheet.pressure": ("sheet under pressure", 0.7, lambda s: s.description["sheet"]["pressure"]),
    "cell.pressure": ("cell", 0.1, lambda s: s.description["cell"]["pressure"]),
    "rings.half_height": ("film", 0.4, lambda s: s.description["rings"]["half_height"]),
}  # fmt: skip


@pytest.mark.parametrize("path", CHANGES)
def test_one_number_of_a_scene_is_changed_by_its_path(path):
    kind, value, read = CHANGES[path]
    scene = KINDS[kind]()
    there = scene.at(path, value)
    assert read(there) == pytest.approx(value, rel=1e-12)
    assert read(scene) != pytest.approx(value, rel=1e-3)
    back, asked = there.at(path, read(scene)), scene.recipe.scene()
    assert read(back) == pytest.approx(read(asked), rel=1e-12)
    assert back.surface.points == pytest.approx(asked.surface.points, rel=1e-9, abs=1e-12)


def test_gravity_of_another_size_keeps_its_direction():
    tilted = KINDS["tilted"]().at("gravity.acceleration", 2.0)
    assert np.cross(tilted.acceleration, (0.3, 0.0, -1.0)) == pytest.approx(np.zeros(3), abs=1e-15)


@pytest.mark.parametrize(
    "path",
    ["substrate", "substrate.nothing", "particle[0].radius", "sheet.pressure", "liquid.volume[1]",
     "", "a.b.c", "substrate.normal[3]", "nonsense.volume", "sheet.volume", "droplet.volume",
     "gravity.gravity[0]", "gravity.volume"],
)  # fmt: skip
def test_a_number_that_is_not_there_is_refused_by_its_path(path):
    with pytest.raises(iga.SceneError, match="path = "):
        KINDS["plane"]().at(path, 1.0)


def test_a_value_out_of_range_is_refused_by_its_field():
    with pytest.raises(iga.SceneError, match="contact_angle"):
        KINDS["plane"]().at("substrate.contact_angle", 200.0)


def test_a_scene_of_which_parts_were_replaced_is_built_anew_instead():
    scene = KINDS["plane"]()
    terms = [iga.Gravity(1.0, (0.0, 0.0, -3.0)) if t.name == "gravity" else t for t in scene.terms]
    heavy = dataclasses.replace(scene, terms=terms, ramp=None)
    with pytest.raises(iga.SceneError, match="build it anew"):
        heavy.at("liquid.volume", 1.0)


def test_a_recipe_calls_families_only():
    with pytest.raises(iga.SceneError, match="family"):
        Recipe("print", {})
