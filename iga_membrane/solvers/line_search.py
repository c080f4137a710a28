"""How much of a Newton step is taken: backtracking on an exact merit function."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly, System
from ..surface.surface import Surface
from .direction import Direction


def search(
    assembly: Assembly,
    system: System,
    surface: Surface,
    displacement: Array,
    direction: Direction,
    longest: float,
) -> tuple[float, Surface | None]:
    """Backtrack on ``E - m . c + kappa/2 |c|^2``; the part taken and the new state, or None.

    With the new multipliers m the slope along the Newton step is ``-s^T K s - kappa |c|^2``;
    kappa makes it negative even where K is not.
    """
    start = system.energies
    c, multipliers = system.constraints, direction.multipliers
    along = system.gradient - system.constraint_gradients @ multipliers
    slope = float(along @ direction.step)
    square = float(c @ c)
    kappa = 1.0
    if square > 0 and slope - kappa * square > -abs(slope):
        kappa = 2.0 * abs(slope) / square + 1.0
    slope -= kappa * square
    uphill = (direction.index > 0 and not direction.shift) or not assembly.conservative

    def merit(total: float, missing: Array) -> float:
        return float(total - multipliers @ missing + 0.5 * kappa * missing @ missing)

    begin = merit(start.total, start.constraints)
    noise = 1e-13 * (abs(start.total) + abs(begin))
    lowest = -np.inf
    if assembly.above_plane:
        lowest = -assembly.contact.depth_allowed
    part = longest
    for _ in range(25):
        trial = surface.moved(surface.points + part * displacement)
        energies = assembly.energies(trial)
        value = merit(energies.total, energies.constraints)
        if (
            energies.regular_after(start)
            and energies.lowest >= lowest
            and (uphill or value <= begin + 1e-4 * part * slope + noise)
        ):
            return part, trial
        part *= 0.5
    return 0.0, None
