"""What new users do first, each job in a process of its own, in a fresh environment.

``python benchmarks/first_day.py`` makes a virtual environment in a temporary folder, installs the
package there from this clone, runs the jobs in empty folders and prints a table of CPU and elapsed
seconds. ``--here`` runs them with this Python instead.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

ROOT = Path(__file__).parents[1]

TEXTURE = """
scene = "sessile_droplet"
[liquid]
surface_tension = "72.8 mN/m"
density = "998 kg/m^3"
volume = "3 uL"
[gravity]
acceleration = "9.81 m/s^2"
[substrate]
kind = "height_map"
shape = "egg_carton"
amplitude = "10 um"
period = "0.5 mm"
contact_angle = 115.0
[droplet]
hold = "xy"
"""
SWEEP = (
    TEXTURE
    + """
[[over]]
parameter = "liquid.volume"
values = ["2 uL", "3 uL", "4 uL"]
[[over]]
parameter = "substrate.contact_angle"
values = [110.0, 115.0]
"""
)
TABLE = """
import iga_membrane as iga
drop = iga.load("out/state.npz")
print(drop)
print(drop.row())
"""
OWN = """
from dataclasses import dataclass, replace
import numpy as np
import iga_membrane as iga
from iga_membrane.terms import BodyDensity, BodyTerm

@dataclass(frozen=True)
class Wind(BodyTerm):
    \"\"\"Uniform force per volume along x.\"\"\"
    force: float
    name = "wind"
    def density(self):
        return BodyDensity(0.0, (-self.force, 0.0, 0.0))
    def scaled(self, scale):
        return Wind(self.force * scale.length**2 / scale.tension)

ridge = iga.HeightMap(
    lambda x, y: (0.02 * np.cos(3 * x), -0.06 * np.sin(3 * x), 0 * x, -0.18 * np.cos(3 * x),
                  0 * x, 0 * x),
    contact_angle=100.0, scale=0.3,
)
mesh = iga.Discretization(elements=10, degree=3)
drop = iga.solve(iga.sessile_droplet(ridge, volume=1.0, hold="xy"))
print(drop)
plain = iga.sessile_droplet(
    iga.Plane(100), volume=1.0, gravity=[0.1, 0.0, -0.5], hold="x", discretization=mesh
)
ours = iga.solve(replace(plain, terms=[*plain.terms, Wind(0.3)], ramp=None))
print(ours, iga.check_derivatives(ours.scene)["all terms"].right)
"""
JOBS = {
    "install": [],
    "a photograph to angle and volume": [
        ["{python}", str(ROOT / "examples" / "goniometer.py")],
        ["{python}", "-m", "iga_membrane", "fit", "drop.png", "--scale", "8 um", "--out", "fit"],
    ],
    "3 uL on a texture of 115 degrees: file, picture, table": [
        ["{python}", "-m", "iga_membrane", "init", "first.toml"],
        ["{python}", "-m", "iga_membrane", "solve", "texture.toml", "--out", "out", "--png"],
        ["{python}", "table.py"],
    ],
    "an own term and an own solid": [["{python}", "own.py"]],
    "a sweep of 6 points by 2 processes, and again": [
        ["{python}", "-m", "iga_membrane", "sweep", "sweep.toml", "--out", "s", "--workers", "2"],
        ["{python}", "-m", "iga_membrane", "sweep", "sweep.toml", "--out", "s", "--workers", "2"],
    ],
}
"""Job to its commands, in a folder that holds the files they name."""
FILES = {"texture.toml": TEXTURE, "sweep.toml": SWEEP, "table.py": TABLE, "own.py": OWN}


def children() -> float:
    """CPU seconds of all processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(commands: list[list[str]], python: str, folder: Path, env: dict[str, str]) -> None:
    """Each command, one after the other; the first that fails ends it."""
    for command in commands:
        words = [word.replace("{python}", python) for word in command]
        subprocess.run(words, cwd=folder, env=env, check=True, stdout=subprocess.DEVNULL)


def main(here: bool = False) -> dict[str, tuple[float, float]]:
    """CPU and elapsed seconds by job."""
    spent = {}
    with tempfile.TemporaryDirectory() as place:
        home = Path(place)
        env = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
        env |= {"HOME": place, "OMP_NUM_THREADS": "1"}
        python = sys.executable if here else str(home / "env" / "bin" / "python")
        if here:
            env["PYTHONPATH"] = str(ROOT)
        else:
            JOBS["install"] = [
                [sys.executable, "-m", "venv", str(home / "env")],
                [python, "-m", "pip", "install", "-q", str(ROOT)],
            ]
        for job, commands in JOBS.items():
            folder = home / job.replace(" ", "_").replace("/", "_")
            folder.mkdir()
            for name, text in FILES.items():
                (folder / name).write_text(text)
            cpu, clock = children(), perf_counter()
            run(commands, python, folder, env)
            spent[job] = children() - cpu, perf_counter() - clock
    return spent


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--here", action="store_true", help="with this Python")
    print("| job | CPU s | elapsed s |\n|---|---|---|")
    for job, (cpu, clock) in main(parser.parse_args().here).items():
        print(f"| {job} | {cpu:.1f} | {clock:.1f} |")
