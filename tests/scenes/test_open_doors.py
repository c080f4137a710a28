"""What users bring along is checked before anything is computed."""

import numpy as np
import pytest
from helpers import example

import iga_membrane as iga
from iga_membrane.terms import Scale

Pillars = example("pillars").Pillars


def test_an_own_solid_is_a_solid():
    assert isinstance(Pillars(0.1, 0.05, 0.4), iga.Solid)
    assert isinstance(example("own_substrate").Ridges(), iga.Solid)
    for solid in (
        iga.Plane(90),
        iga.Sphere(90, 1.0),
        iga.SphereLattice(90, 0.1, 0.4),
        iga.Spheres(90, [[0, 0, 0]], 1.0),
    ):
        assert isinstance(solid, iga.Solid)
    assert not isinstance(object(), iga.Solid)


def test_an_own_solid_keeps_its_place_in_local_units():
    solid, scale = Pillars(0.1, 0.05, 0.4), Scale(2.0, 1.0, (0.1, 0.2, 0.3))
    x = np.random.default_rng(0).uniform(-0.3, 0.3, (50, 3))
    here, there = solid.nearest(scale.to_world(x)), scale.local_solid(solid).nearest(x)
    assert there.gap * 2.0 == pytest.approx(here.gap, rel=1e-12)
    assert there.hessian() / 2.0 == pytest.approx(here.hessian(), rel=1e-12)


def test_an_own_solid_has_no_edge_of_the_membrane_and_no_contact_line_at_180_degrees():
    with pytest.raises(iga.SceneError, match='contact_line = "conforming"'):
        iga.sessile_droplet(
            Pillars(0.1, 0.05, 0.4, contact_angle=150.0), volume=1.0, contact_line="conforming"
        )
    with pytest.raises(iga.SceneError, match='contact_line = "trimmed"'):
        iga.sessile_droplet(Pillars(0.1, 0.05, 0.4), volume=1.0, contact_line="trimmed")


def test_a_goniometer_does_not_know_an_own_solid():
    scene = iga.sessile_droplet(Pillars(0.15, 0.15, 0.6), volume=4.19, gravity=1.0)
    drop = iga.solve(scene)
    assert "apparent_angle" not in drop.measures
    assert "wetted_fraction" not in drop.dimensionless
    with pytest.raises(iga.SceneError, match="what a goniometer sees on Pillars is not known"):
        iga.plot_side(drop, "side.png")


def uniform(elements, degree):
    return iga.bspline_basis(iga.open_knots(np.linspace(0.0, 1.0, elements + 1), degree), degree)


@pytest.mark.parametrize(
    ("space", "message"),
    [
        (lambda elements, degree: None, "must return a Basis, got NoneType"),
        (lambda elements, degree: iga.periodic_basis(elements, degree), "a meridian from 0 to 1"),
        (
            lambda elements, degree: iga.bspline_basis(iga.open_knots([0.0, 2.0], degree), degree),
            "reach from 0 to 2",
        ),
    ],
)
def test_a_space_that_is_none_is_refused(space, message):
    mesh = iga.Discretization(space=space, degree=3, elements=8)
    with pytest.raises(iga.SceneError, match=message):
        iga.sessile_droplet(iga.Plane(120), volume=1.0, discretization=mesh)


def test_scenes_that_need_their_own_space_refuse_others():
    mesh = iga.Discretization(space=uniform, degree=3, elements=8)
    with pytest.raises(iga.SceneError, match='"uniform": not available yet in a cell'):
        iga.asperity_cell(iga.Sphere(180, 0.05), size=0.2, pressure=2.0, discretization=mesh)
    with pytest.raises(iga.SceneError, match='"uniform": a membrane over its whole foot'):
        iga.sessile_droplet(iga.SphereLattice(180, 0.1, 0.4), volume=4.0, discretization=mesh)


def test_the_same_space_by_an_own_function_gives_the_same_droplet():
    def height(space):
        mesh = iga.Discretization(space=space, degree=3, elements=6)
        scene = iga.sessile_droplet(iga.Plane(120), volume=1.0, gravity=1.0, discretization=mesh)
        return iga.solve(scene).measures["height"]

    assert height(uniform) == height("bspline")
