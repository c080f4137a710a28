"""Going on: load stepping from where it was interrupted, and solves from a saved state (S2-S5)."""

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest
from helpers import droplet, droplet_file, path_file, some

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.cli import main


def angles(options=None, on_fail="raise", report=lambda load: None):
    return iga.trace(
        lambda angle: droplet(angle, 1.0, elements=8),
        [90.0, 110.0, 130.0, 150.0],
        parameter="substrate.contact_angle",
        options=options,
        on_fail=on_fail,
        report=report,
    )


class Killed(Exception):
    pass


def killed_after(count):
    loads = []

    def report(load):
        loads.append(load)
        if len(loads) == count:
            raise Killed

    return report


@pytest.mark.parametrize("count", some((1, 2, 3), {1}))
def test_an_interrupted_path_goes_on_to_the_same_end(tmp_path, count):
    whole = angles()
    state = tmp_path / "state.npz"
    options = iga.SolverOptions(checkpoint=state)
    with pytest.raises(Killed):
        angles(options, report=killed_after(count))
    with pytest.raises(iga.StateError, match="no solution yet"):
        iga.load(state)
    resumed = angles(replace(options, start=state))
    assert resumed.values == whole.values
    for one, two in zip(resumed.solutions, whole.solutions, strict=True):
        assert np.abs(one.surface.points - two.surface.points).max() <= 1e-10
        assert one.measures == pytest.approx(two.measures, rel=1e-10)
    steps = [(step.load, step.iterations) for step in resumed.end.load_steps]
    assert steps == [(step.load, step.iterations) for step in whole.end.load_steps]


def test_only_converged_steps_are_kept(tmp_path, monkeypatch):
    from iga_membrane.solvers import load_path as module

    options = iga.SolverOptions(checkpoint=tmp_path / "state.npz")
    newton, calls = module.newton, []

    def failing(*arguments):
        calls.append(1)
        result = newton(*arguments)
        if len(calls) == 3:
            result.status = iga.Status.STALLED
        return result

    monkeypatch.setattr(module, "newton", failing)
    written = []
    monkeypatch.setattr(
        "iga_membrane.driver.state.write_state",
        lambda path, state, keep: written.append((state.load, state.result.status)),
    )
    angles(options)
    loads = [load for load, _ in written]
    assert all(status is None for _, status in written)
    assert loads == sorted(set(loads))
    # one attempt failed; the first scene is not an attempt
    assert len(loads) == len(calls)


def test_the_cpu_limit_leaves_a_state_to_go_on_from(tmp_path):
    state = tmp_path / "state.npz"
    short = iga.SolverOptions(checkpoint=state, max_cpu_s=1e-3)
    path = angles(short, on_fail="return")
    assert path.end.status is iga.Status.INTERRUPTED
    whole, resumed = angles(), None
    state.unlink(missing_ok=True)
    for k in range(30):
        # seconds that are enough at last on any machine
        limit = iga.SolverOptions(checkpoint=state, max_cpu_s=0.1 * 1.2**k, start=state)
        start = limit if state.exists() else replace(limit, start=None)
        resumed = angles(start, on_fail="return")
        if resumed.success:
            break
        if resumed.end.progress is not None:
            resumed.end.save(state)
    assert resumed.success
    assert resumed.end.measures == pytest.approx(whole.end.measures, rel=1e-10)


def test_a_damaged_checkpoint_goes_on_from_the_one_before(tmp_path, caplog):
    state = tmp_path / "state.npz"
    options = iga.SolverOptions(checkpoint=state)
    with pytest.raises(Killed):
        angles(options, report=killed_after(3))
    data = bytearray(state.read_bytes())
    data[len(data) // 2] ^= 1
    state.write_bytes(data)
    resumed = angles(replace(options, start=state))
    assert "state.npz: corrupt" in caplog.text
    assert resumed.end.measures == pytest.approx(angles().end.measures, rel=1e-10)
    (tmp_path / "state.previous.npz").unlink()
    state.write_bytes(data)
    with pytest.raises(iga.StateError, match="corrupt"):
        angles(replace(options, start=state))


def test_a_full_disk_does_not_end_a_path(tmp_path, monkeypatch, caplog):
    """S3: the step before stays on the disk, and the result comes back."""
    state = tmp_path / "state.npz"
    options = iga.SolverOptions(checkpoint=state)
    with pytest.raises(Killed):
        angles(options, report=killed_after(2))
    before = state.read_bytes()
    monkeypatch.setattr(os, "fsync", lambda handle: (_ for _ in ()).throw(OSError(28, "full")))
    assert angles(options).success
    assert "cannot be written ([Errno 28] full); going on without this checkpoint" in caplog.text
    assert state.read_bytes() == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["state.npz", "state.previous.npz"]


@pytest.mark.parametrize("ask", [iga.solve, lambda scene, options: angles(options)])
def test_a_checkpoint_that_cannot_be_written_is_named_before_any_work(tmp_path, ask, monkeypatch):
    """S4"""
    (tmp_path / "file").write_text("in the way")
    scene = droplet(120, 1.0, elements=8)
    monkeypatch.setattr(Assembly, "__init__", lambda *a, **k: pytest.fail("computed"))
    with pytest.raises(iga.OutputError, match="cannot be written"):
        ask(scene, iga.SolverOptions(checkpoint=tmp_path / "file" / "out" / "state.npz"))


def test_a_checkpoint_of_another_version_is_refused(tmp_path, monkeypatch):
    """S11"""
    state = tmp_path / "state.npz"
    options = iga.SolverOptions(checkpoint=state)
    with pytest.raises(Killed):
        angles(options, report=killed_after(2))
    monkeypatch.setattr("iga_membrane.driver.state.__version__", "999")
    with pytest.raises(iga.StateError, match="not the state of this path"):
        angles(replace(options, start=state))


@pytest.mark.parametrize("change", [{"tolerance": 1e-7}, {"quadrature": 6}])
def test_a_checkpoint_of_other_options_is_refused(tmp_path, change):
    state = tmp_path / "state.npz"
    options = iga.SolverOptions(checkpoint=state)
    with pytest.raises(Killed):
        angles(options, report=killed_after(2))
    with pytest.raises(iga.StateError, match="not the state of this path"):
        angles(replace(options, start=state, **change))


def test_a_solution_starts_another_solve_of_its_space(tmp_path):
    saved = tmp_path / "drop.npz"
    iga.solve(droplet(120, 1.0, elements=8)).save(saved)
    scene = droplet(125, 1.2, elements=8)
    fresh = iga.solve(scene)
    started = iga.solve(scene, iga.SolverOptions(start=saved))
    for name in ("energy", "height", "contact_radius", "pressure"):
        assert started.measures[name] == pytest.approx(fresh.measures[name], rel=1e-6)
    with pytest.raises(iga.SceneError, match="expected from the discretization"):
        iga.solve(droplet(125, 1.2, elements=9), iga.SolverOptions(start=saved))
    with pytest.raises(iga.SceneError, match=r"solver\.start"):
        iga.SolverOptions(start="drop.json")


PATH = path_file("substrate.contact_angle", [90.0, 105.0, 120.0, 135.0, 150.0])
SCENE = droplet_file(90.0, 1.0, PATH, elements=12, degree=4, model="half")


@pytest.mark.parametrize(
    "sign", [signal.SIGKILL, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)]
)
def test_a_killed_command_goes_on_from_its_state(tmp_path, sign):
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(SCENE)
    command = [sys.executable, "-m", "iga_membrane", "solve", str(scene), "--out", str(out)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    state = out / "state.npz"
    deadline = time.monotonic() + 60
    while not (out / "state.previous.npz").exists():
        assert process.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.005)
    process.send_signal(sign)
    process.wait()
    assert process.returncode != 0
    assert not (out / "result.json").exists()
    again = tmp_path / "again.toml"
    kept = state.read_bytes()
    again.write_text(SCENE + "[[")  # refused: what the path goes on from stays
    assert main(["solve", str(again), "--out", str(out)]) == 2
    assert state.read_bytes() == kept
    again.write_text(SCENE.replace("[[path]]", f'[solver]\nstart = "{state}"\n[[path]]'))
    assert main(["solve", str(again), "--out", str(out)]) == 0
    assert main(["solve", str(scene), "--out", str(tmp_path / "whole")]) == 0
    one, two = (
        json.loads((folder / "result.json").read_text()) for folder in (out, tmp_path / "whole")
    )
    assert one["measures"] == pytest.approx(two["measures"], rel=1e-10)
    assert [s["value"] for s in one["history"]] == [s["value"] for s in two["history"]]
    visible = sorted(p.name for p in out.iterdir() if not p.name.startswith("."))
    assert visible == ["result.json", "state.npz"]


def test_a_foreign_start_exits_2(tmp_path, capsys):
    (tmp_path / "state.npz").write_bytes(b"PK")
    scene = tmp_path / "scene.toml"
    text = SCENE.replace("[[path]]", f'[solver]\nstart = "{tmp_path / "state.npz"}"\n[[path]]')
    scene.write_text(text)
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 2
    assert "not a state file" in capsys.readouterr().err
