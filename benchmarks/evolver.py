"""Surface Evolver's side of the comparison: datafiles, runs, CPU seconds of its process.

Every surface is a quarter between the mirror planes x = 0 and y = 0. A datafile holds a coarse
mesh of rings; the commands refine it and iterate by Evolver's Newton method (``hessian_seek``
first, which is safe, then ``hessian``).
"""

from __future__ import annotations

import resource
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

PROGRAM = shutil.which("evolver-nox-d") or shutil.which("evolver")
"""Double precision, no graphics; None where it is not installed."""
SPOKES = 3
"""Points of a quarter ring."""
MIRRORS = "constraint 1\nformula: x = 0\n\nconstraint 2\nformula: y = 0\n\n"


def rings(
    profile: Sequence[tuple[float, float]], edges: dict[int, str], square: int | None = None
) -> str:
    """Vertices, edges and facets of a quarter surface of revolution, normal outwards.

    Parameters
    ----------
    profile : (r, z) of the rings from the top; r = 0 is a pole.
    edges : number of a ring to the attributes of its points and edges, "constraint 3" or "fixed".
    square : number of a ring that is drawn out to a square of half side r.
    """
    profile = [(float(r), float(z)) for r, z in profile]
    points: list[tuple[float, float, float, str]] = []
    numbers: list[list[int]] = []
    for k, (r, z) in enumerate(profile):
        own = edges.get(k, "")
        if r == 0:
            points.append((0.0, 0.0, z, _attributes(["1", "2"], own)))
            numbers.append([len(points)] * SPOKES)
            continue
        row = []
        for i, phi in enumerate(np.linspace(0.0, 0.5 * np.pi, SPOKES)):
            mirrors = ["2"] if i == 0 else ["1"] if i == SPOKES - 1 else []
            ray = np.array([np.cos(phi), np.sin(phi)])
            reach = r / ray.max() if k == square else r
            x, y = (0.0 if abs(c) < 1e-15 else float(c) for c in reach * ray)
            points.append((x, y, z, _attributes(mirrors, own)))
            row.append(len(points))
        numbers.append(row)
    lines: dict[tuple[int, int], int] = {}
    attributes: list[tuple[int, int, str]] = []

    def edge(a: int, b: int, text: str) -> int:
        if (b, a) in lines:
            return -lines[b, a]
        if (a, b) not in lines:
            lines[a, b] = len(attributes) + 1
            attributes.append((a, b, text))
        return lines[a, b]

    triangles = []
    for k in range(len(profile) - 1):
        for i in range(SPOKES - 1):
            quad = [numbers[k][i], numbers[k + 1][i], numbers[k + 1][i + 1], numbers[k][i + 1]]
            for a, b, c in ((0, 1, 2), (0, 2, 3)):
                corners = quad[a], quad[b], quad[c]
                if len(set(corners)) < 3:
                    continue
                sides = []
                for one, two in zip(corners, corners[1:] + corners[:1], strict=True):
                    sides.append(edge(one, two, _edge_text(one, two, numbers, edges)))
                triangles.append(sides)
    text = "vertices\n"
    text += "".join(f"{n} {x!r} {y!r} {z!r} {a}\n" for n, (x, y, z, a) in enumerate(points, 1))
    text += "\nedges\n"
    text += "".join(f"{n} {a} {b} {t}\n" for n, (a, b, t) in enumerate(attributes, 1))
    text += "\nfaces\n"
    text += "".join(f"{n} {s[0]} {s[1]} {s[2]} tension 1\n" for n, s in enumerate(triangles, 1))
    return text


def _attributes(mirrors: list[str], own: str) -> str:
    if own.startswith("constraint"):
        return "constraints " + " ".join([*mirrors, own.split()[1]])
    return ("constraints " + " ".join(mirrors) if mirrors else "") + (" " + own if own else "")


def _edge_text(a: int, b: int, numbers: list[list[int]], edges: dict[int, str]) -> str:
    for k, row in enumerate(numbers):
        if a in row and b in row and row[0] != row[-1]:
            return edges.get(k, "")
    for i, mirror in ((0, "constraint 2"), (-1, "constraint 1")):
        column = [row[i] for row in numbers]
        if a in column and b in column:
            return mirror
    return ""


def body(volume: float, mesh: str, density: float = 1.0) -> str:
    """The liquid inside a mesh of :func:`rings`."""
    facets = len(mesh.partition("faces\n")[2].splitlines())
    members = " ".join(map(str, range(1, facets + 1)))
    return f"\nbodies\n1 {members} volume {float(volume)!r} density {density!r}\n"


def run(datafile: str, commands: str, values: Sequence[str]) -> tuple[dict[str, float], float]:
    """Values of expressions after the commands, and the CPU seconds of the whole process.

    Raises
    ------
    RuntimeError
        Where a value is missing or not a number: the run went wrong.
    """
    assert PROGRAM is not None
    prints = "".join(f'printf "VALUE {i} %.16g\\n", {v}\n' for i, v in enumerate(values))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.fe"
        path.write_text(datafile)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(
            [PROGRAM, str(path)],
            input=commands + "\n" + prints + "q\nq\n",
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    found = {}
    for line in done.stdout.splitlines():
        at = line.find("VALUE ")
        if at >= 0 and len(line[at:].split()) == 3:
            _, number, value = line[at:].split()
            found[values[int(number)]] = float(value)
    if len(found) < len(values) or not np.isfinite(list(found.values())).all():
        raise RuntimeError(f"Surface Evolver gave {found}:\n{done.stdout[-2000:]}{done.stderr}")
    return found, seconds
