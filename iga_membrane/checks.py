"""Rules of user input: each failure names the field, the value, what is allowed and the remedy.

A rule is a function of a field's name and its value. It returns the value in the type that the
package computes with, or raises a :class:`.SceneError`.
"""

from __future__ import annotations

import inspect
import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from difflib import get_close_matches
from functools import partial
from numbers import Integral, Real
from pathlib import Path
from reprlib import Repr
from typing import Any

import numpy as np

from .arrays import Array
from .errors import SceneError
from .quantities import Quantity, in_si, parsed

Rule = Callable[[str, Any], Any]
"""Field and value to the value, checked."""

SMALLEST, LARGEST = 1e-75, 1e75
"""Sizes of numbers, in any unit: the product of any four is a double (1e-308 to 1e308)."""
SMALLEST_ANGLE = 1e-3
"""Degrees. Without weight a cap of this angle, 1e-5 of its radius high, is solved to 3e-7; its
balance is rounding then, and with weight 0.003 degrees is the least that is solved."""

_REPR = Repr()
_REPR.maxstring = _REPR.maxother = 80


def shown(value: Any) -> str:
    """A value in one short line."""
    if isinstance(value, np.ndarray) and value.size > 6:
        return f"array of {value.dtype} of shape {value.shape}"
    if isinstance(value, int) and abs(value) > 10**20:
        return f"a whole number of {int(value.bit_length() * math.log10(2.0)) + 1} digits"
    try:
        text = " ".join(_REPR.repr(value).split())
    except Exception:
        text = f"<{type(value).__name__}>"
    return text if len(text) <= 160 else f"{text[:120]}...{text[-30:]}"


def refusal(field: str, value: Any, rule: str, remedy: str = "") -> SceneError:
    """``field = value: rule; remedy``."""
    return SceneError(f"{field} = {shown(value)}: {rule}" + (f"; {remedy}" if remedy else ""))


def number(
    field: str,
    value: Any,
    *,
    above: float = -math.inf,
    least: float = -math.inf,
    most: float = math.inf,
    unit: str = "",
    smallest: float = SMALLEST,
    largest: float = LARGEST,
) -> float:
    """A finite real number within ``above < value``, ``least <= value <= most``.

    Parameters
    ----------
    field : path of the field as in the scene file, "liquid.volume".
    unit : what the number means, for the message.
    smallest, largest : sizes between which it must be, or 0.

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
    try:
        value = in_si(field, value)
    except ValueError as error:
        raise refusal(field, value, rule, str(error)) from None
    result = value if isinstance(value, Quantity) else _float(field, value, rule)
    told = value if math.isinf(result) else result
    if not (math.isfinite(result) and result > above and least <= result <= most):
        raise refusal(field, told, rule, "choose a value within")
    if result and not smallest <= abs(result) <= largest:
        raise refusal(
            field, told, f"{rule}, and 0 or of a size from {smallest:g} to {largest:g}",
            "beyond it double precision has no room for products; choose other units",
        )  # fmt: skip
    return result


def _float(field: str, value: Any, rule: str) -> float:
    """A real number as a double, infinite where it is too large for one."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise refusal(field, value, rule, f"got {type(value).__name__}, give a number")
    try:
        return float(value)
    except OverflowError:
        return math.inf


def anything(field: str, value: Any) -> Any:
    """What is checked elsewhere."""
    return value


def listed(value: Any) -> bool:
    """Whether a value is a list of some kind."""
    single = isinstance(value, (str, bytes, Mapping)) or not getattr(value, "ndim", 1)
    return isinstance(value, Iterable) and not single


def real(field: str, value: Any) -> Any:
    """Any real number, also one that is not finite: what a solve found."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise refusal(field, value, "must be a number", f"got {type(value).__name__}")
    try:
        float(value)
    except OverflowError:
        raise refusal(field, value, "must be a number in double precision") from None
    return value


def integer(field: str, value: Any, *, least: int = -(2**31), most: int = 2**31) -> int:
    """A whole number within bounds."""
    name = field.rsplit(".", 1)[-1]
    whole = isinstance(value, Integral) and not isinstance(value, bool)
    if not whole or not least <= int(value) <= most:
        raise refusal(
            field, value, f"{name} must be a whole number from {least} to {most}", "choose another"
        )
    return int(value)


def vector(
    field: str, value: Any, *, smallest: float = 0.0, largest: float = LARGEST
) -> tuple[float, float, float]:
    """Three finite numbers."""
    x, y, z = numbers_of(field, value, 3, "three numbers [x, y, z]", smallest, largest)
    return x, y, z


def pair(field: str, value: Any) -> tuple[float, float]:
    """Two finite numbers."""
    x, y = numbers_of(field, value, 2, "two numbers [x, y]", 0.0, LARGEST)
    return x, y


def numbers_of(
    field: str, value: Any, count: int, words: str, smallest: float, largest: float
) -> list[float]:
    """Some finite numbers."""
    given = list(value) if listed(value) else []
    if len(given) != count:
        raise refusal(field, value, f"{words} are needed", "give a list of them")
    return [
        number(f"{field}[{i}]", item, smallest=smallest, largest=largest)
        for i, item in enumerate(given)
    ]


def direction(field: str, value: Any) -> tuple[float, float, float]:
    """Three numbers that are not all zero; their size does not matter."""
    found = vector(field, value, largest=math.inf)
    if not any(found):
        raise refusal(field, list(found), "a direction must not be zero", "name one, [0, 0, 1]")
    return found


def choice(field: str, value: Any, allowed: Iterable[str]) -> str:
    """One of some words."""
    words = list(allowed)
    if not isinstance(value, str) or value not in words:
        raise SceneError(
            f"{field} = {shown(value)}: must be one of {', '.join(map(repr, words))}"
            + suggestion(value, words)
        )
    return value


def words(*allowed: str) -> Rule:
    """The rule that a value is one of some words."""
    return partial(choice, allowed=allowed)


def either(*rules: Rule) -> Rule:
    """The rule that a value keeps one of several rules."""
    return partial(first_of, rules=rules)


def first_of(field: str, value: Any, *, rules: Sequence[Rule]) -> Any:
    """What the first rule makes of a value that does not refuse it; a value that all of them refuse
    is told all."""
    errors = []
    for one in rules:
        try:
            return one(field, value)
        except SceneError as error:
            errors.append(str(error))
    first, *others = errors
    raise SceneError(", or ".join([first, *(each.partition(": ")[2] for each in others)]))


def contact_angle(field: str, value: Any) -> float:
    """Degrees through the liquid, 0 < angle <= 180."""
    angle = number(
        field, value, above=0.0, most=180.0, unit="degrees, through the liquid", smallest=0.0
    )
    if angle < SMALLEST_ANGLE:
        raise refusal(
            field, angle, f"contact_angle must be >= {SMALLEST_ANGLE:g} and <= 180 (degrees, "
            "through the liquid)", "below, the liquid is a film that no mesh resolves",
        )  # fmt: skip
    return angle


def wet_angle(field: str, value: Any) -> float:
    """The same, or 0: perfectly wet."""
    angle = number(
        field, value, least=0.0, most=180.0, unit="degrees, through the liquid", smallest=0.0
    )
    return contact_angle(field, angle) if angle else angle


def record(field: str, value: Any, *kinds: type) -> Any:
    """An object of one of some classes."""
    if not isinstance(value, kinds):
        names = " or ".join(kind.__name__ for kind in kinds)
        raise refusal(field, value, f"must be a {names}", f"got {type(value).__name__}")
    return value


def instance(*kinds: type) -> Rule:
    """The rule that a value is an object of one of some classes."""
    return lambda field, value: record(field, value, *kinds)


def flag(field: str, value: Any) -> bool:
    """True or false."""
    if not isinstance(value, (bool, np.bool_)):
        raise refusal(field, value, "must be true or false", f"got {type(value).__name__}")
    return bool(value)


def quantity(field: str, value: Any) -> Quantity:
    """Text of a number with its unit."""
    try:
        return parsed(text(field, value))
    except ValueError as error:
        raise refusal(field, value, *str(error).split("; ", 1)) from None


def text(field: str, value: Any) -> str:
    """Text."""
    if not isinstance(value, str):
        raise refusal(field, value, "must be text", f"got {type(value).__name__}")
    return value


def path(field: str, value: Any) -> Any:
    """Where a file or a folder is."""
    if not isinstance(value, (str, os.PathLike)):
        raise refusal(field, value, "must be a path (str or Path)", f"got {type(value).__name__}")
    if not os.fspath(value) or "\0" in str(os.fspath(value)):
        raise refusal(field, value, "must be the path of a file or a folder", "name one")
    return value


def state_file(field: str, value: Any) -> Any:
    """Where a state file is."""
    path(field, value)
    if Path(value).suffix != ".npz":
        raise refusal(field, str(value), "must be a state file, .npz", "name one")
    return value


def function(field: str, value: Any, *, arguments: int | None = None) -> Any:
    """Something to call, with a number of arguments."""
    if not callable(value):
        raise refusal(field, value, "must be a function", f"got {type(value).__name__}")
    try:
        signature = inspect.signature(value)
        if arguments is not None:
            signature.bind(*[None] * arguments)
    except TypeError as error:
        raise refusal(
            field, value, f"must be a function of {arguments} argument" + "s" * (arguments != 1),
            f"{name_of(value)}{signature} is called in vain: {error}",
        ) from error  # fmt: skip
    except ValueError:
        pass  # some built-in functions have no signature
    return value


def name_of(given: Any) -> str:
    """``module.function`` or ``module.Class`` of something that a user brought."""
    named = given if hasattr(given, "__qualname__") else type(given)
    return f"{named.__module__}.{named.__qualname__}"


def array(field: str, value: Any, *, shape: tuple[int | None, ...] | None = None) -> Array:
    """Finite numbers of a shape; None stands for any length."""
    rule = "must be an array of finite numbers"
    if shape is not None:
        rule += f" of shape ({', '.join('n' if n is None else str(n) for n in shape)})"
    try:
        found = np.asarray(value)
    except ValueError:
        raise refusal(field, value, rule, "got rows of several lengths") from None
    if found.size and found.dtype.kind not in "fiu":
        raise refusal(field, value, rule, f"got {found.dtype}")
    found = found.astype(float, copy=False)
    if shape is not None and not _fits(shape, found.shape):
        raise refusal(field, value, rule, f"got shape {found.shape}")
    bad = np.argwhere(~np.isfinite(found))
    if len(bad):
        place = "".join(f"[{k}]" for k in bad[0])
        raise refusal(f"{field}{place}", float(found[tuple(bad[0])]), rule, "give finite numbers")
    return found


def _fits(wanted: tuple[int | None, ...], shape: tuple[int, ...]) -> bool:
    """Whether a shape is the one that is wanted; None stands for any length."""
    fits = (n in (None, m) for n, m in zip(wanted, shape, strict=False))
    return len(shape) == len(wanted) and all(fits)


def ndarray(
    field: str, value: Any, *, kinds: str = "f", shape: tuple[int | None, ...] | None = None
) -> Any:
    """An array of numpy of some kinds of numbers, as it is: what the package computed.

    Parameters
    ----------
    kinds : of numpy's types: "f" for floats, "iu" for whole numbers.
    shape : of the last axes; None stands for any length.
    """
    if not isinstance(value, (np.ndarray, np.generic)) or value.dtype.kind not in kinds:
        got = getattr(value, "dtype", type(value).__name__)
        raise refusal(field, value, "must be an array of numpy", f"got {got}")
    if shape and not _fits(shape, value.shape[-len(shape) :]):
        told = ", ".join("n" if n is None else str(n) for n in shape)
        raise refusal(field, value, f"must have the axes (..., {told})", f"got {value.shape}")
    return value


def items(field: str, value: Any, *, each: Rule, count: int | None = None, least: int = 0) -> Any:
    """A list of values that keep one rule."""
    how_many = f"{count} values" if count is not None else f"{least} or more values"
    rule = f"a list of {how_many if count or least else 'values'} is needed"
    if not listed(value):
        raise refusal(field, value, rule, f"got {type(value).__name__}")
    found = value if isinstance(value, (list, tuple, np.ndarray)) else list(value)
    if len(found) < least or (count is not None and len(found) != count):
        raise refusal(field, value, rule, f"got {len(found)}")
    if isinstance(found, np.ndarray) and found.dtype == float and found.ndim == 1:
        return array(field, found)
    checked = [each(f"{field}[{i}]", item) for i, item in enumerate(found)]
    return tuple(checked) if isinstance(value, tuple) else checked


def mapping(field: str, value: Any, *, each: Rule | None = None) -> Any:
    """Names with values."""
    if not isinstance(value, Mapping):
        raise refusal(field, value, "must be names with values", f"got {type(value).__name__}")
    if each is None:
        return value
    return {text(f"{field}: name", key): each(f"{field}[{key!r}]", item)
            for key, item in value.items()}  # fmt: skip


def one_or_more(field: str, value: Any, *, each: Rule) -> Any:
    """A value, or a list of values."""
    return items(field, value, each=each, least=1) if listed(value) else each(field, value)


def suggestion(word: Any, allowed: Iterable[str]) -> str:
    """``; did you mean "..."?`` where a word is close to an allowed one."""
    close = get_close_matches(str(word), list(allowed), 1) if isinstance(word, str) else []
    return f'; did you mean "{close[0]}"?' if close else ""


POSITIVE: Rule = partial(number, above=0.0)
NOT_NEGATIVE: Rule = partial(number, least=0.0)
