"""A droplet on a lotus leaf: thousands of asperities, each of them in the computation.

A droplet of Bond number 1 rests at 180 degrees on spheres with their tops in one plane, their
radius a quarter of their spacing. As the asperities shrink the droplet approaches the one on the
plane: it stands lower by most of the mean sag of the liquid between the tops, which for a wide
square lattice of spacing s under the pressure p is

    p s^2 / gamma ((log(s / a) - 1.3105) / 2 pi + 1 / 4 pi),    a^2 = p s^2 r / (2 pi gamma),

a being the radius of the wet spots. What touches shrinks, too: the wetted part of the foot is
proportional to the asperities' radius.

``python examples/lotus_leaf.py`` prints the numbers and writes ``lotus_leaf.png`` (height and
wetted part against the spacing) and ``lotus_foot.png``, the foot on 3,700 asperities.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0
SPACINGS = (0.2, 0.1, 0.05, 0.035, 0.02)
SHARE = 0.25
"""Radius over spacing."""


def droplet(substrate: iga.Plane | iga.SphereLattice, elements: int | None = None) -> iga.Solution:
    """The droplet of Bond number 1 on a substrate."""
    mesh = iga.Discretization(elements=elements)
    return iga.solve(
        iga.sessile_droplet(substrate, volume=VOLUME, gravity=1.0, hold="xy", discretization=mesh)
    )


def leaf(spacing: float) -> iga.SphereLattice:
    """Spheres that the liquid does not wet."""
    return iga.SphereLattice(contact_angle=180.0, radius=SHARE * spacing, spacing=spacing)


def sag(pressure: float, spacing: float) -> float:
    """Mean depth of the liquid under the tops (tension 1)."""
    spot = np.sqrt(pressure * spacing**2 * SHARE * spacing / (2.0 * np.pi))
    log = (np.log(spacing / spot) - 1.3105) / (2.0 * np.pi)
    return float(pressure * spacing**2 * (log + 1.0 / (4.0 * np.pi)))


def numbers(flat: iga.Solution, rough: iga.Solution, spacing: float) -> dict[str, float]:
    """What the asperities change."""
    asperities = rough.contact["asperities"]
    return {
        "asperities": float(len(asperities)),
        "lower_by": flat.measures["height"] - rough.measures["height"],
        "sag": sag(rough.measures["p_base"], spacing),
        "contact_radius": rough.measures["contact_radius"],
        "wet_fraction": rough.contact["wet_fraction"],
        "apparent_angle": rough.measures["apparent_angle"],
        "smallest_force": min(a["force"] for a in asperities),
        "carried": -sum(a["force_vector"][2] for a in asperities) / VOLUME,
        "iterations": float(len(rough.iterations)),
        "unknowns": float(rough.unknowns),
        "cpu_seconds": rough.cpu_seconds["solve"],
    }


def main(spacings: Sequence[float] = SPACINGS) -> dict[float, dict[str, float]]:
    """Droplets on finer and finer leaves in numbers."""
    flat = droplet(iga.Plane(contact_angle=180.0))
    return {s: numbers(flat, droplet(leaf(s)), s) for s in spacings}


def graph(found: dict[float, dict[str, float]], path: str) -> None:
    """Height and wetted part of the foot against the spacing."""
    from matplotlib.figure import Figure

    spacing = np.array(sorted(found))
    columns = {k: np.array([found[s][k] for s in spacing]) for k in found[spacing[0]]}
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.loglog(spacing, columns["lower_by"], "o-", label="droplet stands lower by")
    left.loglog(spacing, columns["sag"], "k--", label="mean sag of a wide lattice")
    left.set_ylabel("length over R")
    right.loglog(spacing, columns["wet_fraction"], "o-", label="wetted part of the foot")
    right.set_ylabel("area over the foot's")
    for axes in (left, right):
        axes.set_xlabel("spacing of the asperities over R")
        axes.set_xticks(spacing, [f"{s:g}" for s in spacing])
        axes.xaxis.minorticks_off()
        axes.grid(which="both", alpha=0.3)
        axes.legend()
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    found = main()
    for spacing, row in found.items():
        print(spacing, " ".join(f"{name} {value:.5g}" for name, value in row.items()))
    graph(found, "lotus_leaf.png")
    foot = droplet(leaf(0.02))
    foot.plot(
        "lotus_foot.png",
        color="none",
        view=(1.0, -2.2, 0.25),
        zoom=9.0,
        focus=(0.0, -0.68, 0.01),
        resolution=1201,
    )
