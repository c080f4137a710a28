"""Checks of user input: each failure names the field, the value, the rule and the remedy."""

from __future__ import annotations

import math
from collections.abc import Iterable
from difflib import get_close_matches
from numbers import Integral, Real
from typing import Any

from .errors import SceneError


def number(
    field: str,
    value: Any,
    *,
    above: float = -math.inf,
    least: float = -math.inf,
    most: float = math.inf,
    unit: str = "",
) -> float:
    """A finite real number within ``above < value``, ``least <= value <= most``.

    Parameters
    ----------
    field : path of the field as in the scene file, "liquid.volume".
    unit : what the number means, for the message.

    Raises
    ------
    SceneError
    """
    name = field.rsplit(".", 1)[-1]
    rules = [f"> {above:g}"] if above > -math.inf else []
    rules += [f">= {least:g}"] if least > -math.inf else []
    rules += [f"<= {most:g}"] if most < math.inf else []
    rule = f"{name} must be {' and '.join(rules) or 'a number'}, finite" + (
        f" ({unit})" * bool(unit)
    )
    if isinstance(value, str):
        raise SceneError(
            f"{field} = {value!r}: {rule}; text is not read as a number: give it without quotes "
            "and unit, all fields in one consistent set of units"
        )
    if isinstance(value, bool) or not isinstance(value, Real):
        raise SceneError(f"{field} = {value!r}: {rule}; got {type(value).__name__}")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not (math.isfinite(result) and result > above and least <= result <= most):
        raise SceneError(f"{field} = {result!r}: {rule}")
    return result


def integer(field: str, value: Any, *, least: int, most: int) -> int:
    """A whole number within bounds."""
    name = field.rsplit(".", 1)[-1]
    whole = isinstance(value, Integral) and not isinstance(value, bool)
    if not whole or not least <= int(value) <= most:
        raise SceneError(
            f"{field} = {value!r}: {name} must be a whole number from {least} to {most}"
        )
    return int(value)


def vector(field: str, value: Any) -> tuple[float, float, float]:
    """Three finite numbers."""
    if isinstance(value, str) or not isinstance(value, Iterable):
        raise SceneError(f"{field} = {value!r}: three numbers [x, y, z] are needed")
    items = list(value)
    if len(items) != 3:
        raise SceneError(f"{field} = {items!r}: three numbers [x, y, z] are needed")
    x, y, z = (number(f"{field}[{i}]", item) for i, item in enumerate(items))
    return x, y, z


def choice(field: str, value: Any, allowed: Iterable[str]) -> str:
    """One of some words."""
    words = list(allowed)
    if not isinstance(value, str) or value not in words:
        raise SceneError(
            f"{field} = {value!r}: must be one of {', '.join(map(repr, words))}"
            + suggestion(value, words)
        )
    return value


def contact_angle(field: str, value: Any) -> float:
    """Degrees through the liquid, 0 < angle <= 180."""
    return number(field, value, above=0.0, most=180.0, unit="degrees, through the liquid")


def suggestion(word: Any, allowed: Iterable[str]) -> str:
    """``; did you mean "..."?`` where a word is close to an allowed one."""
    close = get_close_matches(str(word), list(allowed), 1)
    return f'; did you mean "{close[0]}"?' if close else ""
