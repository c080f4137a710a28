"""What a solve costs as it is, with BLAS on one thread from outside, and beside a busy process.

Run ``python benchmarks/threads.py`` with no variable of OpenMP or BLAS set; it prints the table of
docs/results/threads.md. Every run is a process of its own, solves once to load and compile, and
prints the CPU and wall seconds of the second solve; CPU seconds are those of the whole process.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0


def rough() -> iga.Scene:
    """The default droplet at 180 degrees on asperities."""
    lattice = iga.SphereLattice(180.0, radius=0.05, spacing=0.2)
    return iga.sessile_droplet(lattice, volume=VOLUME, gravity=1.0)


def lotus() -> iga.Scene:
    """3,700 asperities."""
    lattice = iga.SphereLattice(180.0, radius=0.005, spacing=0.02)
    return iga.sessile_droplet(lattice, volume=VOLUME, gravity=1.0)


def full() -> iga.Scene:
    """Every element of a droplet on a hexagonal lattice."""
    lattice = iga.SphereLattice(180.0, radius=0.05, spacing=0.2, arrangement="hexagonal")
    mesh = iga.Discretization(model="full")
    return iga.sessile_droplet(lattice, volume=VOLUME, gravity=1.0, discretization=mesh)


def small() -> iga.Scene:
    return iga.sessile_droplet(iga.Plane(90.0), volume=VOLUME)


SCENES = {f.__name__: f for f in (small, rough, lotus, full)}
ONE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


BUSY = "import os\nparent = os.getppid()\nwhile os.getppid() == parent: pass"


def solved(name: str) -> None:
    """In a process of its own."""
    iga.solve(SCENES[name]())
    times = time.process_time(), time.perf_counter()
    iga.solve(SCENES[name]())
    print(time.process_time() - times[0], time.perf_counter() - times[1])


def run(name: str, environment: dict[str, str]) -> tuple[float, float]:
    """CPU and wall seconds."""
    command = [sys.executable, __file__, name]
    out = subprocess.run(command, env=os.environ | environment, check=True,
                         capture_output=True, text=True).stdout  # fmt: skip
    cpu, wall = map(float, out.split())
    return cpu, wall


def main() -> None:
    print("| scene | BLAS | beside | CPU s | wall s |", "|---|---|---|---|---|", sep="\n")
    for name in SCENES:
        for beside in ("nothing", "a busy process"):
            busy = None
            if beside != "nothing":
                busy = subprocess.Popen([sys.executable, "-c", BUSY])
            try:
                for words, environment in (("one thread", ONE), ("as it is", {})):
                    cpu, wall = run(name, environment)
                    print(f"| {name} | {words} | {beside} | {cpu:.3f} | {wall:.3f} |", flush=True)
            finally:
                if busy is not None:
                    busy.kill()
                    busy.wait()


if __name__ == "__main__":
    if len(sys.argv) == 2:
        solved(sys.argv[1])
    else:
        main()
