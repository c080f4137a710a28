"""The points that are left of a sweep, handed to an executor; each of them is kept when it ends."""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from typing import Any

from .. import __version__
from ..driver.result_file import result
from ..driver.solve import solve
from ..errors import SceneError
from ..problems.scene import Scene
from ..records import digest
from ..solvers.options import SolverOptions
from ..threads import one_thread
from .portable import Portable, identity
from .process_pool import UnusableWorkersError
from .record_store import LAPSE, Record, RecordStore

log = logging.getLogger("iga_membrane")

TRIES = 3
"""How often a point whose worker is lost is tried before it is recorded as failed."""
LOST = ("WorkerLostError", "KilledWorker")
"""What executors raise for a call whose worker died, each time if it was tried several times: ours,
Dask's. Whatever else they raise is no fault of the point."""


def question_of(options: SolverOptions) -> str:
    return digest([__version__, options.numerical()])


def fingerprint(scene: Scene) -> str:
    """Of a scene by its words and terms; a scene without words also by its start."""
    return digest([scene.description or scene.surface, scene.terms])


class Job:
    """What is left of a sweep; fills ``found``, and ``computed`` with what it did itself.

    Parameters
    ----------
    scene_of : parameters to a scene.
    left : points by their keys.
    found : records by key.
    void : records in the store that do not count.
    store : where records are kept, if they are.
    options : of every solve.
    report : called with the number of points found.
    in_flight : points claimed and handed out at a time.
    """

    def __init__(
        self,
        scene_of: Callable[..., Scene],
        left: Mapping[str, dict[str, Any]],
        found: dict[str, Record],
        void: Mapping[str, Record],
        store: RecordStore | None,
        options: SolverOptions,
        report: Callable[[float], None],
        in_flight: int,
    ) -> None:
        self._scene_of, self._function = Portable(scene_of), identity(scene_of)
        self._left, self._found, self._void = left, found, void
        self._store, self._options, self._report = store, options, report
        self._in_flight, self._renewed = in_flight, time.monotonic()
        self._tries = dict.fromkeys(left, 0)
        self.computed: set[str] = set()

    def run(self, pool: Executor) -> None:
        """Compute what is left, or wait for the processes that do.

        Raises
        ------
        BrokenExecutor
            If the executor takes no more calls.
        SceneError
            If workers cannot be started or cannot load the function.
        """
        waiting = deque(key for key in self._left if key not in self._found)
        running: dict[Future[Record], str] = {}
        try:
            while waiting or running:
                self._submit(pool, waiting, running)
                if not running:
                    time.sleep(0.2)  # other processes compute what is left
                    continue
                for done in wait(running, timeout=1.0, return_when=FIRST_COMPLETED).done:
                    key = running[done]
                    if not self._finish(key, done):
                        waiting.append(key)
                    del running[done]
                self._renew(running.values())
                self._report(len(self._found))
        except UnusableWorkersError as error:
            raise SceneError(f"executor: {error}") from error
        finally:
            for future, key in running.items():
                future.cancel()
                self._release(key)

    def _submit(
        self, pool: Executor, waiting: deque[str], running: dict[Future[Record], str]
    ) -> None:
        """Hand out points that no other process has, as many as may be in flight."""
        for _ in range(len(waiting)):
            if len(running) >= self._in_flight:
                return
            key = waiting.popleft()
            if self._free(key):
                arguments = self._scene_of, self._left[key], self._options
                running[pool.submit(solve_point, *arguments)] = key
            elif key not in self._found:
                waiting.append(key)

    def _free(self, key: str) -> bool:
        """Claim a point, unless another process has it or has finished it."""
        if self._store is None:
            return True
        if not self._store.claim(key):
            return False
        kept = self._store.read(key)
        if kept is None or kept == self._void.get(key):
            return True
        self._found[key] = kept
        self._store.release(key)
        return False

    def _renew(self, keys: Iterable[str]) -> None:
        if self._store is not None and time.monotonic() - self._renewed > 0.1 * LAPSE:
            self._store.renew(keys)
            self._renewed = time.monotonic()

    def _release(self, key: str) -> None:
        if self._store is not None:
            self._store.release(key)

    def _finish(self, key: str, done: Future[Record]) -> bool:
        """Keep the record of a call; False if the point is to be tried again."""
        point = self._left[key]
        try:
            record = done.result()
        except Exception as error:
            if type(error).__name__ not in LOST:
                raise
            self._tries[key] += 1
            reason = f"{type(error).__name__}: {error}"
            log.warning("%s: %s (try %d of %d)", point, reason, self._tries[key], TRIES)
            if self._tries[key] < TRIES:
                self._release(key)
                return False
            record = {"parameters": point, "question": question_of(self._options), "error": reason}
        record["function"] = self._function
        if self._store is not None:
            self._store.write(key, record)
        self._found[key] = record
        self.computed.add(key)
        return True


@one_thread  # the making of the scene too
def solve_point(scene_of: Portable, point: dict[str, Any], options: SolverOptions) -> Record:
    """One point, in a worker: its result, or why there is none.

    Raises
    ------
    UnusableWorkersError
        If this worker lacks a module that the function needs.
    """
    record: Record = {"parameters": point, "question": question_of(options)}
    try:
        build = scene_of.function
    except Exception as error:
        raise _lacking(error) from error
    try:
        scene = build(**point)
        record["scene"] = fingerprint(scene)
        record["result"] = result(solve(scene, options, on_fail="return"))
    except ImportError as error:
        raise _lacking(error) from error
    except Exception as error:
        record["error"] = f"{type(error).__name__}: {error}"
    return record


def _lacking(error: Exception) -> UnusableWorkersError:
    return UnusableWorkersError(
        f"scene_of cannot be run in a worker ({type(error).__name__}: {error}): install what it "
        "imports where the workers run, or name its folder in PYTHONPATH"
    )
