"""Textures, measured maps and patterns of wettability: from a surface to the droplet on it.

A contact line lies anywhere on a smooth surface, under Young's angle at each of its points. The
script puts a droplet without weight on an egg carton, on a measured map (here made up: a surface
with waves of two lengths, sampled on a grid and written as ``map.npz``), and on a plane with
stripes of 60 and 120 degrees. It tells what a goniometer would see on average: the angle of the
spherical cap of the droplet's foot and volume, beside Wenzel's ``cos(theta*) = r cos(theta)``.

``python examples/textures.py`` prints the numbers and draws ``textures.png`` (the stripes).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0


def measured(path: str | Path = "map.npz") -> iga.HeightMap:
    """A map as an instrument writes it, and the surface through it."""
    x = np.linspace(-3.0, 3.0, 181)
    waves = 0.03 * np.cos(5.0 * x)[:, None] * np.cos(5.0 * x) + 0.01 * np.sin(9.0 * x + 1.0)
    np.savez(path, x=x, y=x, z=waves)
    with np.load(path) as found:
        return iga.HeightMap.from_grid(
            found["x"], found["y"], found["z"], contact_angle=105.0, scale=0.15
        )


def cap_angle(radius: float, volume: float) -> float:
    """Contact angle in degrees of the spherical cap of a foot and a volume."""

    def missing(angle: float) -> float:
        c, s = np.cos(angle), np.sin(angle)
        return float(np.pi * (2.0 + c) * (1.0 - c) ** 2 / (3.0 * s**3) - volume / radius**3)

    return float(np.degrees(brentq(missing, 1e-3, np.pi - 1e-3)))


def solved(solid: iga.Solid) -> iga.Solution:
    """The droplet on a surface, held where it stands."""
    return iga.solve(iga.sessile_droplet(solid, volume=VOLUME, hold="xy"))


def main(folder: str | Path = ".") -> dict[str, iga.Solution]:
    """Droplets by the names of their surfaces."""
    return {
        "egg carton": solved(iga.HeightMap.egg_carton(0.03, 0.5, contact_angle=105.0)),
        "measured map": solved(measured(Path(folder) / "map.npz")),
        "stripes": solved(iga.Plane(iga.stripes(60.0, 120.0, 0.6, 0.2))),
    }


if __name__ == "__main__":
    drops = main()
    for name, drop in drops.items():
        foot, volume = drop.measures["contact_radius"], drop.measures["volume"]
        rough = drop.measures["A_wet"] / (np.pi * foot**2)
        print(f"{name}: wetted area over foot {rough:.4f}, angle of the cap "
              f"{cap_angle(foot, volume):.2f} degrees")  # fmt: skip
        if name != "stripes":
            wenzel = np.degrees(np.arccos(rough * np.cos(np.radians(105.0))))
            print(f"  Wenzel's angle {wenzel:.2f} degrees")
        (line,) = iga.contact_lines(drop)
        high = np.ptp(line.line.position[:, 2])
        print(f"  contact line {line.line.arc.sum():.4f} long, {high:.4f} high")
    drops["stripes"].plot("textures.png", color="none")
