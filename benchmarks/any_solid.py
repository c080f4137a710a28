"""Contact lines inside the membrane on planes, bumps and patches; writes docs/results/any_solid.md.

Run ``python benchmarks/any_solid.py``. The witness is a profile of revolution by shooting
(iga_membrane/reference/revolution.py); times are CPU seconds of the fastest of three solves,
without imports and compilation.
"""

from __future__ import annotations

import platform
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import iga_membrane as iga
from iga_membrane.reference.revolution import drop_on_revolution

ROOT = Path(__file__).parents[1]
VOLUME = 4.0 * np.pi / 3.0
Radial = Callable[[float], float]
NAMES = ("energy", "height", "A_LG", "A_wet")


def bump(height: float, width: float) -> tuple[Radial, Radial]:
    """Height and slope of a Gaussian bump of revolution."""
    return (
        lambda r: height * np.exp(-((r / width) ** 2)),
        lambda r: -2.0 * r / width**2 * height * np.exp(-((r / width) ** 2)),
    )


def even(angle: float) -> Radial:
    return lambda r: float(np.cos(np.radians(angle)))


def radial(inside: float, outside: float, radius: float, border: float) -> Radial:
    one, two = np.cos(np.radians([inside, outside]))
    return lambda r: 0.5 * (one + two) + 0.5 * (one - two) * np.tanh((radius - r) / border)


def row(name: str, solid: iga.Solid, bond: float, exact: dict[str, float], **mesh: int) -> str:
    """A line of a table."""
    scene = iga.sessile_droplet(solid, volume=VOLUME, gravity=bond, hold="xy",
                                contact_line="trimmed",
                                discretization=iga.Discretization(**mesh))  # fmt: skip
    seconds = []
    for _ in range(3):
        begun = time.process_time()
        found = iga.solve(scene, on_fail="return")
        seconds.append(time.process_time() - begun)
    errors = (abs(found.measures[each] / exact[each] - 1.0) for each in NAMES)
    cells = (
        name,
        found.status.name,
        str(found.unknowns),
        str(len(found.iterations)),
        f"{min(seconds):.2f}",
        *(f"{error:.0e}" for error in errors),
    )
    return "| " + " | ".join(cells) + " |"


HEAD = (
    "| scene | status | unknowns | its | CPU s | energy | height | A_LG | A_wet |\n"
    "|---|---|---|---|---|---|---|---|---|"
)


def planes() -> list[str]:
    found = []
    for angle in (20.0, 30.0, 40.0, 60.0, 90.0, 120.0, 150.0):
        for bond in (0.0, 1.0):
            exact = drop_on_revolution(*bump(0.0, 1.0), even(angle), bond, VOLUME, angle)
            name = f"plane, {angle:g} degrees, Bo {bond:g}"
            found.append(row(name, iga.Plane(angle), bond, exact))
    return found


def meshes() -> list[str]:
    exact = drop_on_revolution(*bump(0.0, 1.0), even(100.0), 1.0, VOLUME, 100.0)
    return [
        row(f"degree {p}, {n} elements", iga.Plane(100.0), 1.0, exact, degree=p, elements=n)
        for p, n in ((2, 16), (2, 24), (2, 32), (3, 12), (3, 16), (3, 24))
    ]


def surfaces() -> list[str]:
    found = []
    for h, w, angle, bond in (
        (0.3, 0.6, 120.0, 0.0),
        (0.3, 0.6, 90.0, 1.0),
        (-0.3, 0.6, 100.0, 1.0),
        (0.2, 0.5, 70.0, 0.0),
        (0.4, 1.0, 110.0, 2.0),
        (-0.2, 0.4, 130.0, 0.5),
    ):
        exact = drop_on_revolution(*bump(h, w), even(angle), bond, VOLUME, angle)
        solid = iga.HeightMap.bump(h, w, contact_angle=angle)
        name = f"bump {h:g} high, {w:g} wide, {angle:g} degrees, Bo {bond:g}"
        found.append(row(name, solid, bond, exact))
    for pattern, bond, guess in (((60.0, 120.0, 1.2, 0.1), 0.0, 110.0),
                                 ((60.0, 120.0, 1.2, 0.1), 1.0, 105.0),
                                 ((40.0, 110.0, 1.0, 0.2), 0.0, 100.0),
                                 ((110.0, 70.0, 0.8, 0.15), 0.0, 70.0)):  # fmt: skip
        exact = drop_on_revolution(*bump(0.0, 1.0), radial(*pattern), bond, VOLUME, guess)
        name = "patch of {:g} in {:g} degrees, radius {:g}, border {:g}".format(*pattern)
        found.append(row(f"{name}, Bo {bond:g}", iga.Plane(iga.patch(*pattern)), bond, exact))
    return found


def main() -> None:
    iga.solve(iga.sessile_droplet(iga.Plane(90.0), volume=VOLUME, contact_line="trimmed"))
    lines = [
        "# Contact lines on any solid",
        "",
        f"Made by `python benchmarks/any_solid.py` on {time.strftime('%Y-%m-%d')}, Python "
        f"{platform.python_version()}, numpy {np.__version__}, one thread. Surface tension 1, "
        "volume 4 pi / 3; errors are relative to a profile of revolution by shooting "
        "(`iga_membrane/reference/revolution.py`), CPU seconds those of one solve, stability and "
        "audit included.",
        "",
        "![A droplet on stripes of 60 and 120 degrees](../pictures/textures.png)",
        "",
        "Picture by `python examples/textures.py`.",
        "",
        "## Planes, their lines inside the membrane",
        "",
        HEAD,
        *planes(),
        "",
        "## Meshes (plane, 100 degrees, Bond number 1)",
        "",
        HEAD,
        *meshes(),
        "",
        "## Bumps, dimples and patches, default meshes",
        "",
        HEAD,
        *surfaces(),
        "",
    ]
    (ROOT / "docs" / "results" / "any_solid.md").write_text("\n".join(lines))


if __name__ == "__main__":
    main()
