"""State files: bitwise back, never half-written, never trusted when damaged or foreign (S2-S5,
X1-X4, X7, X8)."""

import ast
import io
import json
import os
import socket
import subprocess
import sys
import tracemalloc
import zipfile
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from helpers import droplet, particle_sheet, pinned_cap, within

import iga_membrane as iga
from iga_membrane import files
from iga_membrane.analysis.record_store import RecordStore
from iga_membrane.cli import main
from iga_membrane.driver.result_file import read_result
from iga_membrane.io.sweep_file import load_sweep
from iga_membrane.problems.scene import Ramp
from iga_membrane.records import digest
from iga_membrane.terms import BodyDensity, BodyTerm

PACKAGE = Path(iga.__file__).parent
SOLVED = {
    "plane": lambda: droplet(150, 1.0, elements=8),
    "contact area": lambda: droplet(180, 1.0, elements=8),
    "sphere": lambda: iga.sessile_droplet(
        iga.Sphere(contact_angle=90, radius=1.0, center=(0, 0, -1)), volume=1.0
    ),
    "sheet": lambda: particle_sheet(90, center=(0.3, 0, -1), elements=6, gravity=0.1),
    "from parts": lambda: pinned_cap(1.0, [iga.SurfaceTension(1.0), iga.Volume(0.8)], "half"),
    "nurbs": lambda: droplet(60, space="nurbs", elements=8),
    "saddle": lambda: droplet(120, 1.0, hold="none", model="full", elements=6),
}


@pytest.fixture(scope="module")
def drop():
    return iga.solve(droplet(120, 1.0, elements=8))


@pytest.fixture(scope="module")
def saved(drop, tmp_path_factory):
    path = tmp_path_factory.mktemp("state") / "drop.npz"
    drop.save(path)
    return path


@pytest.mark.parametrize("name", SOLVED)
def test_a_solution_comes_back_bit_by_bit(name, tmp_path):
    solution = iga.solve(SOLVED[name](), on_fail="return")
    solution.save(tmp_path / "state.npz")
    back = iga.load(tmp_path / "state.npz")
    assert digest(back) == digest(solution)
    assert np.array_equal(back.surface.points, solution.surface.points)
    assert back.summary() == solution.summary()
    assert back.measures == solution.measures
    assert back.status is solution.status
    points = solution.surface.points[:5]
    assert np.array_equal(back.pressure(points), solution.pressure(points))
    back.save(tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == (tmp_path / "state.npz").read_bytes()


def test_a_failed_solution_comes_back_too(tmp_path):
    gravity = [0.5, 0.0, -1.0]
    scene = iga.sessile_droplet(iga.Plane(contact_angle=90), volume=1.0, gravity=gravity)
    solution = iga.solve(scene, on_fail="return")
    solution.save(tmp_path / "state.npz")
    assert iga.load(tmp_path / "state.npz").status is iga.Status.NO_EQUILIBRIUM


def test_a_loaded_scene_refuses_to_call_functions_of_its_user_that_were_not_kept(tmp_path):
    path = iga.trace(lambda angle: droplet(angle, 1.0, elements=6), [100.0, 110.0])
    scene = path.end.scene
    own = replace(scene, ramp=Ramp("angle", (100.0, 110.0), lambda angle: scene), origin=None)
    replace(path.end, scene=own).save(tmp_path / "path.npz")
    with pytest.raises(iga.SceneError, match="build the scene anew"):
        iga.load(tmp_path / "path.npz").scene.ramp(0.5)


@dataclass(frozen=True)
class Field(BodyTerm):
    pull: float
    name = "field"

    def density(self):
        return BodyDensity(0.0, (0.0, 0.0, self.pull))

    def scaled(self, scale):
        return Field(self.pull * scale.length**2 / scale.tension)


def test_a_term_of_ones_own_is_named_when_it_is_missing(tmp_path):
    scene = droplet(120, elements=8)
    scene = replace(scene, terms=[*scene.terms, Field(1.0)], ramp=None)
    solution = iga.solve(scene)
    solution.save(tmp_path / "own.npz")
    with pytest.raises(iga.StateError, match="Field"):
        iga.load(tmp_path / "own.npz")
    assert digest(iga.load(tmp_path / "own.npz", also=[Field])) == digest(solution)


# Damage


def test_every_flipped_bit_is_noticed(saved, tmp_path):
    data = saved.read_bytes()
    rng = np.random.default_rng(5)
    path = tmp_path / "flipped.npz"
    for place in [*rng.integers(0, len(data), 180), *range(len(data) - 90, len(data), 4)]:
        flipped = bytearray(data)
        flipped[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(flipped)
        with pytest.raises(iga.StateError, match=r"flipped\.npz"):
            iga.load(path)


@pytest.mark.parametrize("part", [0.0, 1e-4, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.99, 0.9999])
def test_every_truncation_is_noticed(saved, tmp_path, part):
    path = tmp_path / "cut.npz"
    data = saved.read_bytes()
    path.write_bytes(data[: int(part * len(data))])
    with pytest.raises(iga.StateError, match=r"cut\.npz: not a state file"):
        iga.load(path)


@pytest.mark.slow
def test_mutated_files_are_only_refused_and_quickly(saved, tmp_path):
    data = saved.read_bytes()
    rng = np.random.default_rng(11)
    path = tmp_path / "mutated.npz"
    for _ in range(1000):
        mutated = bytearray(data)
        for _ in range(rng.integers(1, 6)):
            start = int(rng.integers(len(mutated)))
            end = start + int(rng.integers(1, 50))
            match int(rng.integers(3)):
                case 0:
                    mutated[start:end] = rng.bytes(end - start)
                case 1:
                    del mutated[start:end]
                case 2:
                    mutated[start:start] = rng.bytes(end - start)
        path.write_bytes(mutated)
        with within(1.0), pytest.raises(iga.StateError):
            iga.load(path)


@pytest.mark.slow
def test_mutated_result_files_are_printed_or_refused_and_quickly(drop, tmp_path, capsys):
    """X7"""
    drop.save(tmp_path / "result.json")
    data = (tmp_path / "result.json").read_bytes()
    rng = np.random.default_rng(12)
    path, codes = tmp_path / "mutated.json", []
    for _ in range(1000):
        mutated = bytearray(data)
        for _ in range(rng.integers(1, 4)):
            start = int(rng.integers(len(mutated)))
            end = start + int(rng.integers(1, 8))
            match int(rng.integers(4)):
                case 0:
                    mutated[start:end] = rng.bytes(end - start)
                case 1:
                    del mutated[start:end]
                case 2:
                    mutated[start : start + 1] = b"0123456789-.e"[rng.integers(13)].to_bytes()
                case 3:
                    mutated[start:start] = mutated[: end - start]
        path.write_bytes(mutated)
        with within(1.0):
            codes.append(main(["info", str(path)]))
    assert set(codes) == {0, 2}


@pytest.mark.parametrize(
    "record",
    [[], 5, {}, {"status": "X"}, {"status": 5, "measures": {}, "dimensionless": {}, "schema": 1},
     {"status": "X", "measures": [], "dimensionless": {}, "schema": 1}],
)  # fmt: skip
def test_what_is_no_result_file_is_named(tmp_path, record):
    (tmp_path / "result.json").write_text(json.dumps(record))
    with pytest.raises(iga.StateError, match=r"result\.json: not a result file"):
        read_result(tmp_path / "result.json")


def forged(path, header, arrays):
    """A file with a right checksum, as only a malicious hand would write it."""
    files.write_arrays(path, header, arrays)
    return path


@pytest.mark.parametrize(
    "state",
    [
        None,
        [],
        {"record": "os.system", "fields": {"command": "true"}},
        {"record": "subprocess.Popen", "fields": {"args": "true"}},
        {"record": "cli.main", "fields": {}},
        {"record": "driver.solution.Solution", "fields": {}},
        {"record": "terms.tension.SurfaceTension", "fields": {"gamma": "1"}},
        {"record": "files.write_whole", "fields": {}},
        {"record": "records.__class__", "fields": {}},
        {"enum": "solvers.options.SolverOptions", "value": "x"},
        {"enum": "status.Status", "value": "FINE"},
        {
            "record": "problems.recipe.Recipe",
            "fields": {"family": "os.system", "arguments": {"map": [["command", "true"]]}},
        },
        {"array": "nowhere"},
        {"map": [1]},
        {"tuple": [{"tuple": [{"nothing": 1}]}]},
    ],
)
def test_a_forged_state_builds_nothing(tmp_path, state):
    with pytest.raises(iga.StateError, match=r"forged\.npz"):
        iga.load(forged(tmp_path / "forged.npz", {"state": state}, {}))


def rewrite(path, members):
    """A zip of these members with a right checksum."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for (name, data), compression in members:
            archive.writestr(name, data, compression)
        archive.comment = b"iga_membrane state " + b"  1 " + b"0" * 64
    import hashlib

    body = buffer.getvalue()[:-64]
    path.write_bytes(body + hashlib.sha256(body).hexdigest().encode())
    return path


def npy(array):
    stream = io.BytesIO()
    np.save(stream, array, allow_pickle=True)
    return stream.getvalue()


class Bomb:
    def __init__(self, sentinel):
        self.sentinel = sentinel

    def __reduce__(self):
        return (open, (str(self.sentinel), "w"))


def test_an_object_array_is_refused_and_nothing_runs(tmp_path):
    sentinel = tmp_path / "ran"
    data = npy(np.array([Bomb(sentinel)], dtype=object))
    sentinel.unlink(missing_ok=True)
    path = rewrite(tmp_path / "bomb.npz", [(("header.npy", data), zipfile.ZIP_STORED)])
    with pytest.raises(iga.StateError, match=r"bomb\.npz"):
        iga.load(path)
    np.savez(tmp_path / "plain.npz", header=np.array([Bomb(sentinel)], dtype=object))
    sentinel.unlink(missing_ok=True)
    with pytest.raises(iga.StateError, match=r"plain\.npz: not a state file"):
        iga.load(tmp_path / "plain.npz")
    assert not sentinel.exists()


def huge_header(shape):
    stream = io.BytesIO()
    stream.write(np.lib.format.magic(1, 0))
    np.lib.format.write_array_header_1_0(
        stream, {"descr": "<f8", "fortran_order": False, "shape": shape}
    )
    return stream.getvalue()


@contextmanager
def cheap():
    """At most 1 CPU second and 100 MB."""
    tracemalloc.start()
    try:
        with within(1.0):
            yield
        assert tracemalloc.get_traced_memory()[1] <= 100e6
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(
    "member",
    [
        lambda: (("header.npy", huge_header((10**12,))), zipfile.ZIP_STORED),
        lambda: (("header.npy", huge_header((-1,))), zipfile.ZIP_STORED),
        lambda: (("header.npy", npy(np.zeros(200_000_000, np.uint8))), zipfile.ZIP_DEFLATED),
        lambda: (("header.npy", npy(np.frombuffer(b"[" * 100_000, np.uint8))), zipfile.ZIP_STORED),
        lambda: (("header.npy", b"\x93NUMPY\x07\x00"), zipfile.ZIP_STORED),
        lambda: (("other.npy", npy(np.zeros(2))), zipfile.ZIP_STORED),
    ],
    ids=["1e12 entries", "negative", "zip bomb", "deep json", "npy version", "no header"],
)
def test_files_that_claim_too_much_cost_neither_time_nor_memory(tmp_path, member):
    path = rewrite(tmp_path / "huge.npz", [member()])
    with cheap(), pytest.raises(iga.StateError, match=r"huge\.npz"):
        iga.load(path)


def test_a_gigabyte_of_nothing_is_refused_at_once(tmp_path):
    for name in ("large.npz", "large.toml"):
        with open(tmp_path / name, "wb") as file:
            file.truncate(2_000_000_000)  # sparse
    with cheap(), pytest.raises(iga.StateError, match="larger than"):
        iga.load(tmp_path / "large.npz")
    with cheap(), pytest.raises(iga.SceneError, match="larger than"):
        iga.load_scene(tmp_path / "large.toml")


def test_a_newer_file_names_both_versions(saved, tmp_path, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(files, "SCHEMA", 7)
        files.write_arrays(tmp_path / "newer.npz", {}, {})
    with pytest.raises(iga.StateError, match=r"newer\.npz: schema 7, this version reads schema 1"):
        iga.load(tmp_path / "newer.npz")


@pytest.mark.parametrize(
    "make", [lambda p: p.mkdir(), lambda p: None, lambda p: p.write_bytes(b"")]
)
def test_what_is_no_file_is_named(tmp_path, make):
    path = tmp_path / "state.npz"
    make(path)
    with pytest.raises(iga.StateError, match=r"state\.npz"):
        iga.load(path)


def test_a_full_disk_leaves_the_generation_before(drop, tmp_path):
    """A write that meets the limit of file sizes, in a process of its own."""
    drop.save(tmp_path / "state.npz")
    before = (tmp_path / "state.npz").read_bytes()
    code = f"""
import resource, signal
import iga_membrane as iga
solution = iga.load({str(tmp_path / "state.npz")!r})
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
try:
    solution.save({str(tmp_path / "state.npz")!r})
except iga.OutputError as error:
    print("OutputError", "state.npz" in str(error), solution.success)
"""
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["OutputError", "True", "True"]
    assert (tmp_path / "state.npz").read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["state.npz"]


# What the package never does with a file


BANNED = {"pickle", "marshal", "shelve", "dill", "joblib", "cloudpickle", "yaml"}


def dangerous(code):
    """Whether code can unpickle, evaluate, or call a shell."""
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.Import) and BANNED & {a.name.split(".")[0] for a in node.names}:
            return True
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in BANNED:
            return True
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", "")
            owner = getattr(getattr(node.func, "value", None), "id", "")
            of_os = owner == "os" and node.func.attr.startswith(
                ("system", "popen", "exec", "spawn")
            )
            if name in ("eval", "exec", "compile", "__import__") or of_os:
                return True
            for word in node.keywords:
                true = not isinstance(word.value, ast.Constant) or word.value.value is True
                if word.arg in ("allow_pickle", "shell", "jinja2") and true:
                    return True
    return False


@pytest.mark.parametrize(
    "code",
    [
        "import pickle", "from marshal import loads", "import shelve", "import dill, os",
        "from joblib import load", "eval('1')", "exec(text)", "compile(text, '', 'exec')",
        "__import__('os')", "import yaml; yaml.load(text)", "np.load(path, allow_pickle=True)",
        "os.system(text)", "os.popen(text)", "subprocess.run(text, shell=True)",
        "run(text, shell=given)", "exchange.import_json(path, jinja2=True)",
    ],
)  # fmt: skip
def test_the_scan_knows_what_executes(code):
    assert dangerous(code)


def test_no_file_content_is_ever_executed():
    """X1, X6: no unpickling, no evaluation, no shell, no templates, anywhere in the package, but
    where a sweep packs its caller's function for its own workers, in a module that reads no file.
    """
    files = list(PACKAGE.rglob("*.py"))
    assert len(files) > 100
    portable = PACKAGE / "analysis" / "portable.py"
    assert [path for path in files if dangerous(path.read_text())] == [portable]
    words = {node.id for node in ast.walk(ast.parse(portable.read_text()))
             if isinstance(node, ast.Name)}  # fmt: skip
    assert not words & {"open", "Path", "read_file"}


def test_an_output_folder_is_never_named_by_the_scene_file():
    """X4: a scene file has no field that names an output; the measured map is read."""
    from iga_membrane.io.scene_keys import KEYS

    keys = {(t, k) for t in KEYS if t for k in KEYS[t]} - {("substrate", "file")}
    assert not {"out", "output", "path", "file", "name"} & {k for _, k in keys}


# Only regular files are read


@pytest.fixture
def unreadable(tmp_path, saved):
    """Places that a path can lead to and that are no file of ours, by their kind."""

    def make(kind, suffix):
        path = tmp_path / f"given{suffix}"
        places = {"device": "/dev/zero", "terminal": "/dev/tty", "null": "/dev/null",
                  "endless": "/proc/self/mem", "gone": tmp_path / "nowhere"}  # fmt: skip
        if kind == "pipe":
            os.mkfifo(path)
        elif kind == "folder":
            path.mkdir()
        elif kind == "socket":
            with socket.socket(socket.AF_UNIX) as made:
                made.bind(str(path))
        elif kind == "circle":
            path.symlink_to(path)
        else:
            path.symlink_to(places[kind])
        return path

    return make


READERS = {
    "load_scene": (".toml", iga.load_scene, iga.SceneError),
    "load_scene, json": (".json", iga.load_scene, iga.SceneError),
    "load_sweep": (".toml", load_sweep, iga.SceneError),
    "load": (".npz", iga.load, iga.StateError),
    "read_result": (".json", read_result, iga.StateError),
    "start": (".npz", lambda path: iga.solve(droplet(120, elements=8),
                                             iga.SolverOptions(start=path)), iga.StateError),
}  # fmt: skip
KINDS = ["pipe", "device", "terminal", "null", "endless", "folder", "socket", "circle", "gone"]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("reader", READERS)
def test_only_regular_files_are_read(reader, kind, unreadable):
    """At once: a pipe has no writer, a device no end."""
    suffix, read, wrong = READERS[reader]
    path = unreadable(kind, suffix)
    with cheap(), pytest.raises(wrong, match=f"given{suffix}"):
        read(path)


@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
def test_the_command_line_reads_only_regular_files(kind, unreadable, tmp_path, capsys):
    for command, suffix in (("solve", ".toml"), ("sweep", ".json")):
        path = unreadable(kind, suffix)
        assert main([command, str(path), "--out", str(tmp_path / "out")]) == 2
        assert f"{path}: cannot be read: it is a {kind}" in capsys.readouterr().err
    path = unreadable(kind, ".npz")
    for command in (["info", str(path)], ["plot", str(path), "--out", str(tmp_path / "a.png")]):
        assert main(command) == 2
    assert not (tmp_path / "out").exists()


def test_a_record_of_a_sweep_that_is_a_pipe_counts_for_nothing(tmp_path):
    store = RecordStore(tmp_path)
    os.mkfifo(tmp_path / "one.json")
    os.mkfifo(tmp_path / ".one.claim")
    assert store.read("one") is None
    assert not store.claim("one")


def test_a_link_to_a_file_is_read(saved, tmp_path, drop):
    (tmp_path / "link.npz").symlink_to(saved)
    assert iga.load(tmp_path / "link.npz").measures == drop.measures
