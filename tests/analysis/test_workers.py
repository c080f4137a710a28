"""Workers of sweeps: what is no fault of a point is told at once and recorded for none."""

import itertools
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import CancelledError, Executor, Future, ThreadPoolExecutor
from pathlib import Path

import pytest
from analysis.sweep_scenes import Deadly, drop
from helpers import some

import iga_membrane as iga
from iga_membrane.analysis.portable import identity
from iga_membrane.analysis.process_pool import ProcessLanes, WorkerLostError, processors
from iga_membrane.analysis.record_store import RecordStore

PATHS = [str(Path(iga.__file__).parents[1]), str(Path(__file__).parents[1])]
ALONE = "import multiprocessing; multiprocessing.get_all_start_methods = lambda: ['spawn']\n"
"""As on Windows, where every worker is started from nothing."""


def run(arguments, folder, text=None):
    """A Python program in a session of its own, its end and its seconds."""
    began = time.monotonic()
    ended = subprocess.run(
        [sys.executable, *arguments], input=text, cwd=folder, text=True, capture_output=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(PATHS)}, timeout=100,
        start_new_session=True, check=False,
    )  # fmt: skip
    return ended, time.monotonic() - began


UNGUARDED = """
import iga_membrane as iga
from analysis.sweep_scenes import drop
found = iga.sweep(drop, {"angle": [60.0, 90.0]}, out="points", workers=2)
print("went on")
"""


@pytest.mark.parametrize("system", some(("", ALONE), {1}), ids=["server", "spawn"])
def test_a_script_without_a_guard_is_told_at_once(tmp_path, system):
    (tmp_path / "script.py").write_text(system + UNGUARDED)
    ended, seconds = run(["script.py"], tmp_path)
    assert ended.returncode == 1  # an error like any other, no signal
    last = ended.stderr.strip().splitlines()[-1]
    assert "SceneError" in last
    assert "if __name__ == '__main__':" in last
    assert "went on" not in ended.stdout
    assert seconds < 30.0  # of a busy machine; a worker is waited for as long as 120
    assert not list((tmp_path / "points").iterdir())


NOTEBOOK = """
import os, signal, sys, threading
from pathlib import Path
for module, name in ((os, "sched_getaffinity"), (os, "fork"), (signal, "SIGKILL")):
    delattr(module, name)
import iga_membrane as iga
from iga_membrane.analysis.process_pool import processors
assert processors() == os.cpu_count()
volume = 4.19
def made_at_a_prompt(angle, bond):
    mesh = iga.Discretization(elements=8)
    return iga.sessile_droplet(iga.Plane(contact_angle=angle), volume=volume, gravity=bond,
                               discretization=mesh)
def closure(bond):
    return lambda angle: made_at_a_prompt(angle, bond)
class Bonds:
    def __init__(self, bond): self.bond = bond
    def __call__(self, angle): return made_at_a_prompt(angle, self.bond)
heights = [
    iga.sweep(scene_of, over, workers=1, out="points").column("height")[0]
    for scene_of, over in (
        (made_at_a_prompt, {"angle": [90.0], "bond": [2.0]}), (closure(2.0), {"angle": [90.0]}),
    )
]
heights.append(iga.sweep(Bonds(2.0), {"angle": [90.0]}, workers=1).column("height")[0])
print(*heights)
"""


@pytest.mark.parametrize("method", some(("", ALONE), {0}), ids=["server", "spawn"])
def test_functions_of_a_notebook_run_on_any_system(tmp_path, method):
    """Typed at a prompt, so no worker can import them; as on macOS and Windows."""
    ended, _ = run(["-"], tmp_path, method + NOTEBOOK)
    assert ended.returncode == 0, ended.stderr
    mesh = iga.Discretization(elements=8)
    plane = iga.Plane(contact_angle=90.0)
    scene = iga.sessile_droplet(plane, volume=4.19, gravity=2.0, discretization=mesh)
    height = iga.solve(scene).measures["height"]
    assert [float(said) for said in ended.stdout.split()] == [height] * 3


class NoModule:
    """Comes back in no worker, as a function of a module that is not installed there."""

    def __init__(self, name):
        self.name = name

    def __call__(self, angle):
        return drop(angle)

    def __reduce__(self):
        return __import__, (self.name,)


def importing(angle):
    import a_module_that_is_nowhere

    return a_module_that_is_nowhere.drop(angle)


@pytest.mark.parametrize("scene_of", [NoModule("nowhere_installed"), importing])
def test_a_module_that_workers_lack_is_named_and_nothing_is_recorded(tmp_path, scene_of):
    with pytest.raises(iga.SceneError, match=r"(?s)No module named .*PYTHONPATH"):
        iga.sweep(scene_of, {"angle": [60.0, 90.0]}, out=tmp_path, workers=1)
    assert not list(tmp_path.iterdir())  # neither a record nor a claim


class Broken(Executor):
    """Fails in some way, whatever is submitted."""

    def __init__(self, error):
        self.error = error

    def submit(self, call, /, *arguments, **named):
        future = Future()
        future.set_exception(self.error)
        return future


@pytest.mark.parametrize("error", [OSError("no connection"), CancelledError(), TypeError("pickle")])
def test_what_an_executor_raises_is_not_recorded_as_a_points_failure(tmp_path, error):
    with pytest.raises(type(error)):
        iga.sweep(drop, {"angle": [60.0, 90.0]}, out=tmp_path, executor=Broken(error))
    assert not list(tmp_path.iterdir())


def test_workers_that_cannot_be_started_are_an_error(tmp_path, monkeypatch):
    def refused(*arguments):
        raise OSError(11, "Resource temporarily unavailable")

    monkeypatch.setattr("multiprocessing.process.BaseProcess.start", refused)
    with pytest.raises(iga.SceneError, match="Resource temporarily unavailable"):
        iga.sweep(drop, {"angle": [60.0]}, out=tmp_path)
    assert not list(tmp_path.iterdir())


def ends(code):
    os._exit(code)


def raises(text):
    raise ValueError(text)


def never_returns(value):
    """In C, where Python looks after no signal and no other thread runs."""
    return sum(itertools.repeat(value))


def waits(seconds):
    time.sleep(seconds)
    return os.getpid()


def test_a_worker_is_lost_alone_and_replaced():
    """Its call raises what it raised; one that ends or hangs is lost; an idle one that was killed
    costs no call."""
    lanes = ProcessLanes(1, timeout=2.0)
    try:
        first = lanes.submit(waits, 0.0).result()
        with pytest.raises(ValueError, match="why"):
            lanes.submit(raises, "why").result()
        assert lanes.submit(waits, 0.0).result() == first
        for call, argument, said in ((ends, 3, "exit code 3"), (never_returns, 0, "within 2 s")):
            with pytest.raises(WorkerLostError, match=said):
                lanes.submit(call, argument).result()
        second = lanes.submit(waits, 0.0).result()
        assert second != first
        os.kill(second, signal.SIGKILL)
        lanes._all[0]._worker.process.join()
        assert lanes.submit(waits, 0.0).result() not in (first, second)
        hanging = lanes.submit(waits, 99.0)
    finally:
        began = time.monotonic()
        lanes.shutdown(cancel_futures=True)
    assert time.monotonic() - began < 1.5
    assert hanging.done()


def test_processors_are_counted_on_every_system(monkeypatch):
    assert processors() == len(os.sched_getaffinity(0))
    monkeypatch.delattr(os, "sched_getaffinity")
    assert processors() == os.cpu_count()
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert processors() == 1


def test_a_claim_is_never_a_reason_to_send_a_signal_to_a_group(tmp_path, monkeypatch):
    """A claim that is damaged, of process 0, or on a system where signal 0 is Ctrl-C."""
    store, sent = RecordStore(tmp_path), []
    monkeypatch.setattr(os, "kill", lambda *arguments: sent.append(arguments))
    claim, host = tmp_path / ".a.claim", os.uname().nodename
    for text in ("", host, f"{host} 0", f"{host} -1", f"{host} {10**30}", "\0\xff"):
        claim.write_text(text)
        assert not store.claim("a")
    assert all(pid > 0 for pid, _ in sent)
    sent.clear()
    claim.write_text(f"{host} 4194303")
    monkeypatch.setattr(sys, "platform", "win32")
    assert not store.claim("a")
    assert not sent


# What was recorded as failed


def inside(scene_of, over, **options):
    with ThreadPoolExecutor(1) as executor:
        return iga.sweep(scene_of, over, executor=executor, **options)


def strange(angle):
    if angle > 80.0:
        raise ZeroDivisionError("a bug")
    return drop(angle)


def repaired(angle):
    return drop(angle)


def other(angle):
    return drop(angle, 1.0 if angle != 80.0 else 3.0)


def test_a_failed_record_counts_only_for_the_function_that_failed(tmp_path):
    over = {"angle": [60.0, 90.0, 200.0]}
    first = inside(strange, over, out=tmp_path)
    assert first.records[1]["error"] == "ZeroDivisionError: a bug"
    assert inside(strange, over, out=tmp_path).computed == 0
    again = inside(repaired, over, out=tmp_path)
    assert (again.computed, again.statuses) == (2, {"CONVERGED_STABLE": 2, "no result": 1})
    assert inside(repaired, over, out=tmp_path).records == again.records


def test_every_record_of_another_function_is_compared(tmp_path):
    """Also one in the middle of the grid, where a check of its ends sees nothing."""
    over = {"angle": [60.0, 80.0, 100.0]}
    inside(drop, over, out=tmp_path)
    assert inside(repaired, over, out=tmp_path).computed == 0
    with pytest.raises(iga.SceneError, match="allow_mixed"):
        inside(other, over, out=tmp_path)


def test_what_a_function_holds_is_part_of_its_name(tmp_path):
    def of(bond):
        return lambda angle: drop(angle, bond)

    assert identity(of(1.0)) == identity(of(1.0)) != identity(of(2.0))
    assert identity(Deadly([1.0], "a")) == identity(Deadly([1.0], "a")) != identity(Deadly([], "a"))
    assert len({identity(f) for f in (drop, repaired, other, strange, of(1.0), of)}) == 6
    prompts = [eval(f"lambda angle: drop(angle, {bond})") for bond in (1.0, 1.0, 2.0)]
    assert identity(prompts[0]) == identity(prompts[1]) != identity(prompts[2])


def test_failed_points_are_computed_again_when_asked(tmp_path):
    """A point that killed its workers, one that ran out of time; what succeeded is not touched."""
    deadly = Deadly([80.0], tmp_path, 3)
    over, out = {"angle": [60.0, 80.0]}, tmp_path / "points"
    found = iga.sweep(deadly, over, out=out, workers=1)
    assert found.statuses == {"CONVERGED_STABLE": 1, "no result": 1}
    assert "worker died" in found.records[1]["error"]
    good = RecordStore.key({"angle": 60.0})
    before = (out / f"{good}.json").stat().st_mtime_ns
    assert inside(deadly, over, out=out).computed == 0
    again = inside(deadly, over, out=out, retry_failed=True)
    assert (again.computed, again.success) == (1, True)
    assert (out / f"{good}.json").stat().st_mtime_ns == before
    assert inside(deadly, over, out=out, retry_failed=True).computed == 0
    limited = iga.SolverOptions(max_cpu_s=1e-9)
    short = inside(drop, over, out=tmp_path / "short", options=limited)
    assert short.statuses == {"INTERRUPTED": 2}
    assert inside(drop, over, out=tmp_path / "short", retry_failed=True).success
