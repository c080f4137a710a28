"""A progress bar on a terminal or in a notebook; elsewhere lines for a log, or nothing."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from html import escape
from importlib import import_module
from importlib.util import find_spec
from math import log10
from typing import Any

from .arguments import checked
from .checks import POSITIVE

log = logging.getLogger("iga_membrane.progress")
"""Its lines have the level INFO, so they are shown only where logging is set up to show them."""
iterations = logging.getLogger("iga_membrane.solvers.newton")
"""A line of level DEBUG for every Newton iteration: phase, number, relative residual."""
CONVERGED = 1e-13
"""Relative residual of a solve that has converged, from which the bar's estimate counts."""


@contextmanager
@checked(total=POSITIVE)
def progress_bar(text: str, total: float = 1.0) -> Iterator[Callable[[float], None]]:
    """Show how far a solve, a path or a sweep is, on a terminal or in a notebook.

    Parameters
    ----------
    text : what is going on.
    total : what there is to do; of a solve or a path 1, its whole load.

    Yields
    ------
    Callable
        To be called with the part done: the ``report`` of :func:`iga_membrane.solve` and
        :func:`iga_membrane.trace`. Newton iterations are shown by themselves. Where there is
        neither a terminal nor a notebook a line is logged for every tenth of the whole
        (``iga_membrane.progress``, level INFO).
    """
    shows = _in_notebook() or _on_terminal()
    if shows is None:
        yield _lines(text, total)
        return
    with shows(text, total) as show:
        reached = 0.0

        def report(done: float) -> None:
            nonlocal reached
            reached = max(reached, done)
            show(reached, "")

        def iterated(phase: str, number: int, residual: float) -> None:
            show(reached, f": {phase}, {number}, residual {residual:.0e}")
            if phase == "solve":  # of one load: the digits that are found tell how far it is
                digits = log10(min(max(residual, CONVERGED), 1.0))
                report(total * digits / log10(CONVERGED))

        with _following(iterated):
            yield report


Show = Callable[[float, str], None]
"""Takes the part done, and what is said after the text where there is anything new to say."""
Shows = Callable[[str, float], AbstractContextManager[Show]]


def _on_terminal() -> Shows | None:
    """A bar of rich, where stderr is a terminal and rich is there."""
    return _terminal if sys.stderr.isatty() and find_spec("rich") else None


def _in_notebook() -> Shows | None:
    """An element of the page, where this is the kernel of a notebook."""
    shell = sys.modules.get("IPython")
    kernel = shell is not None and getattr(shell.get_ipython(), "kernel", None)
    return _notebook if kernel else None


@contextmanager
def _terminal(text: str, total: float) -> Iterator[Show]:
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as drawn:
        task = drawn.add_task(text, total=total)

        def show(done: float, more: str) -> None:
            drawn.update(task, completed=done)
            if more:
                drawn.update(task, description=text + more)

        yield show


@contextmanager
def _notebook(text: str, total: float) -> Iterator[Show]:
    display = import_module("IPython.display")

    def html(done: float, more: str) -> Any:
        part = f"<progress value='{done / total:.4f}' max='1'></progress>"
        return display.HTML(f"<div>{part} {escape(text + more)}</div>")

    place = display.display(html(0.0, ""), display_id=True)
    last = ""

    def show(done: float, more: str) -> None:
        nonlocal last
        last = more or last
        place.update(html(done, last))

    yield show
    place.update(html(total, ": done"))


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
