"""Arguments of public functions and fields of records, checked where they come in.

What kind of value an argument is follows from its annotation; its range, where it has one, from the
table of fields (:mod:`.fields`) or from a rule of its own. Nothing else is written at a function.
"""

from __future__ import annotations

import dataclasses
import inspect
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, partial, wraps
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import ArrayLike

from . import checks
from .checks import Rule, suggestion
from .fields import FIELDS

T = TypeVar("T", bound=Callable[..., Any])
PLAIN: dict[Any, Rule] = {
    float: checks.number,
    int: checks.integer,
    bool: checks.flag,
    str: checks.text,
    ArrayLike: checks.array,
}
"""Annotation to its rule."""


def checked(table: str = "", /, **rules: Rule | str) -> Callable[[T], T]:
    """Check every argument of a function, or every field of a dataclass (below ``@dataclass``).

    Parameters
    ----------
    table : of the scene file whose fields the arguments are.
    rules : argument to the path of its field, by which messages call it if it ends in the
        argument's name; or to a rule where there is no such field, or only some of its values are
        allowed. None is allowed where the annotation says so.
    """

    def of(thing: T) -> T:
        return (_record if inspect.isclass(thing) else _function)(thing, table, rules)

    return of


def _function(call: Any, table: str, rules: Mapping[str, Rule | str]) -> Any:
    signature = inspect.signature(call)

    @cache
    def known() -> dict[str, tuple[str, Rule]]:
        return _rules(call, tuple(signature.parameters), table, rules)

    @wraps(call)
    def with_checks(*args: Any, **kwargs: Any) -> Any:
        given = _bound(signature, call.__name__, args, kwargs)
        given.apply_defaults()
        for name, (field, rule) in known().items():
            given.arguments[name] = rule(field, given.arguments[name])
        return call(*given.args, **given.kwargs)

    return with_checks


def _bound(
    signature: inspect.Signature, name: str, args: tuple[Any, ...], named: dict[str, Any]
) -> inspect.BoundArguments:
    """The arguments of a call; a slip in a name is told what was meant."""
    try:
        return signature.bind(*args, **named)
    except TypeError as error:
        unknown = next((word for word in named if word not in signature.parameters), None)
        raise TypeError(f"{name}() {error}{suggestion(unknown, signature.parameters)}") from None


def _record(kind: Any, table: str, rules: Mapping[str, Rule | str]) -> Any:
    further = kind.__dict__.get("__post_init__")

    @cache
    def known() -> dict[str, tuple[str, Rule]]:
        return _rules(kind, tuple(f.name for f in dataclasses.fields(kind)), table, rules)

    def check(self: Any) -> None:
        for name, (field, rule) in known().items():
            value = getattr(self, name)
            found = rule(field, value)
            if found is not value:
                object.__setattr__(self, name, found)
        if further is not None:
            further(self)

    check.__name__ = "__post_init__"
    kind.__post_init__ = check
    return kind


def _rules(
    thing: Any, names: Sequence[str], table: str, own: Mapping[str, Rule | str]
) -> dict[str, tuple[str, Rule]]:
    """Argument to the name of its field and its rule."""
    hints, found = get_type_hints(thing), {}
    for name in names:
        field = f"{table}.{name}" if table else name
        rule = own.get(name, FIELDS.get(field))
        if isinstance(rule, str):
            field, rule = rule if rule.endswith(f".{name}") else field, FIELDS[rule]
        hint = hints.get(name, Any)
        if rule is None:
            rule = rule_of(hint)
        elif NoneType in get_args(hint):
            rule = _or_none(rule)
        if rule is not None:
            found[name] = field, rule
    return found


def rule_of(hint: Any) -> Rule | None:
    """The rule of an annotation; None where it allows anything."""
    if hint is Any:
        return None
    hint = hint if hint in PLAIN else _meant(hint)
    if hint in PLAIN:
        return PLAIN[hint]
    kind, inside = get_origin(hint) or hint, get_args(hint)
    if kind in (Union, UnionType):
        return _any_of(inside)
    if kind is Literal:
        return partial(checks.choice, allowed=inside)
    if kind in BY_KIND:
        return BY_KIND[kind](inside)
    return checks.instance(kind) if isinstance(kind, type) else None


def _meant(hint: Any) -> Any:
    """What an alias of an annotation stands for: those of numpy are objects from 2.5 on."""
    while (value := getattr(get_origin(hint) or hint, "__value__", hint)) is not hint:
        inside = get_args(hint)
        hint = value[inside] if inside else value
    return hint


def _or_none(rule: Rule) -> Rule:
    return lambda field, value: None if value is None else rule(field, value)


def _tuple(inside: tuple[Any, ...]) -> Rule:
    """Of one kind of values, as many as the annotation says."""
    each = rule_of(inside[0]) or checks.anything
    if inside[1:] == (Ellipsis,):
        return lambda field, value: tuple(checks.items(field, value, each=each))
    if inside == (float, float, float):
        return checks.vector
    if inside == (float, float):
        return checks.pair
    parts = [rule_of(one) or checks.anything for one in inside]

    def rule(field: str, value: Any) -> Any:
        listed = checks.items(field, value, each=checks.anything, count=len(parts))
        return tuple(
            part(f"{field}[{i}]", one)
            for i, (part, one) in enumerate(zip(parts, listed, strict=True))
        )

    return rule


def _array(inside: tuple[Any, ...]) -> Rule:
    """Of the kind of numbers that the annotation says."""
    wanted = get_args(inside[1])[0]
    kinds = {np.floating: "f", np.integer: "iu", np.bool_: "b"}
    return partial(checks.ndarray, kinds=kinds[get_origin(wanted) or wanted])


def _callable(inside: tuple[Any, ...]) -> Rule:
    """Of as many arguments as the annotation says."""
    known = inside and inside[0] is not Ellipsis
    return partial(checks.function, arguments=len(inside[0]) if known else None)


def _items(inside: tuple[Any, ...]) -> Rule:
    return partial(checks.items, each=rule_of(inside[0]) or checks.anything)


BY_KIND: Mapping[Any, Callable[[tuple[Any, ...]], Rule]] = {
    np.ndarray: _array,
    Callable: _callable,
    tuple: _tuple,
    Sequence: _items,
    Iterable: _items,
    Mapping: lambda inside: partial(checks.mapping, each=rule_of(inside[1])),
    Path: lambda inside: checks.path,
    os.PathLike: lambda inside: checks.path,
}
"""Rules of annotations by their kind, from what stands in their brackets."""


ARRAY_LIKE = set(get_args(_meant(ArrayLike)))
"""What numpy takes as an array."""


def _any_of(kinds: tuple[Any, ...]) -> Rule | None:
    """One of several annotations; a wrong value is told the first one's rule."""
    if str in kinds and {Path, os.PathLike} & {get_origin(kind) or kind for kind in kinds}:
        kinds = (Path, *(kind for kind in kinds if kind is NoneType))
    if set(kinds) >= ARRAY_LIKE:
        return _or_none(checks.array)
    rules = [rule_of(kind) for kind in kinds if kind is not NoneType]
    if None in rules:
        return None

    rule = checks.either(*(one for one in rules if one is not None))
    return _or_none(rule) if NoneType in kinds else rule
