"""A scene that is turned, moved and measured in other units has the same answer, turned, moved and
in those units: every number and vector of its result, and its contact lines (Q3, Q5)."""

from dataclasses import dataclass, field
from functools import cache

import numpy as np
import pytest
from helpers import some
from scipy.spatial.transform import Rotation

import iga_membrane as iga
from iga_membrane.driver.lines import contact_lines
from iga_membrane.driver.result_file import result
from iga_membrane.results.apparent import apparent_angle
from iga_membrane.results.farthest import highest
from iga_membrane.terms import BodyDensity

VOLUME = 4.0 * np.pi / 3.0


@dataclass(frozen=True)
class Change:
    """``x' = length turn x + shift``; tensions are multiplied by ``tension``, accelerations by
    ``pull``, and densities so that weight stays in proportion to tension."""

    turn: np.ndarray = field(default_factory=lambda: np.eye(3))
    shift: np.ndarray = field(default_factory=lambda: np.zeros(3))
    length: float = 1.0
    tension: float = 1.0
    pull: float = 1.0

    def unit(self, length, tension):
        return self.length**length * self.tension**tension

    def point(self, x):
        return tuple(float(c) for c in self.length * (self.turn @ x) + self.shift)

    def vector(self, v, unit=1.0):
        return tuple(float(c) for c in unit * (self.turn @ v))

    @property
    def density(self):
        return self.tension / (self.length**2 * self.pull)

    def liquid(self, density=1.0):
        return iga.Liquid(self.tension, density * self.density)

    def gravity(self, *g):
        return self.vector(g, self.pull)

    def sphere(self, angle, radius, center, density=0.0, motion="fixed"):
        place = self.point(center)
        return iga.Sphere(angle, radius * self.length, place, density * self.density, motion)


def mesh(elements=None, model=None, **more):
    return iga.Discretization(elements=elements, model=model, **more)


def droplet(change, substrate, *, volume=VOLUME, gravity=(0.0, 0.0, 0.0), density=1.0, **more):
    return iga.sessile_droplet(
        substrate,
        volume=volume * change.length**3,
        liquid=change.liquid(density),
        gravity=change.gravity(*gravity),
        **more,
    )


def plane(change, angle, point=(0.0, 0.0, 0.0)):
    return iga.Plane(angle, change.point(point), change.vector((0.0, 0.0, 1.0)))


def leaning(change):
    return droplet(
        change, plane(change, 110.0), gravity=(0.2, 0.1, -0.7), hold="xy", discretization=mesh(8)
    )


def pendant(change):
    return droplet(change, plane(change, 60.0), gravity=(0.0, 0.0, 0.6), discretization=mesh(8))


def lying(change):
    return droplet(change, plane(change, 180.0), gravity=(0.0, 0.0, -1.0), discretization=mesh(12))


def on_a_sphere(change):
    sphere = change.sphere(100.0, 1.5, (0.3, -0.2, 0.4))
    given = {"gravity": (0.05, 0.02, -0.1), "hold": "xy", "discretization": mesh(8)}
    return droplet(change, sphere, **given)


def hanging(change):
    carrier = change.sphere(60.0, 0.8, (0.0, 0.0, 1.2), 0.7)
    return droplet(
        change, None, gravity=(0.0, 0.0, -0.3), particles=[carrier], discretization=mesh(8)
    )


def pulled(change):
    carrier = change.sphere(80.0, 0.5, (0.4, 0.3, 1.25))
    given = {"particles": [carrier], "hold": "xyz", "discretization": mesh(8)}
    return droplet(change, None, **given)


def bridge(change):
    pair = [
        change.sphere(60.0, 1.0, (0.1, 0.0, 1.4), 0.5),
        change.sphere(80.0, 0.6, (0.0, 0.0, -1.0)),
    ]
    return droplet(change, None, gravity=(0.02, 0.0, -0.1), particles=pair, discretization=mesh(8))


def with_a_particle(change):
    grain = change.sphere(90.0, 0.2, (0.6, 0.0, 1.2), 1.0)
    return droplet(
        change,
        plane(change, 150.0),
        gravity=(0.25, 0.0, -0.433),
        hold="xy",
        particles=[grain],
    )  # fmt: skip


def whole_membrane(change):
    return droplet(
        change,
        plane(change, 150.0),
        gravity=(0.0, 0.0, -0.5),
        membrane=iga.WholeMembrane(load_steps=2),
        discretization=mesh(12),
    )


def cells(change):
    return iga.asperity_cell(
        change.sphere(120.0, 0.5, (0.1, 0.2, -0.5)),
        size=2.0 * change.length,
        pressure=0.4 * change.unit(-1, 1),
        liquid=change.liquid(),
        discretization=mesh(24),
    )


def cell_at_180(change):
    return iga.asperity_cell(
        change.sphere(180.0, 0.5, (0.0, 0.0, -0.5)),
        size=2.0 * change.length,
        pressure=0.4 * change.unit(-1, 1),
        liquid=change.liquid(),
        discretization=mesh(24),
    )


def asperities(change):
    """The outer ones pull the membrane down."""
    quarter = [(0.15, 0.15), (0.15, 0.55), (0.55, 0.15)]
    places = [(i * x, j * y, -0.1) for x, y in quarter for i in (1, -1) for j in (1, -1)]
    centers = [change.point(place) for place in places]
    spheres = iga.Spheres(140.0, centers, 0.1 * change.length)
    return droplet(change, spheres, gravity=(0.0, 0.0, -0.2), hold="xy")


def lattice(change):
    unit = change.length
    solid = iga.SphereLattice(180.0, 0.4 * unit, 0.9 * unit)
    return droplet(change, solid, gravity=(0.0, 0.0, -0.5), discretization=mesh(40))


def film(change):
    return iga.film_between_rings(
        radius=change.length,
        half_height=0.5 * change.length,
        volume=3.0 * change.length**3,
        liquid=change.liquid(),
        discretization=mesh(8),
    )


def sheet(change, particle=None, boundary="circle", elements=8, **more):
    given = {name: value * change.unit(*unit) for name, (value, unit) in more.items()}
    return iga.liquid_sheet(
        particle,
        size=3.0 * change.length,
        boundary=boundary,
        liquid=change.liquid(),
        discretization=mesh(elements),
        gravity=0.3 * change.pull,
        liquid_weight=True,
        **given,
    )


def rising(change):
    return sheet(change, boundary="square", pressure=(-0.4, (-1, 1)))


def loaded(change):
    grain = change.sphere(70.0, 0.5, (0.3, 0.2, -0.4), 2.0)
    return sheet(change, grain, elements=16, volume=(0.4, (3, 0)))


CHEAP = {
    "leaning": leaning,
    "pendant": pendant,
    "lying at 180 degrees": lying,
    "on a sphere": on_a_sphere,
    "hanging from a particle": hanging,
    "held and pulled": pulled,
    "a bridge": bridge,
    "a film between rings": film,
    "a sheet": rising,
    "a sheet with a particle": loaded,
    "a cell at 180 degrees": cell_at_180,
    "a lattice": lattice,
}
DEAR = {
    "a cell": cells,
    "with a particle": with_a_particle,
    "the paper's membrane": whole_membrane,
    "asperities": asperities,
}
SCENES = CHEAP | DEAR


def scene_of(name, change):
    return SCENES[name](change)


@cache
def asked(name):
    return iga.solve(scene_of(name, Change()))


ANGLE, LENGTH, AREA, SOLID, PRESSURE, FORCE, ENERGY = (
    (0, 0), (1, 0), (2, 0), (3, 0), (-1, 1), (1, 1), (2, 1)
)  # fmt: skip
UNITS = {
    ENERGY: ("energy", "E_surf", "E_grav"),
    AREA: ("A_LG", "A_wet"),
    SOLID: ("volume", "V_liq", "V_cap"),
    PRESSURE: ("pressure", "p_apex", "p_base", "p_contact", "p_top"),
    LENGTH: (
        "height", "equator_radius", "contact_radius", "z_contact", "sag", "z_edge", "z_corner",
        "cap_height", "neck_radius",
    ),
    FORCE: (
        "F_sphere", "F_press", "F_line", "F_total", "F_P", "F_CL", "F_CL_line", "force"
    ),
    ANGLE: (
        "contact_angle_measured", "alpha_deg", "phi_deg", "psi_deg", "end_slope_deg",
        "apparent_angle", "cassie_baxter_angle",
    ),
}  # fmt: skip
"""Powers of length and tension of each measure."""
UNIT = {name: unit for unit, names in UNITS.items() for name in names}


def expected_measures(solution, change):
    """Measures of the changed scene; only those that are told from the world's axes or origin are
    not just scaled."""
    found = {
        name: None if value is None else value * change.unit(*UNIT[name])
        for name, value in solution.measures.items()
    }
    lifted = -weight_per_volume(solution, change) @ change.shift
    volume = found.get("volume", found.get("V_liq"))
    for name in ("energy", "E_grav"):
        found[name] += lifted * volume
    origin = change.turn.T @ (-change.shift) / change.length
    found["pressure"] = solution.pressure(origin) * change.unit(-1, 1)
    if solution.scene.free:
        found["height"] = top_of(solution, change)
        found["z_contact"] = level_of(solution, change)
        if len(solution.scene.particles) > 1:
            apex = solution.pressure(highest(solution.surface, change.turn[2]))
            found["p_apex"] = apex * change.unit(-1, 1)
    return found


def weight_per_volume(solution, change):
    """World vector in the changed scene."""
    pull = sum(
        (
            term.density_of_liquid * np.array(term.acceleration)
            for term in solution.scene.terms
            if isinstance(term, iga.Gravity)
        ),
        np.zeros(3),
    )
    return change.turn @ pull * change.unit(-2, 1)


def top_of(solution, change):
    """Height of the changed droplet's pole, or of the highest point of one between particles."""
    if len(solution.scene.particles) == 1:
        x = solution.surface.at([0.0, 1.0], 1).position
    else:
        x = highest(solution.surface, change.turn[2])
    return change.point(x)[2]


def level_of(solution, change):
    """Height of the changed contact line's middle: of a cap as large as the wetted one."""
    scene = solution.scene
    seat, polar = scene.substrate, np.radians(solution.measures["alpha_deg"])
    middle = seat.center + seat.radius * np.cos(polar) * scene.units.axes[:, 2]
    return change.point(middle)[2]


def expected_forces(found, change):
    """A particle's record in the changed scene."""
    parts = {
        name: np.array(change.vector(found[name], change.unit(*FORCE)))
        for name in ("F_G", "F_CL", "F_H", "F_B", "F_e", "torque")
    }
    scalars = {name: found[name] * change.unit(*FORCE) for name in ("normal", "tangential")}
    paper = {f"paper {k}": value * change.unit(*FORCE) for k, value in found["paper"].items()}
    center = np.array(change.point(found["center"]))
    return parts | scalars | {"center": center, "lifts": found["lifts"]} | paper


def expected_asperity(found, change):
    return {
        "center": np.array(change.point(found["center"])),
        "force": found["force"] * change.unit(*FORCE),
        "force_vector": np.array(change.vector(found["force_vector"], change.unit(*FORCE))),
        "wet_area": found["wet_area"] * change.unit(*AREA),
        "contact_angle": found["contact_angle"],
    }


def told_by_place(rows):
    return sorted(rows, key=lambda row: tuple(np.round(row["center"], 6)))


def expected_contact(found, change):
    same = ("wet_solids", "wet_fraction", "touches_base", "law")
    scaled = {"wet_area": AREA, "support_force": FORCE}
    told = {name: found[name] for name in same if name in found}
    told |= {name: found[name] * change.unit(*u) for name, u in scaled.items() if name in found}
    told["hold_force"] = np.array(change.vector(found["hold_force"], change.unit(*FORCE)))
    return told


def line_moments(line):
    """Length, middle, second moment and pull of a contact line."""
    middle = line.arc @ line.position / line.arc.sum()
    away = line.position - middle
    moment = np.einsum("k,ki,kj->ij", line.arc, away, away)
    return line.arc.sum(), middle, moment, line.arc @ line.conormal


def expected_moments(line, change):
    length, middle, moment, pull = line_moments(line)
    turned = change.turn @ moment @ change.turn.T * change.length**3
    return (
        length * change.length,
        np.array(change.point(middle)),
        turned,
        np.array(change.vector(pull, change.length)),
    )


def assert_same(found, exact, where, tolerance, unit):
    """Numbers, truth values or vectors."""
    for name, value in exact.items():
        told = f"{where} {name}"
        if value is None or isinstance(value, (bool, str, int)):
            assert found[name] == value, told
            continue
        size = max(float(np.abs(value).max()), unit)
        assert np.asarray(found[name]) == pytest.approx(value, abs=tolerance * size), told


TOLERANCE, LOCAL = 1e-6, 3e-5
"""Of its size or that of the scene, whichever is larger. Meshes turn with their scene but for the
ring's first meridian: what hangs on one point, or on tangents at an edge, differs by the error of
the mesh there."""
AT_A_POINT = ("height", "equator_radius", "p_apex", "F_CL_line", "contact_angle_measured")


def check(name, change):
    one, two = asked(name), iga.solve(scene_of(name, change))
    scene = one.scene
    first, second = result(one), result(two)
    for key in ("status", "index", "warnings", "stability_scope"):
        assert first[key] == second[key], key
    exact = expected_measures(one, change)
    assert set(exact) == set(two.measures)
    size = scene.units.length
    for measure, value in exact.items():
        unit = size ** UNIT[measure][0] * scene.units.tension ** UNIT[measure][1]
        unit *= change.unit(*UNIT[measure]) * max(1.0, np.abs(change.shift).max() / change.length)
        allowed = LOCAL if measure in AT_A_POINT else TOLERANCE
        assert_same(second["measures"], {measure: value}, "measure", allowed, unit)
    assert_same(
        second["dimensionless"], {k: float(v) for k, v in first["dimensionless"].items()},
        "", TOLERANCE, 1.0,
    )  # fmt: skip
    force = scene.units.force * change.unit(*FORCE)
    contact = second["contact"]
    assert_same(contact, expected_contact(first["contact"], change), "contact", TOLERANCE, force)
    rows = told_by_place([expected_asperity(r, change) for r in first["contact"]["asperities"]])
    assert len(rows) == len(contact["asperities"])
    for row, exact in zip(told_by_place(contact["asperities"]), rows, strict=True):
        assert_same(row, exact, "asperity", LOCAL, force)
    assert len(first["forces"]) == len(second["forces"])
    for found, before in zip(second["forces"], first["forces"], strict=True):
        flat = found | {f"paper {k}": value for k, value in found["paper"].items()}
        assert_same(flat, expected_forces(before, change), "force", TOLERANCE, force)
    check_multipliers(one, two, change)
    lines = contact_lines(one), contact_lines(two)
    assert len(lines[0]) == len(lines[1])
    for before, after in zip(*lines, strict=True):
        for found, exact in zip(
            line_moments(after.line), expected_moments(before.line, change), strict=True
        ):
            room = max(float(np.abs(exact).max()), change.length**2)
            assert found == pytest.approx(exact, abs=LOCAL * room)


def check_multipliers(one, two, change):
    """That of the volume is the energy's slope; those of the centroid are a force per volume."""
    if "volume" in one.multipliers:
        lifted = -weight_per_volume(one, change) @ change.shift
        exact = one.multipliers["volume"] * change.unit(*PRESSURE) + lifted
        size = max(abs(exact), change.unit(*PRESSURE))
        assert two.multipliers["volume"] == pytest.approx(exact, abs=TOLERANCE * size)


def rotation(seed):
    return Rotation.random(random_state=seed).as_matrix()


def upright(angle):
    return Rotation.from_rotvec([0.0, 0.0, angle]).as_matrix()


MOTIONS = {
    "any": {"leaning", "pendant", "lying at 180 degrees", "a bridge", "with a particle",
            "the paper's membrane"},
    "about the origin": {"hanging from a particle", "held and pulled"},
    "about z, and any shift": {"on a sphere"},
    "about z": {"a sheet with a particle"},
    "a quarter about z": {"a cell", "a lattice", "asperities", "a sheet"},
}  # fmt: skip
"""How scenes may be turned and shifted: substrates and rims without a frame of their own lie in the
world's, and a free droplet lies between its particle and the origin."""


def change_of(name):
    """A random change of all that may change in a scene."""
    seed = len(name)
    rng = np.random.default_rng(seed)
    units = {"length": 3e-3, "tension": 0.07, "pull": 9.81}
    allowed = next((how for how, names in MOTIONS.items() if name in names), None)
    turn, shift = np.eye(3), np.zeros(3)
    if allowed in ("any", "about the origin"):
        turn = Rotation.random(random_state=seed).as_matrix()
    elif allowed is not None:
        angle = 0.5 * np.pi if "quarter" in allowed else rng.uniform(0.0, 2.0 * np.pi)
        turn = Rotation.from_rotvec([0.0, 0.0, angle]).as_matrix()
    if allowed in ("any", "about z, and any shift"):
        shift = rng.uniform(-4e-3, 4e-3, 3)
    return Change(turn, shift, **units)


@pytest.mark.parametrize("name", [*some(CHEAP, {0, 1, 3, 4, 6, 9, 10}), *some(DEAR, ())])
def test_a_changed_scene_has_the_changed_answer(name):
    check(name, change_of(name))


def test_a_free_droplet_moves_with_its_particle():
    """Along the line to the origin; heights are told from there."""
    name = "hanging from a particle"
    check(name, Change(shift=np.array([0.0, 0.0, 5.0])))
    assert asked(name).measures["height"] < 0.0


@pytest.mark.parametrize(("push", "weight"), [(-1.0, 1.0), (0.0, 0.0), (0.1, -2.0), (-5.0, -2.0)])
def test_the_apparent_angle_is_null_where_no_profile_comes_down(push, weight):
    """A negative pressure at the apex bends it up; of a droplet that hangs it may turn up again."""
    height = 1.0
    lost = BodyDensity(-push - weight * height, (0.0, 0.0, weight))
    assert apparent_angle(height, lost, 1.0) is None
    falling = BodyDensity(-5.0 - weight * height, (0.0, 0.0, weight))
    assert 0.0 < apparent_angle(height, falling, 1.0) <= 180.0


def test_cassies_angle_is_null_where_its_cosine_is_none():
    """At 180 degrees curved spots are larger than their projection."""
    solution = asked("a lattice")
    assert result(solution)["measures"]["cassie_baxter_angle"] is None
    assert any("cassie_baxter_angle" in text for text in solution.warnings)
    assert "cassie_baxter_angle" in solution.summary()


@pytest.mark.slow
def test_an_asperity_that_is_pulled_has_a_negative_force():
    rows = asked("asperities").contact["asperities"]
    upwards = [row["force_vector"][2] > 0.0 for row in rows]
    assert any(upwards)
    assert [row["force"] < 0.0 for row in rows] == upwards
