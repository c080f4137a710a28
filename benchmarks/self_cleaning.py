"""The self-cleaning map on one and two processes, on Dask and on MPI.

Run ``OMP_NUM_THREADS=1 python benchmarks/self_cleaning.py``; writes docs/results/self_cleaning.md
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


def seconds(workers: int) -> float:
    """Wall time of the sweep on so many processes, their start included."""
    began = time.perf_counter()
    found = iga.sweep(scene, {"angle": ANGLES, "bond": BONDS}, workers=workers)
    assert found.success
    return time.perf_counter() - began


def run(command: list[str], folder: str) -> tuple[str, str]:
    """What the example prints, and its table."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    said = subprocess.run([*command, "--workers", "2"], cwd=folder, env=environment, check=True,
                          capture_output=True, text=True).stdout  # fmt: skip
    return said, (Path(folder) / "self_cleaning_map.csv").read_text()


def main() -> None:
    rows = ["| round | one process, s | two processes, s | ratio | load before |", "|---" * 5 + "|"]
    ratios = []
    for k in range(ROUNDS):
        load = os.getloadavg()[0]
        one, two = seconds(1), seconds(2)
        ratios.append(two / one)
        rows.append(f"| {k + 1} | {one:.1f} | {two:.1f} | {ratios[-1]:.3f} | {load:.2f} |")
        print(rows[-1], flush=True)
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
        "Made by `OMP_NUM_THREADS=1 python benchmarks/self_cleaning.py` on "
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
        f"{os.cpu_count()} processors shared with other work. Median ratio "
        f"{statistics.median(ratios):.3f}.",
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
