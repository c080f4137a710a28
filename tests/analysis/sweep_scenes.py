"""Scenes for sweeps, importable by worker processes; some of them misbehave on purpose."""

import os
import signal
import time
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_info

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0


def drop(angle, bond=1.0):
    return iga.sessile_droplet(
        iga.Plane(contact_angle=angle),
        volume=VOLUME,
        gravity=bond,
        discretization=iga.Discretization(elements=8),
    )


class Counting:
    """Notes every scene that is built for a solve, one line per call, in a file."""

    def __init__(self, file, pause=0.0):
        self.file, self.pause = str(file), pause

    def __call__(self, angle, bond=1.0):
        with open(self.file, "a") as file:
            file.write(f"{angle:g} {bond:g}\n")
        time.sleep(self.pause)
        return drop(angle, bond)


class Deadly:
    """Kills its worker at some angles, so often; a file of the angle's name counts the deaths."""

    def __init__(self, deadly, folder, deaths=np.inf):
        self.deadly, self.folder, self.deaths = tuple(deadly), str(folder), deaths

    def __call__(self, angle):
        if angle in self.deadly:
            died = Path(self.folder) / f"{angle:g}"
            if not died.exists() or died.stat().st_size < self.deaths:
                with open(died, "a") as file:
                    file.write("x")
                os.kill(os.getpid(), signal.SIGKILL)
        return drop(angle)


def hanging(angle):
    if angle == 100.0:
        time.sleep(1000.0)
    return drop(angle)


def threads(angle):
    """Not built where BLAS runs on several threads."""
    assert {p["num_threads"] for p in threadpool_info() if p["user_api"] == "blas"} == {1}
    return drop(angle)


if __name__ == "__main__":
    import sys

    where, pause = sys.argv[1], float(sys.argv[2])
    scene_of = Counting(Path(where).with_suffix(".log"), pause)
    angles = [30.0 + 4.0 * k for k in range(int(sys.argv[3]))]
    found = iga.sweep(scene_of, {"angle": angles}, out=where, workers=int(sys.argv[4]))
    print(len(found.records), found.computed, found.success)
