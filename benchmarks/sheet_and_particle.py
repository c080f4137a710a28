"""Sheets on a particle: errors, effort, forces; writes docs/results/sheet_and_particle.md.

Run ``python benchmarks/sheet_and_particle.py``. Errors are against the finest
mesh of each rim, times are medians of three solves without imports and compilation.
"""

from __future__ import annotations

import platform
import statistics
import sys
import time
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

import iga_membrane as iga

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "examples"))
import figure11  # noqa: E402

RIMS = ("circle", "square")
FINEST = {"circle": 40, "square": 24}


def scene(
    angle: float,
    boundary: str,
    *,
    radius: float = 1.0,
    size: float = 5.0,
    gravity: float = 0.0,
    weight: bool = False,
    **mesh: object,
) -> iga.Scene:
    particle = iga.Sphere(angle, radius, (0.0, 0.0, -radius), density=1.0)
    return iga.liquid_sheet(
        particle,
        size=size,
        boundary=boundary,
        gravity=gravity,
        liquid_weight=weight,
        discretization=iga.Discretization(**mesh),
    )


@cache
def finest(angle: float, boundary: str) -> dict[str, float]:
    return iga.solve(scene(angle, boundary, degree=4, elements=FINEST[boundary])).measures


def errors(solution: iga.Solution, exact: dict[str, float]) -> tuple[float, float, float]:
    m = solution.measures
    return (
        abs(m["energy"] / exact["energy"] - 1.0),
        abs(m["F_CL"] / exact["F_CL"] - 1.0),
        abs(m["phi_deg"] - exact["phi_deg"]),
    )


def rounded(error: float) -> str:
    return f"{error:.0e}" if error > 1e-14 else "< 1e-14"


def against_elements(angle: float = 120.0) -> list[str]:
    rows = ["| rim | degree | elements | unknowns | its | CPU s | energy | F_CL | phi, degrees |",
            "|---" * 9 + "|"]  # fmt: skip
    for boundary in RIMS:
        for degree in (2, 3, 4):
            for elements in (4, 8, 16) if boundary == "square" else (5, 10, 20):
                asked = scene(angle, boundary, degree=degree, elements=elements)
                found = [iga.solve(asked, on_fail="return") for _ in range(3)]
                seconds = statistics.median(s.cpu_seconds["solve"] for s in found)
                cells = " | ".join(rounded(e) for e in errors(found[0], finest(angle, boundary)))
                mark = "" if found[0].success else f" {found[0].status.name}"
                rows.append(
                    f"| {boundary} | {degree} | {elements} | {found[0].unknowns} | "
                    f"{found[0].newton_iterations}{mark} | {seconds:.3f} | {cells} |"
                )
    return rows


def iterations() -> list[str]:
    angles = range(5, 180, 10)
    rows = ["| rim | " + " | ".join(f"{a}" for a in angles) + " |", "|---" * 19 + "|"]
    for boundary in RIMS:
        found = [iga.solve(scene(float(a), boundary)) for a in angles]
        assert all(len(s.load_steps) == 1 for s in found)
        counts = " | ".join(str(s.newton_iterations) for s in found)
        rows.append(f"| {boundary} | {counts} |")
    return rows


def small_particles() -> list[str]:
    rows = ["| r_p | Bond number | F_CL | F_H + F_B + F_G | ratio | F_CL, weighing sheet |",
            "|---" * 6 + "|"]  # fmt: skip
    for radius in (0.01, 0.03, 0.1, 0.3, 1.0):
        size = 5.0 * radius
        asked = scene(90.0, "square", radius=radius, size=size, gravity=1.0)
        forces = iga.solve(asked).forces[0]
        line = forces.contact_line[2]
        rest = (forces.hydrostatic + forces.buoyancy + forces.weight)[2]
        heavy = iga.solve(
            scene(90.0, "square", radius=radius, size=size, gravity=1.0, weight=True),
            on_fail="return",
        )
        weighed = f"{heavy.measures['F_CL']:.6f}" if heavy.success else heavy.status.name
        rows.append(
            f"| {radius:g} | {radius**2:g} | {line:.6f} | {rest:.3e} | {abs(line / rest):.3g} | "
            f"{weighed} |"
        )
    return rows


def heaviest() -> str:
    """Where the square sheet that carries its liquid is lost."""
    path = iga.trace(
        lambda gravity: scene(90.0, "square", gravity=gravity, weight=True),
        (0.1, 0.5, 1.0),
        parameter="gravity.acceleration",
        on_fail="return",
    )
    assert path.bracket is not None, path.end.message
    return (
        "Followed in rho g at r_p = 1 the weighing sheet ends at a limit point between "
        f"{path.bracket.lo:.4f} and {path.bracket.hi:.4f}: five capillary lengths of liquid "
        "hang too heavily on it."
    )


SIZES = (3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0)


def sheet_sizes() -> tuple[list[str], dict[str, list[tuple[float, float]]]]:
    rows = [
        "| size / r_p | F_CL circle | F_e circle | F_CL square | F_e square |",
        "|---" * 5 + "|",
    ]
    found: dict[str, list[tuple[float, float]]] = {rim: [] for rim in RIMS}
    for size in SIZES:
        for rim in RIMS:
            forces = iga.solve(scene(90.0, rim, size=size, gravity=0.1)).forces[0]
            found[rim].append((float(forces.contact_line[2]), float(forces.effective[2])))
        cells = " | ".join(f"{value:.5f}" for rim in RIMS for value in found[rim][-1])
        rows.append(f"| {size:g} | {cells} |")
    return rows, found


def what_sizes_say(found: dict[str, list[tuple[float, float]]]) -> str:
    five, ten, last = (SIZES.index(size) for size in (5.0, 10.0, 20.0))
    parts = []
    for rim in RIMS:
        forces = np.array(found[rim])
        (line, whole), (line_on, whole_on) = (
            forces[ten] / forces[five] - 1.0,
            forces[last] / forces[ten] - 1.0,
        )
        parts.append(
            f"{rim}: F_CL {line:+.0%} and F_e {whole:+.0%} from 5 to 10, {line_on:+.0%} and "
            f"{whole_on:+.0%} from 10 to 20"
        )
    return (
        "A weightless sheet has no length of its own: it falls to the particle like a logarithm, "
        "and its pull keeps falling with the inverse of one. " + "; ".join(parts) + ". "
        "So 5 r_p is a choice, not a limit: forces and critical angles belong to the sheet's size "
        "and should be quoted with it."
    )


def critical() -> list[str]:
    rows = [
        "| rim | Bond number | consistent | paper, F_B up | paper, F_B down |",
        "|---" * 5 + "|",
    ]
    for rim in RIMS:
        for bond in figure11.BONDS:
            angles = [figure11.critical_angle(bond, rim, name) for name in figure11.FORCES]
            cells = " | ".join("none" if a is None else f"{a:.4f}" for a in angles)
            rows.append(f"| {rim} | {bond:g} | {cells} |")
    return rows


def largest() -> list[str]:
    rows = ["| rim | angle | consistent | paper, F_B up | paper, F_B down |", "|---" * 5 + "|"]
    for rim in RIMS:
        for angle in (1.0, 5.0, 15.0, 27.0, 45.0, 90.0):
            bonds = [figure11.largest_bond(angle, rim, name) for name in figure11.FORCES]
            rows.append(f"| {rim} | {angle:g} | " + " | ".join(f"{b:.4f}" for b in bonds) + " |")
    return rows


def grading() -> list[str]:
    factors = (0.0, 0.4, 0.8, 1.2)
    gains = []
    rows = ["| rim | angle | elements | " + " | ".join(f"{f:g}" for f in factors) + " |",
            "|---" * (3 + len(factors)) + "|"]  # fmt: skip
    for rim in RIMS:
        for angle in (60.0, 120.0):
            for elements in (6, 10):
                asked = scene(angle, rim, elements=elements)
                cells, lines = [], []
                for factor in factors:
                    rate = asked.grading.rate * factor / 0.8
                    first = float(rate / np.expm1(rate)) if rate else 1.0
                    graded = replace(asked, grading=iga.Grading(first))
                    energy, line, _ = errors(iga.solve(graded), finest(angle, rim))
                    cells.append(f"{rounded(energy)}, {rounded(line)}")
                    lines.append(line)
                gains.append(lines[0] / lines[2])
                rows.append(f"| {rim} | {angle:g} | {elements} | " + " | ".join(cells) + " |")
    return [
        f"The built-in grading divides the error of the line force by {min(gains):.0f} to "
        f"{max(gains):.0f}.",
        "",
        *rows,
    ]


def main() -> None:
    iga.solve(scene(90.0, "circle"))
    sizes, found = sheet_sizes()
    text = [
        "# A sheet on a particle: errors, effort, forces",
        "",
        "Made by `python benchmarks/sheet_and_particle.py` on "
        f"{time.strftime('%Y-%m-%d')}, Python {platform.python_version()}, numpy {np.__version__}, "
        "one thread. The particle has radius r_p = 1, its top just reaches the undeformed sheet, "
        "whose edge length or diameter is 5 unless said otherwise; surface tension 1, no pressure. "
        "Errors are against the finest mesh of each rim (degree 4, 40 elements for the circle, 24 "
        "for the square). CPU seconds are the median of three solves: everything between the scene "
        "and the result, stability and audit included, without imports.",
        "",
        "## Error against elements and CPU seconds, 120 degrees",
        "",
        "Eighth model. Relative errors of energy and line force, absolute error of the contact "
        "line's polar angle phi. The default meshes have degree 4, 20 elements (circle) or 8 "
        "elements (square).",
        "",
        *against_elements(),
        "",
        "## Newton iterations from the default start, by contact angle",
        "",
        "No load steps anywhere, default meshes.",
        "",
        *iterations(),
        "",
        "## Does the line force dominate for small particles?",
        "",
        "Square sheet of size 5 r_p, 90 degrees, gamma = 1, rho g = 1 (capillary length 1), "
        "particle as dense as the liquid, weightless sheet. The line force falls like r_p, the "
        "other three like its cube, so their ratio grows like 1/Bond number: the claim holds for "
        "particles much smaller than the capillary length. Last column: the same with the liquid's "
        "weight on the sheet, or the status where no equilibrium was found.",
        "",
        *small_particles(),
        "",
        heaviest(),
        "",
        "## Is a sheet of 5 r_p large enough?",
        "",
        "90 degrees, Bond number 0.1, weightless sheet, default meshes.",
        "",
        *sizes,
        "",
        what_sizes_say(found),
        "",
        "## Critical contact angles",
        "",
        "Degrees between 1 and 175 at which the effective force vanishes, by `iga.critical_value`. "
        "Three readings of paper eq. (39): the consistent forces, and the paper's with F_B up or "
        "down; see [theory](../theory.md#forces-on-a-particle).",
        "",
        *critical(),
        "",
        "## Largest Bond number with lift-off",
        "",
        "The forces of a weightless sheet are linear in the Bond number, so two solves give it.",
        "",
        *largest(),
        "",
        "## Grading towards the particle",
        "",
        "Relative errors of energy and line force, degree 4, for gradings of exponent "
        "`factor * log(rim / line)`; 0 is uniform and 0.8 is built in.",
        "",
        *grading(),
        "",
    ]  # fmt: skip
    (ROOT / "docs/results/sheet_and_particle.md").write_text("\n".join(text))


if __name__ == "__main__":
    main()
