"""Critical values: where a measure of the equilibrium changes sign along a parameter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from scipy.optimize import brentq

from ..arguments import checked
from ..checks import name_of, number, record
from ..driver.solution import Solution
from ..driver.solve import solve
from ..errors import SceneError
from ..own import called
from ..problems.scene import Scene
from ..solvers.options import SolverOptions


@dataclass(frozen=True)
@checked()
class Crossing:
    """Where a measure vanishes.

    Attributes
    ----------
    value : of the parameter; solution : the equilibrium there.
    rising : whether the measure grows with the parameter.
    """

    value: float
    rising: bool
    solution: Solution = field(repr=False)


@checked(tolerance=partial(number, least=1e-14, most=1.0))
def critical_value(
    scene_at: Callable[[float], Scene],
    measure: Callable[[Solution], float],
    low: float,
    high: float,
    *,
    tolerance: float = 1e-9,
    options: SolverOptions | None = None,
) -> Crossing:
    """Find where a measure changes sign, by bracketed root finding (Brent) over solves.

    Parameters
    ----------
    scene_at : value of the parameter to a scene.
    measure : of its solution, ``lambda s: s.forces[0].effective[2]``.
    low, high : values between which the measure changes sign.
    tolerance : of the parameter, relative to ``high - low``.
    options : of each solve.

    Raises
    ------
    SceneError
        If the measure has one sign at both ends; the message gives its values.
    SolveError
        If a scene in between has no stable equilibrium.
    """
    number("high", high, above=low)
    solutions: dict[float, Solution] = {}

    def at(value: float) -> float:
        solutions[value] = solve(
            record(f"scene_at({value:g})", called(scene_at, value), Scene), options
        )
        return number(
            f"{name_of(measure)}(solution)", called(measure, solutions[value]), smallest=0.0
        )

    ends = at(low), at(high)
    if ends[0] * ends[1] > 0:
        raise SceneError(
            f"low, high = {low:g}, {high:g}: the measure has one sign there ({ends[0]:.6g}, "
            f"{ends[1]:.6g}); give values between which it changes sign"
        )
    value = float(brentq(at, low, high, xtol=tolerance * (high - low)))
    if value not in solutions:
        at(value)
    return Crossing(value, ends[1] > ends[0], solutions[value])
