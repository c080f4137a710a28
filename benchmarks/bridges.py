"""Capillary bridges against known values and published fits; writes docs/results/bridges.md.

Run ``python benchmarks/bridges.py``: about two minutes.
"""

from __future__ import annotations

import platform
import sys
import time
from pathlib import Path

import numpy as np

import iga_membrane as iga
from iga_membrane.reference import bridge_between

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "examples"))

import capillary_bridge as example  # noqa: E402

PLANE = np.inf
CASES = [
    ((PLANE, PLANE), (110.0, 60.0), 0.6, 1.0, 0.0),
    ((PLANE, PLANE), (40.0, 70.0), 0.3, 1.0, 0.5),
    ((PLANE, PLANE), (30.0, 30.0), 1e-3, 1e-3, 0.0),
    ((PLANE, PLANE), (150.0, 160.0), 0.5, 1.0, 0.0),
    ((PLANE, PLANE), (0.0, 30.0), 0.3, 0.5, 0.0),
    ((1.0, 1.0), (60.0, 60.0), 0.1, 0.2, 0.0),
    ((1.0, 2.0), (20.0, 70.0), 0.1, 0.2, 0.0),
    ((PLANE, 1.0), (60.0, 60.0), 0.1, 0.2, 0.0),
    ((1.0, PLANE), (60.0, 80.0), 0.2, 0.5, 0.7),
]
VOLUMES, ANGLES = (1e-4, 1e-3, 1e-2, 0.1), (5.0, 20.0, 40.0)


def solid(radius: float, angle: float) -> iga.Plane | iga.Sphere:
    return iga.Plane(angle) if np.isinf(radius) else iga.Sphere(angle, radius)


def against_the_witness() -> list[str]:
    rows = [
        "| solids | angles | gap | volume | Bond number | force | its error | pressure | "
        "its error | neck radius | CPU s |",
        "|---" * 11 + "|",
    ]
    for radii, angles, gap, volume, bond in CASES:
        exact = bridge_between(radii, angles, gap, volume, bond)
        scene = iga.capillary_bridge(
            *map(solid, radii, angles), gap=gap, volume=volume, gravity=bond
        )
        found = iga.solve(scene)
        m = found.measures
        names = " and ".join("plane" if np.isinf(r) else f"sphere {r:g}" for r in radii)
        errors = [abs(m[n] - getattr(exact, n)) / abs(getattr(exact, n)) for n in
                  ("force", "pressure")]  # fmt: skip
        rows.append(
            f"| {names} | {angles[0]:g}, {angles[1]:g} | {gap:g} | {volume:g} | {bond:g} | "
            f"{m['force']:.7g} | {errors[0]:.0e} | {m['pressure']:.7g} | {errors[1]:.0e} | "
            f"{m['neck_radius']:.6g} | {found.cpu_seconds['solve']:.2f} |"
        )
    return rows


def known_values() -> list[str]:
    rows = ["| what | known | found |", "|---|---|---|"]
    ball = iga.capillary_bridge(
        iga.Disc(radius=0.5), iga.Plane(150.0), gap=1.7320508, volume=4.0810486
    )
    force = iga.solve(ball).measures["force"]
    rows.append(
        f"| force of a ball between a disc of 0.5 and a plate of 150 degrees | 0 | {force:.1e} |"
    )

    def cylinder(gap: float) -> iga.Scene:
        return iga.capillary_bridge(iga.Plane(90.0), iga.Plane(90.0), gap=gap, volume=np.pi**2)

    path = iga.trace(cylinder, [2.5, 3.3], parameter="gap.distance", on_fail="return")
    rows.append(f"| gap at which a cylinder of volume pi^2 gives way | 3.14159 | {told(path)} |")

    def hanging(volume: float) -> iga.Scene:
        return iga.sessile_droplet(iga.Plane(60.0), volume=volume, gravity=[0.0, 0.0, 1.0])

    path = iga.trace(hanging, [5.0, 7.5, 9.0], parameter="liquid.volume", on_fail="return")
    rows.append(f"| largest drop under a ceiling of 60 degrees | 8.00379 | {told(path)} |")
    return rows


def told(path: iga.Path) -> str:
    return f"{path.bracket.lo:.5f} to {path.bracket.hi:.5f}"


def against_fits() -> list[str]:
    rows = [
        "| volume | angle | force at contact: ours | Willett | half way to rupture: ours | "
        "Willett | rupture: ours | Lian |",
        "|---" * 8 + "|",
    ]
    for volume in VOLUMES:
        for angle in ANGLES:
            ball, end = iga.Sphere(angle, 1.0), example.lian(volume, angle)
            near, half = 0.01 * end, 0.5 * end
            one = example.curve((ball, ball), [near, half, 1.3 * end], volume)
            forces = [
                f"{one.forces[k]:.4f} | {example.willett(gap, volume, angle):.4f}"
                for k, gap in enumerate((near, half))
            ]
            ruptures = "none found" if one.rupture is None else f"{one.rupture[0]:.5f}"
            rows.append(
                f"| {volume:g} | {angle:g} | {' | '.join(forces)} | {ruptures} | {end:.5f} |"
            )
    return rows


def main() -> None:
    lines = [
        "# Capillary bridges",
        "",
        f"Made by `python benchmarks/bridges.py` on {time.strftime('%Y-%m-%d')}, Python "
        f"{platform.python_version()}, numpy {np.__version__}, one thread. Default meshes (120 "
        "unknowns), tension 1. The force is that on the upper solid, positive = attraction; CPU "
        "seconds are those of the solve.",
        "",
        "## Against an independent axisymmetric solution",
        "",
        "Young and Laplace by Chebyshev collocation (`iga_membrane.reference.bridge_between`).",
        "",
        *against_the_witness(),
        "",
        "## Known values",
        "",
        *known_values(),
        "",
        "## Published fits for equal unit spheres",
        "",
        "Willett's closed form of the force (4 % by its authors) and Lian's rupture distance, "
        "`(1 + theta / 2) V^(1/3)`, are fits to numerical solutions; ours is the largest gap with "
        "a stable bridge, bracketed to 1e-3. "
        "A whole curve by `python examples/capillary_bridge.py`.",
        "",
        *against_fits(),
        "",
    ]
    (ROOT / "docs/results/bridges.md").write_text("\n".join(lines))


if __name__ == "__main__":
    main()
