"""A membrane that passes through its sphere against one that ends on it: the same equilibria."""

import numpy as np
import pytest
from helpers import some

import iga_membrane as iga

SHEETS = {
    "circle, 150": (150.0, "circle", (0.0, 0.0, -1.0), {}),
    "circle, 30": (30.0, "circle", (0.0, 0.0, -1.0), {}),
    "circle, heavy liquid": (
        90.0, "circle", (0.0, 0.0, -1.0), {"gravity": 0.1, "liquid_weight": True},
    ),
    "circle, under pressure": (120.0, "circle", (0.0, 0.0, -0.8), {"pressure": 0.1}),
    "square, 120": (120.0, "square", (0.0, 0.0, -1.0), {}),
    "square, off the axis": (90.0, "square", (0.3, 0.2, -1.0), {}),
}  # fmt: skip


@pytest.mark.parametrize("name", some(SHEETS, {1, 2, 5}))
def test_a_sheet_on_a_particle(name):
    angle, boundary, center, more = SHEETS[name]
    particle = iga.Sphere(angle, 1.0, center, 1.0)
    one, other = (
        iga.solve(iga.liquid_sheet(particle, size=5.0, boundary=boundary, contact_line=way, **more))
        for way in ("conforming", "trimmed")
    )
    for key in ("energy", "A_LG", "A_wet", "V_liq", "contact_radius", "F_CL", "F_total", "V_cap"):
        assert other.measures[key] == pytest.approx(one.measures[key], abs=3e-6), key
    assert other.measures["phi_deg"] == pytest.approx(one.measures["phi_deg"], abs=1e-4)
    for part in ("contact_line", "hydrostatic", "buoyancy"):
        first, second = getattr(one.forces[0], part), getattr(other.forces[0], part)
        assert np.abs(first - second).max() < 3e-6, part


@pytest.mark.parametrize(
    ("angle", "bond", "radius"), some([(120.0, 1.0, 1.0), (90.0, 0.5, 1.0)], {0})
)
def test_a_drop_on_a_sphere(angle, bond, radius):
    sphere = iga.Sphere(angle, radius, (0.0, 0.0, -radius))
    one, other = (
        iga.solve(
            iga.sessile_droplet(
                sphere, volume=4.0 * np.pi / 3.0, gravity=bond, hold="xy", contact_line=way
            )
        )
        for way in ("conforming", "trimmed")
    )
    for key in ("energy", "pressure", "height", "contact_radius", "A_wet", "A_LG"):
        assert other.measures[key] == pytest.approx(one.measures[key], abs=1e-5), key
