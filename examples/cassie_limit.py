"""How much pressure an asperity carries: the limit of the Cassie state against contact angle.

Liquid rests on spheres of a square lattice, gas below. In a cell of area A round one sphere the
contact line carries the pressure, p (A - pi a^2) = 2 pi a gamma sin(phi + theta - pi), with its
radius a = r sin(phi). The line sinks with the pressure until it can pull up no more:

    p_max = max over phi of 2 pi r sin(phi) gamma sin(phi + theta - pi) / (A - pi r^2 sin^2(phi)).

This is exact for a round cell. The example follows round and square cells by ``iga.trace`` until
they are lost, LIMIT_POINT, and compares the bracket of the last pressure with it. In a square cell
the line is not level, and yet a level line in a cell of the same area gives its limit to the width
of the bracket. All limits lie beyond the equator of the sphere.

``python examples/cassie_limit.py`` prints the table and, where matplotlib is installed, draws
``cassie_limit.png``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize_scalar

import iga_membrane as iga

RADIUS, SPACING = 0.05, 0.2
ANGLES = (165.0, 150.0, 135.0, 120.0, 105.0, 90.0)
PER_RADIUS = 8


def level_line(angle: float, area: float) -> float:
    """Largest pressure that a level contact line carries in a cell of some area (tension 1)."""
    hang = np.pi - np.radians(angle)

    def carried(phi: float) -> float:
        a = RADIUS * np.sin(phi)
        return float(2.0 * np.pi * a * np.sin(phi - hang) / (area - np.pi * a**2))

    found = minimize_scalar(
        lambda phi: -carried(phi), bounds=(hang, hang + 0.5 * np.pi), method="bounded"
    )
    return carried(found.x)


def area(shape: str) -> float:
    """Of a cell whose diameter or side is the spacing."""
    return SPACING**2 * (1.0 if shape == "square" else 0.25 * np.pi)


def limit(angle: float, shape: str, per_radius: int = PER_RADIUS) -> iga.Path:
    """Follow a cell from half of what a level line carries to more than that."""
    across = SPACING / RADIUS * (1.0 if shape == "square" else 0.5)
    mesh = iga.Discretization(elements=round(per_radius * across))
    sphere = iga.Sphere(angle, RADIUS, (0.0, 0.0, -RADIUS))

    def cell(pressure: float) -> iga.Scene:
        return iga.asperity_cell(
            sphere, size=SPACING, pressure=pressure, shape=shape, discretization=mesh
        )

    most = level_line(angle, area(shape))
    return iga.trace(cell, [0.5 * most, 1.1 * most], parameter="cell.pressure", on_fail="return")


def main(
    angles: Sequence[float] = ANGLES,
    shapes: Sequence[str] = ("circle", "square"),
    per_radius: int = PER_RADIUS,
) -> list[dict[str, float | str]]:
    """Brackets of the largest pressure of each cell at each angle."""
    rows: list[dict[str, float | str]] = []
    for shape in shapes:
        for angle in angles:
            path = limit(angle, shape, per_radius)
            assert path.bracket is not None, path.end.message
            rows.append(
                {
                    "shape": shape,
                    "angle": angle,
                    "level_line": level_line(angle, area(shape)),
                    "low": path.bracket.lo,
                    "high": path.bracket.hi,
                    "polar": path.end.measures["phi_deg"],
                }
            )
    return rows


def draw(rows: Sequence[dict[str, float | str]]) -> None:
    """Largest pressures against contact angle."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axis = plt.subplots(figsize=(6, 4.2), layout="constrained")
    angles = np.linspace(90.0, 180.0, 91)
    for shape, colour in (("circle", "k"), ("square", "b")):
        curve = [level_line(angle, area(shape)) for angle in angles]
        axis.plot(angles, curve, colour + "-", label=f"{shape}, level line")
        some = [r for r in rows if r["shape"] == shape]
        axis.plot(
            [r["angle"] for r in some],
            [r["low"] for r in some],
            colour + "o",
            label=f"{shape}, found",
        )
    axis.set(
        xlabel="contact angle (degrees)",
        ylabel="largest pressure (gamma / R, r = R / 20)",
        ylim=(0, None),
    )
    axis.legend(frameon=False)
    figure.savefig("cassie_limit.png", dpi=150)


if __name__ == "__main__":
    found = main()
    print("cell     angle  level line  last with  first without  polar angle of the line")
    for r in found:
        print(
            f"{r['shape']:8}{r['angle']:6g}{r['level_line']:12.5f}{r['low']:11.5f}"
            f"{r['high']:15.5f}{r['polar']:14.2f}"
        )
    try:
        draw(found)
    except ImportError:
        print("cassie_limit.png needs matplotlib: pip install matplotlib")
