"""Moves between the package's files in one Newton iteration: how far its code lies apart.

``python benchmarks/moves.py`` counts changes of file, among those of the package, over one
iteration after another has warmed up caches and compiled kernels (``sys.setprofile``), and prints
which pairs of files make most of them.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path
from time import thread_time
from types import FrameType

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.solvers.newton import newton
from iga_membrane.solvers.predictor import first, settings_of

HOME = str(Path(iga.__file__).parent)
SCENES = {
    "droplet on a plane": lambda: iga.sessile_droplet(
        iga.Plane(contact_angle=120.0), volume=1.0, gravity=1.0
    ),
    "contact lines on asperities": lambda: iga.sessile_droplet(
        iga.SphereLattice(150.0, radius=0.1, spacing=0.4), volume=4.18879, gravity=1.0, hold="xy"
    ),
}


def moves_of(scene: iga.Scene) -> Counter[tuple[str, str]]:
    """Changes of file in the second of two Newton iterations beside an equilibrium."""
    assembly = Assembly(scene)
    options = settings_of(scene, iga.SolverOptions(), thread_time())
    begun = first(scene, assembly, options)
    start = begun.surface.moved(1.001 * begun.surface.points)

    def counted(iterations: int) -> Counter[tuple[str, str]]:
        few = replace(options, max_iterations=iterations)
        changes = Changes()
        sys.setprofile(changes)
        try:
            newton(assembly, start, begun.multipliers, scene.meridian_grading, few)
        finally:
            sys.setprofile(None)
        return changes.found

    counted(2)
    return counted(2) - counted(1)


class Changes:
    """A profile function that counts changes of file."""

    def __init__(self) -> None:
        self.found: Counter[tuple[str, str]] = Counter()
        self._here: str | None = None

    def __call__(self, frame: FrameType, event: str, argument: object) -> None:
        if event == "return" and frame.f_back is not None:
            frame = frame.f_back
        elif event != "call":
            return
        name = frame.f_code.co_filename
        if name.startswith(HOME) and name != self._here:
            if self._here is not None:
                self.found[self._here, name] += 1
            self._here = name


def main() -> None:
    for name, make in SCENES.items():
        found = moves_of(make())
        print(f"{name}: {found.total()} moves")
        for (one, two), count in found.most_common(12):
            print(f"  {count:5d} {one.removeprefix(HOME)} -> {two.removeprefix(HOME)}")


if __name__ == "__main__":
    main()
