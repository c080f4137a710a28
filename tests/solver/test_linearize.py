"""Stiffness, residual and constraints of solutions, against energies that are integrated here."""

import numpy as np
import pytest
from scipy.linalg import eigh, null_space
from scipy.sparse import issparse

import iga_membrane as iga

MESH = {"elements": 4, "degree": 3}


def integrals(surface):
    """Area, and flux of z e_z through a surface, by the Gauss points of the solve."""
    table = surface.space.table((3, 4))
    at = surface.on(table)
    normal = np.cross(at.tangents[..., 0, :], at.tangents[..., 1, :])
    area = (table.weights * np.linalg.norm(normal, axis=-1)).sum()
    return area, (table.weights * at.position[..., 2] * normal[..., 2]).sum()


def moved(solution, shift):
    surface = solution.surface
    return surface.moved(surface.points + shift.reshape(-1, 3))


@pytest.fixture(scope="module")
def film():
    """A bridge of a prescribed volume between rings off z = 0, in units far from one."""
    liquid = iga.Liquid(0.07, 0.0)
    mesh = iga.Discretization(model="full", **MESH)
    return iga.solve(
        iga.film_between_rings(
            radius=2.0, half_height=0.8, volume=22.0, liquid=liquid, discretization=mesh
        )
    )


def test_the_model_of_a_film_is_its_energy(film):
    """Taylor: the error of the second-order model falls as the cube of the step."""
    K, r, B = found = iga.linearize(film)
    assert issparse(K)
    assert issparse(B)
    assert found.names[0] == "volume"
    assert found.multipliers[0] == pytest.approx(film.measures["pressure"], rel=1e-9)
    assert abs(K - K.T).max() < 1e-9 * abs(K).max()
    assert np.abs(r).max() < 1e-7 * 0.07
    ways = np.random.default_rng(0).uniform(-1.0, 1.0, (6, len(r)))
    area, volume = integrals(film.surface)
    second, first = [], []
    for step in (2e-2, 1e-2, 5e-3):
        off = []
        for s in step * ways:
            area_s, volume_s = integrals(moved(film, found.T @ s))
            pushed = volume_s - volume
            energy = 0.07 * (area_s - area) - found.multipliers[0] * pushed
            off.append((energy - r @ s - 0.5 * s @ (K @ s), pushed - (B.T @ s)[0]))
        bent, pushed = np.linalg.norm(off, axis=0)
        second.append(bent)
        first.append(pushed)
    assert np.all(np.array(second[:-1]) / np.array(second[1:]) > 6.5)
    assert np.all(np.array(first[:-1]) / np.array(first[1:]) > 3.5)


def test_a_model_of_less_speaks_for_the_whole(film):
    """In a quarter the same energy for motions with its symmetry."""
    mesh = iga.Discretization(model="quarter", **MESH)
    part = iga.solve(
        iga.film_between_rings(
            radius=2.0, half_height=0.8, volume=22.0, liquid=iga.Liquid(0.07, 0.0),
            discretization=mesh,
        )
    )  # fmt: skip
    small, whole = iga.linearize(part), iga.linearize(film)
    s = np.random.default_rng(1).uniform(-1.0, 1.0, len(small.r))
    # the same displacements by the unknowns of the whole
    t = np.linalg.lstsq(whole.T.toarray(), small.T @ s, rcond=None)[0]
    assert whole.T @ t == pytest.approx(small.T @ s, abs=1e-6)
    assert s @ (small.K @ s) == pytest.approx(t @ (whole.K @ t), rel=1e-5)
    assert (small.B.T @ s)[0] == pytest.approx((whole.B.T @ t)[0], rel=1e-6)


@pytest.mark.parametrize("gravity", [0.0, 5.0])
def test_a_newton_step_leaves_a_droplet_and_its_index_is_that_of_the_solve(gravity):
    """On the null space of the constraints K has as many negative eigenvalues as the solve says."""
    mesh = iga.Discretization(model="quarter", **MESH)
    drop = iga.solve(
        iga.sessile_droplet(
            iga.Plane(contact_angle=110), volume=2.0, gravity=gravity, discretization=mesh
        )
    )
    K, _, B = iga.linearize(drop)
    free = null_space(B.toarray().T)
    assert (eigh(free.T @ K.toarray() @ free, eigvals_only=True) < 0).sum() == drop.index == 0


def test_a_large_body_is_sparse():
    """With gravity along the plane the constraints are the volume and the centroid."""
    drop = iga.solve(
        iga.sessile_droplet(
            iga.Plane(contact_angle=80), volume=1.0, gravity=[0.5, 0.0, -1.0], hold="x",
            discretization=iga.Discretization(model="full", elements=10, degree=3),
        )
    )  # fmt: skip
    found = iga.linearize(drop)
    assert found.K.shape == (drop.unknowns, drop.unknowns)
    assert found.K.nnz < 0.25 * drop.unknowns**2
    assert {"volume", "centroid_x"} <= set(found.names)
    assert found.multipliers[found.names.index("centroid_x")] == pytest.approx(
        drop.multipliers["centroid_x"], rel=1e-6
    )
    assert len(repr(found)) < 500


def test_contact_areas_are_refused():
    drop = iga.solve(
        iga.sessile_droplet(iga.Plane(180.0), volume=1.0, gravity=1.0,
                            discretization=iga.Discretization(elements=8))
    )  # fmt: skip
    with pytest.raises(iga.SceneError, match="contact areas"):
        iga.linearize(drop)
