"""A progress bar on a terminal; nothing in a log or a pipe."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec


@contextmanager
def bar(text: str, total: float = 1.0) -> Iterator[Callable[[float], None]]:
    """Yields what is to be called with the part done; drawn by rich where it is installed."""
    if not (sys.stderr.isatty() and find_spec("rich")):
        yield lambda done: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as drawn:
        task = drawn.add_task(text, total=total)
        yield lambda done: drawn.update(task, completed=done)
