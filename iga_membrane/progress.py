"""A progress bar on a terminal; elsewhere lines for a log, nothing unless it is asked for."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec

log = logging.getLogger("iga_membrane.progress")
"""Its lines have the level INFO, so they are shown only where logging is set up to show them."""


@contextmanager
def bar(text: str, total: float = 1.0) -> Iterator[Callable[[float], None]]:
    """Yields what is to be called with the part done.

    On a terminal it is drawn by rich, where that is installed; otherwise a line is logged for
    every tenth of the whole.
    """
    if not (sys.stderr.isatty() and find_spec("rich")):
        yield _lines(text, total)
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as drawn:
        task = drawn.add_task(text, total=total)
        yield lambda done: drawn.update(task, completed=done)


def _lines(text: str, total: float) -> Callable[[float], None]:
    logged = 0

    def report(done: float) -> None:
        nonlocal logged
        tenths = int(10.0 * done / total + 1e-9)
        if tenths > logged:
            logged = tenths
            log.info("%s: %d %%", text, 10 * tenths)

    return report
