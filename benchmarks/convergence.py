"""Splines against Lagrange elements: errors, unknowns, CPU seconds; writes
docs/results/convergence.md and its pictures.

Run ``python benchmarks/convergence.py``. References are axisymmetric solutions by
two methods that agree to 2.5e-12; for the rough droplet the finest mesh.
"""

from __future__ import annotations

import json
import platform
import time
from pathlib import Path

import numpy as np

import iga_membrane as iga
from iga_membrane.analysis.convergence import Study
from iga_membrane.reference import drop_on_plane

ROOT = Path(__file__).parents[1]
CASES = ROOT / "tests/verification"
VOLUME = 4.0 * np.pi / 3.0
SPLINES = [("bspline", 2), ("bspline", 3), ("bspline", 4)]
SPACES = [*SPLINES, ("lagrange", 1), ("lagrange", 2), ("lagrange", 3), ("lagrange", 4)]
ELEMENTS = (4, 8, 16, 32)
REPEATS = 3
THIRD, HALF = 1.0 / 3.0, 0.5
ROUNDING = 1e-12


def drop(mesh: iga.Discretization) -> iga.Scene:
    return iga.sessile_droplet(iga.Plane(150.0), volume=VOLUME, gravity=1.0, discretization=mesh)


def drop_on_sphere(mesh: iga.Discretization) -> iga.Scene:
    ball = iga.Sphere(120.0, 1.0, (0.0, 0.0, -1.0))
    return iga.sessile_droplet(ball, volume=VOLUME, gravity=0.5, hold="xy", discretization=mesh)


def sheet(mesh: iga.Discretization) -> iga.Scene:
    particle = iga.Sphere(120.0, 1.0, (0.0, 0.0, -1.0))
    return iga.liquid_sheet(particle, size=5.0, boundary="circle", discretization=mesh)


def rough_drop(mesh: iga.Discretization) -> iga.Scene:
    asperities = iga.SphereLattice(180.0, radius=0.05, spacing=0.2)
    return iga.sessile_droplet(
        asperities, volume=VOLUME, gravity=1.0, hold="xy", discretization=mesh
    )


def references() -> dict[str, dict[str, float]]:
    spheres = json.loads((CASES / "drops_on_spheres.json").read_text())
    on_sphere = next(c["values"] for c in spheres
                     if (c["radius"], c["bond"], c["contact_angle"]) == (1, 0.5, 120))  # fmt: skip
    sheets = json.loads((CASES / "sheets_on_particles.json").read_text())
    on_particle = next(c["values"] for c in sheets
                       if [c["params"][k] for k in ("theta_deg", "d", "p", "g", "Rb")]
                       == [120, 0, 0, 0, 2.5])  # fmt: skip
    plane = drop_on_plane(1.0, 150.0)
    return {
        "plane": {name: plane[name] for name in ("energy", "p_base", "height", "contact_radius")},
        "sphere": {name: on_sphere[name] for name in ("energy", "p_top", "alpha_deg")},
        "particle": {name: on_particle[name] for name in ("energy", "phi_deg", "F_CL")},
    }


def at_equal_error(study: Study) -> list[str]:
    """What a spline costs over what the Lagrange space of its degree costs at the same error."""
    rows = ["| degree | measure | error | unknowns | of Lagrange | CPU s | of Lagrange |",
            "|---" * 7 + "|"]  # fmt: skip
    shares: dict[str, list[float]] = {"unknowns": [], "cpu": []}
    dear: list[float] = []
    least = min(run.cost("cpu") for run in study.runs)
    for degree in (2, 3, 4):
        for measure in study.measures:
            for run in study.of("bspline", degree)[1:]:
                error = run.errors[measure]
                if error < ROUNDING:
                    continue
                cells = [degree, measure, f"{error:.0e}"]
                for of, most in (("unknowns", THIRD), ("cpu", HALF)):
                    other = study.cost(error, measure, "lagrange", degree, of)
                    own = run.cost(of)
                    cells.append(f"{own:.0f}" if of == "unknowns" else f"{own:.3f}")
                    if other is None:
                        cells.append("not reached")
                        continue
                    share = own / other
                    shares[of].append(share)
                    if of == "cpu" and other > 4.0 * least:
                        dear.append(share)
                    cells.append(f"{share:.2f}" if share <= most else f"**{share:.2f}**")
                rows.append("| " + " | ".join(map(str, cells)) + " |")
    kept = {of: sum(s <= most for s in shares[of])
            for of, most in (("unknowns", THIRD), ("cpu", HALF))}  # fmt: skip
    note = (
        f"At most a third of the unknowns: {kept['unknowns']} of {len(shares['unknowns'])}. At "
        f"most half the CPU seconds: {kept['cpu']} of {len(shares['cpu'])}. No solve of this scene "
        f"costs less than {least:.3f} s; where the Lagrange space needs more than four times that, "
        f"the shares of the CPU seconds are {min(dear):.2f} to {max(dear):.2f}."
        if dear
        else ""
    )
    return [note, "", *rows]


def section(name: str, title: str, study: Study, text: str) -> list[str]:
    pictures = []
    for against in ("unknowns", "cpu"):
        picture = f"convergence_{name}_{against}.png"
        study.plot(ROOT / "docs/results" / picture, against=against)
        pictures.append(f"![Error of the energy against {against}]({picture})")
    study.save(ROOT / f"docs/results/convergence_{name}.csv")
    return [f"## {title}", "", text, "", " ".join(pictures), "", study.table(), ""]


TITLES = {
    "plane": ("A droplet on a plane", "150 degrees, Bond number 1.", drop),
    "sphere": ("A droplet on a sphere", "Sphere of the drop's radius, 120 degrees, Bond number "
               "0.5.", drop_on_sphere),
    "particle": ("A sheet on a particle", "Circular rim of diameter 5, particle of radius 1, 120 "
                 "degrees.", sheet),
}  # fmt: skip


def main() -> None:
    iga.solve(drop(iga.Discretization()))  # imports are not counted
    text = [
        "# Splines against Lagrange elements",
        "",
        "Made by `python benchmarks/convergence.py` on "
        f"{time.strftime('%Y-%m-%d')}, Python {platform.python_version()}, numpy {np.__version__}, "
        "one thread. Errors are relative; the order in the element size stands in parentheses. "
        f"CPU seconds are medians of {REPEATS} solves from the scene to the result, stability and "
        "audit included. MB is the largest resident size of the process. Every run is the smallest "
        "model that the scene allows (an eighth); the status is that of the solve, whose errors "
        "are of the state it reached. The same numbers stand as comma separated values beside this "
        "page.",
        "",
    ]
    exact = references()
    equal: list[str] = []
    for name, (title, what, scene_of) in TITLES.items():
        study = iga.convergence_study(
            scene_of, spaces=SPACES, elements=ELEMENTS, exact=exact[name], repeats=REPEATS
        )
        text += section(name, title, study, what)
        equal += [f"### {title}", "", *at_equal_error(study), ""]
    fine = iga.solve(rough_drop(iga.Discretization(degree=3, elements=160))).measures
    study = iga.convergence_study(
        rough_drop,
        spaces=SPLINES,
        elements=(48, 64, 90),
        exact={name: fine[name] for name in ("energy", "p_base", "height")},
    )
    text += section(
        "rough", "A droplet on asperities", study,
        "180 degrees, Bond number 1, spheres of radius 0.05 at distances of 0.2. A contact area "
        "needs C1 splines, so there is no Lagrange run; errors are against degree 3 with 160 "
        "elements. The membrane's curvature jumps at the edge of every wet spot, which caps the "
        "order of all degrees.",
    )  # fmt: skip
    text += [
        "## At equal error",
        "",
        "Unknowns and CPU seconds of each spline run over those of the Lagrange space of the same "
        "degree at the same error, interpolated between the logarithms of its runs. Bold: more "
        "than a third of the unknowns, or more than half the CPU seconds. \"not reached\": the "
        "error lies outside the Lagrange runs.",
        "",
        "Where a target is missed, and why:",
        "",
        "- CPU seconds on coarse meshes. Below about 300 unknowns both spaces pay the same for "
        "what does not depend on their number: calls, line search, measures, stability, audit. The "
        "advantage shows where the Lagrange space has a thousand unknowns.",
        "- Degree 2 on the sheet. Its Lagrange energy falls with the sixth power here, with a "
        "constant ten times smaller than that of the splines, and the sign of its error of F_CL "
        "changes between 8 and 16 elements, so one of its runs looks better than its order.",
        "- Degree 2, height of the droplet on a plane: the value of one point converges with the "
        "third power in both spaces, and Lagrange elements have half the error at equal meshes.",
        "- Degree 4: Lagrange elements reach 1e-10 on four elements, where their cost is the least "
        "possible one.",
        "",
        "Tried: the quarter model instead of the eighth, which doubles both sides and changes the "
        "shares by less than 0.15.",
        "",
        *equal,
    ]  # fmt: skip
    (ROOT / "docs/results/convergence.md").write_text("\n".join(text))


if __name__ == "__main__":
    main()
