"""A droplet on a flat surface: the paper's figure 5, at every contact angle.

The droplet of radius R = 1 (gamma = 1, rho g R^2 / gamma = 1) rests on a smooth plane. Its membrane
obeys Young-Laplace, 2 H gamma + p = 0 (eq. 20), with the volume as constraint and Young's angle
(eq. 30) as natural boundary condition. For each angle the example prints the height, the contact
radius and the pressure beside those of an axisymmetric shooting method that shares no code with
the solver.

Run ``python examples/droplet_on_plane.py`` to print the table and write ``droplet_on_plane.png``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane

ANGLES = (30.0, 60.0, 90.0, 120.0, 150.0, 170.0, 179.0)


def main(angles: Sequence[float] = ANGLES, bond: float = 1.0) -> list[dict[str, float]]:
    """Solve the drop at each contact angle; returns measures and their errors."""
    rows = []
    for angle in angles:
        scene = iga.sessile_droplet(
            iga.Plane(contact_angle=angle), volume=4.0 * np.pi / 3.0, gravity=bond
        )
        solution = iga.solve(scene)
        exact = drop_on_plane(bond, angle)
        names = ("height", "contact_radius", "p_base", "energy")
        row = {name: solution.measures[name] for name in names}
        row["angle"] = angle
        row["error"] = max(abs(row[name] / exact[name] - 1.0) for name in names)
        row["iterations"] = solution.newton_iterations
        row["cpu_seconds"] = solution.cpu_seconds["solve"]
        rows.append(row)
    return rows


def picture(path: str, angle: float = 150.0, bond: float = 1.0) -> None:
    """Draw the drop of figure 5, coloured by mean curvature."""
    scene = iga.sessile_droplet(
        iga.Plane(contact_angle=angle), volume=4.0 * np.pi / 3.0, gravity=bond
    )
    iga.solve(scene).plot(path)


if __name__ == "__main__":
    print(" angle    height  contact radius    p_base      energy   rel. error  its  CPU s")
    for r in main():
        print(
            f"{r['angle']:6.1f}{r['height']:10.6f}{r['contact_radius']:16.6f}{r['p_base']:10.6f}"
            f"{r['energy']:12.6f}{r['error']:13.1e}{r['iterations']:5.0f}{r['cpu_seconds']:7.3f}"
        )
    picture("droplet_on_plane.png")
