"""Which particles a liquid lifts: a phase diagram over contact angle and particle Bond number.

A circular liquid sheet of diameter 5 r_p touches a particle whose top just reaches it (figure 11).
Each of 420 points is a solve of its own; a particle is lifted where the force of membrane and
liquid is more than its weight, paper eq. (39). Over them lies the critical curve, where the
effective force vanishes: at every contact angle the Bond number that ``critical_value`` finds on
its own. On either side of it ``self_cleaning`` is asked for its answer.

``python examples/self_cleaning_map.py`` writes ``self_cleaning_map.png`` and the table
``self_cleaning_map.csv``. The sweep runs on all processors; with ``--executor dask`` on two workers
of Dask; with ``--executor mpi``, under ``mpiexec -n 3 python -m mpi4py.futures``, on those of MPI.
With ``--out FOLDER`` points are kept there, and the same command goes on where it was stopped.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager

import numpy as np

import iga_membrane as iga

ANGLES = np.linspace(5.0, 175.0, 21).tolist()
BONDS = np.linspace(0.05, 1.2, 20).tolist()
FRICTION = 0.3


def scene(angle: float, bond: float) -> iga.Scene:
    """Sheet on a particle as dense as the liquid; lengths in r_p, forces in gamma r_p."""
    particle = iga.Sphere(contact_angle=angle, radius=1.0, center=(0, 0, -1), density=1.0)
    return iga.liquid_sheet(particle, size=5.0, boundary="circle", gravity=bond)


def critical_bond(angle: float) -> float:
    """Particle Bond number at which the effective force vanishes."""
    found = iga.critical_value(
        lambda bond: scene(angle, bond), lambda s: s.forces[0].effective[2], 0.0, 2.0
    )
    return found.value


def answer(angle: float, bond: float) -> str:
    """What happens to the particle: "lifted", "dragged" or "stays"."""
    return iga.self_cleaning(scene(angle, bond), friction=FRICTION).verdicts[0].answer


def main(
    angles: Sequence[float] = ANGLES,
    bonds: Sequence[float] = BONDS,
    out: str | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
) -> tuple[iga.Sweep, list[float]]:
    """The sweep, and the critical Bond number at each contact angle."""
    over = {"angle": angles, "bond": bonds}
    found = iga.sweep(scene, over, out=out, executor=executor, workers=workers)
    return found, [critical_bond(angle) for angle in angles]


@contextmanager
def workers_of(engine: str) -> Iterator[Executor | None]:
    """Two workers of Dask on this machine, those of MPI, or None: the sweep's own processes."""
    if engine == "dask":
        from dask.distributed import Client, LocalCluster

        cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
        with cluster, Client(cluster) as client:
            yield client.get_executor()
    elif engine == "mpi":
        from mpi4py.futures import MPIPoolExecutor

        with MPIPoolExecutor() as pool:
            yield pool
    else:
        yield None


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Phase diagram of self-cleaning.")
    parser.add_argument("--executor", choices=("processes", "dask", "mpi"), default="processes")
    parser.add_argument("--workers", type=int, help="of the executor")
    parser.add_argument("--out", help="folder that keeps the points")
    given = parser.parse_args()
    with workers_of(given.executor) as executor:
        sweep, critical = main(out=given.out, executor=executor, workers=given.workers)
    lifted = int(sweep.column("lifts").sum())
    print(f"{len(sweep.records)} points, {lifted} lifted; {sweep.statuses}")
    print("   angle   critical Bond number   just below / above")
    for angle, bond in zip(ANGLES, critical, strict=True):
        sides = [answer(angle, factor * bond) for factor in (0.999, 1.001)]
        print(f"{angle:8.2f}{bond:16.6f}          {sides[0]} / {sides[1]}")
    sweep.save("self_cleaning_map.csv")
    iga.plot_phases(
        sweep,
        "self_cleaning_map.png",
        x="angle",
        y="bond",
        of="F_e_z",
        names=("stays", "lifted"),
        curve=("critical curve", np.array(ANGLES), np.array(critical)),
    )
