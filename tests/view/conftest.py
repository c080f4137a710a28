import pytest
from helpers import UNIT_VOLUME, droplet

import iga_membrane as iga


@pytest.fixture(scope="session")
def solution():
    """A drop on a plane."""
    return iga.solve(droplet(150, 1.0))


@pytest.fixture(scope="session")
def cell():
    """A membrane that passes through a sphere, with a contact line inside."""
    scene = iga.asperity_cell(
        iga.Sphere(120.0, 0.05, (0.0, 0.0, -0.05)),
        size=0.2,
        pressure=3.0,
        discretization=iga.Discretization(elements=16),
    )
    return iga.solve(scene)


@pytest.fixture(scope="session")
def sheet():
    """A sheet on a heavy particle off its middle."""
    particle = iga.Sphere(90.0, 1.0, (0.3, 0.0, -1.0), density=1.0)
    mesh = iga.Discretization(elements=8)
    return iga.solve(iga.liquid_sheet(particle, size=5.0, gravity=0.1, discretization=mesh))


@pytest.fixture(scope="session")
def rough():
    """A drop that lies on a few large asperities."""
    scene = iga.sessile_droplet(
        iga.SphereLattice(180.0, 0.2, 0.7, base=-0.3),
        volume=UNIT_VOLUME,
        gravity=1.0,
        discretization=iga.Discretization(elements=16),
        penetration_tolerance=0.1,
    )
    return iga.solve(scene, on_fail="return")
