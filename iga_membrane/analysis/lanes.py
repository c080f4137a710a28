"""Processes that die or hang alone: an executor whose workers share nothing."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import queue
import signal
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Any

STARTING = 120.0
"""Seconds within which a worker must have started."""


class WorkerLostError(RuntimeError):
    """A worker died, or was killed because it took too long."""


class WorkerStartError(RuntimeError):
    """Processes cannot be started here."""


class ProcessLanes(Executor):
    """Processes side by side, each a pool of its own.

    A worker that dies takes only its own call with it, one that exceeds the time is killed, and
    either is replaced. Workers leave Ctrl-C to their parent and end when it is gone.

    Parameters
    ----------
    workers : number of processes; the processors by default.
    timeout : seconds of wall time per call, or None.
    """

    def __init__(self, workers: int | None = None, timeout: float | None = None) -> None:
        count = workers or processors()
        self._timeout = timeout
        self._threads = ThreadPoolExecutor(count)
        self._lanes: queue.SimpleQueue[_Lane] = queue.SimpleQueue()
        self._all = [_Lane() for _ in range(count)]
        for lane in self._all:
            self._lanes.put(lane)

    def submit(self, call: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        return self._threads.submit(self._run, call, arguments, named)

    def _run(self, call: Callable[..., Any], arguments: Any, named: Any) -> Any:
        lane = self._lanes.get()
        try:
            return lane.run(self._timeout, call, arguments, named)
        finally:
            self._lanes.put(lane)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        if cancel_futures:
            # what runs is not waited for: its worker is killed
            self._threads.shutdown(wait=False, cancel_futures=True)
            for lane in self._all:
                lane.end()
        self._threads.shutdown(wait, cancel_futures=cancel_futures)
        for lane in self._all:
            lane.end()


def processors() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0))


class _Lane:
    """One worker process, started when it is first needed."""

    def __init__(self) -> None:
        self._pool: ProcessPoolExecutor | None = None
        self._pid = 0
        self._ended = False

    def run(self, timeout: float | None, call: Callable[..., Any], args: Any, named: Any) -> Any:
        try:
            if self._pool is None:
                self._start()
            assert self._pool is not None
            return self._pool.submit(call, *args, **named).result(timeout)
        except TimeoutError:
            self._drop()
            raise WorkerLostError(f"no answer within {timeout:g} s; the worker was ended") from None
        except BrokenProcessPool:
            self._drop()
            raise WorkerLostError("its worker died, killed or out of memory") from None

    def end(self) -> None:
        """Kill the worker, whatever it does."""
        self._ended = True
        self._drop()

    def _start(self) -> None:
        if self._ended:
            raise WorkerLostError("the sweep was stopped")
        method = "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else None
        context = multiprocessing.get_context(method)
        self._pool = ProcessPoolExecutor(1, context, _prepare)
        try:
            self._pid = self._pool.submit(os.getpid).result(STARTING)
        except (BrokenProcessPool, TimeoutError) as error:
            raise WorkerStartError("processes cannot be started here") from error

    def _drop(self) -> None:
        pool, self._pool = self._pool, None
        if pool is not None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self._pid, signal.SIGKILL)
            pool.shutdown(wait=False, cancel_futures=True)


def _prepare() -> None:
    """In a worker: ignore Ctrl-C, and end when the parent is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    assert parent is not None

    def watch() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
