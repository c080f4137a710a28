"""BLAS on one thread: its own threads wait for each other at every small front of a solve."""

from __future__ import annotations

import sys
import threading
from collections.abc import Sequence
from contextlib import ContextDecorator

from threadpoolctl import LibController, ThreadpoolController


class _OneThread(ContextDecorator):
    """While any thread of Python is inside, every BLAS of this process runs on one thread; when the
    last one leaves, each has the number back that it had when it was first met.

    Entering costs some 15 microseconds (docs/results/threads.md). A library that was imported
    inside, as scipy's BLAS is where a matrix is sparse, is held from the next entry on.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._entered = 0
        self._modules = 0
        self._libraries: Sequence[LibController] = ()
        self._before: list[tuple[LibController, int]] = []

    def __enter__(self) -> None:
        with self._lock:
            # looking through the libraries takes milliseconds, and only an import brings new ones
            grown = len(sys.modules) != self._modules
            if grown:
                self._modules = len(sys.modules)
                self._libraries = ThreadpoolController().select(user_api="blas").lib_controllers
            if grown or not self._entered:
                for library in self._libraries:
                    self._before.append((library, library.num_threads))
                    _set(library, 1)
            self._entered += 1

    def __exit__(self, *exception: object) -> None:
        with self._lock:
            self._entered -= 1
            while self._before and not self._entered:
                _set(*self._before.pop())  # the first number that a library had comes last


def _set(library: LibController, number: int) -> None:
    """Set it from whatever thread of Python: the last one that leaves need not be the first."""
    # threadpoolctl >= 3.8 leaves OpenBLAS to the thread that first set it, and ignores all others
    let_go = getattr(library, "clear_controlling_thread", lambda force: None)
    let_go(force=True)
    library.set_num_threads(number)
    let_go(force=True)


one_thread = _OneThread()
"""To enter with ``with`` or as a decorator, also again inside itself and from several threads."""
