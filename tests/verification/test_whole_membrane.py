"""The paper's formulation reaches what the default one finds, and says so when it does not."""

import json

import numpy as np
import pytest
from helpers import UNIT_VOLUME
from taylor import lagrangian_slopes

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.cli import main
from iga_membrane.reference import drop_on_plane


def sheet(angle, boundary="circle", membrane=None, **mesh):
    particle = iga.Sphere(angle, 1.0, (0.0, 0.0, -1.0), density=1.0)
    return iga.liquid_sheet(
        particle, size=5.0, boundary=boundary, discretization=iga.Discretization(**mesh),
        membrane=membrane,
    )  # fmt: skip


SLOW = [pytest.param(angle, marks=pytest.mark.slow) for angle in (120.0, 90.0, 30.0)]


@pytest.mark.parametrize("angle", [150.0, *SLOW])
def test_sheet_on_a_particle(angle):
    exact = iga.solve(sheet(angle)).measures
    membrane = iga.WholeMembrane(load_steps=12, penalty=1e5)
    found = iga.solve(sheet(angle, membrane=membrane, elements=18))
    for name in ("phi_deg", "F_CL", "energy", "A_LG", "A_wet", "V_liq", "contact_radius", "V_cap"):
        assert found.measures[name] == pytest.approx(exact[name], rel=1e-3), name
    # tension on the wetted cap presses with 2 gamma / r
    assert 1e-5 < found.audit.penetration < 1e-4
    assert len(found.load_steps) > 13


@pytest.mark.slow
def test_square_rim(tmp_path):
    exact = iga.solve(sheet(140.0, "square")).measures
    membrane = iga.WholeMembrane(load_steps=4)
    found = iga.solve(sheet(140.0, "square", membrane, degree=2, elements=9))
    for name in ("phi_deg", "F_CL", "energy"):
        assert found.measures[name] == pytest.approx(exact[name], rel=1e-2), name
    found.plot(tmp_path / "square.png")  # the rim has no normal at its corners: no warning


@pytest.mark.slow
def test_a_harder_penalty_comes_closer():
    exact = iga.solve(sheet(145.0)).measures["phi_deg"]
    errors = []
    for penalty in (1e3, 1e4):
        membrane = iga.WholeMembrane(0.1, load_steps=1, penalty=penalty)
        found = iga.solve(sheet(145.0, membrane=membrane, elements=12))
        errors.append(abs(found.measures["phi_deg"] / exact - 1.0))
    assert errors[1] < 0.4 * errors[0]


@pytest.mark.parametrize("angle", [110.0])
def test_flat_droplet(angle):
    exact = drop_on_plane(1.0, angle)
    mesh = iga.Discretization(degree=3, elements=12)
    scene = iga.sessile_droplet(
        iga.Plane(angle), volume=UNIT_VOLUME, gravity=1.0, discretization=mesh,
        membrane=iga.WholeMembrane(load_steps=2),
    )  # fmt: skip
    found = iga.solve(scene)
    for name in ("energy", "p_base", "height", "contact_radius", "A_LG", "A_wet"):
        assert found.measures[name] == pytest.approx(exact[name], rel=1e-3), name
    assert found.measures["contact_angle_measured"] == pytest.approx(angle, abs=0.1)
    assert found.measures["volume"] == pytest.approx(UNIT_VOLUME, rel=1e-10)


LOADS = {
    "pressure": {"pressure": 0.2},
    "weight": {"pressure": 0.2, "gravity": 0.5, "liquid_weight": True},
    "volume": {"volume": 1.0},
}


@pytest.mark.slow
@pytest.mark.parametrize("load", LOADS)
def test_liquid_above_the_sheet(load):
    """Section 6.2: "the capillary pressure effect can still be considered"."""
    particle = iga.Sphere(120.0, 1.0, (0.0, 0.0, -1.0), density=1.0)
    asked = {"size": 5.0, "boundary": "circle"} | LOADS[load]
    exact = iga.solve(iga.liquid_sheet(particle, **asked))
    how = iga.WholeMembrane(load_steps=3, penalty=1e5)
    found = iga.solve(iga.liquid_sheet(particle, membrane=how, **asked))
    for name in ("energy", "V_liq", "A_LG", "A_wet", "phi_deg", "F_P", "F_CL", "F_total"):
        assert found.measures[name] == pytest.approx(exact.measures[name], rel=1e-3), name
    assert found.forces[0].effective == pytest.approx(exact.forces[0].effective, abs=1e-3)


LATTICE = iga.SphereLattice(180.0, radius=0.1, spacing=0.4)


@pytest.mark.parametrize(
    ("solid", "normal"),
    [
        (iga.Plane(180.0), (0.0, 0.0, 1.0)),
        pytest.param(iga.Plane(180.0, normal=(0.0, 0.6, 0.8)), (0.0, 0.6, 0.8),
                     marks=pytest.mark.slow),
        pytest.param(LATTICE, (0.0, 0.0, 1.0), marks=pytest.mark.slow),
    ],
    ids=["plane", "turned plane", "asperities"],
)  # fmt: skip
def test_a_droplet_lies_on_its_solid(solid, normal):
    """Figures 5 and 6: load steps of the weight, with stabilization, reach what one unknown per
    control point finds with the same penalty."""
    asked = {"volume": UNIT_VOLUME, "gravity": [-n for n in normal], "hold": "xy"}
    mesh = iga.Discretization(elements=32 if solid is LATTICE else 20)
    own = iga.sessile_droplet(
        solid, discretization=mesh, penalty=1e4, penetration_tolerance=0.2, **asked
    )
    exact = iga.solve(own)
    how = iga.WholeMembrane(load_steps=4, penetration_tolerance=0.2)
    found = iga.solve(iga.sessile_droplet(solid, discretization=mesh, membrane=how, **asked))
    assert found.success
    assert len(found.load_steps) == 6
    for name in ("energy", "height", "p_base", "A_LG"):
        assert found.measures[name] == pytest.approx(exact.measures[name], rel=1e-3), name
    assert found.measures["volume"] == pytest.approx(UNIT_VOLUME, rel=1e-10)
    assert found.audit.force < 1e-3


def test_three_unknowns_per_control_point_of_a_closed_skin_have_exact_derivatives():
    scene = iga.sessile_droplet(
        iga.Plane(180.0), volume=UNIT_VOLUME, gravity=1.0, membrane=iga.WholeMembrane(),
        discretization=iga.Discretization(elements=6),
    )  # fmt: skip
    surface = scene.local_surface()
    sunk = surface.moved(surface.points - [0.0, 0.0, 0.05])  # all of the foot in contact
    assembly = Assembly(scene)
    assembly.begin_step(sunk, scene.local_terms().stabilizations[0])
    direction = np.random.default_rng(0).uniform(-1.0, 1.0, assembly.size)
    first, second = lagrangian_slopes(
        assembly, sunk, np.array([2.0]), assembly.motion(sunk), direction
    )
    assert first >= 1.9
    assert second >= 2.9


@pytest.mark.slow
def test_relaxed_shapes_do_not_know_the_stabilization():
    """N6: from a hundredth of the tension to ten times it."""
    found = []
    for mu, projected in ((0.01, False), (0.1, False), (1.0, False), (10.0, False), (0.1, True)):
        membrane = iga.WholeMembrane(mu, projected, load_steps=4)
        found.append(iga.solve(sheet(140.0, membrane=membrane, elements=15)).measures)
    for name, bound in (("energy", 1e-6), ("F_CL", 1e-6), ("phi_deg", 1e-5)):
        values = [measures[name] for measures in found]
        assert np.ptp(values) <= bound * abs(values[0]), name


@pytest.mark.slow
def test_a_strong_stabilization_fades():
    energies = []
    for mu in (1.0, 100.0):
        membrane = iga.WholeMembrane(stabilization=mu, load_steps=2)
        found = iga.solve(sheet(110.0, membrane=membrane, degree=2, elements=6))
        energies.append(found.measures["energy"])
    assert energies[1] == pytest.approx(energies[0], rel=1e-6)


@pytest.mark.slow
def test_where_fading_fails_the_stabilization_fades_less():
    hard = iga.WholeMembrane(penalty=1e6)
    found = iga.solve(sheet(120.0, membrane=hard, elements=18))
    assert found.measures["phi_deg"] == pytest.approx(
        iga.solve(sheet(120.0)).measures["phi_deg"], rel=1e-4
    )
    soft = iga.WholeMembrane(penalty=1e2)
    found = iga.solve(sheet(150.0, membrane=soft, elements=18), on_fail="return")
    assert found.status is iga.Status.PENETRATION


def test_a_stabilization_that_has_not_relaxed_is_named(monkeypatch):
    monkeypatch.setattr("iga_membrane.solvers.quasi_static.RELAXATIONS", 3)
    membrane = iga.WholeMembrane(stabilization=100.0, load_steps=2)
    found = iga.solve(sheet(110.0, membrane=membrane, degree=2, elements=6), on_fail="return")
    assert found.status is iga.Status.STALLED
    assert "lower solver.stabilization" in found.message


@pytest.mark.slow
def test_a_penalty_too_soft_is_penetration():
    membrane = iga.WholeMembrane(penalty=50.0, load_steps=4)
    found = iga.solve(sheet(130.0, membrane=membrane, elements=9), on_fail="return")
    assert found.status is iga.Status.PENETRATION


@pytest.mark.slow
def test_through_the_command_line(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'scene = "liquid_sheet"\n[[particle]]\nradius = 2.0\ncenter = [0.0, 0.0, -2.0]\n'
        'contact_angle = 145.0\n[sheet]\nboundary = "circle"\nsize = 10.0\n'
        "[discretization]\nelements = 12\n"
        '[solver]\nmotion = "cartesian"\nstabilization = 0.5\ncontact = "penalty"\n'
        'penalty = 2e4\ncontact_line = "line_load"\n'
    )
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 0
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    exact = iga.solve(sheet(145.0)).measures
    assert result["measures"]["phi_deg"] == pytest.approx(exact["phi_deg"], rel=1e-3)
    assert result["measures"]["F_CL"] == pytest.approx(2.0 * exact["F_CL"], rel=5e-3)
    assert result["scene"]["solver"]["stabilization"] == 0.5
    assert result["load_steps"] > 20
    assert 0 < result["contact"]["max_penetration"] < 1e-3


@pytest.mark.parametrize(
    ("solver", "said"),
    [
        ({"motion": "cartesian"}, "not available yet"),
        ({"contact_line": "adhesion"}, "must be one of"),
        ({"contact_line": "line_load", "motion": "spines"}, "leave them out"),
        ({"contact_line": "line_load", "contact": "exact"}, "leave them out"),
        ({"contact_line": "line_load", "stabilization": 0.0}, "solver.stabilization"),
        ({"contact_line": "line_load", "penalty": -1.0}, "solver.penalty"),
    ],
)
def test_what_does_not_go_together_is_refused(solver, said):
    particle = {"radius": 1.0, "center": [0, 0, -1.0], "contact_angle": 90.0}
    table = {"size": 5.0, "boundary": "circle"}
    with pytest.raises(iga.SceneError, match=said):
        iga.read_scene(
            {"scene": "liquid_sheet", "sheet": table, "particle": [particle], "solver": solver}
        )


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"start": iga.cap(1.0, 60.0)}, "not available yet"),
        ({"boundary": "circle", "particle": iga.Sphere(180.0, 1.0, (0, 0, -1.0))}, "below|< 180"),
        ({"particle": iga.Sphere(90.0, 1.0, (0.2, 0, -1.0))}, "off the axis"),
        ({"discretization": iga.Discretization(space="lagrange", degree=2)}, "lagrange"),
        ({"discretization": iga.Discretization(model="half")}, "half"),
        ({"discretization": iga.Discretization(elements=4)}, ">= 6"),
    ],
)
def test_sheets_that_are_not_built_are_refused(change, said):
    asked = {
        "particle": iga.Sphere(90.0, 1.0, (0, 0, -1.0)), "size": 5.0, "boundary": "circle",
        "membrane": iga.WholeMembrane(),
    } | change  # fmt: skip
    with pytest.raises(iga.SceneError, match=said):
        iga.liquid_sheet(asked.pop("particle"), **asked)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"substrate": iga.Sphere(90.0, 1.0, (0, 0, -1.0))}, "not available yet"),
        ({"penalty": 1e4}, "a penalty of its own"),
        ({"substrate": iga.Plane(180.0)}, "steps of the weight"),
        ({"substrate": iga.SphereLattice(150.0, 0.1, 0.4)}, "below 180 degrees"),
        ({"gravity": [0.3, 0.0, -1.0]}, "quarter"),
    ],
)
def test_droplets_that_are_not_built_are_refused(change, said):
    asked = {"substrate": iga.Plane(90.0), "volume": 1.0, "membrane": iga.WholeMembrane()} | change
    with pytest.raises(iga.SceneError, match=said):
        iga.sessile_droplet(asked.pop("substrate"), **asked)
