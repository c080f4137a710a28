"""Integrals over the wetted cap of a sphere, from its contact line alone."""

import numpy as np
import pytest

import iga_membrane as iga
from iga_membrane.results.contact_line import ContactLine
from iga_membrane.results.wetted_cap import WettedCap
from iga_membrane.terms import BodyDensity

SPHERE = iga.Sphere(90.0, 0.7, (0.3, -0.2, 0.5))
COUNT = 200


def wavy_cap(axis, polar, wave):
    """The cap inside ``polar + wave cos(3 phi)`` about an axis, and (k, 3) normals with weights all
    over it."""
    axis = np.array(axis) / np.linalg.norm(axis)
    one = np.cross(axis, [0.3, 0.8, -0.5])
    one /= np.linalg.norm(one)
    phi = 2.0 * np.pi * np.arange(COUNT) / COUNT
    edge, slope = polar + wave * np.cos(3.0 * phi), -3.0 * wave * np.sin(3.0 * phi)
    out = np.outer(np.cos(phi), one) + np.outer(np.sin(phi), np.cross(axis, one))
    round_ = np.outer(-np.sin(phi), one) + np.outer(np.cos(phi), np.cross(axis, one))
    sine, cosine = np.sin(edge)[:, None], np.cos(edge)[:, None]
    normal, r = sine * out + cosine * axis, SPHERE.radius
    velocity = r * (slope[:, None] * (cosine * out - sine * axis) + sine * round_)
    speed = np.linalg.norm(velocity, axis=1)
    tangent, arc = velocity / speed[:, None], speed * 2.0 * np.pi / COUNT
    position = np.array(SPHERE.center) + r * normal
    line = ContactLine(position, tangent, normal, edge, arc)
    u, w = np.polynomial.legendre.leggauss(20)
    angle = edge[:, None] * (0.5 + 0.5 * u)
    normals = np.sin(angle)[..., None] * out[:, None] + np.cos(angle)[..., None] * axis
    weights = r**2 * np.sin(angle) * edge[:, None] * 0.5 * w * 2.0 * np.pi / COUNT
    x, y, z = (float(a) for a in axis)
    return WettedCap(line, SPHERE, (x, y, z)), normals.reshape(-1, 3), weights.ravel()


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (-0.9, 0.1, 0.2), (0.1, 0.3, -1.0)])
@pytest.mark.parametrize(("polar", "wave"), [(0.4, 0.1), (1.6, 0.3), (2.6, 0.2)])
def test_integrals_are_those_over_the_sphere(axis, polar, wave):
    cap, normal, weights = wavy_cap(axis, polar, wave)
    center, r = np.array(SPHERE.center), SPHERE.radius
    x = center + r * normal
    assert cap.area == pytest.approx(weights.sum(), rel=1e-10)
    for body in (BodyDensity(1.3), BodyDensity(-0.4, (0.5, -0.7, 1.1))):
        value = body.constant + x @ np.array(body.gradient)
        np.testing.assert_allclose(cap.push(body), (value * weights) @ normal, atol=1e-10)
    over = ((x - cap.apex) * normal).sum(axis=1) @ weights / 3.0
    assert cap.volume_over_cone == pytest.approx(over, rel=1e-9)


def test_line_at_the_dry_end_of_its_axis_is_refused():
    term = iga.SphereContactLine(1.0, SPHERE, toward=(0.0, 0.0, -1.0))
    top = np.array(SPHERE.center) + [0.0, 0.0, SPHERE.radius]
    scene = iga.sessile_droplet(iga.Plane(90.0), volume=1.0)
    table = scene.surface.space.edge_table("xi2=0")
    points = np.tile(top, (scene.surface.space.count, 1))
    with pytest.raises(iga.GeometryError, match="dry end"):
        term.energy(table, points, 1.0, BodyDensity())
