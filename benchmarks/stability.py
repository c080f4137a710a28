"""Stiff and extreme cases: solved, failed by name, or wrong; writes docs/results/stability.md.

Run ``python benchmarks/stability.py``. A cell is wrong if the solve says success
and a measure misses its reference by more than the tolerance of its table.
"""

from __future__ import annotations

import platform
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.reference import cap_on_plane, drop_on_plane
from iga_membrane.splines import points_of
from iga_membrane.surface.ring import axisymmetric, drop_space
from iga_membrane.threads import one_thread

ROOT = Path(__file__).parents[1]
VOLUME = 4.0 * np.pi / 3.0
NAMES = ("height", "contact_radius", "p_base")
COUNTS: Counter[str] = Counter()
LONGEST = 20.0
"""CPU seconds of a solve at most; a longer one is "interrupted"."""


def solved(scene: iga.Scene) -> iga.Solution:
    return iga.solve(scene, iga.SolverOptions(max_cpu_s=LONGEST), on_fail="return")


def judged(found: iga.Solution, exact: dict[str, float] | None, allowed: float,
           names: Sequence[str] = NAMES) -> str:  # fmt: skip
    """A cell: error and iterations, or the named failure, or WRONG."""
    if not found.success:
        COUNTS["failed by name"] += 1
        return f"{found.status.name.lower().replace('_', ' ')}, {found.newton_iterations}"
    if exact is None:
        COUNTS["solved, no reference"] += 1
        return f"solved, {found.newton_iterations}"
    error = max(abs(found.measures[n] / exact[n] - 1.0) for n in names)
    COUNTS["solved" if error <= allowed else "wrong"] += 1
    mark = "" if error <= allowed else "**WRONG** "
    return f"{mark}{error:.0e}, {found.newton_iterations}"


def drop(angle: float, bond: float, **options: object) -> iga.Scene:
    return iga.sessile_droplet(iga.Plane(angle), volume=VOLUME, gravity=bond, **options)


def reference(angle: float, bond: float) -> dict[str, float] | None:
    try:
        return cap_on_plane(angle, VOLUME) if bond == 0 else drop_on_plane(bond, angle, VOLUME)
    except (ValueError, RuntimeError, ArithmeticError):
        return None


def table(first: str, columns: Sequence[object], rows: dict[object, list[str]]) -> list[str]:
    lines = ["| " + " | ".join(map(str, [first, *columns])) + " |"]
    lines.append("|---" * (1 + len(columns)) + "|")
    return [*lines, *("| " + " | ".join([str(k), *cells]) + " |" for k, cells in rows.items())]


ANGLES = (0.5, 1.0, 5.0, 30.0, 60.0, 90.0, 120.0, 150.0, 170.0, 179.0, 179.5, 179.9, 180.0)
BONDS = (0.0, 1e-6, 1e-3, 0.1, 1.0, 10.0, 100.0, 1000.0)


def angles_and_bonds() -> list[str]:
    rows: dict[object, list[str]] = {}
    for angle in ANGLES:
        # the bounds of angles near 0 and 180, and of puddles, are wider
        rows[angle] = []
        for bond in BONDS:
            hard = angle < 5.0 or angle > 179.0 or bond >= 100.0
            try:
                scene = drop(angle, bond)
            except iga.SceneError:
                COUNTS["refused"] += 1
                rows[angle].append("refused")
                continue
            found = solved(scene)
            rows[angle].append(judged(found, reference(angle, bond), 1e-2 if hard else 1e-3))
    return table("angle, Bond number", [f"{b:g}" for b in BONDS], rows)


def conditions() -> list[str]:
    """Condition number of the last Hessian, scaled to a unit diagonal."""
    rows: dict[object, list[str]] = {}
    for degree in (2, 3, 4):
        rows[f"bspline {degree}"] = [_condition("bspline", degree, n) for n in (8, 16, 32)]
    for degree in (1, 2, 3, 4):
        rows[f"lagrange {degree}"] = [_condition("lagrange", degree, n) for n in (8, 16, 32)]
    return table("space, elements", (8, 16, 32), rows)


def _condition(space: str, degree: int, elements: int) -> str:
    mesh = iga.Discretization(space=space, degree=degree, elements=elements)
    scene = drop(150.0, 1.0, discretization=mesh)
    found = solved(scene)
    assembly = Assembly(scene)
    surface = found.surface.moved(scene.units.to_local(found.surface.points))
    motion = assembly.spines.on(surface)
    multipliers = np.array([found.multipliers["volume"] / scene.units.pressure])
    matrix = assembly.system(surface, motion.directions, multipliers).matrix
    full = matrix.dense()
    size = np.sqrt(np.abs(np.diag(full)))
    return f"{np.linalg.cond(full / np.outer(size, size)):.0e}"


def distortions() -> list[str]:
    """Starts whose rings are shifted at random by parts of their distance."""
    rows: dict[object, list[str]] = {}
    for angle in (60.0, 120.0, 165.0):
        exact = reference(angle, 1.0)
        rows[angle] = []
        for part in (0.0, 0.1, 0.3, 0.6):
            scene = drop(angle, 1.0)
            rng = np.random.default_rng(1)
            net = scene.surface.net.copy()
            shift = part * rng.uniform(-1.0, 1.0, net.shape[1] - 3)
            net[:, 1:-2] += shift[:, None] * (net[:, 2:-1] - net[:, 1:-2])
            start = scene.surface.moved(points_of(scene.surface.space, net))
            try:
                found = solved(drop(angle, 1.0, start=start))
            except iga.SceneError:
                COUNTS["refused"] += 1
                rows[angle].append("refused")
                continue
            rows[angle].append(judged(found, exact, 1e-3))
    return table("angle, shift", ("0", "0.1", "0.3", "0.6"), rows)


def aspects() -> list[str]:
    """Rings of few long or many short elements."""
    rows: dict[object, list[str]] = {}
    angle, bond = 120.0, 1.0
    exact = drop_on_plane(bond, angle)
    turn = np.radians(angle)
    radius = (VOLUME / (np.pi * (2 + np.cos(turn)) * (1 - np.cos(turn)) ** 2 / 3)) ** (1 / 3)

    def profile(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        u = turn * (1.0 - t)
        height = radius * (np.cos(u) - np.cos(turn))
        return radius * np.sin(u), height, -radius * turn * np.cos(u)

    base = drop(angle, bond)
    for elements in (8, 32, 128):
        cells = []
        for around in (8, 64, 512):
            space = drop_space("bspline", 3, elements, around=around)
            scene = replace(base, surface=axisymmetric(space, profile), ramp=None)
            cells.append(judged(solved(scene), exact, 1e-3))
        rows[elements] = cells
    return table("elements along, round", (8, 64, 512), rows)


def penalties() -> list[str]:
    rows: dict[object, list[str]] = {}
    exact = drop_on_plane(1.0, 180.0)
    for penalty in (1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9):
        scene = drop(180.0, 1.0, penalty=penalty)
        found = solved(scene)
        # the drop sinks by the pressure over the penalty
        allowed = max(5e-3, 4.0 * exact["p_base"] / penalty)
        cell = judged(found, exact, allowed, ("height", "p_base"))
        depth = found.audit.penetration if found.audit else np.nan
        expected = exact["p_base"] / penalty
        rows[f"{penalty:.0e}"] = [cell, f"{depth:.1e}", f"{expected:.1e}"]
    return table("penalty", ("error, iterations", "depth", "p / penalty"), rows)


def sizes() -> list[str]:
    rows: dict[object, list[str]] = {}
    flat = drop_on_plane(1.0, 180.0)["height"]
    for radius in (0.2, 0.1, 0.05, 0.025):
        solid = iga.SphereLattice(180.0, radius=radius, spacing=4.0 * radius)
        scene = iga.sessile_droplet(solid, volume=VOLUME, gravity=1.0, hold="xy")
        found = solved(scene)
        cell = judged(found, None, 0.0)
        change = found.measures["height"] - flat
        missing = abs(found.contact["support_force"] / VOLUME - 1.0)
        rows[radius] = [cell, str(found.unknowns), f"{found.cpu_seconds['solve']:.2f}",
                        str(found.contact["wet_solids"]), f"{change:.5f}",
                        f"{missing:.0e}"]  # fmt: skip
    names = ("outcome, iterations", "unknowns", "CPU s", "wet", "height over flat",
             "error of the force")  # fmt: skip
    return table("radius (spacing 4 radii)", names, rows)


def load_steps() -> list[str]:
    """The rough droplet along its gravity, in more and more values."""
    rows: dict[object, list[str]] = {}
    tables = {
        "scene": "sessile_droplet",
        "liquid": {"volume": VOLUME},
        "gravity": {"acceleration": 1.0},
        "substrate": {"kind": "sphere_lattice", "radius": 0.1, "spacing": 0.4,
                      "contact_angle": 180.0},
    }  # fmt: skip
    direct = iga.solve(iga.read_scene(tables).scene).measures
    for count in (2, 3, 5, 9):
        values = [float(g) for g in np.linspace(0.5, 1.0, count)]
        path = {"parameter": "gravity.acceleration", "values": values}
        scene = iga.read_scene(tables | {"path": [path]}).scene
        found = solved(scene)
        cell = judged(found, direct, 1e-4, ("height", "p_base", "energy"))
        rows[count] = [cell, str(len(found.load_steps)), f"{found.cpu_seconds['solve']:.2f}"]
    return table("values", ("difference from direct, iterations", "load steps", "CPU s"), rows)


@one_thread
def main() -> None:
    parts = [
        ("Contact angle and Bond number", "Droplet on a plane, default mesh. Allowed: 1e-3; 1e-2 "
         "below 5 and above 179 degrees and from Bond number 100 on. Each cell: largest relative "
         "error of height, contact radius and base pressure, Newton iterations; or the named "
         "failure. At 180 degrees without gravity there is no contact area, and with next to none "
         "a point.", angles_and_bonds),
        ("Condition number", "Last Hessian of the droplet at 150 degrees, Bond number 1, in the "
         "unknowns of the eighth model, scaled to a unit diagonal.", conditions),
        ("Distorted starts", "Droplet on a plane, Bond number 1: every ring of control points but "
         "the rim and the pole is shifted along the meridian by a random part of the distance to "
         "the next. Allowed: 1e-3.", distortions),
        ("Aspect ratio of the elements", "Droplet at 120 degrees, Bond number 1, degree 3, from a "
         "spherical cap: elements up to 70 times as long as wide, either way. Allowed: 1e-3.",
         aspects),
        ("Penalty", "Droplet on a plane at 180 degrees, Bond number 1. Allowed: four times the "
         "pressure over the penalty, at least 5e-3, against the solution without penalty.",
         penalties),
        ("Size of the asperities", "Droplet at 180 degrees, Bond number 1. There is no exact "
         "solution; the last column is the error of the force that the asperities carry, over "
         "the weight.", sizes),
        ("Number of load steps", "Droplet on asperities of radius 0.1 at distances of 0.4, 180 "
         "degrees, along its gravity from 0.5 to 1. Allowed: 1e-4 against the direct solve.",
         load_steps),
    ]  # fmt: skip
    text = []
    for title, what, make in parts:
        print(title, flush=True)
        text += [f"## {title}", "", what, "", *make(), ""]
    counted = ", ".join(f"{n} {name}" for name, n in sorted(COUNTS.items()))
    head = [
        "# Stiff and extreme cases",
        "",
        f"Made by `python benchmarks/stability.py` on {time.strftime('%Y-%m-%d')}"
        f", Python {platform.python_version()}, numpy {np.__version__}, one thread. A cell would "
        "say WRONG if a solve claimed success and missed its reference by more than allowed. "
        f"Solves are interrupted after {LONGEST:g} CPU seconds. In "
        f"all tables: {counted}; wrong: {COUNTS['wrong']}. Stabilization, penalty and load steps "
        "of the paper's formulation stand in [The paper's formulation](paper_method.md).",
        "",
    ]
    (ROOT / "docs/results/stability.md").write_text("\n".join([*head, *text]))


if __name__ == "__main__":
    main()
