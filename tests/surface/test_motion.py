import numpy as np
import pytest
from helpers import droplet, pinned_cap

import iga_membrane as iga
from iga_membrane.splines import Grading
from iga_membrane.surface.reparametrize import arc_length, distortion


def moved(scene, seed=0, size=0.05):
    surface = scene.local_surface()
    motion = iga.Spines(surface, tuple(scene.supports)).on(surface)
    step = size * np.random.default_rng(seed).standard_normal(motion.size)
    return surface.moved(surface.points + motion.displacement(step))


@pytest.mark.parametrize("space", ["bspline", "lagrange"])
@pytest.mark.parametrize("model", ["half", "quarter", "eighth"])
def test_sector_models_move_mirror_symmetrically(space, model):
    surface = moved(droplet(120, space=space, degree=3, elements=5, model=model))
    phi = np.linspace(0.1, 0.7, 5)
    t = np.linspace(0.0, 0.9, 4)

    def at(angle):
        xi = np.stack(np.meshgrid(np.mod(angle, 2 * np.pi), t, indexing="ij"), axis=-1)
        return surface.at(xi, 1).position

    base = at(phi)
    assert at(-phi) == pytest.approx(base * [1, -1, 1], abs=1e-12)
    if model != "half":
        assert at(np.pi - phi) == pytest.approx(base * [-1, 1, 1], abs=1e-12)
    if model == "eighth":
        assert at(np.pi / 2 - phi) == pytest.approx(base[..., [1, 0, 2]], abs=1e-12)


def test_contact_line_stays_in_the_plane_and_moves():
    scene = droplet(60, elements=5)
    before, after = scene.local_surface().net[:, 0], moved(scene).net[:, 0]
    assert (after[:, 2] == 0).all()
    assert np.abs(after - before).max() > 1e-3


def test_fixed_rim_does_not_move():
    scene = pinned_cap(1.0, [iga.SurfaceTension(1.0)])
    before, after = scene.local_surface().net, moved(scene).net
    assert (after[:, 0] == before[:, 0]).all()
    assert np.linalg.norm(after[:, 1] - before[:, 1], axis=1).min() > 0


def test_moved_pole_stays_smooth():
    surface = moved(droplet(120, elements=5, model="full"))
    spokes = surface.net[:, -2] - surface.net[0, -1]
    assert np.linalg.matrix_rank(spokes, tol=1e-10) == 2


def test_edges_in_a_symmetry_plane_stay_in_it():
    flat = iga.sheet(1.0, elements=4)
    quarter = flat.moved(flat.points + [0.5, 0.5, 0.0])
    scene = iga.Scene(quarter, [iga.SurfaceTension(1.0)], [iga.Symmetry("x"), iga.Symmetry("y")])
    bent = quarter.moved(quarter.points + np.outer(quarter.points[:, 0], [0, 0, 0.3]))
    motion = iga.Spines(scene.surface, tuple(scene.supports)).on(bent)
    on_plane = np.flatnonzero(quarter.points[:, 0] == 0)
    assert len(on_plane) == 7
    assert (motion.directions[on_plane, 0] == 0).all()
    assert np.abs(motion.directions[on_plane, 2]).min() > 0.9


def test_a_seam_stays_closed():
    seam = iga.refined(iga.cap(1.0, 80.0), [0.1, 0.6], [0.5])
    motion = iga.Spines(seam, (iga.Joint(("xi1=0", "xi1=1")),)).on(seam)
    step = np.random.default_rng(0).standard_normal(motion.size)
    net = seam.moved(seam.points + motion.displacement(step)).net
    assert net[0] == pytest.approx(net[-1], abs=1e-14)
    assert motion.size == seam.space.count - net.shape[1]


def test_arc_length_walk_keeps_the_shape_to_the_order_of_the_space():
    errors = []
    for elements in (8, 16, 32):
        surface = moved(droplet(120, degree=3, elements=elements), size=0.0)
        graded = arc_length(surface, Grading(0.5))
        k = graded.grid(16, 33, 1)
        radius = np.linalg.norm(k.position - [0, 0, -np.cos(np.radians(120)) * 1.058267], axis=-1)
        errors.append(np.abs(radius - 1.0582673679787995).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert rates.min() > 3.5
    assert errors[-1] < 1e-6
    assert distortion(graded, Grading(0.5)) < 1e-4


def test_a_surface_without_normal_is_named():
    scene = droplet(90, elements=5)
    surface = scene.local_surface()
    with pytest.raises(iga.GeometryError, match="no normal at control point"):
        iga.Spines(surface).on(surface.moved(np.zeros_like(surface.points)))
