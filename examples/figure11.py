"""Is the particle lifted? Effective force against contact angle: the paper's figure 11.

A weightless sheet of size 5 r_p, square or circular, on a particle as dense as the liquid. The
effective force of paper eq. (39) adds weight, line force, pressure and buoyancy; where it passes
zero the particle is just lifted. ``bond`` is the particle's Bond number rho g r_p^2 / gamma.

Three curves: the consistent forces (``F_e``), and the paper's with F_B up or down
(``F_e_up``, ``F_e_down``); the paper's sign of F_B decides whether heavy particles can be lifted.

The forces are linear in the Bond number, and so the largest one with lift-off follows from two
solves at each angle.

``python examples/figure11.py`` prints the critical angles and the largest Bond numbers and, where
matplotlib is installed, draws ``figure11.png``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import iga_membrane as iga

BONDS = (0.1, 0.3, 0.6, 1.0)
ANGLES = (5.0, 15.0, 27.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0, 150.0, 165.0, 175.0)
FORCES = ("F_e", "F_e_up", "F_e_down")


def scene(angle: float, bond: float, boundary: str = "circle") -> iga.Scene:
    """Sheet on a particle of this contact angle and Bond number."""
    particle = iga.Sphere(contact_angle=angle, radius=1.0, center=(0, 0, -1), density=1.0)
    return iga.liquid_sheet(particle, size=5.0, boundary=boundary, gravity=bond)


def effective(solution: iga.Solution, name: str = "F_e") -> float:
    """Effective force by one of the three readings."""
    forces = solution.forces[0]
    return float(forces.effective[2]) if name == "F_e" else forces.paper[name]


def critical_angle(bond: float, boundary: str = "circle", name: str = "F_e") -> float | None:
    """Contact angle at which the effective force vanishes, or None if it has one sign."""
    try:
        found = iga.critical_value(
            lambda angle: scene(angle, bond, boundary), lambda s: effective(s, name), 1.0, 175.0
        )
    except iga.SceneError:
        return None
    return found.value


def largest_bond(angle: float, boundary: str = "circle", name: str = "F_e") -> float:
    """Largest particle Bond number with lift-off at a contact angle."""
    without, with_weight = (
        effective(iga.solve(scene(angle, bond, boundary)), name) for bond in (0.0, 1.0)
    )
    return without / (without - with_weight)


def main(
    angles: Sequence[float] = ANGLES,
    bonds: Sequence[float] = BONDS,
    boundary: str = "circle",
) -> dict[float, dict[str, np.ndarray]]:
    """Curves of the effective force against contact angle for each Bond number."""
    curves = {}
    for bond in bonds:
        found = [iga.solve(scene(angle, bond, boundary)) for angle in angles]
        curves[bond] = {name: np.array([effective(s, name) for s in found]) for name in FORCES}
    return curves


def draw(boundaries: Sequence[str] = ("circle", "square")) -> None:
    """Curves and critical points of both sheets."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), sharey=True, layout="constrained")
    for axis, boundary in zip(axes, boundaries, strict=True):
        for colour, (bond, curve) in zip("krbg", main(boundary=boundary).items(), strict=True):
            for name, style in zip(FORCES, ("-", ":", "--"), strict=True):
                label = f"Bond number {bond:g}" if name == "F_e" else None
                axis.plot(ANGLES, curve[name], colour + style, label=label)
            angle = critical_angle(bond, boundary)
            if angle is not None:
                axis.plot(angle, 0.0, colour + "o")
        axis.axhline(0.0, color="0.7", lw=0.8)
        axis.set(title=f"{boundary} sheet", xlabel="contact angle (degrees)", ylim=(-4, 6))
    axes[0].set_ylabel("effective force / (gamma r_p)")
    axes[0].legend(title="consistent -   paper, F_B up ···   down - -", frameon=False)
    figure.savefig("figure11.png", dpi=150)


if __name__ == "__main__":
    print("critical contact angles (degrees)")
    for rim in ("circle", "square"):
        for bp in BONDS:
            print(f"{rim:8}{bp:6.1f}", {name: critical_angle(bp, rim, name) for name in FORCES})
    print("largest Bond number with lift-off")
    for theta in (0.5, 5.0, 15.0, 27.0):
        print(f"{theta:6.1f}", {name: round(largest_bond(theta, name=name), 4) for name in FORCES})
    try:
        draw()
    except ImportError:
        print("figure11.png needs matplotlib: pip install matplotlib")
