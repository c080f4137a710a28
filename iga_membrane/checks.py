"""Checks of user input: each failure names the field, the value, the rule and the remedy."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
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


def record(field: str, value: Any, *kinds: type) -> None:
    """An object of one of some classes."""
    if not isinstance(value, kinds):
        names = " or ".join(kind.__name__ for kind in kinds)
        raise SceneError(f"{field} = {value!r}: must be a {names}, got {type(value).__name__}")


def flag(field: str, value: Any) -> bool:
    """True or false."""
    if not isinstance(value, bool):
        raise SceneError(f"{field} = {value!r}: must be true or false")
    return value


LONGEST_PATH = 10_000
"""Values of a path at most."""


def path_values(field: str, values: Any) -> tuple[float, ...]:
    """Two or more finite numbers, each different from the one before; a path may turn back."""
    if isinstance(values, (str, Mapping)) or not isinstance(values, Iterable):
        raise SceneError(f"{field} = {values!r}: a list of two or more numbers is needed")
    given = list(values)
    if not 2 <= len(given) <= LONGEST_PATH:
        shown = given if len(given) < 2 else f"{len(given)} numbers"
        raise SceneError(
            f"{field} = {shown}: a path needs two or more values, at most {LONGEST_PATH}"
        )
    checked = tuple(number(f"{field}[{i}]", value) for i, value in enumerate(given))
    for i in range(1, len(checked)):
        if checked[i] == checked[i - 1]:
            raise SceneError(f"{field}[{i}] = {checked[i]!r}: the same as the value before it")
    return checked


def suggestion(word: Any, allowed: Iterable[str]) -> str:
    """``; did you mean "..."?`` where a word is close to an allowed one."""
    close = get_close_matches(str(word), list(allowed), 1)
    return f'; did you mean "{close[0]}"?' if close else ""
