"""The measurements behind three constants of the code; writes docs/results/choices.md.

Run ``python benchmarks/choices.py``.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.dofs import dof_map as rows_module
from iga_membrane.linalg.bordered import Bordered
from iga_membrane.reference import drop_on_plane
from iga_membrane.terms import variations
from iga_membrane.threads import one_thread


def drop(**mesh: object) -> iga.Scene:
    return iga.sessile_droplet(
        iga.Plane(contact_angle=150),
        volume=4.0 * np.pi / 3.0,
        gravity=1.0,
        discretization=iga.Discretization(**mesh),
    )


def cpu(call: Callable[[], object], repeats: int = 5) -> float:
    spent = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        spent.append(time.process_time() - start)
    return 1e3 * statistics.median(spent)


def system(scene: iga.Scene) -> tuple:
    made = Assembly(scene)
    surface = scene.local_surface()
    motion = made.spines.on(surface)
    multipliers = np.ones(len(made.constraints))
    return made, lambda: made.system(surface, motion.directions, multipliers)


def dense_or_sparse() -> list[str]:
    rows = ["| unknowns | dense Cholesky, ms | nested dissection, ms |", "|---|---|---|"]
    keep = rows_module.DENSE_LIMIT
    for elements, model in ((20, "eighth"), (20, "quarter"), (20, "half"), (20, "full"),
                            (40, "half")):  # fmt: skip
        spent = []
        for limit in (10**6, 0):
            rows_module.DENSE_LIMIT = limit
            made, evaluate = system(drop(degree=3, elements=elements, model=model))
            s = evaluate()
            held = s.constraint_gradients.shape[1]

            def factor_and_solve(s: object = s, held: int = held) -> None:
                Bordered(s.matrix, s.constraint_gradients).solve(s.gradient, np.ones(held))

            spent.append(cpu(factor_and_solve))
        rows.append(f"| {made.size} | {spent[0]:.1f} | {spent[1]:.1f} |")
    rows_module.DENSE_LIMIT = keep
    return rows


def numpy_or_compiled() -> list[str]:
    rows = ["| elements | numpy, ms | compiled, ms |", "|---|---|---|"]
    keep = variations.COMPILED_FROM
    for elements in (20, 40, 80, 120):
        spent = []
        for start in (10**9, 0):
            variations.COMPILED_FROM = start
            made, evaluate = system(drop(degree=3, elements=elements, model="eighth"))
            evaluate()
            spent.append(cpu(evaluate))
        rows.append(f"| {len(made.table.functions)} | {spent[0]:.1f} | {spent[1]:.1f} |")
    variations.COMPILED_FROM = keep
    return rows


def quadrature() -> list[str]:
    exact = drop_on_plane(1.0, 150.0)
    rows = ["| degree | elements | rule | p_base | energy | contact_radius |", "|---" * 6 + "|"]
    for degree in (2, 3, 4):
        for elements in (8, 16, 32):
            for name, points in (("degree", degree), ("default", None), ("degree + 2", degree + 2)):
                found = iga.solve(
                    drop(degree=degree, elements=elements),
                    iga.SolverOptions(quadrature=points),
                    on_fail="return",
                )
                cells = " | ".join(
                    f"{found.measures[m] / exact[m] - 1.0:.1e}"
                    for m in ("p_base", "energy", "contact_radius")
                )
                rows.append(f"| {degree} | {elements} | {name} | {cells} |")
    return rows


@one_thread
def main() -> None:
    text = [
        "# Measurements behind constants of the code",
        "",
        "Made by `python benchmarks/choices.py`; CPU milliseconds, medians of five, one thread.",
        "",
        "## Dense or sparse factorization (`linalg/bordered.py`, `DENSE_LIMIT`)",
        "",
        "Factor and solve the bordered system of the drop at 150 degrees, with one step of "
        "refinement. The sparse one finds its order once, some 5 ms, and loads scipy, about 0.1 s "
        "in every process.",
        "",
        *dense_or_sparse(),
        "",
        "## numpy or compiled loops (`terms/variations.py`, `COMPILED_FROM`)",
        "",
        "One evaluation of gradient and Hessian, degree 3. Loading and compiling the loops costs "
        "about one second once per process, so they pay where a solve of some ten evaluations "
        "saves more than that.",
        "",
        *numpy_or_compiled(),
        "",
        "## Gauss points (`assembly/functional.py`)",
        "",
        "Relative errors of the drop at 150 degrees, Bond number 1. The default is degree + 1 "
        "points along the meridian and max(degree, 3) round the ring.",
        "",
        *quadrature(),
        "",
    ]
    target = Path(__file__).parents[1] / "docs/results/choices.md"
    target.write_text("\n".join(text))


if __name__ == "__main__":
    main()
