"""Bridges between planes, spheres and discs against an independent axisymmetric solution and known
values; pinned and pendant droplets."""

import json

import numpy as np
import pytest
from helpers import UNIT_VOLUME, some

import iga_membrane as iga
from iga_membrane.cli import main
from iga_membrane.reference import bridge_between

PLANE = np.inf
SEED = 20261201


def solid(radius, angle):
    return iga.Plane(angle) if np.isinf(radius) else iga.Sphere(angle, radius)


def member(number):
    """One of the kind with the witness's solution: any pairing, angle, gap, volume and weight."""
    rng = np.random.default_rng((SEED, number))
    while True:
        radii = tuple(float(r) for r in rng.choice([PLANE, PLANE, 0.7, 2.0], 2))
        angles = tuple(float(a) for a in rng.uniform(5.0, 170.0, 2))
        volume = float(10.0 ** rng.uniform(-1.5, 0.5))
        gap = float(10.0 ** rng.uniform(-2.0, -0.3)) * volume ** (1.0 / 3.0)
        bond = float(rng.choice([0.0, 0.5]))
        try:
            witness = bridge_between(radii, angles, gap, volume, bond)
        except ValueError:
            continue  # no bridge there
        return radii, angles, gap, volume, bond, witness


@pytest.mark.parametrize("number", some(range(30), range(6)))
def test_any_pairing_any_angle(number):
    radii, angles, gap, volume, bond, witness = member(number)
    scene = iga.capillary_bridge(
        solid(radii[0], angles[0]), solid(radii[1], angles[1]),
        gap=gap, volume=volume, gravity=bond,
    )  # fmt: skip
    found = iga.solve(scene, on_fail="return")
    if found.status is iga.Status.CONVERGED_SADDLE:
        return  # the witness knows axisymmetric stability only
    assert found.success, (radii, angles, gap, volume, bond, found.message)
    size = max(abs(witness.pressure), 1.0 / witness.neck_radius)
    assert found.measures["pressure"] == pytest.approx(witness.pressure, abs=1e-5 * size)
    largest = size * np.pi * witness.contact_radius_upper**2
    assert found.measures["force"] == pytest.approx(witness.force, abs=1e-5 * largest)
    for name in ("neck_radius", "contact_radius_lower", "contact_radius_upper", "A_LG", "A_wet"):
        assert found.measures[name] == pytest.approx(getattr(witness, name), rel=1e-5), name


def test_plates_of_different_angles():
    found = iga.solve(iga.capillary_bridge(iga.Plane(110), iga.Plane(60), gap=0.6, volume=1.0))
    assert found.measures["force"] == pytest.approx(2.377167, rel=1e-6)
    assert found.measures["pressure"] == pytest.approx(0.990965, rel=1e-6)
    assert found.stability_scope == "full"


@pytest.mark.parametrize("gap", [1e-3, 1e-4])
def test_flat_bridges_are_known_from_their_start(gap):
    """The force of a flat bridge is its area times 2 cos(theta) / gap."""
    scene = iga.capillary_bridge(iga.Plane(30), iga.Plane(30), gap=gap, volume=gap)
    found = iga.solve(scene)
    assert found.newton_iterations <= 4
    assert found.measures["force"] == pytest.approx(2.0 * np.cos(np.pi / 6.0) / gap, rel=3.0 * gap)


def test_a_cylinder_between_plates_gives_way_at_a_gap_of_half_its_girth():
    """Rayleigh and Plateau, with lines that are free to slide."""

    def at(gap):
        return iga.capillary_bridge(iga.Plane(90), iga.Plane(90), gap=gap, volume=np.pi**2)

    path = iga.trace(at, [3.0, 3.2], parameter="gap.distance", on_fail="return")
    assert path.end.status is iga.Status.LIMIT_POINT
    assert path.bracket.parameter == "gap.distance"
    assert path.bracket.lo <= np.pi <= path.bracket.hi
    assert path.bracket.hi - path.bracket.lo <= 1e-3 * np.pi


def test_the_force_is_the_slope_of_the_energy():
    def at(gap):
        return iga.solve(iga.capillary_bridge(
            iga.Plane(50), iga.Plane(80), gap=gap, volume=0.6, gravity=0.8
        )).measures  # fmt: skip

    low, middle, high = (at(gap) for gap in (0.2995, 0.3, 0.3005))
    slope = (high["energy"] - low["energy"]) / 1e-3
    assert middle["force"] == pytest.approx(slope, rel=1e-5)


def test_a_ball_between_a_disc_and_a_plate_carries_no_force():
    scene = iga.capillary_bridge(
        iga.Disc(radius=0.5), iga.Plane(150.0), gap=1.7320508, volume=4.0810486
    )
    found = iga.solve(scene)
    assert abs(found.measures["force"]) <= 1e-5
    assert found.measures["contact_radius_lower"] == pytest.approx(0.5, rel=1e-9)


def test_between_two_discs_the_pressure_is_that_of_the_film_between_rings():
    half, volume = 0.4, 0.9
    film = iga.solve(iga.film_between_rings(radius=0.7, half_height=half, volume=volume))
    disc = iga.Disc(20.0, radius=0.7)
    found = iga.solve(iga.capillary_bridge(disc, disc, gap=2.0 * half, volume=volume))
    assert found.measures["pressure"] == pytest.approx(film.measures["pressure"], rel=1e-6)


def cap_volume(angle, rim):
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.pi / 3.0 * (2.0 + c) * (1.0 - c) ** 2 * (rim / s) ** 3


@pytest.mark.parametrize(
    ("angle", "kind"),
    [(50.0, "leaves_its_rim"), (75.0, None), (140.0, None), (155.0, "leaves_its_rim")],
)
def test_a_line_rests_on_a_rim_within_gibbs_range(angle, kind):
    disc = iga.Disc(60.0, radius=0.8, edge=90.0)
    found = iga.solve(iga.sessile_droplet(disc, volume=cap_volume(angle, 0.8)), on_fail="return")
    assert found.kind == kind
    assert found.success == (kind is None)
    assert found.measures["contact_angle_measured"] == pytest.approx(angle, abs=1e-3)


@pytest.mark.slow
def test_the_largest_drop_under_a_ceiling():
    def at(volume):
        return iga.sessile_droplet(iga.Plane(60.0), volume=volume, gravity=[0.0, 0.0, 1.0])

    path = iga.trace(at, [5.0, 7.5, 9.0], parameter="liquid.volume", on_fail="return")
    assert path.end.status is iga.Status.LIMIT_POINT
    assert path.bracket.lo <= 8.00378887 <= path.bracket.hi
    assert path.bracket.hi - path.bracket.lo <= 1e-3 * 8.0


def test_a_light_liquid_rises():
    """A negative density is that of gravity the other way round."""
    plane = iga.Plane(80.0)
    light = iga.solve(iga.sessile_droplet(
        plane, volume=UNIT_VOLUME, gravity=1.0, liquid=iga.Liquid(1.0, -0.3)
    ))  # fmt: skip
    hung = iga.solve(iga.sessile_droplet(
        plane, volume=UNIT_VOLUME, gravity=[0.0, 0.0, 1.0], liquid=iga.Liquid(1.0, 0.3)
    ))  # fmt: skip
    assert light.measures["height"] == pytest.approx(hung.measures["height"], rel=1e-10)
    assert any("lighter than its surroundings" in text for text in light.warnings)


def test_through_the_command_line(tmp_path):
    scene = tmp_path / "bridge.toml"
    scene.write_text(
        'scene = "capillary_bridge"\n[liquid]\nvolume = 0.5\n'
        '[lower]\nkind = "sphere"\nradius = 1.0\ncontact_angle = 40.0\n'
        '[upper]\nkind = "disc"\nradius = 0.6\n[gap]\ndistance = 0.3\n'
    )
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 0
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["measures"]["contact_radius_upper"] == pytest.approx(0.6, rel=1e-9)
    assert result["scene"]["upper"] == {
        "kind": "disc", "radius": 0.6, "edge": 90.0, "contact_angle": 90.0
    }  # fmt: skip


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"gap": 0.0}, "gap = 0"),
        ({"volume": -1.0}, "liquid.volume = -1"),
        ({"gravity": [0.1, 0.0, -1.0]}, "along the axis"),
        ({"lower": iga.SphereLattice(120.0, 0.1, 0.4)}, "lower"),
        ({"upper": iga.Plane(iga.stripes(60.0, 90.0, 1.0, 0.1))}, "a bridge is round"),
    ],
)
def test_what_a_bridge_does_not_have_is_refused(change, said):
    asked = {"lower": iga.Plane(60.0), "upper": iga.Plane(60.0), "gap": 0.3, "volume": 0.5} | change
    with pytest.raises(iga.SceneError, match=said):
        iga.capillary_bridge(asked.pop("lower"), asked.pop("upper"), **asked)
