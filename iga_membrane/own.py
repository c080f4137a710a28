"""What users bring along: laws, solids and terms of their own, and who is to blame.

Shapes are checked at every call, derivatives once, against central differences; a number that is
not finite is noted and told where a solve fails, for on the way a step may be tried where a law
ends, and rejected.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextvars import ContextVar
from typing import Any

import numpy as np

from .arrays import Array
from .checks import name_of, shown
from .deadline import OutOfTime
from .errors import GeometryError, OutputError, SceneError, SolveError, StateError

PACKAGE = __name__.partition(".")[0]
STEPS = 10.0 ** -np.arange(2.0, 8.0)
"""Steps of differences over the length that is asked for: at one of them truncation and rounding
are both below the error that counts, whatever the reach of a law."""
WRONG = 1e-3
"""Relative error of a derivative that is no error of a difference."""
FEW = 0.1
"""Part of the points at which a derivative may jump."""
_COMPLAINTS: ContextVar[dict[str, str] | None] = ContextVar("complaints", default=None)


def is_own(thing: Any) -> bool:
    """Whether the class of something is not of this package."""
    return type(thing).__module__.partition(".")[0] != PACKAGE


def begin() -> None:
    """Forget the complaints of the solve before."""
    _COMPLAINTS.set({})


def complaints() -> str:
    """What was noted of users' functions since the solve began, to be added to a message."""
    return "".join(f"; {text}" for text in (_COMPLAINTS.get() or {}).values())


def note_bad(call: Any, answer: str, values: Array, where: Array, place: str) -> None:
    """Note a function that returned a number that is not finite.

    Parameters
    ----------
    answer : name of what it returned, (...) or (..., k) values.
    where : (...) or (..., 3) what it was asked for, of the name ``place``.
    """
    finite = np.isfinite(values)
    found = _COMPLAINTS.get()
    if finite.all() or found is None or name_of(call) in found:
        return
    first = tuple(np.argwhere(~finite)[0])
    at = np.asarray(where[first[: where.ndim - (place == "point")]]).tolist()
    found[name_of(call)] = (
        f"{name_of(call)} returned {answer} = {float(values[first])!r} at {place} {shown(at)}: it "
        "must be finite wherever the membrane may come"
    )


def called(call: Any, *given: Any) -> Any:
    """What a function of the user's returns; an error in it blames it by its name."""
    try:
        return call(*given)
    except SceneError as error:
        raise SceneError(f"{name_of(call)}({_shown(given)}): {error}") from error
    except (GeometryError, OutputError, StateError, SolveError, OutOfTime, MemoryError):
        raise
    except Exception as error:
        raise SceneError(
            f"{name_of(call)}({_shown(given)}): raised {type(error).__name__}: {error}; mend the "
            "function"
        ) from error


def _shown(given: tuple[Any, ...]) -> str:
    return ", ".join(map(shown, given))


def answer_of(
    call: Any, found: Any, names: Iterable[str], shape: tuple[int, ...], *, finite: bool = True
) -> list[Array]:
    """What a function of the user's returned, or an error that blames it: arrays of one shape.

    Parameters
    ----------
    call : the function, for messages.
    names : of the arrays.
    finite : whether a number that is not is an error.
    """
    told, wanted = name_of(call), list(names)
    if not isinstance(found, (tuple, list)) or len(found) != len(wanted):
        raise SceneError(
            f"{told}: returned {shown(found)}, expected {', '.join(wanted)}: {len(wanted)} arrays "
            f"of shape {shape}"
        )
    arrays = []
    for name, value in zip(wanted, found, strict=True):
        one = np.asarray(value)
        if one.shape != shape or one.dtype.kind not in "fiu":
            raise SceneError(
                f"{told}: {name} has shape {one.shape} and dtype {one.dtype}, expected {shape} and "
                "float64"
            )
        if finite and not np.isfinite(one).all():
            raise SceneError(f"{told}: {name} is not finite; it must be everywhere")
        arrays.append(one.astype(float, copy=False))
    return arrays


def check_slopes(
    call: Any,
    names: tuple[str, str],
    value: Callable[[Array], Array],
    slope: Array,
    length: Array | float,
    least_size: float = 0.0,
) -> None:
    """Compare a derivative that a user's function returned with differences of its values.

    Parameters
    ----------
    names : of the derivative and of the value.
    value : steps (n, ...) to the values there.
    slope : (n, ...) derivative.
    length : (n,) or one, over which values may change.
    least_size : of a derivative, below which errors are not relative any more.

    Raises
    ------
    SceneError
        If they differ at more than a few points.
    """
    if not np.isfinite(slope).all():
        raise SceneError(
            f"{name_of(call)}: {names[0]} is not finite at the start; mend the function"
        )
    wide = tuple(range(1, slope.ndim))
    least: Array = np.full(len(slope), np.inf)
    best = np.zeros_like(slope)
    size = np.abs(slope).max(initial=0.0, axis=wide)
    for h in STEPS:
        step = np.broadcast_to(h * np.asarray(length, float), len(slope))
        after, before = value(step), value(-step)
        column = step.reshape(-1, *[1] * len(wide))
        found = (after - before) / (2.0 * column)
        noise = 1e-13 * np.abs(after).max(axis=wide) / step
        scale = np.maximum(size, np.abs(found).max(axis=wide)).clip(least_size)
        error = np.abs(found - slope).max(axis=wide)
        error = np.where(error <= noise, 0.0, error / np.where(scale > 0.0, scale, 1.0))
        better = error < least
        best[better], least = found[better], np.minimum(error, least)
    wrong = least > WRONG
    if wrong.mean() > FEW:
        k = int(np.argmax(np.where(wrong, np.abs(best - slope).max(axis=wide), -1.0)))
        raise SceneError(
            f"{name_of(call)}: {names[0]} = {shown(slope[k])} is not the derivative of {names[1]}, "
            f"differences give {shown(best[k])} (relative error {least[k]:.1e} at "
            f"{wrong.sum()} of {len(wrong)} points); mend the function"
        )
