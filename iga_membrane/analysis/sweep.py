"""Sweeps: the equilibria of many scenes, on any executor, resumable after any kill."""

from __future__ import annotations

import inspect
import itertools
import logging
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import POSITIVE, integer, number
from ..checks import record as check_record
from ..driver.result_file import flat
from ..errors import OutputError, SceneError
from ..files import write_whole
from ..output_folder import output_folder
from ..overview import Overview, Told
from ..problems.scene import Scene
from ..progress import progress_bar
from ..quantities import DIMENSIONLESS, told_value
from ..solvers.options import SolverOptions
from ..tables import column, csv_text, dataframe, dataset, names_of
from .job import Job, fingerprint, question_of
from .portable import Portable, identity
from .process_pool import ProcessLanes, UnusableWorkersError, processors
from .record_store import Record, RecordStore

log = logging.getLogger("iga_membrane")

IN_FLIGHT = 64
"""Points handed at a time to an executor whose number of workers is not said."""
MOST = 1_000_000
"""Points of a sweep at most."""
SUCCESS = "CONVERGED_STABLE"
TEXTS = ("status", "units", "error")
"""Columns that are no numbers."""


@dataclass(frozen=True, repr=False)
@checked(computed=partial(integer, least=0))
class Sweep(Told):
    """What a sweep found.

    Attributes
    ----------
    parameters : names of what was varied.
    records : one per point, in the order of the grid: ``parameters``, and either ``result`` (by the
        names of the result file) or ``error``, why there is none.
    computed : how many of them this call computed; the others were there.
    mixed : whether records of other options or another version are among them.
    """

    parameters: tuple[str, ...]
    records: Sequence[Record] = field(repr=False)
    computed: int = 0
    mixed: bool = False

    def overview(self) -> Overview:
        """How its points ended, what was varied, and the measures from least to greatest."""
        counts = ", ".join(f"{count} {name}" for name, count in self.statuses.items())
        rows = [("status", counts)]
        names = [name for name in names_of(self._rows()) if name not in TEXTS]
        for name in names:
            found = self.column(name)
            found = found[np.isfinite(found)]
            if len(found):
                most = told_value(name, found.max(), self.units)
                rows.append((name, f"{found.min():.6g} to {most}"))
        return Overview(f"sweep, {self.units}: {len(self.records)} points", rows)

    @property
    def units(self) -> str:
        """Of its numbers: "SI" or "dimensionless"; of points in both, both."""
        found = {row["units"] for row in self._rows() if "units" in row}
        return " and ".join(sorted(found)) or DIMENSIONLESS

    @property
    def success(self) -> bool:
        """Whether every point is a success."""
        return all(_status(record) == SUCCESS for record in self.records)

    @property
    def statuses(self) -> dict[str, int]:
        """How many points ended how."""
        names = [_status(record) for record in self.records]
        return {name: names.count(name) for name in sorted(set(names))}

    def column(self, name: str) -> Array:
        """(points,) a parameter or a measure; not a number where a point has none."""
        return column(self._rows(), name)

    def save(self, path: str | Path) -> None:
        """Write a table of parameters, status and measures, .csv or .npz.

        Raises
        ------
        OutputError
        """
        path = Path(path)
        rows = self._rows()
        if path.suffix == ".csv":
            write_whole(path, lambda name: Path(name).write_text(csv_text(rows), "utf-8"))
        elif path.suffix == ".npz":
            columns: dict[str, Any] = {
                name: np.array([str(row.get(name, "")) for row in rows])
                if name in TEXTS
                else column(rows, name)
                for name in names_of(rows)
            }
            write_whole(path, lambda name: np.savez(name, **columns))
        else:
            raise OutputError(f"{path}: ending must be .csv or .npz")

    def to_dataframe(self) -> Any:
        """``pandas.DataFrame`` with the rows of the table.

        Raises
        ------
        OutputError
            If pandas is not installed.
        """
        return dataframe(self._rows())

    def to_xarray(self) -> Any:
        """``xarray.Dataset`` of the table on the grid of the parameters.

        Raises
        ------
        OutputError
            If xarray is not installed.
        """
        return dataset(self._rows(), self.parameters)

    def _rows(self) -> list[dict[str, Any]]:
        return [_row(record) for record in self.records]


@checked(workers=partial(integer, least=1, most=1024), timeout=POSITIVE)
def sweep(
    scene_of: Callable[..., Scene],
    over: Mapping[str, Sequence[Any]],
    *,
    out: str | Path | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    timeout: float | None = None,
    options: SolverOptions | None = None,
    allow_mixed: bool = False,
    retry_failed: bool = False,
) -> Sweep:
    """Solve the scenes of a grid of parameters.

    Every finished point is a file in ``out``. The same call again computes only what is missing,
    after a kill at any moment too; several processes may share the folder. A worker's death or
    hang costs its own point, which is tried again.

    Parameters
    ----------
    scene_of : parameters by name to a scene. To processes a function of a notebook, a script or
        inside another function goes by value, one of a module by its name.
    over : name to values; the grid is their product, the last name varying fastest.
    out : folder of the records; without it nothing is kept.
    executor : any ``concurrent.futures.Executor``, of Dask or MPI too; by default processes of this
        machine. Every point runs BLAS on one thread.
    workers : number of processes of the default executor (the processors), or of workers that
        another one has; twice as many points are claimed and handed out at a time (else 64).
    timeout : seconds per point, of the default executor.
    options : of every solve.
    allow_mixed : whether records of other options, scenes or versions may stand beside new ones.
    retry_failed : whether points that are recorded, but not as a success, are computed again.

    Returns
    -------
    Sweep
        A solve that fails, a scene that is refused and a point that killed its workers are records
        like any other.

    Raises
    ------
    SceneError
        An empty grid; a function that does not take its parameters or cannot be sent to a process;
        workers that cannot be started or cannot import what the function needs, which is recorded
        for no point; records in ``out`` of another question.
    OutputError
        If ``out`` cannot be written; checked before any work.
    """
    options = SolverOptions() if options is None else options
    points = _grid(over)
    names = tuple(over)
    _check_parameters(scene_of, points[0])
    store = None if out is None else RecordStore(output_folder("out", out))
    keys, function = [RecordStore.key(point) for point in points], identity(scene_of)
    found, void = _kept(store, keys, function, retry_failed)
    mixed = _check_mixed(scene_of, function, found, options, allow_mixed)
    left = {key: point for key, point in zip(keys, points, strict=True) if key not in found}
    computed = 0
    if left:
        if executor is None:
            _check_sendable(scene_of)
        with progress_bar("sweep", len(points)) as report:
            job = Job(
                scene_of, left, found, void, store, options, report, _in_flight(executor, workers)
            )
            _run(job, executor, workers, timeout)
        computed = len(job.computed)
    return Sweep(names, [found[key] for key in keys], computed, mixed)


def _kept(
    store: RecordStore | None, keys: Sequence[str], function: str, retry_failed: bool
) -> tuple[dict[str, Record], dict[str, Record]]:
    """Records of points by their keys: those that count, and those that do not."""
    found: dict[str, Record] = {}
    void: dict[str, Record] = {}
    for key in keys if store is not None else ():
        kept = store.read(key) if store is not None else None
        if kept is not None:
            (found if _counts(kept, function, retry_failed) else void)[key] = kept
    return found, void


def _run(job: Job, executor: Executor | None, workers: int | None, timeout: float | None) -> None:
    """Compute the points that are left; if the executor breaks, by processes of our own."""
    try:
        with _running(executor, workers, timeout) as pool:
            job.run(pool)
    except BrokenExecutor as error:
        log.warning("the executor broke (%s): going on with processes of our own", error)
        with _running(None, workers, timeout) as pool:
            job.run(pool)


def _grid(over: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    check_record("over", over, Mapping)
    if not over:
        raise SceneError("over = {}: name at least one parameter with its values")
    plain = [_values(f"over[{name!r}]", values) for name, values in over.items()]
    total = math.prod(map(len, plain))
    if total > MOST:
        raise SceneError(f"over: {total} points, at most {MOST}")
    points = [dict(zip(over, values, strict=True)) for values in itertools.product(*plain)]
    if len({RecordStore.key(point) for point in points}) < len(points):
        raise SceneError("over: a value is given twice; give it once")
    return points


def _values(told: str, values: Sequence[Any]) -> list[Any]:
    """The values of one parameter."""
    if isinstance(values, str) or not hasattr(values, "__len__") or not len(values):
        raise SceneError(f"{told} = {values!r}: a list of values is needed")
    plain: list[Any] = np.asarray(values).tolist()
    for i, value in enumerate(plain):
        if not isinstance(value, (str, bool)):
            number(f"{told}[{i}]", value)
    return plain


def _check_parameters(scene_of: Callable[..., Scene], point: dict[str, Any]) -> None:
    """See that the function takes the parameters, where Python can tell."""
    try:
        signature = inspect.signature(scene_of)
    except ValueError:
        return
    try:
        signature.bind(**point)
    except TypeError as error:
        raise SceneError(
            f"over: scene_of{signature} cannot be called with {', '.join(point)} ({error}); name "
            "its parameters in over"
        ) from error


def _counts(kept: Record, function: str, retry_failed: bool) -> bool:
    """Whether a record is an answer to this sweep. One without a scene tells only of the function
    that was to build it."""
    if retry_failed and _status(kept) != SUCCESS:
        return False
    return "scene" in kept or kept.get("function") == function


def _check_mixed(
    scene_of: Callable[..., Scene],
    function: str,
    found: Mapping[str, Record],
    options: SolverOptions,
    allowed: bool,
) -> bool:
    """Whether records answer another question: other options, version, or another scene.

    Scenes are built to see: all those of another function, but of this one, since what it calls
    may have changed, only the first and the last.
    """
    question = question_of(options)
    other = any(kept.get("question") != question for kept in found.values())
    built = [kept for kept in found.values() if "scene" in kept]
    ours = [kept for kept in built if kept.get("function") == function]
    asked = [kept for kept in built if kept.get("function") != function] + ours[:1] + ours[1:][-1:]
    other = other or any(_scene(scene_of, kept["parameters"]) != kept["scene"] for kept in asked)
    if other and not allowed:
        raise SceneError(
            f"out: {len(found)} records there, some of other options, scenes or another version "
            "than this sweep's; choose another folder, or allow_mixed=True"
        )
    return other


def _scene(scene_of: Callable[..., Scene], point: dict[str, Any]) -> str | None:
    """Fingerprint of the scene of a point; None where there is none."""
    try:
        return fingerprint(scene_of(**point))
    except Exception:
        return None


def _in_flight(executor: Executor | None, workers: int | None) -> int:
    """Enough points to keep all workers busy, and few, since no other process gets them."""
    if executor is not None and workers is None:
        return IN_FLIGHT
    return 2 * (workers or processors())


def _check_sendable(scene_of: Callable[..., Scene]) -> None:
    try:
        _ = Portable(scene_of).packed
    except Exception as error:
        raise SceneError(
            f"scene_of = {scene_of!r}: cannot be sent to a process ({error}); make inside of it "
            "what cannot be copied, or give executor=ThreadPoolExecutor(1)"
        ) from error


@contextmanager
def _running(
    executor: Executor | None, workers: int | None, timeout: float | None
) -> Iterator[Executor]:
    """The executor; one of our own is ended with the sweep, at once if it is interrupted."""
    if executor is not None:
        yield executor
        return
    try:
        own = ProcessLanes(workers, timeout)
    except UnusableWorkersError as error:
        raise SceneError(f"executor: {error}") from error
    try:
        yield own
    finally:
        own.shutdown(cancel_futures=True)


def _status(record: Record) -> str:
    return str(record["result"]["status"]) if "result" in record else "no result"


def _row(record: Record) -> dict[str, Any]:
    row = {**record["parameters"], "status": _status(record), "error": record.get("error", "")}
    return row | flat(record["result"]) if "result" in record else row
