"""Questions that have no answer, or another one than a careless code would give."""

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet, pinned_cap, solved

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.driver.acceptance import defect
from iga_membrane.reference import drop_on_plane
from iga_membrane.splines import points_of
from iga_membrane.verification.audit import audit
from iga_membrane.verification.evidence import TOLERANCE, Audit

TENSION = iga.SurfaceTension(1.0)


@pytest.mark.parametrize("model", ["quarter", "eighth"])
def test_a_model_without_the_mirror_planes_of_gravity_is_refused(model):
    with pytest.raises(iga.SceneError, match="leans to x"):
        pinned_cap(1.0, [TENSION, iga.Volume(1.0), iga.Gravity(1.0, (1.0, 0, 0))], model)


def test_a_half_model_is_not_for_gravity_along_y():
    with pytest.raises(iga.SceneError, match="leans to y"):
        pinned_cap(1.0, [TENSION, iga.Volume(1.0), iga.Gravity(1.0, (0, 1.0, 0))], "half")


@pytest.mark.parametrize("shift", [1e-3, 0.1])
def test_a_start_off_the_mirror_planes_is_refused(shift):
    plane = iga.Plane(contact_angle=120)
    start = droplet(120).surface.transformed(shift=[shift, 0, 0])
    scene = iga.sessile_droplet(plane, volume=UNIT_VOLUME, gravity=1.0, start=start)
    with pytest.raises(iga.SceneError, match="start: not symmetric"):
        iga.solve(scene)


def test_a_start_off_the_axis_gives_the_same_drop():
    plane = iga.Plane(contact_angle=120)
    mesh = iga.Discretization(elements=12, model="half")
    start = droplet(120, elements=12).surface.transformed(shift=[0.2, 0, 0])
    scene = iga.sessile_droplet(
        plane, volume=UNIT_VOLUME, gravity=1.0, start=start, discretization=mesh
    )
    found, exact = iga.solve(scene).measures, drop_on_plane(1.0, 120.0)
    for name in ("height", "equator_radius", "p_apex", "contact_radius"):
        assert found[name] == pytest.approx(exact[name], rel=1e-3), name


def test_a_start_of_another_mesh_is_refused():
    start = droplet(120, elements=12).surface
    with pytest.raises(iga.SceneError, match="expected from the discretization"):
        iga.sessile_droplet(iga.Plane(contact_angle=120), volume=UNIT_VOLUME, start=start)


def test_the_faintest_tilt_is_no_equilibrium():
    tilt = np.radians(1e-3)
    scene = iga.sessile_droplet(
        iga.Plane(contact_angle=120),
        volume=UNIT_VOLUME,
        gravity=0.01 * np.array([0.0, np.sin(tilt), -np.cos(tilt)]),
        discretization=iga.Discretization(elements=8),
    )
    assert iga.solve(scene, on_fail="return").status is iga.Status.NO_EQUILIBRIUM


def test_a_hold_without_volume_reports_its_force():
    terms = [TENSION, iga.Pressure(1.0), iga.Gravity(1.0, (0.3, 0, 0)), iga.Centroid("x")]
    solution = iga.solve(pinned_cap(1.0, terms, "half"), on_fail="return")
    weight = 0.3 * solution.measures["volume"]
    assert solution.hold_force[0] == pytest.approx(-weight, rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize(("angle", "bond"), [(0.5, 100.0), (1.0, 1000.0)])
def test_a_solver_at_a_loss_does_not_claim_a_limit(angle, bond):
    solution = iga.solve(
        droplet(angle, bond), iga.SolverOptions(min_load_step=0.02), on_fail="return"
    )
    assert solution.status is not iga.Status.LIMIT_POINT


def test_a_flat_sheet_is_an_equilibrium():
    rim = [iga.Fixed(f"xi{i}={j}") for i in (1, 2) for j in (0, 1)]
    solution = iga.solve(iga.Scene(iga.sheet(1.0, elements=4), [TENSION], rim))
    assert solution.measures["A_LG"] == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("size", [1e200, 1e-200])
def test_the_length_of_a_direction_does_not_matter(size):
    scene = {
        "scene": "sessile_droplet",
        "liquid": {"volume": UNIT_VOLUME},
        "gravity": {"acceleration": 1.0, "direction": [0, 0, -size]},
        "substrate": {"contact_angle": 90.0},
    }
    found = iga.solve(iga.read_scene(scene).scene).measures
    assert found["height"] == pytest.approx(solved(90, 1.0).measures["height"], rel=1e-12)


def test_numbers_beyond_floats_are_refused():
    with pytest.raises(iga.SceneError, match="volume"):
        iga.sessile_droplet(iga.Plane(contact_angle=90), volume=10**400)
    for volume in (1e308, 5e-324):
        with pytest.raises(iga.SceneError, match="choose other units"):
            iga.sessile_droplet(iga.Plane(contact_angle=90), volume=volume)


def test_no_sliding_line_at_180_degrees_however_composed():
    drop = iga.sessile_droplet(iga.Plane(contact_angle=120), volume=1.0).surface
    terms = [iga.SurfaceTension(1.0), iga.Volume(1.0), iga.PlaneContactLine(1.0, 180.0)]
    with pytest.raises(iga.SceneError, match="a contact line that slides freely"):
        iga.Scene(drop, terms, [iga.Sliding("xi2=0")])


@pytest.mark.parametrize(
    "make",
    [
        lambda: iga.Fixed("rim"),
        lambda: iga.Sliding("xi3=0"),
        lambda: iga.Sector("third"),
        lambda: iga.Symmetry("w"),
        lambda: iga.Joint(("xi1=0", "top")),
        lambda: iga.PlaneContactLine(1.0, 90.0, "xi2=1"),
        lambda: iga.Gravity(float("nan"), (0, 0, -1)),
        lambda: iga.Pressure(float("inf")),
    ],
)
def test_misspelt_parts_are_refused(make):
    with pytest.raises(iga.SceneError):
        make()


def test_a_spline_surface_with_a_kink_is_refused():
    seam = iga.refined(iga.cap(1.0, 60.0), [0.1])
    with pytest.raises(iga.SceneError, match="C1 needed"):
        iga.Scene(seam, [TENSION])


@pytest.mark.parametrize("name", ["residual", "volume", "force", "line", "angle", "penetration"])
def test_every_objection_of_the_audit_counts(name):
    clean = dict.fromkeys(("residual", "volume", "force", "line", "angle", "penetration"), 0.0)
    assert defect(Audit(**clean), TOLERANCE.penetration) is None
    status, message = defect(
        Audit(**clean | {name: 1.1 * getattr(TOLERANCE, name)}), TOLERANCE.penetration
    )
    named = iga.Status.PENETRATION if name == "penetration" else iga.Status.UNDERRESOLVED
    assert status is named
    assert message


def test_a_membrane_through_a_sphere_is_penetration():
    deep = Audit(residual=0.0, penetration=1.1 * TOLERANCE.indentation)
    assert defect(deep, TOLERANCE.indentation)[0] is iga.Status.PENETRATION


def test_the_audit_sees_a_membrane_inside_its_sphere():
    sphere = iga.Sphere(contact_angle=100, radius=1.0, center=(0, 0, -1))
    scene = iga.sessile_droplet(sphere, volume=UNIT_VOLUME)
    assembly, surface = Assembly(scene), scene.local_surface()
    net = surface.net.copy()
    net[:, 3:] *= [1.0, 1.0, -0.3]
    sunk = surface.moved(points_of(surface.space, net))
    motion, load = assembly.spines.on(surface), np.zeros(surface.space.count)
    body = assembly.density(np.zeros(assembly.multipliers))
    fine = audit(scene, surface, motion, body, load, assembly.points, assembly.contact)
    found = audit(scene, sunk, motion, body, load, assembly.points, assembly.contact)
    assert fine.penetration < 1e-6
    assert found.penetration > 0.1


def test_support_force_is_the_weight_and_pressures_differ_by_the_head():
    solution = solved(130, 2.0)
    m, exact = solution.measures, drop_on_plane(2.0, 130.0)
    assert solution.contact["support_force"] == pytest.approx(2.0 * UNIT_VOLUME, rel=1e-6)
    assert solution.contact["wet_area"] == pytest.approx(m["A_wet"], rel=1e-10)
    for name in ("p_apex", "equator_radius", "E_surf", "E_grav"):
        assert m[name] == pytest.approx(exact[name], rel=1e-6), name
    apex = np.array([0.0, 0.0, m["height"]])
    assert solution.pressure(apex) == pytest.approx(m["p_apex"], rel=1e-10)
