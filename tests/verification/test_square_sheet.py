"""Sheets with a square rim on a particle: convergence, symmetry, forces as derivatives of the
energy."""

from itertools import product

import numpy as np
import pytest
from helpers import particle_sheet, slopes, some

import iga_membrane as iga


def solved(angle, **options):
    return iga.solve(particle_sheet(angle, boundary="square", **options))


@pytest.fixture(scope="module")
def fine():
    """Energy and line force on a mesh fine enough to be called exact, by contact angle."""
    found = {}

    def at(angle):
        if angle not in found:
            found[angle] = solved(angle, elements=12).measures
        return found[angle]

    return at


@pytest.mark.parametrize("angle", some((30, 60, 120, 150), {0, 2}))
def test_four_elements_are_enough(angle, fine):
    coarse, exact = solved(angle, elements=4).measures, fine(angle)
    assert coarse["energy"] == pytest.approx(exact["energy"], rel=1e-8)
    line = exact["F_CL"]
    assert abs(coarse["F_CL"] - line) <= 1e-6 * max(abs(line), 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("angle", [5, 30, 60, 90, 120, 150, 175])
def test_the_finest_mesh_changes_nothing(angle, fine):
    finest = solved(angle, elements=24).measures
    for name in ("energy", "F_CL"):
        assert fine(angle)[name] == pytest.approx(finest[name], rel=1e-8, abs=1e-8), name
    assert fine(angle)["phi_deg"] == pytest.approx(finest["phi_deg"], abs=2e-5)


@pytest.mark.parametrize(("degree", "allowed"), [(2, 1e-7), (3, 1e-9)])
@pytest.mark.parametrize("angle", some((60, 120), {1}))
def test_energy_converges_at_twice_the_degree(angle, degree, allowed, fine):
    errors = [
        solved(angle, degree=degree, elements=elements).measures["energy"] / fine(angle)["energy"]
        - 1.0
        for elements in (4, 8, 16)
    ]
    assert np.all(slopes(errors) >= 2 * degree - 0.3)
    assert abs(errors[-1]) <= allowed


def test_all_models_are_one_sheet():
    found = [
        solved(90, pressure=0.1, elements=4, model=model).measures
        for model in ("full", "half", "quarter", "eighth")
    ]
    for other in found[1:]:
        assert other == pytest.approx(found[0], rel=1e-10, abs=1e-11)


UNLOADED, PRESSED = {}, {"pressure": 0.1}
HEAVY = {"pressure": 0.1, "gravity": 0.3, "liquid_weight": True}


@pytest.mark.parametrize(
    ("boundary", "load", "axes"),
    [
        pytest.param("circle", UNLOADED, "xyz", marks=pytest.mark.slow),
        pytest.param("circle", PRESSED, "xyz", marks=pytest.mark.slow),
        pytest.param("circle", HEAVY, "xyz", marks=pytest.mark.slow),
        pytest.param("square", UNLOADED, "xyz", marks=pytest.mark.slow),
        pytest.param("square", PRESSED, "xyz", marks=pytest.mark.slow),
        pytest.param("square", HEAVY, "xyz", marks=pytest.mark.slow),
        ("square", HEAVY, "y"),
    ],
)
def test_force_off_the_middle_is_minus_the_slope_of_the_energy(boundary, load, axes):
    options = {"boundary": boundary, "elements": 6 if boundary == "circle" else 4, **load}

    def at(place):
        return iga.solve(particle_sheet(90, center=tuple(place), **options))

    place, step = np.array([0.3, 0.4, -1.0]), 3e-3
    forces = at(place).forces[0]
    found = forces.contact_line + forces.hydrostatic + forces.buoyancy
    energies = [
        [at(place + sign * axis).measures["energy"] for sign in (1, -1)]
        for axis in step * np.eye(3)[["xyz".index(axis) for axis in axes]]
    ]
    slope = np.diff(energies, axis=1).ravel() / (2.0 * step)
    along = found[["xyz".index(axis) for axis in axes]]
    assert np.abs(along - slope).max() <= 3e-6 * np.linalg.norm(found)
    # on its wide side the sheet is less steep and pulls harder sideways: it centres the particle
    assert found[0] < 0
    assert found[1] < 0
    assert found[1] < found[0]


@pytest.mark.parametrize(
    ("boundary", "weighs"), some(product(("circle", "square"), (True, False)), {2})
)
def test_forces_off_the_middle_split_into_line_and_pressure(boundary, weighs):
    """F_CL by tractions along the line; the rest by quadrature of the pressure over the cap."""
    center, gravity = np.array([0.5, 0.7, -1.0]), 0.3
    scene = particle_sheet(
        90, boundary=boundary, center=tuple(center), gravity=gravity, liquid_weight=weighs,
        pressure=0.1,
    )  # fmt: skip
    solution = iga.solve(scene)
    forces = solution.forces[0]
    line = iga.contact_line(solution.surface, solid=scene.substrate)
    # tangents converge slower than energies
    assert forces.contact_line == pytest.approx(-line.arc @ line.conormal, rel=1e-3)
    away = line.position - center
    turn = line.arc * (away[:, 0] * line.tangent[:, 1] - away[:, 1] * line.tangent[:, 0])
    turn /= away[:, 0] ** 2 + away[:, 1] ** 2
    azimuth = np.arctan2(away[:, 1], away[:, 0])[:, None]
    end = np.arccos(away[:, 2] / np.linalg.norm(away, axis=1))[:, None]
    u, w = np.polynomial.legendre.leggauss(12)
    polar = 0.5 * (u + 1.0) * end
    normal = np.stack(
        [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], axis=-1
    )
    pressure = 0.1 - gravity * (center[2] + normal[..., 2])
    weights = 0.5 * w * end * np.sin(polar) * turn[:, None]
    pushed = -np.einsum("kq,kqi->i", weights * pressure, normal)
    assert forces.hydrostatic + forces.buoyancy == pytest.approx(pushed, rel=1e-5, abs=1e-6)
    # Archimedes' volume over the cone: 1/3 of the flux of the position from the line's centroid
    apex = line.arc @ line.position / line.arc.sum()
    volume = np.einsum("kq,kqi,kqi->", weights, center + normal - apex, normal) / 3.0
    assert forces.buoyancy == pytest.approx([0.0, 0.0, gravity * volume], rel=1e-5)


def test_a_particle_in_the_middle_is_pulled_straight_up():
    forces = solved(90, elements=4, model="full").forces[0]
    assert np.abs(forces.effective[:2]).max() <= 1e-12
    assert forces.effective[2] > 1.0


def test_a_square_sheet_pulls_less_steeply_than_a_circular_one_inside_it():
    square = solved(90).measures["F_CL"]
    inscribed = iga.solve(particle_sheet(90, boundary="circle")).measures["F_CL"]
    around = iga.solve(particle_sheet(90, boundary="circle", size=5.0 * np.sqrt(2.0)))
    assert around.measures["F_CL"] < square < inscribed


@pytest.mark.parametrize("place", [(0.3, 0.0), (0.0, 0.3), (0.3, 0.4)])
def test_the_model_follows_the_place_of_the_particle(place):
    smallest = "half" if place[1] == 0.0 else "full"
    center = (*place, -1.0)
    assert particle_sheet(90, boundary="square", center=center).sector.model == smallest
    with pytest.raises(iga.SceneError, match="no such mirror planes"):
        particle_sheet(90, boundary="square", center=center, model="eighth")
