"""Droplets on hundreds to thousands of asperities; writes docs/results/lotus.md.

Run ``OMP_NUM_THREADS=1 python benchmarks/lotus.py``. Times are CPU seconds of one solve each,
without imports and compilation.
"""

from __future__ import annotations

import platform
import resource
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane

ROOT = Path(__file__).parents[1]
VOLUME = 4.0 * np.pi / 3.0
FLAT = drop_on_plane(1.0, 180.0)["height"]


def solved(substrate: iga.SphereLattice | iga.Spheres, elements: int | None = None) -> iga.Solution:
    mesh = iga.Discretization(elements=elements)
    scene = iga.sessile_droplet(substrate, volume=VOLUME, gravity=1.0, discretization=mesh)
    return iga.solve(scene, on_fail="return")


def lattice(spacing: float) -> iga.SphereLattice:
    return iga.SphereLattice(180.0, 0.25 * spacing, spacing)


def scattered(spacing: float, seed: int, reach: float = 1.1) -> iga.Spheres:
    """Places at random, at least four fifths of a spacing apart; radii scattered by 10 %."""
    rng, cells, places = np.random.default_rng(seed), {}, []
    apart = 0.8 * spacing
    for place in rng.uniform(-reach, reach, (int(30 * reach**2 / spacing**2), 2)):
        i, j = (place // apart).astype(int)
        near = [q for k in (-1, 0, 1) for m in (-1, 0, 1) for q in cells.get((i + k, j + m), ())]
        if all(np.hypot(*(place - other)) >= apart for other in near):
            cells.setdefault((i, j), []).append(place)
            places.append(place)
    radii = 0.25 * spacing * (1.0 + 0.1 * rng.uniform(-1.0, 1.0, len(places)))
    return iga.Spheres(180.0, np.column_stack([places, -radii]), radii)


def row(name: str, solution: iga.Solution) -> str:
    contact = solution.contact
    vertical = -np.array([a["force_vector"][2] for a in contact["asperities"]])
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    status = "" if solution.success else f" {solution.status.name}"
    return (
        f"| {name} | {contact['law']} | {solution.unknowns} | {len(solution.iterations)}{status} | "
        f"{solution.cpu_seconds['solve']:.2f} | {memory:.2f} | {contact['wet_solids']} | "
        f"{solution.measures['height'] - FLAT:.3e} | {vertical.min():.1e} | "
        f"{vertical.sum() / VOLUME - 1.0:+.0e} |"
    )


HEAD = (
    "| {} | law | unknowns | its | CPU s | peak GB | wet | height - flat | smallest force | "
    "forces / weight - 1 |"
)


def table(first: str, rows: Sequence[str]) -> list[str]:
    return [HEAD.format(first), "|---" * 10 + "|", *rows]


def main() -> None:
    scales = [row(f"{s:g}", solved(lattice(s))) for s in (0.1, 0.05, 0.02, 0.01)]
    irregular = [row(f"seed {seed}", solved(scattered(0.05, seed))) for seed in range(3)]
    meshes = {0.1: (60, 110, 160, 220), 0.05: (90, 110, 240, 320), 0.02: (120, 150, 250, 366)}
    finer = [
        row(f"{s:g}, {n}", solved(lattice(s), n)) for s, counts in meshes.items() for n in counts
    ]
    page = [
        "# A lotus leaf: thousands of asperities",
        "",
        f"Made by `OMP_NUM_THREADS=1 python benchmarks/lotus.py` on {time.strftime('%Y-%m-%d')}, "
        f"Python {platform.python_version()}, numpy {np.__version__}, one thread. Surface tension "
        "1, volume 4 pi / 3 (R = 1), Bond number 1, contact angle 180 degrees; spheres of radius a "
        "quarter of their spacing, tops in z = 0. CPU seconds are those of one solve, stability "
        f"and audit included; peak memory is the process's so far. The flat droplet is "
        f"{FLAT:.7f} high (axisymmetric reference).",
        "",
        "![Height and wetted part of the foot](lotus_leaf.png)",
        "",
        "![The rim of the foot on 3,700 asperities, wet ones red](lotus_foot.png)",
        "",
        "Pictures by `python examples/lotus_leaf.py`.",
        "",
        "## Default meshes, eighth model",
        "",
        *table("spacing", scales),
        "",
        "## Mesh and law",
        "",
        "Elements from the middle of the foot to the widest place are given; the law follows from "
        "them. A spot of radius a, a^2 = p s^2 r / 2 pi, is resolved by a penalty at all "
        "quadrature points from about 1.3 elements along a; an asperity is a point support where "
        "a is less than three eighths of an element. Between the two laws a penalty is too "
        "stiff: at a = 0.4 "
        "elements by a fifth of the height's change, which ends `UNDERRESOLVED` where a spot has "
        "less than 6 quadrature points.",
        "",
        *table("spacing, elements", finer),
        "",
        "## Irregular asperities, full model",
        "",
        "Places at random, at least 0.04 apart, mean spacing about 0.05, radii 0.0125 scattered by "
        "10 %. The droplet rolls to a place where it is stable, which takes most of the "
        "iterations.",
        "",
        *table("places", irregular),
        "",
        "## What is converged and what is not",
        "",
        "- Height changes by point supports: within 3 % of finer meshes' at spacings up to 0.05, "
        "5 % at 0.1, where the spots are 1.3 times as wide as the supports' own.",
        "- The apparent and the Cassie-Baxter angle, wet areas and forces are those of the same "
        "states; wet areas follow from the forces.",
        "- Between its supports the membrane is that of the mesh: curvatures near an asperity mean "
        "nothing on a mesh of point supports, and no depth in the spheres is audited there.",
        "- Below 180 degrees the contact lines are resolved, see the [open ends](../roadmap.md).",
        "",
    ]
    (ROOT / "docs/results/lotus.md").write_text("\n".join(page))


if __name__ == "__main__":
    main()
