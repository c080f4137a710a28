"""Processes that die or hang alone: an executor whose workers share nothing."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import queue
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from multiprocessing.connection import Connection, wait
from typing import Any

STARTING = 120.0
"""Seconds within which a worker must be ready; importing the package takes 0.4 on an idle machine,
and a script that its workers import may take long. One that ends before is noticed at once."""
ENDING = 1.0
"""Seconds that a worker is given to end when it is asked to, before it is killed."""
GUARD = (
    "each worker imports the script that is run, so call sweep under ``if __name__ == "
    "'__main__':`` there; or give executor=ThreadPoolExecutor(1)"
)
"""What to do if workers do not start."""
_START = threading.Lock()
_PRELOADED = [f"{__package__}.job"]


class WorkerLostError(RuntimeError):
    """A worker died, or was ended because it took too long."""


class UnusableWorkersError(RuntimeError):
    """Workers cannot be started here, or cannot load what they are to call."""


class ProcessLanes(Executor):
    """Processes side by side, each with a pipe of its own.

    A worker that dies takes only its own call with it, one that exceeds the time is ended, and
    either is replaced. Workers leave Ctrl-C to their parent and end when it is gone. They are
    started by a server that has loaded the package already, where the system has that way (not on
    Windows), and one by one elsewhere.

    Parameters
    ----------
    workers : number of processes; the processors by default.
    timeout : seconds of wall time per call, or None.

    Raises
    ------
    UnusableWorkersError
        If the first worker cannot be started.
    """

    def __init__(self, workers: int | None = None, timeout: float | None = None) -> None:
        count = workers or processors()
        self._timeout = timeout
        self._all = [_Lane() for _ in range(count)]
        self._all[0].start()
        self._threads = ThreadPoolExecutor(count)
        self._lanes: queue.LifoQueue[_Lane] = queue.LifoQueue()
        for lane in reversed(self._all):
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
            # what runs is not waited for: its worker is ended
            self._threads.shutdown(wait=False, cancel_futures=True)
            for lane in self._all:
                lane.end()
        self._threads.shutdown(wait, cancel_futures=cancel_futures)
        for lane in self._all:
            lane.end()
            lane.drop()


def processors() -> int:
    """Those that this process may use, where the system tells; else all."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1


class _Lane:
    """One worker process, started when it is first needed."""

    def __init__(self) -> None:
        self._worker: _Worker | None = None
        self._ended = False

    def start(self) -> _Worker:
        """The worker, a new one if there is none or if it has died while it was idle."""
        if self._worker is None or not self._worker.process.is_alive():
            self.drop()
            self._worker = _Worker()
        return self._worker

    def run(self, timeout: float | None, call: Callable[..., Any], args: Any, named: Any) -> Any:
        worker = self.start()
        try:
            if self._ended:
                raise WorkerLostError("the sweep was stopped")
            return worker.call(timeout, (call, args, named))
        except WorkerLostError:
            self.drop()
            raise

    def end(self) -> None:
        """End the worker, whatever it does; who waits for its answer is told that it is lost."""
        self._ended = True
        worker = self._worker
        if worker is not None:
            worker.terminate()

    def drop(self) -> None:
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.end()


class _Worker:
    """A process that answers calls, one after the other.

    Raises
    ------
    UnusableWorkersError
        If it ends before it is ready.
    """

    def __init__(self) -> None:
        context = _context()
        self._pipe, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs,))
        try:
            with _START, _typed_program_not_imported():
                self.process.start()
        except Exception as error:
            raise UnusableWorkersError(f"no worker can be started ({error}); {GUARD}") from error
        finally:
            theirs.close()
        try:
            self._answer(STARTING)
        except WorkerLostError:
            code = self.process.exitcode
            self.end()
            how = f"was not ready within {STARTING:g} s" if code is None else f"ended ({code=})"
            raise UnusableWorkersError(
                f"workers do not start: one {how} before it took any work; what it wrote stands "
                f"above; {GUARD}"
            ) from None

    def call(self, timeout: float | None, what: tuple[Callable[..., Any], Any, Any]) -> Any:
        """The answer of a call.

        Raises
        ------
        WorkerLostError
            Without an answer. What the call itself raises is raised here too.
        """
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            self._pipe.send(what)
        answer, error = self._answer(timeout)
        if error is not None:
            raise error
        return answer

    def terminate(self) -> None:
        """Ask the process to end, if it has not."""
        if self.process.is_alive():
            self.process.terminate()

    def end(self) -> None:
        """End the process, and let go of it."""
        self.terminate()
        self.process.join(ENDING)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()
        self._pipe.close()

    def _answer(self, timeout: float | None) -> Any:
        if not wait([self._pipe, self.process.sentinel], timeout):
            raise WorkerLostError(f"no answer within {timeout:g} s; the worker was ended")
        # what it said last counts, also if it has ended since
        with contextlib.suppress(EOFError, ConnectionResetError):
            if self._pipe.poll():
                return self._pipe.recv()
        self.process.join(ENDING)
        raise WorkerLostError(
            f"its worker died, killed or out of memory: exit code {self.process.exitcode}"
        )


def _context() -> Any:
    """How processes are started; never by forking this one, whose threads would be lost."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(_PRELOADED)
    return context


@contextlib.contextmanager
def _typed_program_not_imported() -> Iterator[None]:
    """Workers import the script that is run; one that was typed or piped in is no file, though
    Python names it ``<stdin>``."""
    main = vars(sys.modules["__main__"])
    name = main.get("__file__")
    if name is None or os.path.exists(name):
        yield
        return
    del main["__file__"]
    try:
        yield
    finally:
        main["__file__"] = name


def _serve(pipe: Connection) -> None:
    """A worker's life: ready, then call after call until the parent closes the pipe."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    _end_with_parent()
    pipe.send("ready")
    with contextlib.suppress(EOFError, ConnectionResetError, BrokenPipeError):
        while True:
            call, arguments, named = pipe.recv()
            try:
                pipe.send((call(*arguments, **named), None))
            except Exception as error:
                pipe.send((None, error))


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None

    def watch() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
