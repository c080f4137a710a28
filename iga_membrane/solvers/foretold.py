"""Where a path of equilibria ends, foretold by its smallest eigenvalue.

At a fold the square of the eigenvalue falls linearly to zero, at a bifurcation the eigenvalue
itself, and the states beyond are known, too. Loads on both sides of the place so foretold bracket
it in a few solves, where halving would take a dozen.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

NEARER = 0.1
"""Part of the way to the foretold load that is left: what is foretold from afar is inexact."""
INSIDE, WITHIN = 0.4, 0.9
"""Parts of a sufficient bracket: on either side of the foretold load, and in all at most."""


@dataclass(eq=False)
class Foretold:
    """What is known of the end of a path.

    Attributes
    ----------
    good : loads with stable equilibria, ascending, and their smallest eigenvalues.
    beyond : the least load with an unstable one, and its eigenvalue; or None.
    lost : the least load at which an attempt failed, or None.
    """

    good: list[tuple[float, float]] = field(default_factory=list)
    beyond: tuple[float, float] | None = None
    lost: float | None = None

    def end(self) -> float | None:
        """The load at which the smallest eigenvalue vanishes, or None."""
        if self.beyond is not None:
            return _zero(self.good[-1], self.beyond)
        if len(self.good) < 2:
            return None
        last = [(load, size**2) for load, size in self.good[-3:]]
        fold, crossing = _zero(*last[-2:]), _zero(*self.good[-2:])
        if len(last) == 2 or fold is None or crossing is None:
            return fold
        # the one that was foretold before, too
        off = abs(fold - (_zero(*last[:2]) or np.inf))
        return fold if off <= abs(crossing - (_zero(*self.good[-3:-1]) or np.inf)) else crossing

    def next(self, width: float) -> float | None:
        """The load to try next so that a bracket of a width is found soon, or None where nothing is
        foretold between the last good load and the first lost one."""
        end = self.end()
        if end is None or self.lost is None or not self.good[-1][0] < end <= self.lost:
            return None
        last = self.good[-1][0]
        load = end - max(INSIDE * width, NEARER * (end - last))
        if load - last <= INSIDE * width:
            load = min(last + WITHIN * width, end + INSIDE * width)
        return load if load < self.lost else 0.5 * (last + self.lost)

    def reached(self, load: float) -> None:
        """Forget an end that has been passed."""
        if self.lost is not None and load >= self.lost:
            self.good, self.beyond, self.lost = [], None, None


def _zero(one: tuple[float, float], two: tuple[float, float]) -> float | None:
    """Where a value that falls from one load to another vanishes by a straight line, or None."""
    (first, high), (second, low) = one, two
    return second + low * (second - first) / (high - low) if high > low else None
