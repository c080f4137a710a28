"""The CPU limit of a solve, asked for between any two pieces of its work.

It counts the thread of Python that solves, which does all the work (:mod:`.threads`), and nothing
that runs beside it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from math import inf
from time import thread_time

_DEADLINE: ContextVar[float] = ContextVar("deadline", default=inf)


class OutOfTime(Exception):
    """The CPU limit was reached."""

    def __init__(self) -> None:
        super().__init__("the CPU limit was reached")


@contextmanager
def until(deadline: float) -> Iterator[None]:
    """Let :func:`check_time` stop what runs inside at a CPU time (``thread_time``), or before it
    if an earlier one is set already; what begins later than that does not run.

    Raises
    ------
    OutOfTime
    """
    token = _DEADLINE.set(min(deadline, _DEADLINE.get()))
    try:
        check_time()
        yield
    finally:
        _DEADLINE.reset(token)


def check_time() -> None:
    """Stop if there is a deadline and it has passed.

    Raises
    ------
    OutOfTime
    """
    if thread_time() > _DEADLINE.get():
        raise OutOfTime
