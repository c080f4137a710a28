"""A function that other processes can call, wherever it was written.

cloudpickle is named here only. It packs a function that the caller gave for the caller's own
workers; nothing is ever loaded from a file.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import cached_property, lru_cache
from types import CodeType
from typing import Any

import cloudpickle

from ..records import digest


class Portable:
    """A function to be called in any process: a notebook's, a script's or a closure by value,
    one of a module by its name.

    Parameters
    ----------
    function : which in this process is called as it is.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function

    @cached_property
    def packed(self) -> bytes:
        """What is sent. Raises whatever the function's own values raise when they are packed."""
        packed: bytes = cloudpickle.dumps(self.function)
        return packed

    @cached_property
    def function(self) -> Callable[..., Any]:
        """The function. Raises whatever its module raises when it is imported."""
        return _loaded(self.packed)

    def __reduce__(self) -> tuple[Callable[[bytes], Portable], tuple[bytes]]:
        return _arrived, (self.packed,)


def _arrived(packed: bytes) -> Portable:
    """In a worker: loaded when it is first needed, where an error can be told."""
    arrived = Portable.__new__(Portable)
    arrived.packed = packed
    return arrived


@lru_cache(maxsize=1)
def _loaded(packed: bytes) -> Callable[..., Any]:
    function: Callable[..., Any] = cloudpickle.loads(packed)
    return function


def identity(function: Callable[..., Any]) -> str:
    """A name of a function by its text and by what it holds, as far as that is plain data."""
    kind: Any = function if hasattr(function, "__qualname__") else type(function)
    code = getattr(function, "__code__", None)
    try:
        text = inspect.getsource(kind)
    except (OSError, TypeError):  # written at a prompt
        text = repr(code and (code.co_code, code.co_names, _constants(code)))
    held = [getattr(function, name, None) for name in ("__dict__", "__defaults__", "func", "args")]
    held += [cell.cell_contents for cell in getattr(function, "__closure__", None) or ()]
    return digest([kind.__module__, kind.__qualname__, text, *map(_plain, held)])


def _constants(code: CodeType) -> list[Any]:
    """Numbers and texts of a code and of those inside it."""
    inside = [_constants(c) for c in code.co_consts if isinstance(c, CodeType)]
    return [repr(c) for c in code.co_consts if not isinstance(c, CodeType)] + inside


def _plain(held: Any) -> str:
    try:
        return digest(held)
    except (TypeError, KeyError):
        return ""
