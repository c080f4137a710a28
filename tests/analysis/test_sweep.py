"""Sweeps: nothing lost, nothing twice, whatever is killed (S1, S6-S9, S11-S13)."""

import csv
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from analysis.sweep_scenes import Counting, Deadly, drop, hanging, threads
from helpers import droplet_file

import iga_membrane as iga
from iga_membrane.analysis.record_store import LAPSE, RecordStore
from iga_membrane.cli import main

HERE = Path(__file__).parent
ANGLES = [40.0, 60.0, 80.0, 100.0]


def measures(found):
    return [record["result"]["measures"] for record in found.records]


def inside(over, **options):
    """A sweep in this process."""
    with ThreadPoolExecutor(1) as executor:
        return iga.sweep(drop, over, executor=executor, **options)


def test_a_grid_is_the_product_of_its_values(tmp_path):
    found = inside({"angle": [60.0, 120.0], "bond": [0.1, 1.0, 2.0]}, out=tmp_path)
    assert found.success
    assert found.computed == 6
    assert found.column("angle") == pytest.approx([60, 60, 60, 120, 120, 120])
    assert found.column("bond") == pytest.approx([0.1, 1, 2] * 2)
    assert found.column("height")[1] == iga.solve(drop(60.0, 1.0)).measures["height"]
    assert found.statuses == {"CONVERGED_STABLE": 6}
    found.save(tmp_path / "table.csv")
    with open(tmp_path / "table.csv") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["height"]) for row in rows] == found.column("height").tolist()
    found.save(tmp_path / "table.npz")
    with np.load(tmp_path / "table.npz", allow_pickle=False) as table:
        assert np.array_equal(table["height"], found.column("height"))
        assert set(table["status"]) == {"CONVERGED_STABLE"}
    with pytest.raises(iga.OutputError, match="ending must be"):
        found.save(tmp_path / "table.xlsx")


def test_a_sweep_is_a_frame_and_a_dataset_on_its_grid():
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    found = inside({"angle": [60.0, 120.0], "bond": [0.1, 1.0, 2.0]})
    frame, data = found.to_dataframe(), found.to_xarray()
    assert frame["height"].tolist() == found.column("height").tolist()
    assert frame["bond_number"].tolist() == pytest.approx([0.1, 1.0, 2.0] * 2)
    assert dict(data.sizes) == {"angle": 2, "bond": 3}
    assert float(data.height.sel(angle=120.0, bond=1.0)) == found.column("height")[4]
    assert data.status.values.tolist() == [["CONVERGED_STABLE"] * 3] * 2


def test_a_second_call_computes_only_what_is_missing(tmp_path):
    first = inside({"angle": ANGLES}, out=tmp_path)
    for path, when in zip(tmp_path.glob("*.json"), (0, 0, 4e9, 4e9), strict=True):
        os.utime(path, (when, when))  # S12: clocks that jump
    again = inside({"angle": ANGLES}, out=tmp_path)
    assert again.computed == 0
    assert again.records == first.records
    more = inside({"angle": [*ANGLES, 120.0]}, out=tmp_path)
    assert more.computed == 1
    victim = next(tmp_path.glob("*.json"))
    text = victim.read_text()
    victim.write_text(text[: len(text) // 2])
    assert inside({"angle": ANGLES}, out=tmp_path).computed == 1
    assert victim.read_text().splitlines()[0].startswith("sha256 ")


def test_order_and_workers_do_not_matter(tmp_path):
    """S13: in this process, in two processes, shuffled."""
    plain = inside({"angle": ANGLES})
    shuffled = iga.sweep(drop, {"angle": [100.0, 60.0, 40.0, 80.0]}, workers=2)
    order = [1.0 * a for a in shuffled.column("angle")]
    for angle, one in zip(ANGLES, measures(plain), strict=True):
        assert measures(shuffled)[order.index(angle)] == pytest.approx(one, rel=1e-12)


def test_scenes_that_are_refused_or_fail_are_records():
    found = inside({"angle": [60.0, 200.0]})
    assert not found.success
    assert "contact_angle = 200.0" in found.records[1]["error"]
    assert np.isnan(found.column("height")[1])
    with ThreadPoolExecutor(1) as executor:
        failed = iga.sweep(
            drop, {"angle": [150.0], "bond": [10.0]}, executor=executor,
            options=iga.SolverOptions(max_iterations=1),
        )  # fmt: skip
    assert failed.records[0]["result"]["success"] is False


@pytest.mark.parametrize(
    ("over", "options", "said"),
    [
        ({}, {}, "name at least one parameter"),
        ({"angle": []}, {}, r"over\['angle'\] = \[\]"),
        ({"angle": 5}, {}, r"over\['angle'\] = 5"),
        ({"angle": "90"}, {}, r"over\['angle'\] = '90'"),
        ({"angle": [90.0, 90.0]}, {}, "given twice"),
        ({"angle": range(2000), "bond": range(2000)}, {}, "4000000 points"),
        ([90.0], {}, "over = "),
        ({"angle": [90.0, float("nan")]}, {}, "nan"),
        ({"angle": [90.0, None]}, {}, "None"),
        ({"angle": [{"a": 1}]}, {}, "angle"),
        ({"angle": [90.0]}, {"workers": 0}, "workers = 0"),
        ({"angle": [90.0]}, {"timeout": -1.0}, "timeout"),
        ({"angle": [90.0]}, {"options": 5}, "options = 5"),
        ({"angel": [90.0]}, {}, "angel"),
        ({"angle": [90.0], "tilt": [0.0]}, {}, "tilt"),
    ],
)
def test_bad_sweeps_are_named(over, options, said):
    with pytest.raises(iga.SceneError, match=said):
        iga.sweep(drop, over, **options)


def test_a_function_that_cannot_be_sent_is_named(tmp_path):
    lock = threading.Lock()

    def scene_of(angle):
        with lock:
            return drop(angle)

    with pytest.raises(iga.SceneError, match="cannot be sent to a process"):
        iga.sweep(scene_of, {"angle": [90.0]}, out=tmp_path)
    with ThreadPoolExecutor(1) as executor:
        found = iga.sweep(scene_of, {"angle": [90.0]}, out=tmp_path, executor=executor)
    assert (found.success, found.computed) == (True, 1)


def test_a_folder_that_cannot_be_written_is_named_before_any_work(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(iga.OutputError):
        iga.sweep(Deadly([90.0], tmp_path), {"angle": [90.0]}, out=tmp_path / "file" / "out")


def other_drop(angle, bond=2.0):
    return drop(angle, bond)


def test_records_of_another_question_are_not_mixed(tmp_path, monkeypatch):
    """S11: other options, another scene, another version."""
    inside({"angle": ANGLES[:2]}, out=tmp_path)
    other = iga.SolverOptions(tolerance=1e-6)
    with pytest.raises(iga.SceneError, match="allow_mixed"):
        inside({"angle": ANGLES}, out=tmp_path, options=other)
    with ThreadPoolExecutor(1) as executor, pytest.raises(iga.SceneError, match="allow_mixed"):
        iga.sweep(other_drop, {"angle": ANGLES}, out=tmp_path, executor=executor)
    mixed = inside({"angle": ANGLES}, out=tmp_path, options=other, allow_mixed=True)
    assert mixed.mixed
    assert mixed.computed == 2
    with monkeypatch.context() as patch:
        patch.setattr("iga_membrane.analysis.job.__version__", "999")
        with pytest.raises(iga.SceneError, match="another version"):
            inside({"angle": ANGLES}, out=tmp_path)
    limits = iga.SolverOptions(max_cpu_s=100.0)  # no other numbers
    shutil.rmtree(tmp_path)
    inside({"angle": ANGLES[:2]}, out=tmp_path)
    assert not inside({"angle": ANGLES}, out=tmp_path, options=limits).mixed


@pytest.mark.parametrize(
    ("points", "workers"), [(4, 2), pytest.param(30, 2, marks=pytest.mark.slow)]
)
def test_a_point_that_kills_its_worker_costs_only_itself(points, workers, tmp_path):
    """S7: every tenth point, tried again twice."""
    angles = [40.0 + 3.0 * k for k in range(points)]
    deadly = angles[1::10]
    found = iga.sweep(Deadly(deadly, tmp_path), {"angle": angles}, workers=workers)
    failed = [r for r in found.records if r["parameters"]["angle"] in deadly]
    assert all("worker died" in record["error"] for record in failed)
    assert [(tmp_path / f"{angle:g}").stat().st_size for angle in deadly] == [3] * len(deadly)
    solved = points - len(deadly)
    assert found.statuses == {"CONVERGED_STABLE": solved, "no result": len(deadly)}


def test_a_worker_lost_once_is_replaced_and_its_point_tried_again(tmp_path):
    found = iga.sweep(Deadly(ANGLES[:2], tmp_path, 1), {"angle": ANGLES}, workers=1)
    assert found.success
    assert found.computed == 4


def test_a_hanging_point_is_ended_and_costs_only_itself():
    """S8: its worker, the only one, is replaced for the others."""
    found = iga.sweep(hanging, {"angle": [100.0, 60.0, 80.0]}, workers=1, timeout=3.0)
    assert [("result" in record) for record in found.records] == [False, True, True]
    assert "no answer within 3 s" in found.records[0]["error"]


def test_workers_run_blas_on_one_thread(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    assert iga.sweep(threads, {"angle": [90.0]}, workers=1).success


def test_an_executor_that_breaks_is_replaced(caplog, tmp_path):
    with ProcessPoolExecutor(2) as executor:
        found = iga.sweep(Deadly([60.0], tmp_path), {"angle": ANGLES}, executor=executor)
    assert sum("result" in record for record in found.records) == 3
    assert "going on with processes of our own" in caplog.text


def test_a_claim_of_a_process_that_is_gone_counts_for_nothing(tmp_path):
    """S6: a stale lock."""
    store = RecordStore(tmp_path)
    child = subprocess.Popen([sys.executable, "-c", "pass"])
    while Path(f"/proc/{child.pid}/stat").read_text().split()[2] != "Z":
        time.sleep(0.01)  # ended, though nobody has asked for its exit code yet
    key = store.key({"angle": 90.0})
    (tmp_path / f".{key}.claim").write_text(f"{os.uname().nodename} {child.pid}")
    assert store.claim(key)
    assert not store.claim(key)
    assert not RecordStore(tmp_path).claim(key)
    store.release(key)
    child.wait()
    (tmp_path / f".{key}.claim").write_text(f"{os.uname().nodename} {child.pid}")
    assert store.claim(key)
    (tmp_path / f".{key}.claim").write_text("another-host 1")
    assert not store.claim(key)
    long_ago = time.time() - 2.0 * LAPSE
    os.utime(tmp_path / f".{key}.claim", (long_ago, long_ago))
    store.renew([key])
    assert not store.claim(key)
    os.utime(tmp_path / f".{key}.claim", (long_ago, long_ago))
    assert store.claim(key)


def started(where, pause, points, workers, **options):
    command = [sys.executable, str(HERE / "sweep_scenes.py"), str(where), *map(str, (pause, points,
               workers))]  # fmt: skip
    return subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            # run in the background, the tests ignore interrupts
                            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
                            **options)  # fmt: skip


def records(where):
    """Of finished points; what a killed process was writing is hidden."""
    paths = (path for path in where.glob("*.json") if not path.name.startswith("."))
    return {path.stem: path.read_bytes() for path in paths}


def killed_and_resumed(tmp_path, kills, points, pause, rng):
    """Kill a sweep at random moments, then let it end: no record is broken or touched again, and
    all are those of a sweep without kills, bit by bit. Returns how often it was killed."""
    where = tmp_path / "points"
    finished, killed = {}, 0
    for _ in range(kills):
        process = started(where, pause, points, 2, start_new_session=True)
        time.sleep(rng.uniform(0.5, 3.5))
        killed += process.poll() is None
        os.killpg(process.pid, signal.SIGKILL) if rng.random() < 0.5 else process.kill()
        process.communicate()
        found = records(where)
        assert all(RecordStore(where).read(key) is not None for key in found)
        assert finished.items() <= found.items()
        finished = found
    said, _ = started(where, 0.0, points, 2).communicate(timeout=300)
    total, computed, success = said.split()
    assert (int(total), success) == (points, "True")
    assert int(computed) == points - len(finished)
    assert finished.items() <= records(where).items()
    assert len(records(where)) == points
    for record in inside({"angle": [30.0 + 4.0 * k for k in range(points)]}).records:
        kept = RecordStore(where).read(RecordStore.key(record["parameters"]))
        assert kept["result"]["measures"] == record["result"]["measures"]
    return killed


@pytest.mark.slow
def test_a_killed_sweep_loses_only_what_was_in_flight(tmp_path):
    killed = killed_and_resumed(tmp_path, 2, 8, 0.3, random.Random(2))
    assert killed >= 1
    built = (tmp_path / "points.log").read_text().splitlines()
    in_flight, seen_again = 2 * 2, 2  # twice as many as workers; the check on resume
    assert len(built) <= 8 + 2 * (in_flight + seen_again)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_forty_kills_of_a_sweep_lose_nothing(tmp_path, seed):
    """S1: eight sweeps of thirty points, killed five times each."""
    assert killed_and_resumed(tmp_path, 5, 30, 1.0, random.Random(seed)) == 5


def test_every_flipped_bit_of_a_record_is_noticed(tmp_path):
    """S5: a damaged record counts for nothing."""
    store = RecordStore(tmp_path)
    store.write("one", {"parameters": {"angle": 90.0}, "result": {"measures": {"height": 1.25}}})
    path, rng = tmp_path / "one.json", np.random.default_rng(4)
    data = path.read_bytes()
    assert store.read("one") is not None
    for place in range(len(data)):
        flipped = bytearray(data)
        flipped[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(flipped)
        assert store.read("one") is None
        path.write_bytes(data[:place])
        assert store.read("one") is None


def test_a_full_disk_ends_a_sweep_by_name_and_keeps_its_records(tmp_path, monkeypatch):
    """S3"""
    inside({"angle": ANGLES[:2]}, out=tmp_path)
    before = records(tmp_path)

    def full(*arguments, **options):
        raise OSError(28, "No space left on device")

    for place in ("os.fsync", "pathlib.Path.write_text"):
        with monkeypatch.context() as patch:
            patch.setattr(place, full)
            with pytest.raises(iga.OutputError, match="No space left"):
                inside({"angle": ANGLES}, out=tmp_path)
        assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == {
            f"{key}.json": data for key, data in before.items()
        }


@pytest.mark.parametrize("points", [10, pytest.param(200, marks=pytest.mark.slow)])
def test_two_processes_share_a_folder(tmp_path, points):
    """S6: every point once, none broken."""
    where = tmp_path / "points"
    both = [started(where, 0.05 if points == 10 else 0.0, points, 1) for _ in range(2)]
    said = [process.communicate(timeout=600)[0].split() for process in both]
    assert [int(total) for total, _, _ in said] == [points, points]
    assert sum(int(computed) for _, computed, _ in said) == points
    assert len(records(where)) == points
    assert not list(where.glob(".*.claim"))


def test_an_interrupt_ends_a_sweep_and_leaves_valid_records(tmp_path):
    """S9"""
    where = tmp_path / "points"
    process = started(where, 0.3, 20, 2)
    deadline = time.monotonic() + 60
    while not where.exists() or len(records(where)) < 2:
        assert time.monotonic() < deadline
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    asked = time.monotonic()
    process.communicate(timeout=30)
    assert process.returncode in (130, -signal.SIGINT, 1)
    assert time.monotonic() - asked <= 2.0
    store = RecordStore(where)
    kept = [store.read(key) for key in records(where)]
    assert None not in kept
    assert len(kept) < 20
    assert not list(where.glob(".*.claim"))


OVER = """[[over]]
parameter = "substrate.contact_angle"
values = [60.0, 120.0]
[[over]]
parameter = "gravity.acceleration"
values = [0.5, 1.0]
"""
SWEEP = droplet_file(90.0, 1.0, OVER, elements=8)


def test_the_command_line_sweeps_and_goes_on(tmp_path, capsys):
    file, out = tmp_path / "sweep.toml", tmp_path / "out"
    file.write_text(SWEEP)
    command = ["sweep", str(file), "--out", str(out), "--workers", "1"]
    assert main(command) == 0
    assert "4 points (4 computed now): 4 CONVERGED_STABLE" in capsys.readouterr().out
    assert main(command) == 0
    assert "(0 computed now)" in capsys.readouterr().out
    with open(out / "table.csv") as table:
        rows = list(csv.DictReader(table))
    height = iga.solve(drop(120.0, 1.0)).measures["height"]
    assert float(rows[3]["height"]) == pytest.approx(height, rel=1e-12)
    assert (rows[3]["substrate.contact_angle"], rows[3]["status"]) == ("120.0", "CONVERGED_STABLE")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("[[over]]", "[[under]]"), "under: unknown key"),
        (('"substrate.contact_angle"', '"substrate.contact_angel"'), "over[0].parameter"),
        (("values = [60.0, 120.0]", "values = []"), "over[0].values = []"),
        (("values = [60.0, 120.0]", 'values = ["x"]'), "over[0].values[0] = 'x'"),
        (('"gravity.acceleration"', '"substrate.contact_angle"'), "given twice"),
        (("acceleration = 1.0", "acceleration = -1.0\nx = 1"), "gravity.x"),
        (('values = [60.0, 120.0]', "value = 1"), "over[0] = "),
        (('parameter = "substrate.contact_angle"', "parameter = 5"), "over[0].parameter = 5"),
    ],
)  # fmt: skip
def test_a_bad_sweep_file_exits_2(tmp_path, capsys, change, said):
    (tmp_path / "sweep.toml").write_text(SWEEP.replace(*change, 1))
    assert main(["sweep", str(tmp_path / "sweep.toml"), "--out", str(tmp_path / "out")]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_info_prints_a_result_wherever_it_lies(tmp_path, capsys):
    solution = iga.solve(drop(120.0))
    solution.save(tmp_path / "state.npz")
    solution.save(tmp_path / "result.json")
    for name in ("", "state.npz"):
        assert main(["info", str(tmp_path / name)]) == 0
        assert capsys.readouterr().out == solution.summary() + "\n"
    assert main(["info", str(tmp_path / "result.json")]) == 0
    said = capsys.readouterr().out
    assert repr(solution.measures["height"]) in said
    for path in (tmp_path / "nowhere", tmp_path / "empty"):
        (tmp_path / "empty").mkdir(exist_ok=True)
        assert main(["info", str(path)]) == 2
    (tmp_path / "other.json").write_text(json.dumps({"a": 1}))
    assert main(["info", str(tmp_path / "other.json")]) == 2
    assert "not a result file" in capsys.readouterr().err
    newer = json.loads((tmp_path / "result.json").read_text()) | {"schema": 2}
    (tmp_path / "newer.json").write_text(json.dumps(newer))
    assert main(["info", str(tmp_path / "newer.json")]) == 2
    assert "schema 2, this version reads schema 1" in capsys.readouterr().err


def test_plot_draws_a_result(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr("iga_membrane.view.picture.check_drawing", lambda: None)
    monkeypatch.setattr(
        "iga_membrane.view.picture.plot", lambda s, path, **k: drawn.append((s, path, k))
    )
    iga.solve(drop(120.0)).save(tmp_path / "state.npz")
    assert main(["plot", str(tmp_path), "--color", "pressure"]) == 0
    solution, path, options = drawn[0]
    assert solution.success
    assert path == tmp_path / "picture.png"
    assert options == {"color": "pressure"}


def test_counting_scenes_are_counted(tmp_path):
    scene = Counting(tmp_path / "log")(90.0)
    assert scene.kind == "sessile_droplet"
    assert (tmp_path / "log").read_text() == "90 1\n"
