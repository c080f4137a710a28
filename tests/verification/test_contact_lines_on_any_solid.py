"""Droplets on bumps, textures, fibres and patterns of wettability, their lines inside the membrane:
against profiles of revolution by shooting, against each other, and their derivatives."""

from dataclasses import dataclass

import numpy as np
import pytest
from helpers import UNIT_VOLUME, some

import iga_membrane as iga
from iga_membrane.reference.revolution import drop_on_revolution


def even(angle):
    return lambda r: np.cos(np.radians(angle)) + 0.0 * r


def bump(height, width):
    return (
        lambda r: height * np.exp(-((r / width) ** 2)),
        lambda r: -2.0 * r / width**2 * height * np.exp(-((r / width) ** 2)),
    )


def radial(inside, outside, radius, border):
    one, two = np.cos(np.radians([inside, outside]))
    return lambda r: 0.5 * (one + two) + 0.5 * (one - two) * np.tanh((radius - r) / border)


FLAT = bump(0.0, 1.0)


def drop(solid, bond=0.0, **options):
    return iga.sessile_droplet(solid, volume=UNIT_VOLUME, gravity=bond, hold="xy", **options)


def compare(scene, exact, energy, length, wet):
    found = iga.solve(scene)
    errors = {name: found.measures[name] / exact[name] - 1.0 for name in exact}
    assert abs(errors["energy"]) <= energy, errors
    assert max(abs(errors[name]) for name in ("height", "A_LG")) <= length, errors
    assert abs(errors["A_wet"]) <= wet, errors
    return found


@pytest.mark.parametrize(
    ("angle", "bond"),
    some([(120.0, 0.0), (60.0, 1.0), (30.0, 0.0), (40.0, 1.0), (90.0, 1.0), (150.0, 1.0)], {0, 1}),
)
def test_a_plane_by_lines_inside_the_membrane(angle, bond):
    exact = drop_on_revolution(*FLAT, even(angle), bond, UNIT_VOLUME, angle)
    scene = drop(iga.Plane(angle), bond, contact_line="trimmed")
    found = compare(scene, exact, 2e-7, 1e-5, 2e-6)
    assert found.measures["contact_angle_measured"] == pytest.approx(angle, abs=0.05)
    assert abs(found.audit.force) < 1e-3


@pytest.mark.parametrize(
    ("height", "width", "angle", "bond"),
    some(
        [
            (0.3, 0.6, 120.0, 0.0),
            (-0.3, 0.6, 100.0, 1.0),
            (0.2, 0.5, 70.0, 0.0),
            (0.4, 1.0, 110.0, 2.0),
            (-0.2, 0.4, 130.0, 0.5),
            (0.25, 0.7, 90.0, 1.0),
        ],
        {0, 1},
    ),
)
def test_bumps_and_dimples_agree_with_profiles_of_revolution(height, width, angle, bond):
    solid = iga.HeightMap.bump(height, width, contact_angle=angle)
    exact = drop_on_revolution(*bump(height, width), even(angle), bond, UNIT_VOLUME, angle)
    compare(drop(solid, bond), exact, 2e-7, 1e-5, 1e-5)


@pytest.mark.parametrize(
    ("pattern", "bond", "guess"),
    some(
        [
            ((60.0, 120.0, 1.2, 0.1), 0.0, 110.0),
            ((60.0, 120.0, 1.2, 0.1), 1.0, 105.0),
            ((40.0, 110.0, 1.0, 0.2), 0.0, 100.0),
            ((110.0, 70.0, 0.8, 0.15), 0.0, 70.0),
        ],
        {2},
    ),
)
def test_patches_agree_with_profiles_of_revolution(pattern, bond, guess):
    exact = drop_on_revolution(*FLAT, radial(*pattern), bond, UNIT_VOLUME, guess)
    compare(drop(iga.Plane(iga.patch(*pattern)), bond), exact, 2e-7, 1e-5, 1e-5)


def test_energies_on_a_bump_converge_at_twice_the_degree():
    exact = drop_on_revolution(*bump(0.3, 0.6), even(100.0), 1.0, UNIT_VOLUME, 100.0)
    solid = iga.HeightMap.bump(0.3, 0.6, contact_angle=100.0)
    errors = []
    for elements in (16, 32):
        mesh = iga.Discretization(elements=elements, degree=2)
        found = iga.solve(drop(solid, 1.0, discretization=mesh))
        errors.append(abs(found.measures["energy"] / exact["energy"] - 1.0))
    assert np.log2(errors[0] / errors[1]) > 3.5
    assert errors[1] < 1e-7


@pytest.mark.slow
def test_every_model_of_a_flat_droplet_gives_the_same():
    """Below 90 degrees the outer part of the folded patch hangs together at its folds only."""
    solid = iga.HeightMap.bump(0.2, 0.8, contact_angle=60.0)
    found = []
    for model in ("eighth", "half", "full"):
        mesh = iga.Discretization(elements=24, model=model)
        found.append(iga.solve(drop(solid, 0.5, discretization=mesh)).measures)
    for other in found[1:]:
        assert other["energy"] == pytest.approx(found[0]["energy"], rel=1e-8)
        for name in ("A_LG", "A_wet", "height"):
            assert other[name] == pytest.approx(found[0][name], rel=2e-6), name


def test_a_droplet_rolls_off_a_bump_unless_it_is_held():
    solid = iga.HeightMap.bump(0.3, 0.6, contact_angle=120.0)
    free = iga.sessile_droplet(solid, volume=UNIT_VOLUME, gravity=1.0)
    found = iga.solve(free, on_fail="return")
    assert found.status is iga.Status.CONVERGED_SADDLE
    assert "roll or slide off" in found.message
    dimple = iga.HeightMap.bump(-0.3, 0.6, contact_angle=120.0)
    assert iga.solve(iga.sessile_droplet(dimple, volume=UNIT_VOLUME, gravity=1.0)).success


SCENES = {
    "plane": lambda: drop(iga.Plane(100.0), 1.0, contact_line="trimmed"),
    "egg carton": lambda: drop(iga.HeightMap.egg_carton(0.03, 0.5, contact_angle=100.0), 1.0),
    "pillars": lambda: drop(
        iga.HeightMap.pillars(0.3, 0.05, 0.9, 0.1, contact_angle=100.0),
        1.0,
        discretization=iga.Discretization(elements=24),
    ),
    "stripes": lambda: drop(iga.Plane(iga.stripes(60.0, 120.0, 0.8, 0.3)), 1.0),
    "stripes on a bump": lambda: drop(
        iga.HeightMap.bump(0.2, 0.7, contact_angle=iga.stripes(70.0, 110.0, 0.8, 0.3)), 1.0
    ),
    "fibre": lambda: drop(iga.Cylinder(100.0, radius=2.0), 1.0),
    "tilted, full model": lambda: iga.sessile_droplet(
        iga.HeightMap.egg_carton(0.03, 0.6, contact_angle=100.0),
        volume=UNIT_VOLUME,
        gravity=[0.1, 0.05, -1.0],
        discretization=iga.Discretization(elements=20),
    ),
}


LONG = "pillars", "tilted, full model", "stripes on a bump"
"""Of which a derivative costs seconds."""


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] if n in LONG else []) for n in SCENES]
)
def test_every_term_has_exact_derivatives(name):
    for term, errors in iga.check_derivatives(SCENES[name]()).items():
        assert errors.gradient < 1e-6, term
        assert errors.hessian < 1e-6, term


@dataclass(frozen=True)
class Ridge:
    """A fibre along y by its gap alone, as a user may write it."""

    contact_angle: float
    scale: float

    def center_of(self, which):
        return np.zeros((*np.shape(which), 3)) - [0.0, 0.0, self.scale]

    def radius_of(self, which):
        return np.full(np.shape(which), np.inf)

    def nearest(self, points):
        which = np.zeros(points.shape[:-1], int)
        away = (points - self.center_of(which)) * [1.0, 0.0, 1.0]
        distance = np.linalg.norm(away, axis=-1)
        normal = away / distance[..., None]
        ridge = normal[..., ::-1] * [1.0, 0.0, -1.0] / np.sqrt(distance)[..., None]
        return iga.Nearest(distance - self.scale, normal, 0.0 * distance, which, ridge)


def test_an_own_solid_carries_contact_lines_as_ours_does():
    ours = iga.solve(drop(iga.Cylinder(100.0, radius=1.0)))
    own = iga.solve(drop(Ridge(100.0, 1.0)))
    for name in ("energy", "A_LG", "A_wet", "height", "contact_radius"):
        assert own.measures[name] == pytest.approx(ours.measures[name], rel=1e-7), name
    (line,) = iga.contact_lines(own)
    (same,) = iga.contact_lines(ours)
    assert line.line.arc.sum() == pytest.approx(same.line.arc.sum(), rel=1e-7)


@pytest.mark.slow
def test_nothing_depends_on_where_a_texture_stands():
    """An egg carton shifted by half a period along both axes is the same surface."""
    period = 0.6
    same = iga.HeightMap.egg_carton(0.04, period, contact_angle=105.0)

    def shifted(x, y):
        h = same.height(x + 0.5 * period, y + 0.5 * period)
        return tuple(h)

    there = iga.HeightMap(shifted, 105.0, same.scale)
    one, two = (iga.solve(drop(solid, 0.5)) for solid in (same, there))
    for name in ("energy", "A_LG", "A_wet", "height"):
        assert one.measures[name] == pytest.approx(two.measures[name], rel=1e-9), name


def test_units_do_not_matter_on_a_pattern():
    scale, gamma = 1e-3, 0.07
    metres = iga.sessile_droplet(
        iga.Plane(iga.patch(60.0, 110.0, 1.1 * scale, 0.2 * scale)),
        volume=UNIT_VOLUME * scale**3,
        liquid=iga.Liquid(gamma, 1000.0),
        gravity=gamma / (1000.0 * scale**2),
        hold="xy",
    )
    plain = drop(iga.Plane(iga.patch(60.0, 110.0, 1.1, 0.2)), 1.0)
    small, one = iga.solve(metres).measures, iga.solve(plain).measures
    assert small["energy"] == pytest.approx(one["energy"] * gamma * scale**2, rel=1e-9)
    assert small["contact_radius"] == pytest.approx(one["contact_radius"] * scale, rel=1e-8)


def test_contact_lines_close_and_bound_the_wetted_area():
    solid = iga.HeightMap.egg_carton(0.04, 0.6, contact_angle=105.0)
    found = iga.solve(drop(solid, 0.5))
    (each,) = iga.contact_lines(found)
    x, t, arc = each.line.position, each.line.tangent, each.line.arc
    flat = 0.5 * float((x[:, 0] * t[:, 1] - x[:, 1] * t[:, 0]) @ arc)
    assert flat == pytest.approx(np.pi * found.measures["contact_radius"] ** 2, rel=1e-8)
    assert np.linalg.norm(arc @ t) < 1e-8 * arc.sum()
    steps = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)
    assert steps.max() < 0.05
    young = np.degrees(each.line.angle @ arc) / arc.sum()
    assert young == pytest.approx(105.0, abs=0.3)


def test_states_on_any_solid_are_kept_and_solved_again(tmp_path):
    for number, solid in enumerate((
        iga.HeightMap.bump(0.2, 0.6, contact_angle=100.0),
        iga.Plane(iga.stripes(70.0, 110.0, 0.8, 0.3)),
    )):  # fmt: skip
        found = iga.solve(drop(solid, 0.5))
        path = tmp_path / f"{number}.npz"
        iga.save(found, path)
        again = iga.load(path)
        assert again.measures == found.measures
        assert iga.solve(again.scene).measures["energy"] == pytest.approx(
            found.measures["energy"], rel=1e-10
        )


def test_what_lines_inside_the_membrane_do_not_have_is_refused():
    bumpy = iga.HeightMap.bump(0.2, 0.6, contact_angle=100.0)
    for options, said in (
        ({"contact_line": "conforming"}, 'contact_line = "conforming"'),
        ({"contact_line": "adhesion"}, 'contact_line = "adhesion"'),
        ({"penalty": 1e4}, "no penalty"),
        ({"discretization": iga.Discretization(space="lagrange")}, '"bspline"'),
        ({"discretization": iga.Discretization(model="eighth"), "gravity": [0.1, 0.0, -1.0]},
         "no such mirror planes"),
    ):  # fmt: skip
        with pytest.raises(iga.SceneError, match=said):
            iga.sessile_droplet(bumpy, volume=1.0, **options)
