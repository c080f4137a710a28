"""A sweep over Dask or MPI workers, one of which is killed midway; run as a program."""

import os
import sys
from pathlib import Path

from analysis.sweep_scenes import Deadly, threads

import iga_membrane as iga

ANGLES = [40.0 + 10.0 * k for k in range(8)]


class OnOneThread(Deadly):
    """Dies once at one angle; not built by a worker whose BLAS runs on several threads."""

    def __init__(self, deadly, folder):
        super().__init__(deadly, folder, 1)
        self.caller = os.getpid()

    def __call__(self, angle):
        if os.getpid() != self.caller:
            threads(angle)
        return super().__call__(angle)


def main(engine, out):
    """Prints the points, how many were computed, and whether all are successes."""
    scene_of = OnOneThread([ANGLES[4]], out.with_suffix(".died"))

    def run(executor):
        return iga.sweep(scene_of, {"angle": ANGLES}, out=out, executor=executor, workers=2)

    if engine == "dask":
        from dask.distributed import Client, LocalCluster

        where = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
        with LocalCluster(**where) as cluster, Client(cluster) as client:
            found = run(client.get_executor())
    else:
        from mpi4py.futures import MPIPoolExecutor

        with MPIPoolExecutor() as executor:
            assert executor.num_workers == 2
            found = run(executor)
    print(len(found.records), found.computed, found.success)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
