"""A progress bar on a terminal; elsewhere lines for a log, nothing unless it is asked for."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from math import log10

log = logging.getLogger("iga_membrane.progress")
"""Its lines have the level INFO, so they are shown only where logging is set up to show them."""
iterations = logging.getLogger("iga_membrane.solvers.newton")
"""A line of level DEBUG for every Newton iteration: phase, number, relative residual."""
CONVERGED = 1e-13
"""Relative residual of a solve that has converged, from which the bar's estimate counts."""


@contextmanager
def bar(text: str, total: float = 1.0) -> Iterator[Callable[[float], None]]:
    """Yields what is to be called with the part done.

    On a terminal it is drawn by rich, where that is installed, with the Newton iterations on the
    way; otherwise a line is logged for every tenth of the whole.
    """
    if not (sys.stderr.isatty() and find_spec("rich")):
        yield _lines(text, total)
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as drawn:
        task = drawn.add_task(text, total=total)
        reached = 0.0

        def report(done: float) -> None:
            nonlocal reached
            reached = max(reached, done)
            drawn.update(task, completed=reached)

        def iterated(phase: str, number: int, residual: float) -> None:
            drawn.update(task, description=f"{text}: {phase}, {number}, residual {residual:.0e}")
            if phase == "solve":  # of one load: the digits that are found tell how far it is
                digits = log10(min(max(residual, CONVERGED), 1.0))
                report(total * digits / log10(CONVERGED))

        with _following(iterated):
            yield report


@contextmanager
def _following(iterated: Callable[..., None]) -> Iterator[None]:
    """Call with what is said of every Newton iteration, instead of logging it."""

    class Follower(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            iterated(*record.args)  # type: ignore[misc]

    follower, before = Follower(logging.DEBUG), (iterations.level, iterations.propagate)
    iterations.addHandler(follower)
    iterations.setLevel(logging.DEBUG)
    iterations.propagate = False
    try:
        yield
    finally:
        iterations.removeHandler(follower)
        iterations.level, iterations.propagate = before


def _lines(text: str, total: float) -> Callable[[float], None]:
    logged = 0

    def report(done: float) -> None:
        nonlocal logged
        tenths = int(10.0 * done / total + 1e-9)
        if tenths > logged:
            logged = tenths
            log.info("%s: %d %%", text, 10 * tenths)

    return report
