"""Contact angle, volume and tension from photographs of drops that an independent profile drew:
8 um per pixel, blurred over a pixel, every row's edges off by 0.4 pixels, base line not given."""

from functools import cache
from time import process_time

import numpy as np
import pytest
from drop_camera import NOISE, PIXEL, WATER, pendant, photograph, sessile
from scipy.ndimage import gaussian_filter, rotate

import iga_membrane as iga
from iga_membrane.photograph.axisymmetric import Fit, Profile, distances
from iga_membrane.photograph.cut import cut
from iga_membrane.photograph.local_angles import side_angles

WIDTH, NEEDLE = 2e-3, 0.9e-3
LIQUID = iga.Liquid("72.8 mN/m", "998 kg/m^3")


@cache
def measured(angle, seed, ground="dark", blur="ramp", fit=("contact_angle", "volume")):
    """Errors of angle (degrees) and volume (relative) with their standard errors, CPU seconds, and
    the fit."""
    r, z, volume = sessile(angle, WIDTH)
    dice = np.random.default_rng(1000 + seed)
    image = photograph(
        r, z, seed=seed, ground=ground, blur=blur, shape=(560 if ground == "mirror" else 400, 420),
        base=300.0 + dice.uniform(-1, 1), middle=210.0 + dice.uniform(-1, 1),
    )  # fmt: skip
    began = process_time()
    found = iga.fit_profile(
        iga.silhouette(image, scale="8 um"), liquid=LIQUID, gravity="9.81 m/s^2", fit=fit
    )
    spent = process_time() - began
    angle_error = found.values["contact_angle"] - angle
    volume_error = found.values["volume"] / volume - 1.0
    errors = found.standard_errors["contact_angle"], found.standard_errors["volume"] / volume
    return angle_error, volume_error, errors, spent, found


@pytest.mark.parametrize(("angle", "ground"), [(41.0, "dark"), (112.0, "mirror")])
def test_angle_and_volume_of_a_drop(angle, ground):
    off, off_volume, _, spent, _ = measured(angle, 3, ground)
    # three standard deviations of what twenty images may have
    assert abs(off) < 0.3
    assert abs(off_volume) < 0.006
    assert spent < 3.0


@pytest.mark.slow
@pytest.mark.parametrize("blur", ["ramp", "gauss"])
@pytest.mark.parametrize("ground", ["dark", "none", "mirror"])
def test_twenty_drops(ground, blur):
    """Root mean square 0.1 degrees and 0.2 % of volume, 3 CPU seconds each; the standard errors say
    how far off the values are."""
    angles = np.random.default_rng(7).uniform(30.0, 150.0, 20)
    fit = ("contact_angle", "volume", *["base"] * (ground == "mirror"))
    rows = [measured(float(a), k, ground, blur, fit) for k, a in enumerate(angles)]
    off, off_volume = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
    told, told_volume = np.array([row[2] for row in rows]).T
    print(ground, blur, np.sqrt(np.mean(off**2)), np.sqrt(np.mean(off_volume**2)),
          max(row[3] for row in rows), np.sqrt(np.mean((off / told) ** 2)),
          np.sqrt(np.mean((off_volume / told_volume) ** 2)))  # fmt: skip
    assert np.sqrt(np.mean(off**2)) < 0.1
    assert np.sqrt(np.mean(off_volume**2)) < 0.002
    assert max(row[3] for row in rows) < 3.0
    for ratio in (off / told, off_volume / told_volume):
        assert 0.5 < np.sqrt(np.mean(ratio**2)) < 1.6


def hanging_image(part, seed):
    r, z, volume = pendant(part, NEEDLE)
    image = photograph(r, z, seed=seed, ground="none", needle=NEEDLE, base=60.3, middle=250.4,
                       shape=(780, 500))  # fmt: skip
    return image, volume


@pytest.mark.parametrize(
    "part", [0.83, *[pytest.param(p, marks=pytest.mark.slow) for p in (0.7, 0.77, 0.9, 0.95)]]
)
@pytest.mark.parametrize("guess", ["50 mN/m", pytest.param("20 mN/m", marks=pytest.mark.slow)])
def test_tension_of_water_on_a_needle(part, guess):
    """0.5 % on a needle of 1.8 mm, from a tension that is far off, in 3 CPU seconds."""
    image, volume = hanging_image(part, int(1000 * part))
    began = process_time()
    points = iga.silhouette(image, scale="8 um")
    found = iga.fit_profile(
        points, liquid=iga.Liquid(guess, "998 kg/m^3"), gravity=9.81, fit=("surface_tension",)
    )
    assert process_time() - began < 3.0
    print(part, guess, found.values["surface_tension"] / 0.0728 - 1.0, process_time() - began)
    assert found.values["surface_tension"] == pytest.approx(0.0728, rel=0.005)
    assert found.values["volume"] == pytest.approx(volume, rel=0.01)
    drop = found.solution  # of the tension that was found, on a needle of the base's radius
    assert drop.measures["height"] == pytest.approx(found.values["height"], rel=1e-3)
    assert drop.measures["contact_radius"] == pytest.approx(
        found.values["contact_radius"], rel=1e-6
    )
    assert points.camera.hangs
    assert np.all(points[:, 1] < 0.0)


def test_a_camera_that_is_tilted_sees_the_same_drop():
    """The base line is found with its tilt."""
    r, z, volume = sessile(70.0, WIDTH)
    level = photograph(r, z, seed=5, noise=0.1, shape=(420, 520), middle=259.5, base=300.0)
    tilted = rotate(level, 2.0, reshape=False, order=3, mode="nearest")
    points = iga.silhouette(tilted, scale=PIXEL)
    assert np.degrees(points.camera.tilt) == pytest.approx(-2.0, abs=0.02)
    found = iga.fit_profile(points, liquid=LIQUID, gravity=9.81)
    assert found.values["contact_angle"] == pytest.approx(70.0, abs=0.2)
    assert found.values["volume"] == pytest.approx(volume, rel=0.005)


@pytest.mark.slow
def test_light_and_dark_may_change_places_and_light_may_be_uneven_and_noisy():
    r, z, _ = sessile(95.0, WIDTH)
    image = photograph(r, z, seed=2, grey=4.0)
    uneven = gaussian_filter(image, 1.0) * np.linspace(0.85, 1.1, image.shape[1])
    for each in (uneven, 255.0 - image, np.stack([image] * 3, axis=-1)):
        found = iga.fit_profile(iga.silhouette(each, scale=PIXEL), liquid=LIQUID, gravity=9.81)
        assert found.values["contact_angle"] == pytest.approx(95.0, abs=0.3)


@pytest.mark.slow
def test_a_highlight_and_dust_do_not_count():
    r, z, _ = sessile(110.0, WIDTH)
    image = photograph(r, z, seed=4, middle=209.81)
    image[230:280, 190:230] = 230.0  # the lamp through the droplet
    image[100:104, 50:54] = 20.0
    clean = iga.fit_profile(iga.silhouette(image, scale=PIXEL), liquid=LIQUID, gravity=9.81)
    assert clean.values["contact_angle"] == pytest.approx(110.0, abs=0.2)
    # a hair on the outline
    image[240:243, 60:120] = 20.0
    found = iga.fit_profile(iga.silhouette(image, scale=PIXEL), liquid=LIQUID, gravity=9.81)
    assert found.values["contact_angle"] == pytest.approx(110.0, abs=0.2)
    assert 0 < (~found.used).sum() < 20


def cap_points(angle, noise, seed):
    """Points x (with noise) and z of a circular cap whose foot has the radius 1."""
    radius, dice = 1.0 / np.sin(np.radians(angle)), np.random.default_rng(seed)
    low = -radius * np.cos(np.radians(angle))
    z = np.linspace(0.02, low + radius - 0.01, 150)
    half = np.sqrt(radius**2 - (z - low) ** 2)
    x = np.concatenate([-half, half]) + noise * dice.standard_normal(300)
    return x, np.concatenate([z, z])


@pytest.mark.parametrize("angle", [60.0, 85.0, 105.0, 130.0])
@pytest.mark.parametrize("shear", [0.0, 0.15, -0.3])
def test_front_and_rear_of_a_leaning_drop(angle, shear):
    """A cap that leans has cot(theta) +- shear at its ends."""
    x, z = cap_points(angle, 0.0, 0)
    points = np.stack([x + shear * z, z], axis=1)
    cot = 1.0 / np.tan(np.radians(angle))
    left = np.degrees(np.arctan2(1.0, cot + shear))
    right = np.degrees(np.arctan2(1.0, cot - shear))
    found = iga.fit_profile(points, gravity=[0.3, 0.0, -1.0])
    assert found.values["angle_front"] == pytest.approx(right, abs=1.0)
    assert found.values["angle_rear"] == pytest.approx(left, abs=1.0)
    back = iga.fit_profile(points, gravity=[-0.3, 0.0, -1.0]).values
    assert back["angle_front"] == found.values["angle_rear"]
    with pytest.raises(iga.SceneError, match="does not tell its volume"):
        _ = found.scene


def test_a_held_drop_on_a_slope_has_its_angle_at_both_ends():
    """The section of a solved droplet under lateral gravity: its angle is 80 degrees all round."""
    drop = iga.solve(
        iga.sessile_droplet(
            iga.Plane(contact_angle=80), volume=1.0, gravity=[1.0, 0.0, -1.0], hold="x",
            discretization=iga.Discretization(elements=12),
        )
    )  # fmt: skip
    t = np.linspace(0.0, 0.999, 300)
    sides = [drop.surface.at(np.stack([np.full(300, a), t], axis=1)).position for a in (0.0, np.pi)]
    section = np.concatenate(sides)[:, [0, 2]]
    found = iga.fit_profile(section[section[:, 1] > 1e-3], gravity=[1.0, 0.0, -1.0])
    assert found.values["angle_front"] == pytest.approx(80.0, abs=1.0)
    assert found.values["angle_rear"] == pytest.approx(80.0, abs=1.0)


def test_noise_is_told_by_standard_errors_of_local_fits():
    """Over twenty noisy outlines the angle left scatters as its standard errors say."""
    off, told = [], []
    for seed in range(20):
        x, z = cap_points(100.0, 0.01, seed)
        left, _ = side_angles(x, z)
        off.append(left.degrees - 100.0)
        told.append(left.error)
    # the choice of the part that counts is noisy too
    assert 0.6 < np.sqrt(np.mean(np.square(off) / np.square(told))) < 1.7
    assert np.median(np.abs(off)) < 1.5


def test_what_was_found_is_solved():
    """The solution of the fitted droplet has its angle, volume, contact radius and height."""
    _, _, _, _, found = measured(41.0, 3, "dark")
    drop = found.solution
    assert drop.scene.unit_system == "SI"
    for name in ("volume", "contact_radius", "height"):
        assert drop.measures[name] == pytest.approx(found.values[name], rel=1e-3)
    assert drop.measures["contact_angle_measured"] == pytest.approx(
        found.values["contact_angle"], abs=1e-3
    )


def test_plain_points_without_a_camera():
    """A profile of the reference, without noise, in its own units: nothing to find but itself."""
    from iga_membrane.reference import profile_on_plane

    r, z = profile_on_plane(1.3, 120.0, points=400)
    points = np.concatenate([np.stack([-r, z], axis=1), np.stack([r, z], axis=1)[1:]])
    found = iga.fit_profile(points + [0.3, 0.0], liquid=iga.Liquid(2.0, 1.3), gravity=2.0)
    assert found.units == "dimensionless"
    assert found.values["contact_angle"] == pytest.approx(120.0, abs=1e-3)
    assert found.values["volume"] == pytest.approx(4.0 * np.pi / 3.0, rel=1e-5)
    free = iga.fit_profile(points, liquid=iga.Liquid(5.0, 1.3), gravity=2.0,
                           fit=("contact_angle", "volume", "surface_tension"))  # fmt: skip
    assert free.values["surface_tension"] == pytest.approx(2.0, rel=1e-4)
    upside = iga.fit_profile(points * [1.0, -1.0], liquid=iga.Liquid(2.0, 1.3), gravity=[0, 0, 2.0])
    assert upside.values["volume"] == pytest.approx(found.values["volume"], rel=1e-9)


PROFILES = [Profile(0.2, 1.1, 0.9, 1.3, 0.1), Profile(-0.1, 1.9, 0.7, -0.8, -0.05)]


@pytest.mark.parametrize("profile", PROFILES)
def test_distances_have_their_slopes(profile):
    """Taylor: the error falls as the square of the step, until the samples of the meridian tell."""
    m = profile.down_to(0.3)
    k = np.linspace(60, len(m.s) - 200, 40).astype(int)
    x = profile.middle + np.where(k % 2, 1.0, -1.0) * profile.radius * m.r[k] * 1.02
    y = profile.apex - profile.radius * m.depth[k]
    mirrored = np.arange(40) % 3 == 0
    y = np.where(mirrored, 2.0 * profile.base - y, y)
    at = distances(profile, x, y, mirrored)
    away = np.array([0.3, -0.2, 0.25, 0.4, 0.1])
    errors = []
    for step in (2e-2, 5e-3):
        d = step * away
        moved = Profile(profile.middle + d[0], profile.apex + d[1], profile.radius * np.exp(d[2]),
                        profile.weight * np.exp(d[3]), profile.base + d[4])  # fmt: skip
        change = distances(moved, x, y, mirrored).off - at.off
        errors.append(np.abs(change - at.by @ d).max())
    assert errors[0] / errors[1] > 12.0
    assert errors[1] < 5e-4


@pytest.mark.parametrize("profile", PROFILES)
def test_values_of_a_cut_have_their_slopes(profile):
    def values(p):
        fit = Fit(p, (0, 1, 2, 3, 4), np.eye(5), np.zeros(1), np.ones(1, bool))
        return cut(fit, 2.0 / np.exp(np.log(p.weight / profile.weight)))

    at = values(profile)
    for k in range(5):
        errors = []
        for step in (1e-2, 2.5e-3):
            d = np.eye(5)[k] * step
            one, two = (
                values(Profile(profile.middle + s * d[0], profile.apex + s * d[1],
                               profile.radius * np.exp(s * d[2]),
                               profile.weight * np.exp(s * d[3]), profile.base + s * d[4]))
                for s in (1.0, -1.0)
            )  # fmt: skip
            errors.append({
                name: abs((one.values[name] - two.values[name]) / (2 * step) - at.slopes[name][k])
                for name in at.values
            })  # fmt: skip
        for name, last in errors[1].items():
            size = max(abs(at.slopes[name][k]), abs(at.values[name]))
            assert last < 1e-4 * size or errors[0][name] / last > 12.0, (name, k)
            assert last < 1e-2 * size


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda: iga.silhouette(np.zeros((100, 100))), "same shade"),
        (lambda: iga.silhouette(np.zeros((5, 5))), "must be an image"),
        (lambda: iga.silhouette("nowhere.png"), "no such file"),
        (lambda: iga.silhouette(np.zeros((100, 100)), scale="3 uL"), "quantity of length"),
        (lambda: iga.silhouette(photograph(*sessile(90.0, WIDTH)[:2], seed=1, middle=60.0)),
         "reaches a side border"),
        (lambda: iga.silhouette(photograph(*sessile(90.0, WIDTH)[:2], seed=1, ground="none",
                                           base=410.0)), "lower border"),
        (lambda: iga.fit_profile([[0, 1], [1, 1]]), "12 are needed"),
        (lambda: iga.fit_profile(np.ones((40, 3))), "shape"),
        (lambda: iga.fit_profile(np.ones((40, 2)), fit=("tension",)), "must be one of"),
        (lambda: iga.fit_profile(np.ones((40, 2)), fit=("surface_tension",)), "needs a weight"),
        (lambda: iga.fit_profile(np.ones((40, 2)), fit=("base",)), "is not in the points"),
    ],
)  # fmt: skip
def test_what_cannot_be_measured_is_refused(ask, said):
    with pytest.raises(iga.SceneError, match=said):
        ask()


def test_a_drop_that_leans_is_told():
    x, z = cap_points(90.0, 0.0, 0)
    found = iga.fit_profile(np.stack([x + 0.2 * z, z], axis=1))
    assert "leans" in found.warnings[0]
    assert "leans" in repr(found)


def test_the_overlay_and_the_summary_say_the_values(tmp_path):
    _, _, _, _, found = measured(41.0, 3, "dark")
    iga.plot_fit(found, tmp_path / "fit.png")
    assert (tmp_path / "fit.png").stat().st_size > 5000
    assert f"contact_angle {found.values['contact_angle']:.6g}" in repr(found)
    assert "m^3" in repr(found)
    assert "image/png" in found._repr_html_()
    plain = iga.fit_profile(np.asarray(found.points), liquid=LIQUID, gravity=9.81)
    iga.plot_fit(plain, tmp_path / "plain.svg")
    assert (tmp_path / "plain.svg").stat().st_size > 5000


def test_noise_is_what_the_image_has():
    """Residuals along rows are the noise that was put in."""
    _, _, _, _, found = measured(112.0, 3, "mirror")
    off = found.residuals[found.used] / PIXEL
    assert 0.5 * NOISE < np.std(off) < 1.1 * NOISE
    assert WATER > 0


@pytest.mark.slow
@pytest.mark.parametrize("ground", [25.0, 100.0, 170.0, 215.0])
@pytest.mark.parametrize("angle", [30.0, 75.0, 110.0, 150.0])
def test_blur_in_all_directions_and_solids_of_any_shade(angle, ground):
    """Light that falls on parts of pixels, lenses that blur every way: drawn eight times finer,
    each row's edges off, then blurred by a pixel and rounded to whole grey values."""
    fine, base, middle = 8, 320.3, 209.4
    r, z, volume = sessile(angle, WIDTH)
    dice = np.random.default_rng(int(angle + ground))
    rows, columns = (np.arange(n * fine) / fine + 0.5 / fine - 0.5 for n in (400, 420))
    height, order = (base - rows) * PIXEL, np.argsort(z)
    half = np.interp(height, z[order], r[order], left=-1.0, right=-1.0) / PIXEL
    left, right = (np.repeat(NOISE * dice.standard_normal(400), fine) for _ in range(2))
    inside = (columns > (middle - half + left)[:, None]) & (
        columns < (middle + half + right)[:, None]
    )
    image = np.where(inside & (height > 0)[:, None], 25.0, 215.0)
    image[height <= 0] = ground
    image = image.reshape(400, fine, 420, fine).mean(axis=(1, 3))
    points = iga.silhouette(gaussian_filter(image, 1.0).round(), scale="8 um")
    found = iga.fit_profile(points, liquid=LIQUID, gravity=9.81)
    assert found.values["contact_angle"] == pytest.approx(angle, abs=0.3)
    assert found.values["volume"] == pytest.approx(volume, rel=0.006)
