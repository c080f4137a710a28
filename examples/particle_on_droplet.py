"""A particle at the surface of a droplet: how hard it is pulled, and whereto.

The droplet of Bond number 0.5 rests on a plane that it wets at 150 degrees. A fixed sphere of
radius R / 5 and 90 degrees has its centre on the surface of the undisturbed droplet, at polar
angles from the top downwards, seen from half the droplet's height. A uniform
horizontal body force holds the droplet against the particle's pull.

The force of liquid and membrane on the particle is split along the undisturbed surface's normal,
outwards, and its tangent, downwards. The normal part is the larger one; the tangential one points
upwards and nearly vanishes without gravity.

``python examples/particle_on_droplet.py`` prints the forces and writes ``particle_on_droplet.png``
and ``particle_forces.png``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0
BOND = 0.5
PLANE = iga.Plane(contact_angle=150.0)
POLAR = tuple(np.arange(30.0, 111.0, 10.0).tolist())


class Undisturbed:
    """The droplet without particles, and places on its surface in the plane y = 0."""

    def __init__(self) -> None:
        alone = iga.solve(iga.sessile_droplet(PLANE, volume=VOLUME, gravity=BOND))
        k = alone.surface.grid(3, 2001, 1)
        self.place = self._in_plane(k.position[0])
        self.normal = self._in_plane(k.normal[0])
        height = self.place[:, 2] - 0.5 * alone.measures["height"]
        self.polar = np.degrees(np.arctan2(self.place[:, 0], height))

    @staticmethod
    def _in_plane(vectors: np.ndarray) -> np.ndarray:
        radial = np.hypot(vectors[:, 0], vectors[:, 1])
        return np.stack([radial, np.zeros(len(vectors)), vectors[:, 2]], axis=1)

    def at(self, polar: float) -> tuple[np.ndarray, np.ndarray]:
        """Point and outward normal at a polar angle in degrees."""
        nearest = int(np.abs(self.polar - polar).argmin())
        return self.place[nearest], self.normal[nearest]


def scene(
    place: np.ndarray, angle: float = 90.0, radius: float = 0.2, elements: int | None = None
) -> iga.Scene:
    """The droplet with one particle whose centre is at a place in the plane y = 0."""
    x, y, z = (float(c) for c in place)
    particle = iga.Sphere(contact_angle=angle, radius=radius, center=(x, y, z))
    return iga.sessile_droplet(
        PLANE,
        volume=VOLUME,
        gravity=BOND,
        hold="x",
        particles=[particle],
        discretization=iga.Discretization(elements=elements),
    )


def sweep(polar: Sequence[float] = POLAR, elements: int | None = None) -> list[iga.Solution]:
    """Solutions by the particle's polar angle."""
    droplet = Undisturbed()
    return [iga.solve(scene(droplet.at(a)[0], elements=elements)) for a in polar]


def numbers(
    solutions: Sequence[iga.Solution], polar: Sequence[float] = POLAR
) -> list[dict[str, float]]:
    """Force of liquid and membrane on the particle, its parts, and what holds the droplet."""
    droplet, rows = Undisturbed(), []
    for angle, solution in zip(polar, solutions, strict=True):
        _, normal = droplet.at(angle)
        force = solution.forces[0].effective  # the particle weighs nothing
        rows.append(
            {
                "polar": angle,
                "F_x": float(force[0]),
                "F_z": float(force[2]),
                "normal": float(force @ normal),
                "tangential": float(force @ [normal[2], 0.0, -normal[0]]),
                "hold": solution.hold_force[0],
            }
        )
    return rows


def main(polar: Sequence[float] = POLAR, elements: int | None = None) -> list[dict[str, float]]:
    """Forces by polar angle."""
    return numbers(sweep(polar, elements), polar)


def draw(rows: Sequence[dict[str, float]], path: str) -> None:
    """Forces against the polar angle."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
    for name, style in (("F_x", "--"), ("F_z", ":"), ("normal", "-"), ("tangential", "-.")):
        axes.plot([r["polar"] for r in rows], [r[name] for r in rows], style, label=name)
    axes.axhline(0.0, color="black", linewidth=0.5)
    axes.set_xlabel("polar angle of the particle, degrees")
    axes.set_ylabel(r"force on the particle, $\gamma R$")
    axes.legend()
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    solutions = sweep()
    rows = numbers(solutions)
    print("".join(f"{name:>12}" for name in rows[0]))
    for row in rows:
        print("".join(f"{value:12.6f}" for value in row.values()))
    draw(rows, "particle_forces.png")
    solutions[POLAR.index(80.0)].plot("particle_on_droplet.png", color="pressure", resolution=401)
