"""The self-cleaning map on one and two processes, on Dask and on MPI.

Run ``python benchmarks/self_cleaning.py``; writes docs/results/self_cleaning.md
and its picture. Needs the extra ``cluster`` and an ``mpiexec``.
"""

from __future__ import annotations

import os
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import iga_membrane as iga
from iga_membrane.analysis.process_pool import ProcessLanes

ROOT = Path(__file__).parents[1]
EXAMPLE = ROOT / "examples/self_cleaning_map.py"
ROUNDS = 3
ENGINES = {
    "processes": [sys.executable, str(EXAMPLE)],
    "Dask": [sys.executable, str(EXAMPLE), "--executor", "dask"],
    "MPI": ["mpiexec", "-n", "3", sys.executable, "-m", "mpi4py.futures", str(EXAMPLE)]
    + ["--executor", "mpi"],
}
sys.path.insert(0, str(EXAMPLE.parent))

from self_cleaning_map import ANGLES, BONDS, scene  # noqa: E402


def waited() -> float:
    """Seconds for which this worker was ready and had no processor (Linux)."""
    time.sleep(0.5)  # so that every worker answers once
    return 1e-9 * float(Path("/proc/self/schedstat").read_text().split()[1])


def seconds(workers: int) -> tuple[float, float]:
    """Wall time of the sweep on so many processes, their start included; mean of their waiting."""
    began = time.perf_counter()
    with ProcessLanes(workers) as pool:
        over = {"angle": ANGLES, "bond": BONDS}
        found = iga.sweep(scene, over, executor=pool, workers=workers)
        assert found.success
        wall = time.perf_counter() - began
        waits = [pool.submit(waited) for _ in range(workers)]
        return wall, statistics.mean(each.result() for each in waits)


def run(command: list[str], folder: str) -> tuple[str, str]:
    """What the example prints, and its table."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    said = subprocess.run([*command, "--workers", "2"], cwd=folder, env=environment, check=True,
                          capture_output=True, text=True).stdout  # fmt: skip
    return said, (Path(folder) / "self_cleaning_map.csv").read_text()


def main() -> None:
    rows = ["| round | load before | one process, s | two, s | ratio | one, less waiting | "
            "two, less waiting | ratio |", "|---" * 8 + "|"]  # fmt: skip
    ratios = []
    for k in range(ROUNDS):
        load = os.getloadavg()[0]
        (one, one_waited), (two, two_waited) = seconds(1), seconds(2)
        free = one - one_waited, two - two_waited
        ratios.append((two / one, free[1] / free[0]))
        rows.append(f"| {k + 1} | {load:.2f} | {one:.1f} | {two:.1f} | {two / one:.3f} | "
                    f"{free[0]:.1f} | {free[1]:.1f} | {free[1] / free[0]:.3f} |")  # fmt: skip
        print(rows[-1], flush=True)
    wall, free_wall = (statistics.median(each) for each in zip(*ratios, strict=True))
    said, tables = "", {}
    for name, command in ENGINES.items():
        with tempfile.TemporaryDirectory() as folder:
            printed, tables[name] = run(command, folder)
            if name == "processes":
                said = printed
                picture = Path(folder) / "self_cleaning_map.png"
                shutil.copy(picture, ROOT / "docs/results/self_cleaning_map.png")
    same = [name for name in ENGINES if tables[name] == tables["processes"]]
    text = [
        "# Which particles are lifted",
        "",
        "Made by `python benchmarks/self_cleaning.py` on "
        f"{time.strftime('%Y-%m-%d')}, Python {platform.python_version()}, numpy {np.__version__}. "
        "The map alone: `python examples/self_cleaning_map.py`.",
        "",
        "A weightless circular sheet of diameter 5 r_p on a particle as dense as the liquid, "
        f"{len(ANGLES)} contact angles times {len(BONDS)} Bond numbers, every point a solve. The "
        "dashed line is found by `iga.critical_value` at each contact angle; the black one below "
        "it is interpolated between the points. `iga.self_cleaning` answers on either side of the "
        "line, a thousandth of the Bond number away.",
        "",
        "![Phase diagram of self-cleaning](self_cleaning_map.png)",
        "",
        "```text",
        said.rstrip(),
        "```",
        "",
        "## Two processes, Dask, MPI",
        "",
        "Wall seconds of the sweep, start of the processes included, on "
        f"{os.cpu_count()} processors shared with other work (the load is that before each round; "
        "1 is one processor taken by others). Less waiting: without the time for which "
        "workers were ready and others had the processors, which estimates a machine of one's own. "
        f"Median ratios: {wall:.3f} in wall time, {free_wall:.3f} less waiting.",
        "",
        *rows,
        "",
        "The tables of all measures of all points are the same to the last digit on two workers of "
        + ", ".join(same) + ". See [sweeps on a cluster](../cluster.md).",
        "",
    ]  # fmt: skip
    (ROOT / "docs/results/self_cleaning.md").write_text("\n".join(text))
    assert len(same) == len(ENGINES), tables


if __name__ == "__main__":
    main()
