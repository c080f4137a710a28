"""Membranes that lie on solids and roll over them while they are iterated."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..surface.surface import Surface

LAG, ROLLS = 1.0, 30
"""Way over the contact length that a droplet's top may roll ahead of its foot before the start
begins anew there, and how often it does."""
ROLL, HELD = 0.5, 0.01
"""Way over the contact length that a droplet may roll in one step: once its foot has taken a full
step, and before; less while it rolls to and fro."""


class Rolling:
    """How far a body may roll in a step, and where its start begins anew.

    Parameters
    ----------
    assembly : whose contact says over which length it changes, infinite where nothing rolls.
    """

    def __init__(self, assembly: Assembly) -> None:
        self._assembly = assembly
        self._steady, self._reach, self._rolled = False, ROLL, 0
        self._way: Array = np.zeros(3)
        self._roll: Array = np.zeros(len(assembly.spines.shifts))

    @property
    def farthest(self) -> float:
        """Way that the shifts may go in the next step."""
        return float((self._reach if self._steady else HELD) * self._assembly.contact.reach)

    def after(self, moved: Surface, step: Array, taken: float) -> tuple[Surface, bool]:
        """The state to go on from after a part of a step (n,), and whether it is the start, carried
        to where the body has rolled."""
        assembly, contact = self._assembly, self._assembly.contact
        self._steady = taken == 1.0
        last, self._roll = self._roll, step[assembly.size - len(self._roll) :]
        back = self._roll @ last < 0.0
        self._reach = max(0.5 * self._reach, HELD) if back else min(1.5 * self._reach, ROLL)
        if not contact.lies:
            return moved, False
        lag = assembly.spines.lag(moved)
        ahead = np.linalg.norm(lag) > LAG * contact.length
        # one that rolls back is near its place
        onward = contact.rounds == 0 and self._rolled < ROLLS and lag @ self._way >= 0.0
        if not (ahead and onward):
            return moved, False
        self._steady, self._rolled, self._way = False, self._rolled + 1, lag
        return assembly.anew(moved), True
