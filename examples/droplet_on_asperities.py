"""A droplet on a rough surface that repels it: the paper's figures 5 and 6.

The droplet of Bond number 1 rests on a plane, and on spheres of radius R / 20 on a square lattice
of four radii, at 180 degrees in both cases. On the spheres it touches only their tops: its wetted
area is a small part of that on the plane, and every wet asperity carries its share of the weight.
The liquid sags between them, so with tops level with the plane the droplet stands a little lower.

``python examples/droplet_on_asperities.py`` prints the numbers and writes
``droplet_on_plane_180.png``, ``droplet_on_asperities.png`` and ``foot_on_asperities.png``, a zoom
on the foot with the wet asperities in red.
"""

from __future__ import annotations

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0


def droplet(substrate: iga.Plane | iga.SphereLattice, elements: int | None = None) -> iga.Solution:
    """The droplet of Bond number 1 on a substrate."""
    mesh = iga.Discretization(elements=elements)
    return iga.solve(
        iga.sessile_droplet(substrate, volume=VOLUME, gravity=1.0, hold="xy", discretization=mesh)
    )


def pair(radius: float = 0.05, elements: int | None = None) -> tuple[iga.Solution, iga.Solution]:
    """The droplet on the plane, and on asperities of a radius."""
    lattice = iga.SphereLattice(contact_angle=180.0, radius=radius, spacing=4.0 * radius)
    return droplet(iga.Plane(contact_angle=180.0)), droplet(lattice, elements)


def numbers(flat: iga.Solution, rough: iga.Solution) -> dict[str, float]:
    """What the asperities change."""
    forces = [asperity["force"] for asperity in rough.contact["asperities"]]
    vertical = [asperity["force_vector"][2] for asperity in rough.contact["asperities"]]
    return {
        "height_flat": flat.measures["height"],
        "height_rough": rough.measures["height"],
        "wet_flat": flat.measures["A_wet"],
        "wet_rough": rough.measures["A_wet"],
        "asperities": float(len(forces)),
        "largest_force": max(forces),
        "smallest_force": min(forces),
        "carried": -sum(vertical) / VOLUME,
        "penetration": rough.contact["max_penetration"],
    }


def main(radius: float = 0.05, elements: int | None = None) -> dict[str, float]:
    """Both droplets in numbers."""
    return numbers(*pair(radius, elements))


if __name__ == "__main__":
    flat, rough = pair()
    for name, value in numbers(flat, rough).items():
        print(f"{name:16}{value:12.6f}")
    flat.plot("droplet_on_plane_180.png", color="pressure")
    rough.plot("droplet_on_asperities.png", color="pressure")
    rough.plot(
        "foot_on_asperities.png",
        color="none",
        view=(1.0, -2.2, 0.12),
        zoom=3.5,
        focus=(0.0, -0.7, 0.05),
        resolution=601,
    )
