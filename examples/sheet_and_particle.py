"""A liquid sheet on a spherical particle: the paper's figures 8 to 10.

A square sheet of side 5 r_p, pinned at z = 0, touches a particle of radius r_p whose top just
reaches the undeformed sheet. The liquid lies above. Young's angle on the particle decides how far
the sheet comes down its sides: at 150 degrees the particle hardly dents it, at 30 degrees the
contact line has passed the particle's equator. The sheet pulls along the line with the tractions of
paper eq. (32); their vertical sum is F_CL.

``python examples/sheet_and_particle.py`` prints the table and writes ``sheet_150.png``,
``sheet_120.png``, ``sheet_90.png`` and ``sheet_30.png`` with the tractions as arrows.
"""

from __future__ import annotations

from collections.abc import Sequence

import iga_membrane as iga

ANGLES = (150.0, 120.0, 90.0, 30.0)


def sheet_on_particle(angle: float, boundary: str = "square") -> iga.Solution:
    """The sheet on a particle of this contact angle."""
    particle = iga.Sphere(contact_angle=angle, radius=1.0, center=(0, 0, -1), density=1.0)
    return iga.solve(iga.liquid_sheet(particle, size=5.0, boundary=boundary))


def main(angles: Sequence[float] = ANGLES) -> list[iga.Solution]:
    """Solutions at each contact angle."""
    return [sheet_on_particle(angle) for angle in angles]


if __name__ == "__main__":
    print(" angle      phi      psi       F_CL   contact radius")
    for angle, solution in zip(ANGLES, main(), strict=True):
        m = solution.measures
        print(
            f"{angle:6.1f}{m['phi_deg']:9.4f}{m['psi_deg']:9.4f}{m['F_CL']:11.6f}"
            f"{m['contact_radius']:12.6f}"
        )
        solution.plot(f"sheet_{angle:.0f}.png", color="none", traction=True, view=(1, -2, 1.2))
