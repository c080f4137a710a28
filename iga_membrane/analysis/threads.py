"""One thread for the libraries of each worker: processes side by side already fill the machine."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Iterator

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
"""What libraries read when they are loaded."""

_ENVIRONMENT = threading.Lock()


@contextlib.contextmanager
def children_on_one_thread() -> Iterator[None]:
    """Processes started inside run their libraries on one thread, unless told otherwise."""
    with _ENVIRONMENT:
        added = _add()
        try:
            yield
        finally:
            for name in added:
                del os.environ[name]


def stay_on_one_thread() -> None:
    """Keep the libraries of this process on one thread, loaded or not, unless told otherwise."""
    if len(_add()) == len(THREADS):
        from threadpoolctl import threadpool_limits

        threadpool_limits(1)


def _add() -> list[str]:
    """Set the variables that are not set; their names."""
    added = [name for name in THREADS if name not in os.environ]
    os.environ.update(dict.fromkeys(added, "1"))
    return added
