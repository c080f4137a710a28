"""The result file (JSON)."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .. import __version__
from ..errors import SceneError, StateError
from ..io.scene_file import SCHEMA, read_tables
from ..quantities import DIMENSIONLESS, unit_of
from ..results.forces import ParticleForces
from ..solvers.load_path import LoadStep
from .solution import Solution


def result(solution: Solution) -> dict[str, Any]:
    """The record of a solve by the names of the contract; None where a value is not finite."""
    verdict, system = solution.audit, solution.scene.unit_system
    record = {
        "schema": SCHEMA,
        "version": __version__,
        "scene": dict(solution.scene.description),
        "status": solution.status.name,
        "kind": solution.kind,
        "success": solution.success,
        "message": solution.message,
        "warnings": list(solution.warnings),
        "stability_scope": solution.stability_scope,
        "index": solution.index,
        "lambda_min": solution.lambda_min,
        "bracket": vars(solution.bracket) if solution.bracket else None,
        "unknowns": solution.unknowns,
        "load_steps": len(solution.load_steps),
        "newton_iterations": solution.newton_iterations,
        "cpu_seconds": dict(solution.cpu_seconds),
        "units": system,
        "measures": dict(solution.measures),
        "unit_of": {
            name: unit_of(name, system) or DIMENSIONLESS for name in solution.measures
        },
        "dimensionless": dict(solution.dimensionless),
        "multipliers": dict(solution.multipliers),
        "contact": {
            "asperities": [],
            "touches_base": False,
            **solution.contact,
            "hold_force": list(solution.hold_force),
        },
        "forces": [_forces(found) for found in solution.forces],
        "audit": verdict.defects if verdict else None,
        "volume_error": solution.volume_error,
        "last_good_load": _step(solution.last_good_load),
        "history": [_step(step) for step in solution.load_steps],
        "iterations": [vars(step) for step in solution.iterations],
    }  # fmt: skip
    cleaned: dict[str, Any] = finite(record)
    return cleaned


def result_text(solution: Solution) -> str:
    """JSON text of the result."""
    return json.dumps(result(solution), indent=1, allow_nan=False) + "\n"


def flat(found: Mapping[str, Any]) -> dict[str, Any]:
    """A result as one row of a table: status, measures, numbers without dimensions, and of each
    particle's forces ``F_e_x``, ``F_e_y``, ``F_e_z`` and ``lifts``, numbered if there are several.
    """
    row = {"status": found["status"], "units": found.get("units", DIMENSIONLESS)}
    row |= found["measures"] | found.get("dimensionless", {})
    for k, force in enumerate(found["forces"]):
        mark = f"_{k}" if len(found["forces"]) > 1 else ""
        row |= {f"F_e_{axis}{mark}": v for axis, v in zip("xyz", force["F_e"], strict=True)}
        row[f"lifts{mark}"] = force["lifts"]
    return row


def row(solution: Solution) -> dict[str, Any]:
    """A solution as one row of a table."""
    return flat(result(solution))


def _step(step: LoadStep | None) -> dict[str, Any] | None:
    return None if step is None else vars(step) | {"status": step.status and step.status.name}


def _forces(found: ParticleForces) -> dict[str, Any]:
    """Force vectors of a particle and their parts."""
    parts = {
        "F_G": found.weight,
        "F_CL": found.contact_line,
        "F_H": found.hydrostatic,
        "F_B": found.buoyancy,
        "F_e": found.effective,
        "torque": found.torque,
    }
    vectors: dict[str, Any] = {name: value.tolist() for name, value in parts.items()}
    return vectors | {
        "center": found.center.tolist(),
        "normal": found.normal,
        "tangential": found.tangential,
        "lifts": found.lifts,
        "paper": dict(found.paper),
    }


def finite(value: Any) -> Any:
    """Plain Python values; numbers that JSON cannot hold become None."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    return value


def read_result(path: Path) -> dict[str, Any]:
    """The record in a result file.

    Raises
    ------
    StateError
        Not readable, not a result file, or of another version.
    """
    try:
        record = read_tables(path)
    except SceneError as error:
        raise StateError(str(error)) from error
    kinds = {"status": str, "measures": dict, "dimensionless": dict}
    if not isinstance(record, dict) or any(
        not isinstance(record.get(name), kind) for name, kind in kinds.items()
    ):
        raise StateError(f"{path}: not a result file of iga_membrane")
    if record.get("schema") != SCHEMA:
        raise StateError(
            f"{path}: schema {record.get('schema')!r}, this version reads schema {SCHEMA}: read "
            "the file with the version that wrote it"
        )
    return dict(record)
