"""Error against CPU seconds for the drop on a plane; writes docs/results/droplet_on_plane.md.

Run ``python benchmarks/droplet_on_plane.py``. Errors are against the axisymmetric
reference, times are medians of several solves without imports and compilation.
"""

from __future__ import annotations

import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane

MEASURES = ("height", "contact_radius", "p_base", "energy", "A_LG", "A_wet")
SPACES = [("bspline", 2), ("bspline", 3), ("bspline", 4), ("nurbs", 3)]
SPACES += [("lagrange", 1), ("lagrange", 2), ("lagrange", 3), ("lagrange", 4)]
ROOT = Path(__file__).parents[1]


def solve(angle: float, bond: float, repeats: int = 1, **mesh: object) -> tuple:
    scene = iga.sessile_droplet(
        iga.Plane(contact_angle=angle),
        volume=4.0 * np.pi / 3.0,
        gravity=bond,
        discretization=iga.Discretization(**mesh),
    )
    found = [iga.solve(scene, on_fail="return") for _ in range(repeats)]
    return found[0], statistics.median(s.cpu_seconds["solve"] for s in found)


def errors(solution: object, exact: dict[str, float]) -> list[float]:
    return [abs(solution.measures[name] / exact[name] - 1.0) for name in MEASURES]


def against_time() -> list[str]:
    """150 degrees, Bond number 1, every space under refinement."""
    exact = drop_on_plane(1.0, 150.0)
    rows = ["| space | degree | elements | unknowns | its | CPU s | " + " | ".join(MEASURES) + " |",
            "|---" * (6 + len(MEASURES)) + "|"]  # fmt: skip
    for space, degree in SPACES:
        for elements in (4, 8, 16, 32):
            solution, seconds = solve(150.0, 1.0, 5, space=space, degree=degree, elements=elements)
            cells = " | ".join(f"{e:.0e}" for e in errors(solution, exact))
            rows.append(
                f"| {space} | {degree} | {elements} | {solution.unknowns} | "
                f"{solution.newton_iterations} | {seconds:.3f} | {cells} |"
            )
    return rows


def whole_family() -> list[str]:
    """Largest relative error of the six measures at the default discretization."""
    bonds = (0.0, 0.01, 0.3, 1.0, 3.0, 10.0, 30.0, 59.0, 100.0)
    rows = ["| angle \\ Bond | " + " | ".join(f"{b:g}" for b in bonds) + " |",
            "|---" * (1 + len(bonds)) + "|"]  # fmt: skip
    for angle in (3.0, 11.0, 30.0, 60.0, 90.0, 120.0, 150.0, 165.0, 169.0, 175.0, 179.0):
        cells = []
        for bond in bonds:
            solution, _ = solve(angle, bond)
            worst = max(errors(solution, drop_on_plane(bond, angle)))
            mark = "" if solution.success else f" {solution.status.name}"
            cells.append(f"{worst:.0e}, {solution.newton_iterations}{mark}")
        rows.append(f"| {angle:g} | " + " | ".join(cells) + " |")
    return rows


def whole_process(repeats: int = 5) -> float:
    """Median CPU seconds of the command line, with warm caches."""
    import resource

    spent = []
    command = [sys.executable, "-m", "iga_membrane", "solve", str(ROOT / "examples/droplet.toml")]
    for _ in range(repeats + 1):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([*command, "--out", str(ROOT / "out")], check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return statistics.median(spent[1:])


def main() -> None:
    solve(150.0, 1.0)
    text = [
        "# A droplet on a plane: error against CPU seconds",
        "",
        "Made by `python benchmarks/droplet_on_plane.py` on "
        f"{time.strftime('%Y-%m-%d')}, Python {platform.python_version()}, numpy {np.__version__}, "
        "one thread. Volume 4 pi / 3, surface tension 1. Errors are relative, against the "
        "axisymmetric reference (`iga_membrane/reference`, itself right to 1e-11). CPU seconds are "
        "the median of five solves: everything between the scene and the result, stability and "
        "audit included, without imports.",
        "",
        "## The whole family at the default discretization",
        "",
        "B-splines of degree 4, 20 elements along the meridian, eighth model, 111 unknowns. Each "
        "entry: largest relative error of height, contact radius, base pressure, energy, "
        "liquid-gas and wetted area; Newton iterations from the default start. No load steps "
        "anywhere.",
        "",
        *whole_family(),
        "",
        "## 150 degrees, Bond number 1, every space",
        "",
        *against_time(),
        "",
        f"The whole process of the command line on this scene (default discretization, imports and "
        f"files included) takes {whole_process():.2f} CPU seconds.",
        "",
    ]  # fmt: skip
    (ROOT / "docs/results/droplet_on_plane.md").write_text("\n".join(text))


if __name__ == "__main__":
    main()
