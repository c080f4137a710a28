"""Droplets and liquid sheets as C1 spline membranes: static wetting and self-cleaning.

Names are loaded on first use, so ``import iga_membrane`` costs next to nothing.
"""

from __future__ import annotations

from typing import Any

from .lazy import part

__version__ = "0.1.0"

_HOME = {
    "errors": ("GeometryError", "OutputError", "SceneError", "SolveError", "StateError"),
    "units": ("si",),
    "progress": ("progress_bar",),
    "splines": ("Basis", "Grading", "Space", "Table", "bspline_basis", "close_pole",
                "lagrange_basis", "line_basis", "open_knots", "periodic_basis", "ring_basis",
                "tensor_space"),
    "surface.surface": ("Surface",),
    "surface.kinematics": ("Kinematics",),
    "surface.shapes": ("cap", "cylinder", "disc", "sheet", "sphere"),
    "surface.ring": ("axisymmetric", "drop_space", "ring_space"),
    "surface.refine": ("elevated", "refined"),
    "surface.exchange": ("from_geomdl", "to_geomdl"),
    "dofs.boundary_conditions": ("Fixed", "Joint", "Mirror", "Sector", "Sliding", "Symmetry"),
    "dofs.spines": ("Motion", "Spines"),
    "solids": ("Nearest", "Plane", "Solid", "Sphere", "SphereLattice", "Spheres"),
    "solids.cylinder": ("Cylinder",),
    "solids.disc": ("Disc",),
    "solids.hysteresis": ("Hysteresis",),
    "solids.height_map": ("HeightMap",),
    "solids.wettability": ("Wettability", "patch", "stripes"),
    "terms": ("Centroid", "GapTerm", "Gravity", "PlaneContactLine", "Pressure", "Scale",
              "SphereContactLine", "Stabilization", "SurfaceTension",
              "Volume"),
    "initial.liquid": ("Discretization", "Liquid"),
    "problems.scene": ("Scene",),
    "problems.droplet": ("sessile_droplet",),
    "problems.cell": ("asperity_cell",),
    "problems.capillary_bridge": ("capillary_bridge",),
    "problems.film": ("film_between_rings",),
    "problems.sheet": ("liquid_sheet",),
    "problems.osman_sauer": ("WholeMembrane",),
    "io.scene_file": ("load_scene", "read_scene"),
    "io.schema": ("scene_schema",),
    "solvers.options": ("SolverOptions",),
    "status": ("Status",),
    "driver.solution": ("Solution",),
    "driver.linearize": ("linearize",),
    "driver.evolve": ("evolve",),
    "driver.solve": ("solve",),
    "driver.state": ("load",),
    "driver.trace": ("Path", "trace"),
    "results.contact_line": ("contact_line",),
    "verification.derivatives": ("Derivatives", "check_derivatives"),
    "analysis.convergence": ("Study", "convergence_study"),
    "analysis.critical": ("Crossing", "critical_value"),
    "analysis.pull_off": ("PullOff", "pull_off"),
    "analysis.self_cleaning": ("SelfCleaning", "Verdict", "self_cleaning"),
    "analysis.sweep": ("Sweep", "sweep"),
    "photograph.silhouette": ("silhouette",),
    "photograph.fit": ("fit_profile",),
    "view.picture": ("plot",),
    "view.overlay": ("plot_fit",),
    "view.section": ("plot_section",),
    "view.goniometer": ("plot_side",),
    "view.animation": ("animate",),
    "view.diagrams": ("plot_curves", "plot_phases"),
    "driver.lines": ("contact_lines",),
    "view.export": ("save", "writer"),
}  # fmt: skip
_MODULE = {name: module for module, names in _HOME.items() for name in names}

__all__ = ["__version__", *sorted(_MODULE)]


def __getattr__(name: str) -> Any:
    if name not in _MODULE:
        from difflib import get_close_matches

        close = get_close_matches(name, _MODULE, 1)
        hint = f"; did you mean {close[0]!r}?" if close else ""
        raise AttributeError(f"module 'iga_membrane' has no attribute {name!r}{hint}")
    value = part(_MODULE[name], name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
