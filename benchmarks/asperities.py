"""Droplets on asperities at 180 degrees: accuracy, effort; writes docs/results/asperities.md.

Run ``python benchmarks/asperities.py``. Times are CPU seconds of one solve each,
without imports and compilation.
"""

from __future__ import annotations

import platform
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane

ROOT = Path(__file__).parents[1]
VOLUME = 4.0 * np.pi / 3.0
RADIUS = 0.05
CELL = {"size": 0.2, "pressure": 3.5}
ROUND_CELL = (0.014969599287521528, 0.03014261600166157)
"""Sag and energy of the round cell by two independent axisymmetric solvers."""


def rough(radius: float = RADIUS, elements: int | None = None, **options: object) -> iga.Solution:
    scene = iga.sessile_droplet(
        iga.SphereLattice(180.0, radius, 4.0 * radius),
        volume=VOLUME,
        gravity=1.0,
        hold="xy",
        discretization=iga.Discretization(elements=elements),
        **options,
    )
    return iga.solve(scene, on_fail="return")


def table(head: str, rows: Sequence[str]) -> list[str]:
    return [head, "|---" * (head.count("|") - 1) + "|", *rows]


def depth(solution: iga.Solution, radius: float = RADIUS) -> str:
    """Penetration over the asperity's radius."""
    found = solution.contact["max_penetration"]
    return "" if found is None else f"{found / radius:.2e}"


def mark(solution: iga.Solution) -> str:
    return "" if solution.success else solution.status.name


def against_elements() -> list[str]:
    rows = []
    for elements in (38, 50, 75, 100, 125, 150):
        s = rough(elements=elements)
        carried = -sum(a["force_vector"][2] for a in s.contact["asperities"])
        m = s.measures
        rows.append(
            f"| {elements} | {s.unknowns} | {s.newton_iterations} {mark(s)}| "
            f"{s.cpu_seconds['solve']:.2f} | {m['height']:.5f} | {m['energy']:.5f} | "
            f"{m['p_base']:.5f} | {s.contact['wet_solids']} | {carried / VOLUME - 1.0:+.0e} | "
            f"{depth(s)} |"
        )
    return table(
        "| elements | unknowns | its | CPU s | height | energy | p_base | wet "
        "| forces / weight - 1 | penetration / r_s |",
        rows,
    )


def against_radius() -> list[str]:
    rows = []
    for radius in (0.2, 0.15, 0.1, 0.075, 0.05):
        s = rough(radius)
        m = s.measures
        cells = (
            f"{m['height']:.4f} | {m['contact_radius']:.4f} | {m['A_wet']:.4f} | "
            f"{s.contact['wet_solids']}"
            if s.success
            else " | | | "
        )
        rows.append(f"| {radius:g} | {cells} | {s.newton_iterations} {mark(s)}|")
    flat = drop_on_plane(1.0, 180.0)
    rows.append(
        f"| plane | {flat['height']:.4f} | {flat['contact_radius']:.4f} | {flat['A_wet']:.4f} | | |"
    )
    return table("| r_s | height | contact radius | A_wet | wet asperities | its |", rows)


def against_penalty() -> list[str]:
    rows = []
    exact = rough()
    for penalty in (1e3, 1e4, 1e5, 1e6, None):
        s = exact if penalty is None else rough(penalty=penalty, penetration_tolerance=0.2)
        m = s.measures
        predicted = (
            "" if penalty is None else f"{(m['p_base'] + 2.0 / RADIUS) / penalty / RADIUS:.2e}"
        )
        cells = (
            f"{s.cpu_seconds['solve']:.2f} | {m['height']:.5f} | {m['energy']:.5f} | {depth(s)} | "
            f"{predicted}"
            if s.success
            else " | | | | "
        )
        name = "exact" if penalty is None else f"{penalty:.0e}"
        rows.append(f"| {name} | {s.newton_iterations} {mark(s)}| {cells} |")
    return table(
        "| penalty | its | CPU s | height | energy | penetration / r_s | predicted |", rows
    )


def cells() -> list[str]:
    rows = []
    for elements in (8, 12, 16, 20, 24, 32, 40, 48):
        found = []
        for shape in ("circle", "square"):
            sphere = iga.Sphere(180.0, RADIUS, (0.0, 0.0, -RADIUS))
            mesh = iga.Discretization(elements=elements)
            scene = iga.asperity_cell(sphere, shape=shape, discretization=mesh, **CELL)
            found.append(iga.solve(scene))
        one, two = (s.measures for s in found)
        total = CELL["pressure"] * CELL["size"] ** 2
        rows.append(
            f"| {elements} | {(one['sag'] - ROUND_CELL[0]) / RADIUS:+.1e} | "
            f"{one['energy'] / ROUND_CELL[1] - 1.0:+.1e} | {two['sag'] / RADIUS:.5f} | "
            f"{two['energy']:.7f} | {two['F_sphere'] / total - 1.0:+.0e} | "
            f"{found[1].cpu_seconds['solve']:.3f} |"
        )
    return table(
        "| elements | circle: error of sag / r_s | of energy | square: sag / r_s | energy "
        "| F_sphere / (p s^2) - 1 | CPU s |",
        rows,
    )


def main() -> None:
    rough(elements=38)
    text = [
        "# Contact at 180 degrees on asperities: accuracy and effort",
        "",
        "Made by `python benchmarks/asperities.py` on "
        f"{time.strftime('%Y-%m-%d')}, Python {platform.python_version()}, numpy {np.__version__}, "
        "one thread. Surface tension 1; the droplet has volume 4 pi / 3 (R = 1) and Bond number 1. "
        "Asperities are spheres of radius r_s on a square lattice of spacing 4 r_s, their tops in "
        "z = 0. Degree 2, eighth model. CPU seconds are those of one solve, stability and audit "
        "included.",
        "",
        "![The droplet on asperities](droplet_on_asperities.png)",
        "",
        "![Its foot, wet asperities in red](foot_on_asperities.png)",
        "",
        "Pictures by `python examples/droplet_on_asperities.py`.",
        "",
        "## Against elements, r_s = 0.05",
        "",
        "Elements from the middle of the foot to the widest place; 75 is the default here. The "
        "last two columns: what the wet asperities carry, and the deepest point of the membrane "
        "inside one, of which 1e-2 is allowed.",
        "",
        *against_elements(),
        "",
        "## Against the asperities' radius",
        "",
        "Default meshes. Contact radius is that of a disc as large as the lattice cells of the wet "
        "asperities. As the asperities shrink the height approaches that on the plane from below: "
        "the liquid sags between tops that are level with the plane. At r_s = 0.2 no droplet rests "
        "on the tops: a sphere carries at most (p + 2 gamma / r_s) pi r_s^2, with the membrane at "
        "its equator, so the pressure must be below 2 pi gamma r_s / (spacing^2 - pi r_s^2), here "
        "2.44, and on the plane it is already 2.92.",
        "",
        *against_radius(),
        "",
        "## Exact contact against a penalty, r_s = 0.05",
        "",
        "Penalty as in paper eq. (24), in units of tension over R squared; default mesh; a "
        "penetration of 0.2 r_s is allowed. The prediction is (p + 2 gamma / r_s) / penalty. Hard "
        "penalties act through multipliers that give way, and the membrane is lifted until it dips "
        "no deeper beside their points; that takes the place of a finer mesh, and raises the "
        "droplet by as much as it dipped.",
        "",
        *against_penalty(),
        "",
        "## One asperity in a cell",
        "",
        "Sphere of radius 0.05, cell of diameter or side 0.2, pressure 3.5. Errors of the round "
        "cell are against axisymmetric solutions. The edge of the wet spot falls anywhere in an "
        "element, so errors of the sag change sign from mesh to mesh; forces do not, because the "
        "multipliers balance the pressure on every mesh.",
        "",
        *cells(),
        "",
    ]
    (ROOT / "docs/results/asperities.md").write_text("\n".join(text))


if __name__ == "__main__":
    main()
