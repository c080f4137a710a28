"""A droplet on a rough surface with three particles at its surface: the paper's figure 2 computed.

The droplet of Bond number 1 rests on spheres of radius R / 10 in a square lattice of spacing
0.3 R, which it meets at 150 degrees. Three particles of other sizes and contact angles are held at
its surface in the plane y = 0; each has its contact line, like each wet asperity. What asperities
and particles carry is the droplet's weight, and sideways it is nothing: the droplet itself is not
held.

``python examples/whole_system.py`` prints the forces and writes ``whole_system.png``.
"""

from __future__ import annotations

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0
ASPERITIES = iga.SphereLattice(contact_angle=150.0, radius=0.1, spacing=0.3, offset=(0.15, 0.15))
PARTICLES = (
    iga.Sphere(contact_angle=80.0, radius=0.25, center=(0.83, 0.0, 1.08)),
    iga.Sphere(contact_angle=90.0, radius=0.3, center=(-0.62, 0.0, 1.26)),
    iga.Sphere(contact_angle=100.0, radius=0.2, center=(0.1, 0.0, 1.42)),
)


def scene(elements: int | None = None) -> iga.Scene:
    """Droplet, asperities and particles."""
    return iga.sessile_droplet(
        ASPERITIES,
        volume=VOLUME,
        gravity=1.0,
        particles=PARTICLES,
        discretization=iga.Discretization(elements=elements),
    )


def numbers(solution: iga.Solution) -> dict[str, np.ndarray]:
    """Forces of the droplet on its solids, and what is left of their sum with its weight."""
    asperities = np.array([each["force_vector"] for each in solution.contact["asperities"]])
    particles = np.array([each.effective for each in solution.forces])  # they weigh nothing
    weight = np.array([0.0, 0.0, -VOLUME])
    return {
        "asperities": asperities.sum(axis=0),
        **{f"particle {k}": force for k, force in enumerate(particles)},
        "weight": weight,
        "missing": weight - asperities.sum(axis=0) - particles.sum(axis=0),
    }


def main(elements: int | None = None) -> dict[str, np.ndarray]:
    """The system's forces."""
    return numbers(iga.solve(scene(elements)))


if __name__ == "__main__":
    solution = iga.solve(scene())
    print(solution.status.name, f"{solution.unknowns} unknowns")
    for name, force in numbers(solution).items():
        print(f"{name:12}" + "".join(f"{component:12.6f}" for component in force))
    solution.plot("whole_system.png", color="pressure", view=(1.0, -2.2, 0.35), resolution=401)
