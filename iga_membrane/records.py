"""Records of this package as plain data, and back: dataclasses, arrays, numbers, text.

Nothing is executed: a record is built by the constructor of a dataclass of this package, which
checks its fields. Functions are not kept; what stands in their place refuses to be called.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from importlib import import_module
from typing import Any

import numpy as np

from .arrays import Array
from .errors import SceneError
from .quantities import Quantity

_PACKAGE = __name__.rpartition(".")[0]


def encode(value: Any, arrays: dict[str, Array]) -> Any:
    """What JSON can hold; arrays are put aside, equal ones once.

    Parameters
    ----------
    arrays : filled with them, by the names that stand in their places.
    """
    if isinstance(value, Enum):
        return {"enum": _name(type(value)), "value": value.name}
    if isinstance(value, Quantity):
        return {"quantity": [float(value), value.dimension]}
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.generic):
        return encode(value.item(), arrays)
    if isinstance(value, complex):
        return {"complex": [value.real, value.imag]}
    if isinstance(value, np.ndarray):
        return _put_aside(value, arrays)
    if isinstance(value, (Mapping, tuple, list)):
        return _several(value, arrays)
    if is_dataclass(value) and not isinstance(value, type):
        kept = [f.name for f in fields(value) if f.init and f.metadata.get("kept", True)]
        inside = {name: encode(getattr(value, name), arrays) for name in kept}
        return {"record": _name(type(value)), "fields": inside}
    if callable(value):
        return {"function": getattr(value, "__qualname__", type(value).__name__)}
    raise TypeError(f"a {type(value).__name__} cannot be kept in a file")


def _several(value: Any, arrays: dict[str, Array]) -> Any:
    """A mapping, a tuple or a list."""
    if isinstance(value, Mapping):
        return {"map": [[str(key), encode(item, arrays)] for key, item in value.items()]}
    items = [encode(item, arrays) for item in value]
    return {"tuple": items} if isinstance(value, tuple) else items


def _put_aside(value: Array, arrays: dict[str, Array]) -> dict[str, str]:
    """The mark of an array, which is kept by it."""
    kind = {"f": float, "i": np.int64, "u": np.int64, "b": bool}[value.dtype.kind]
    kept = np.ascontiguousarray(value, kind).reshape(value.shape)
    mark = f"{kept.dtype.str}{kept.shape}".encode()
    name = "a" + hashlib.sha256(mark + kept.tobytes()).hexdigest()[:32]
    arrays[name] = kept
    return {"array": name}


def decode(tree: Any, arrays: Mapping[str, Array], also: Sequence[type] = ()) -> Any:
    """The value that was encoded.

    Parameters
    ----------
    also : dataclasses from outside of this package that may be built.

    Raises
    ------
    ValueError
        Anything that :func:`encode` does not write.
    """

    def items_of(tree: list[Any]) -> list[Any]:
        return [decode(item, arrays, also) for item in tree]

    def table_of(pairs: Any) -> dict[str, Any]:
        return {str(key): decode(item, arrays, also) for key, item in pairs}

    if isinstance(tree, list):
        return items_of(tree)
    if not isinstance(tree, dict):
        return tree
    if tree.keys() == {"array"} and tree["array"] not in arrays:
        raise ValueError(f"array {tree['array']} is missing")
    match tree:
        case {"array": str(name)}:
            return arrays[name]
        case {"complex": [float(real), float(imaginary)]}:
            return complex(real, imaginary)
        case {"quantity": [float(size), str(dimension)]}:
            return Quantity(size, dimension)
        case {"map": list(items)}:
            return table_of(items)
        case {"tuple": list(items)}:
            return tuple(items_of(items))
        case {"enum": str(kind), "value": str(name)}:
            return _enum(kind)[name]
        case {"record": str(kind), "fields": dict(inside)}:
            return _record(kind, also)(**table_of(inside.items()))
        case {"function": str(name)}:
            return _Lost(name)
    raise ValueError(f"no record: {list(tree)[:3]}")


def digest(value: Any) -> str:
    """A name of a value by its content; functions count by their names only."""
    arrays: dict[str, Array] = {}
    text = json.dumps(encode(value, arrays), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


class _Lost:
    """Stands where a function was."""

    def __init__(self, name: str) -> None:
        self.__qualname__ = name

    def __call__(self, *arguments: Any) -> Any:
        raise SceneError(
            f"{self.__qualname__}: a state file keeps no functions; build the scene anew to solve "
            "it in this way"
        )


def _name(kind: type) -> str:
    """``terms.tension.SurfaceTension``; a class from outside by its whole name."""
    return f"{kind.__module__}.{kind.__qualname__}".removeprefix(f"{_PACKAGE}.")


def _found(name: str) -> Any:
    """A class of this package by its name, where it is defined."""
    if not re.fullmatch(r"[a-z_]+(\.[a-z_]+)*\.[A-Za-z]+", name):
        raise ValueError(f"{name!r} is no record of this package")
    module, _, kind = name.rpartition(".")
    try:
        found = getattr(import_module(f"{_PACKAGE}.{module}"), kind)
    except (ImportError, AttributeError) as error:
        raise ValueError(f"{name!r} is not known to this version") from error
    if not isinstance(found, type) or _name(found) != name:
        raise ValueError(f"{name!r} is no record of this package")
    return found


def _record(name: str, also: Sequence[type]) -> Any:
    for kind in also:
        if _name(kind) == name:
            return kind
    found = _found(name)
    if not is_dataclass(found):
        raise ValueError(f"{name!r} is no record")
    return found


def _enum(name: str) -> Any:
    found = _found(name)
    if not issubclass(found, Enum):
        raise ValueError(f"{name!r} is no enumeration")
    return found
