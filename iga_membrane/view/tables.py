"""Contact lines, forces and fields of a solution as rows of named values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..driver.lines import contact_lines
from ..optional import optional
from ..solids import Sphere
from ..tables import Row
from .fields import FIELDS, field

if TYPE_CHECKING:
    from ..driver.solution import Solution


def line_rows(solution: Solution) -> list[Row]:
    """One row for each point of each contact line.

    Columns: number of the solid, position, unit tangent, unit conormal (out of the membrane),
    contact angle (degrees), length of arc that belongs to the point.
    """
    rows: list[Row] = []
    for each in contact_lines(solution):
        line = each.line
        vectors = {"": line.position, "tangent_": line.tangent, "conormal_": line.conormal}
        for k in range(len(line.arc)):
            row: dict[str, Any] = {"solid": each.solid, "units": solution.scene.unit_system}
            for name, values in vectors.items():
                row |= _xyz(name, values[k])
            angle = float(np.degrees(line.angle[k]))
            rows.append(row | {"contact_angle": angle, "arc": float(line.arc[k])})
    return rows


def force_rows(solution: Solution) -> list[Row]:
    """One row for each particle, asperity and for the substrate as a whole.

    Columns: what it is and its number, centre, force on it in world axes (of a particle F_e with
    its parts), wet area, contact angle (degrees). That of the substrate is along its normal.
    """
    rows: list[Row] = []
    scene, contact = solution.scene, solution.contact
    particles = scene.particles or [s for s in (scene.substrate,) if isinstance(s, Sphere)]
    for k, forces in enumerate(solution.forces):
        parts = {"F": forces.effective, "F_G": forces.weight, "F_CL": forces.contact_line,
                 "F_H": forces.hydrostatic, "F_B": forces.buoyancy}  # fmt: skip
        row: dict[str, Any] = {"solid": "particle", "number": k}
        row |= _xyz("", particles[k].center)
        for name, force in parts.items():
            row |= _xyz(f"{name}_", force)
        rows.append(row)
    for asperity in contact.get("asperities", ()):
        row = {"solid": "asperity", "number": asperity["index"]}
        row |= _xyz("", asperity["center"]) | _xyz("F_", asperity["force_vector"])
        row |= {name: asperity[name] for name in ("wet_area", "contact_angle")}
        rows.append(row)
    if "support_force" in contact and scene.kind != "liquid_sheet":
        force = -contact["support_force"] * scene.units.axes[:, 2]
        rows.append(
            {"solid": "substrate", **_xyz("F_", force), "wet_area": float(contact["wet_area"])}
        )
    return [{**row, "units": scene.unit_system} for row in rows]


def field_dataset(solution: Solution, resolution: int) -> Any:
    """``xarray.Dataset`` of position and fields on a regular grid of the parameters.

    Raises
    ------
    OutputError
        If xarray is not installed.
    """
    xarray = optional("xarray", "to_xarray", "tables")
    one, two = solution.surface.space.bases
    # the middles of equal intervals keep away from poles, where there is no normal
    middles = (np.arange(resolution) + 0.5) / resolution
    s, t = (b.breaks[0] + (b.breaks[-1] - b.breaks[0]) * middles for b in (one, two))
    at = solution.surface.at(np.stack(np.meshgrid(s, t, indexing="ij"), axis=-1))
    plane = ("xi1", "xi2")
    values = {name: (plane, field(solution, name, at)) for name in FIELDS}
    vectors = {"position": at.position, "normal": at.normal}
    return xarray.Dataset(
        values | {name: ((*plane, "axis"), vector) for name, vector in vectors.items()},
        coords={"xi1": s, "xi2": t, "axis": ["x", "y", "z"]},
        attrs={
            "status": solution.status.name,
            "units": solution.scene.unit_system,
            **_plain(solution.measures),
        },
    )


def _plain(measures: Mapping[str, float | None]) -> dict[str, float]:
    """Numbers, NaN where there is none."""
    return {name: np.nan if value is None else value for name, value in measures.items()}


def _xyz(name: str, vector: Iterable[float]) -> dict[str, float]:
    return {f"{name}{axis}": float(v) + 0.0 for axis, v in zip("xyz", vector, strict=True)}
