"""Contact lines inside the membrane and the ties across cut elements, by rows of the motion."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ..arrays import Array
from ..dofs.dof_map import FirstOrder, Rows
from ..linalg.bordered import Matrix
from ..terms import BodyDensity
from ..terms.trimmed import Line, end_hessian, line_forces, line_hessian
from .ghost_penalty import Ties


class Cut(Protocol):
    """What is asked of a membrane that its solids cut."""

    ties: Ties

    def on_line(self, points: Array) -> Line: ...

    def on_ends(self, points: Array) -> Line: ...


def add_forces(
    total: FirstOrder,
    trim: Cut,
    points: Array,
    tension: float,
    body: BodyDensity,
    held: list[BodyDensity],
) -> None:
    """Add what acts on the lines and across the ties; unknowns that are idle feel no force."""
    inner = trim.on_line(points)
    functions = inner.table.functions
    total.add(line_forces(inner, tension, body), functions)
    for k, density in enumerate(held):
        total.constrain(k, line_forces(inner, 0.0, density), functions)
    total.add_unjudged(tension * trim.ties.forces(points), trim.ties.across[0])
    total.gradient[trim.ties.idle], total.columns[trim.ties.idle] = 0.0, 0.0


def add_hessian(
    matrix: Matrix,
    rows: Rows,
    trim: Cut,
    points: Array,
    directions: Array,
    tension: float,
    body: BodyDensity,
) -> None:
    """Add second derivatives of the lines and of the ties, and a unit for idle unknowns."""
    for at, second in (
        (trim.on_line(points), line_hessian),
        (trim.on_ends(points), end_hessian),
    ):
        functions = at.table.functions
        blocks = second(at, tension, body, directions[functions])
        matrix.add(rows.unknowns(functions), blocks)
    ties = trim.ties
    matrix.add(rows.unknowns(ties.across[0]), tension * ties.hessian(directions))
    matrix.add(ties.idle[:, None], np.full((len(ties.idle), 1, 1), tension))
