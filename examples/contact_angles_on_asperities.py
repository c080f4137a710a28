"""Contact angles at asperities: the paper's figure 7 beside its figures 5 and 6.

The droplet of Bond number 1 on spheres of radius R / 20 on a square lattice of four radii. At 180
degrees it lies on their tops. Below, the membrane meets every wet sphere in a contact line at
Young's angle, and hangs between them. The paper finds that the global shape hardly depends on the
angle. From 180 to 150 degrees the height falls by 0.4 %, to 120 degrees by 1.9 %, and the equator
does not move by more than 0.3 %, while the wet area grows to more than five times its size. What a
goniometer sees, the apparent angle, falls from 165 to 154 degrees.

``python examples/contact_angles_on_asperities.py`` prints the numbers and writes
``droplet_180.png``, ``droplet_150.png`` and, in close-up, ``foot_180.png``, ``foot_150.png`` and
``contact_lines.png``, with the wet asperities in red and the contact lines dark.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0
ANGLES = (180.0, 160.0, 150.0, 135.0, 120.0)


def droplet(angle: float, radius: float = 0.05, elements: int | None = None) -> iga.Solution:
    """The droplet of Bond number 1 on asperities with a contact angle."""
    asperities = iga.SphereLattice(contact_angle=angle, radius=radius, spacing=4.0 * radius)
    mesh = iga.Discretization(elements=elements)
    return iga.solve(
        iga.sessile_droplet(asperities, volume=VOLUME, gravity=1.0, hold="xy", discretization=mesh)
    )


def numbers(solution: iga.Solution) -> dict[str, float]:
    """Shape and foot of one droplet."""
    names = ("height", "equator_radius", "apparent_angle", "A_wet", "energy")
    asperities = solution.contact["asperities"]
    angles = [asperity["contact_angle"] for asperity in asperities]
    return {
        **{name: solution.measures[name] for name in names},
        "asperities": float(len(asperities)),
        "smallest_angle": min(angles),
        "largest_angle": max(angles),
        "carried": -sum(a["force_vector"][2] for a in asperities) / VOLUME,
    }


def main(
    angles: Sequence[float] = ANGLES, radius: float = 0.05, elements: int | None = None
) -> dict[float, dict[str, float]]:
    """Droplets at each contact angle in numbers."""
    return {angle: numbers(droplet(angle, radius, elements)) for angle in angles}


def pictures(angle: float) -> None:
    """Whole droplet and its foot."""
    solution = droplet(angle)
    solution.plot(f"droplet_{angle:g}.png", color="pressure")
    foot = {"color": "none", "resolution": 601}
    beside = {"view": (1.0, -2.2, 0.12), "zoom": 3.5, "focus": (0.0, -0.7, 0.05)}
    solution.plot(f"foot_{angle:g}.png", **foot, **beside)
    if angle < 180.0:
        below = {"view": (0.5, -1.0, -0.12), "zoom": 20.0, "focus": (0.4, -0.4, -0.02)}
        solution.plot("contact_lines.png", **foot, **below)


if __name__ == "__main__":
    print("angle   height  equator  apparent  asperities    A_wet    energy  angles on them")
    for angle, row in main().items():
        print(
            f"{angle:5g}{row['height']:9.5f}{row['equator_radius']:9.5f}"
            f"{row['apparent_angle']:10.2f}{row['asperities']:12.0f}{row['A_wet']:9.4f}"
            f"{row['energy']:10.5f}  {row['smallest_angle']:.2f} to {row['largest_angle']:.2f}"
        )
    for angle in (180.0, 150.0):
        pictures(angle)
