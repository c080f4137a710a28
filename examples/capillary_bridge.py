"""A liquid bridge from its making to its rupture: force over distance.

Two equal spheres, a sphere over a plate and two plates are drawn apart with the same drop of water
between them. The force is what one feels in a pendulum of liquid bridges: granulation, the feet of
insects, wet sand. Each curve ends where no bridge is stable any more, LIMIT_POINT; beyond that the
liquid ruptures, and the bracket tells the distance.

For equal spheres two closed forms are in use, both fits to numerical solutions: that of Willett,
Adams, Johnson and Seville (Langmuir 16, 9396, 2000) for the force, good to 4 % by its authors, and
that of Lian, Thornton and Adams for the rupture distance, ``(1 + theta / 2) V^(1/3)``, theta in
radians.

``python examples/capillary_bridge.py`` prints the curves with the fits beside them and writes
``bridge_spheres.png`` and, where matplotlib is installed, ``bridge_forces.png``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import iga_membrane as iga

VOLUME, ANGLE = 0.01, 30.0
"""Of the liquid, in cubes of the spheres' radius; of contact, in degrees."""
PART = np.linspace(0.02, 1.3, 20)
"""Gaps over Lian's rupture distance."""


def bridges(angle: float = ANGLE) -> dict[str, tuple[iga.Plane | iga.Sphere, ...]]:
    """Pairs of solids."""
    ball, plate = iga.Sphere(angle, 1.0), iga.Plane(angle)
    return {"spheres": (ball, ball), "sphere and plate": (plate, ball), "plates": (plate, plate)}


WILLETT = (
    ((-0.44507, 0.050832, -1.1466), (-0.1119, -0.000411, -0.1490),
     (-0.012101, -0.0036456, -0.01255), (-0.0005, -0.0003505, -0.00029076)),
    ((1.9222, -0.57473, -1.2918), (-0.0668, -0.1201, -0.22574),
     (-0.0013375, -0.0068988, -0.01137)),
    ((1.268, -0.01396, -0.23566), (0.198, 0.092, -0.06418), (0.02232, 0.02238, -0.009853),
     (0.0008585, 0.001318, -0.00053)),
    ((-0.010703, 0.073776, -0.34742), (0.03345, 0.04543, -0.09056),
     (0.0018574, 0.004456, -0.006257)),
)  # fmt: skip
"""Coefficients of f1 to f4 by powers of ln(V), each by powers of the angle in radians."""


def willett(gap: float, volume: float = VOLUME, angle: float = ANGLE) -> float:
    """Force between equal unit spheres, tension 1: ``2 pi exp(f1 - f2 exp(f3 s + f4 s^2))`` with
    ``s = ln(gap / 2 sqrt(V))``."""
    powers = np.radians(angle) ** np.arange(3.0)
    f1, f2, f3, f4 = (
        sum(np.log(volume) ** k * (powers @ row) for k, row in enumerate(rows)) for rows in WILLETT
    )
    s = np.log(0.5 * gap / np.sqrt(volume))
    return float(2.0 * np.pi * np.exp(f1 - f2 * np.exp(f3 * s + f4 * s * s)))


def lian(volume: float = VOLUME, angle: float = ANGLE) -> float:
    """Rupture distance of equal spheres."""
    return float((1.0 + 0.5 * np.radians(angle)) * volume ** (1.0 / 3.0))


@dataclass(frozen=True)
class Curve:
    """Force over distance, up to the rupture.

    Attributes
    ----------
    gaps, forces : of stable bridges; rupture : bracket of the largest gap, None if not reached.
    """

    gaps: np.ndarray
    forces: np.ndarray
    rupture: tuple[float, float] | None


def curve(
    pair: tuple[iga.Plane | iga.Sphere, ...],
    gaps: Sequence[float],
    volume: float = VOLUME,
) -> Curve:
    """A curve through some gaps as far as there are bridges."""
    path = iga.trace(
        lambda gap: iga.capillary_bridge(*pair, gap=gap, volume=volume),
        list(gaps),
        parameter="gap.distance",
        on_fail="return",
    )
    found = path.bracket
    rupture = None if found is None else (found.lo, found.hi)
    return Curve(np.array(path.values[: len(path.solutions)]), path.column("force"), rupture)


def main(part: Sequence[float] = PART, volume: float = VOLUME) -> dict[str, Curve]:
    """Curves of all pairs over gaps that are parts of Lian's distance."""
    gaps = [float(p) * lian(volume) for p in part]
    return {name: curve(pair, gaps, volume) for name, pair in bridges().items()}


def draw(curves: dict[str, Curve]) -> None:
    """Curves and fits."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    for colour, (name, one) in zip("krb", curves.items(), strict=True):
        axes.plot(one.gaps, one.forces, colour + ".-", label=name)
        if one.rupture:
            axes.axvline(one.rupture[0], color=colour, lw=0.6, ls=":")
    gaps = np.linspace(0.005, 0.95, 100) * lian()
    axes.plot(gaps, [willett(gap) for gap in gaps], "k--", lw=0.8, label="spheres, Willett's fit")
    axes.set(xlabel="gap / R", ylabel=r"force / ($\gamma R$)", yscale="log")
    axes.legend(frameon=False)
    figure.savefig("bridge_forces.png", dpi=150)


if __name__ == "__main__":
    found = main()
    for label, each in found.items():
        print(label)
        for distance, force in zip(each.gaps, each.forces, strict=True):
            fit = f"{willett(distance):10.4f}" if label == "spheres" else ""
            print(f"  {distance:8.4f}{force:10.4f}{fit}")
        if each.rupture:
            print(f"  ruptures between {each.rupture[0]:.5f} and {each.rupture[1]:.5f}")
    print(f"Lian's distance {lian():.5f}")
    shown = iga.capillary_bridge(*bridges()["spheres"], gap=0.05, volume=0.1)
    iga.solve(shown).plot("bridge_spheres.png")
    try:
        draw(found)
    except ImportError:
        print("bridge_forces.png needs matplotlib: pip install matplotlib")
