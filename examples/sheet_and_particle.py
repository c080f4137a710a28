"""A liquid sheet on a spherical particle: the paper's figures 8 to 11 with a circular rim.

A sheet of diameter 5 r_p, pinned at z = 0, touches a particle of radius r_p whose top just reaches
the undeformed sheet. The liquid lies above. Young's angle on the particle decides whether the
contact line pulls it up (wetting) or pushes it down (not wetting). The effective force, paper
eq. (39), adds weight, pressure and buoyancy for a particle as dense as the liquid. Where it changes
sign the particle is lifted: the critical point of figure 11.

The consistent forces and the paper's (F_B downwards) stand side by side. Run
``python examples/sheet_and_particle.py`` to print the table and write ``sheet_90.png``.
"""

from __future__ import annotations

from collections.abc import Sequence

import iga_membrane as iga

ANGLES = (150.0, 120.0, 90.0, 60.0, 30.0)


def scene(angle: float, bond: float) -> iga.Scene:
    """The sheet on a particle of this contact angle; ``bond = rho g r_p^2 / gamma``."""
    particle = iga.Sphere(contact_angle=angle, radius=1.0, center=(0, 0, -1), density=1.0)
    return iga.liquid_sheet(particle, size=5.0, gravity=bond)


def main(angles: Sequence[float] = ANGLES, bond: float = 0.1) -> list[dict[str, float]]:
    """Contact angle position and forces at each contact angle."""
    rows = []
    for angle in angles:
        solution = iga.solve(scene(angle, bond))
        forces = solution.forces
        rows.append(
            {
                "angle": angle,
                "phi": solution.measures["phi_deg"],
                "line": forces.line,
                "weight": forces.weight,
                "liquid": forces.hydrostatic + forces.buoyancy,
                "effective": forces.effective,
                "paper": forces.paper["F_e_down"],
                "lifts": forces.lifts,
            }
        )
    return rows


if __name__ == "__main__":
    print(" angle      phi      F_CL       F_G   F_H+F_B       F_e  paper F_e")
    for r in main():
        print(
            f"{r['angle']:6.1f}{r['phi']:9.4f}{r['line']:10.5f}{r['weight']:10.5f}{r['liquid']:10.5f}"
            f"{r['effective']:10.5f}{r['paper']:11.5f}  {'lifts' if r['lifts'] else 'stays'}"
        )
    iga.solve(scene(90.0, 0.1)).plot("sheet_90.png", color="none")
