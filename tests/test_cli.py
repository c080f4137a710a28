"""Exit codes, files and their order: nothing is computed before it can be written (S4)."""

import functools
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

import numpy as np
import pytest
from drop_camera import photograph, sessile
from helpers import droplet_file, within

import iga_membrane as iga
from iga_membrane.cli import main
from iga_membrane.command_line import COMMANDS, parser
from iga_membrane.io.first_scene import KINDS
from iga_membrane.io.scene_readers import READERS
from iga_membrane.view.export import known_endings

SCENE = droplet_file(150.0, 1.0, degree=3, elements=8)


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def test_a_solved_scene_writes_result_state_and_surface(scene, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["solve", str(scene), "--out", str(out), "--vtu"]) == 0
    assert "CONVERGED_STABLE" in capsys.readouterr().out
    result = json.loads((out / "result.json").read_text())
    assert result["schema"] == 1
    assert result["success"] is True
    assert result["stability_scope"] == "full"
    assert result["index"] == 0
    assert result["lambda_min"] > 0
    assert set(result["cpu_seconds"]) == {
        "import", "compile", "assembly", "linear", "contact", "solve", "total"
    }  # fmt: skip
    assert result["scene"]["discretization"]["elements"] == 8
    assert iga.load(out / "state.npz").measures == result["measures"]
    assert sorted(p.name for p in out.iterdir()) == ["result.json", "state.npz", "surface.vtu"]


def test_a_bad_scene_exits_2_and_writes_nothing(scene, tmp_path, capsys):
    scene.write_text(SCENE.replace("150.0", "250.0"))
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 2
    assert "substrate.contact_angle = 250.0" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_failed_solve_exits_3_and_still_writes_its_result(scene, tmp_path):
    scene.write_text(
        SCENE.replace("acceleration = 1.0", "acceleration = 1.0\ndirection = [1, 0, -1]")
    )
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 3
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["status"] == "NO_EQUILIBRIUM"
    assert result["success"] is False
    assert result["contact"]["hold_force"][0] == pytest.approx(-4.18879 / np.sqrt(2), rel=1e-4)


def test_an_output_that_cannot_be_written_exits_4_before_computing(scene, tmp_path, monkeypatch):
    """S4: under a regular file, which stops the superuser too."""
    (tmp_path / "file").write_text("in the way")
    over = '[[over]]\nparameter = "substrate.contact_angle"\nvalues = [60, 90]\n'
    (tmp_path / "sweep.toml").write_text(scene.read_text() + over)
    for name in ("cli.solve", "analysis.sweep.sweep", "driver.state.load"):
        monkeypatch.setattr(f"iga_membrane.{name}", lambda *a, **k: pytest.fail("computed"))
    out = str(tmp_path / "file" / "out")
    with within(1.0):
        assert main(["solve", str(scene), "--out", out]) == 4
        assert main(["sweep", str(tmp_path / "sweep.toml"), "--out", out]) == 4
        assert main(["export", str(tmp_path), f"{out}/drop.stl"]) == 4
        assert main(["plot", str(tmp_path), "--out", f"{out}/drop.png"]) == 4


def test_an_output_never_leaves_its_folder_by_a_link(scene, tmp_path):
    """X4: a link where a file is to be written is replaced, not followed."""
    (tmp_path / "victim").write_text("mine")
    (tmp_path / "out").mkdir()
    for name in ("result.json", "state.npz"):
        (tmp_path / "out" / name).symlink_to(tmp_path / "victim")
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 0
    assert (tmp_path / "victim").read_text() == "mine"
    assert not (tmp_path / "out" / "state.npz").is_symlink()


def test_an_interrupt_exits_130(scene, tmp_path, monkeypatch):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr("iga_membrane.cli.solve", interrupted)
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 130


def test_a_full_disk_leaves_the_old_file(tmp_path, monkeypatch):
    """S3, every kind of file: written to a device that is always full."""
    solution = iga.solve(iga.sessile_droplet(iga.Plane(contact_angle=90), volume=1.0))
    elsewhere = ".png", ".html", ".forces.csv"
    endings = [ending for ending in known_endings() if ending not in elsewhere]

    def on_a_full_device(suffix, prefix, folder):
        name = f"{folder}/{prefix}{suffix}"
        os.symlink("/dev/full", name)
        return os.open(name, os.O_WRONLY), name

    monkeypatch.setattr(tempfile, "mkstemp", on_a_full_device)
    for ending in endings:
        path = tmp_path / f"drop{ending}"
        path.write_text("old")
        with pytest.raises(iga.OutputError, match=f"{ending}: cannot be written"):
            solution.save(path)
        assert path.read_text() == "old"
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(f"drop{e}" for e in endings)


def test_an_unknown_ending_is_refused(tmp_path):
    solution = iga.solve(iga.sessile_droplet(iga.Plane(contact_angle=90), volume=1.0))
    with pytest.raises(iga.OutputError, match="ending must be"):
        solution.save(tmp_path / "drop.step")


def test_export_writes_other_files_of_a_result_by_their_endings(scene, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["solve", str(scene), "--out", str(out)]) == 0
    files = [str(tmp_path / f"drop{ending}") for ending in (".stl", ".lines.csv", ".geomdl.json")]
    assert main(["export", str(out), *files]) == 0
    assert all(name in capsys.readouterr().out for name in files[-1:])
    assert all((tmp_path / name).stat().st_size > 100 for name in files)
    assert main(["export", str(out), str(tmp_path / "one.vtu"), str(tmp_path / "drop.step")]) == 4
    assert "ending must be one of" in capsys.readouterr().err
    assert not (tmp_path / "one.vtu").exists(), "endings are checked before anything is written"


def test_plot_draws_every_kind_of_picture(scene, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["solve", str(scene), "--out", str(out)]) == 0
    for kind in ("goniometer", "section"):
        picture = tmp_path / f"{kind}.pdf"
        assert main(["plot", str(out), "--kind", kind, "--out", str(picture)]) == 0
        assert picture.read_bytes().startswith(b"%PDF")
    assert main(["plot", str(out), "--kind", "section", "--color", "gap"]) == 2
    assert "--color: has no meaning with --kind section" in capsys.readouterr().err


def test_info_tells_numbers_without_units_of_a_result_file_too(scene, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["solve", str(scene), "--out", str(out)]) == 0
    for result in (out, out / "result.json"):
        assert main(["info", str(result)]) == 0
        text = capsys.readouterr().out
        assert "height" in text
        assert "bond" in text


def test_the_module_runs_as_a_process_in_any_locale(scene, tmp_path):
    run = subprocess.run(
        [sys.executable, "-m", "iga_membrane", "solve", str(scene), "--out", str(tmp_path / "out")],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"LC_ALL": "C"},
    )
    assert run.returncode == 0, run.stderr
    assert "height" in run.stdout


def test_two_runs_give_the_same_bits(scene, tmp_path):
    found = []
    for name in ("one", "two"):
        assert main(["solve", str(scene), "--out", str(tmp_path / name)]) == 0
        found.append(json.loads((tmp_path / name / "result.json").read_text())["measures"])
    assert found[0] == found[1]


# One folder, one scene

RESULTS = ("result.json", "state.npz", "surface.vtu", "picture.png")
MINE = ("notes.txt", "other.vtu", "my picture.png", "table.csv.bak", "points/0123.json")


@pytest.fixture
def old(tmp_path):
    """An output folder with all results that an older scene can leave, and with files of the
    user's own, among them the points of a sweep."""
    folder = tmp_path / "out"
    (folder / "points").mkdir(parents=True)
    for name in [*RESULTS, "state.previous.npz", "table.csv", "table.npz"]:
        (folder / name).write_text("older")
    save_drop(folder / "state.npz")
    for name in MINE:
        (folder / name).write_text("mine")
    return folder


@functools.cache
def an_older_drop():
    return iga.solve(iga.sessile_droplet(iga.Plane(contact_angle=90), volume=1.0))


def save_drop(path):
    an_older_drop().save(path)


def left(folder):
    """What an older scene or this one left, all but the user's own files, which are untouched."""
    assert all((folder / name).read_text() == "mine" for name in MINE)
    return {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()} - {*MINE}


@pytest.mark.parametrize("options", [[], ["--vtu"]])
def test_a_folder_holds_the_results_of_one_scene(old, scene, options):
    assert main(["solve", str(scene), "--out", str(old), *options]) == 0
    assert left(old) == {"result.json", "state.npz", *["surface.vtu"] * len(options)}
    measures = json.loads((old / "result.json").read_text())["measures"]
    assert iga.load(old / "state.npz").measures == measures


REFUSED = {
    "value": lambda text: text.replace("150.0", "250.0"),
    "key": lambda text: text.replace("volume", "volumes"),
    "syntax": lambda text: text + "\n[[",
    "memory": lambda text: text + "[solver]\nmax_memory_gb = 1e-9\n",
    "start": lambda text: text + '[solver]\nstart = "nowhere.npz"\n',
}


@pytest.mark.parametrize("kind", REFUSED)
def test_a_refused_scene_leaves_no_older_success(old, scene, kind):
    scene.write_text(REFUSED[kind](SCENE))
    assert main(["solve", str(scene), "--out", str(old)]) == 2
    assert left(old) == set()
    assert main(["info", str(old)]) == 2


def test_a_refused_sweep_leaves_its_points_but_no_older_table(old, scene):
    scene.write_text(SCENE + '[[over]]\nparameter = "liquid.nothing"\nvalues = [1.0]\n')
    assert main(["sweep", str(scene), "--out", str(old)]) == 2
    assert left(old) == set()


@pytest.mark.parametrize(
    ("error", "code"), [(KeyboardInterrupt, 130), (MemoryError, 3), (iga.OutputError("full"), 4)]
)
def test_a_solve_that_is_broken_off_leaves_no_older_success(old, scene, monkeypatch, error, code):
    def broken(*arguments, **options):
        raise error

    monkeypatch.setattr("iga_membrane.cli.solve", broken)
    assert main(["solve", str(scene), "--out", str(old)]) == code
    assert left(old) == set()


def test_a_disk_that_fills_up_leaves_no_mixture(old, scene, monkeypatch, capsys):
    """Neither the old files nor a result without its state; what was solved is printed."""
    monkeypatch.setattr(os, "fsync", lambda handle: (_ for _ in ()).throw(OSError(28, "full")))
    assert main(["solve", str(scene), "--out", str(old)]) == 4
    assert left(old) == set()
    assert "CONVERGED_STABLE" in capsys.readouterr().out


def test_a_picture_that_cannot_be_drawn_leaves_no_older_one(old, scene, monkeypatch):
    monkeypatch.setattr("iga_membrane.view.drawing.can_draw", lambda: False)
    assert main(["solve", str(scene), "--out", str(old), "--png"]) == 4
    assert left(old) == set()


def test_an_older_result_that_cannot_be_removed_is_named_before_the_solve(old, scene, monkeypatch):
    (old / "surface.vtu").unlink()
    (old / "surface.vtu").mkdir()
    monkeypatch.setattr("iga_membrane.cli.solve", lambda *a, **k: pytest.fail("computed"))
    assert main(["solve", str(scene), "--out", str(old)]) == 4


def test_older_results_are_removed_but_not_what_links_lead_to(old, scene, tmp_path):
    (tmp_path / "elsewhere").write_text("mine")
    for name in ("surface.vtu", "picture.png"):
        (old / name).unlink()
        (old / name).symlink_to(tmp_path / "elsewhere")
    assert main(["solve", str(scene), "--out", str(old)]) == 0
    assert left(old) == {"result.json", "state.npz"}
    assert (tmp_path / "elsewhere").read_text() == "mine"


@pytest.mark.parametrize("kind", ["value", "key"])
def test_a_scene_that_starts_from_a_state_in_its_folder_keeps_it(old, scene, monkeypatch, kind):
    """Refused, too: a slip of the pen does not cost the state that was to be gone on from."""
    start = f'[solver]\nstart = "{old / "state.npz"}"\n'
    scene.write_text(REFUSED[kind](SCENE + start))
    assert main(["solve", str(scene), "--out", str(old)]) == 2
    assert left(old) == {"state.npz", "state.previous.npz"}
    monkeypatch.chdir(old.parent)
    text = SCENE.replace("elements = 8", "elements = 20").replace("degree = 3", "degree = 4")
    scene.write_text(text + '[solver]\nstart = "out/../out/state.npz"\n')
    assert main(["solve", str(scene), "--out", "out"]) == 0
    assert left(old) == {"result.json", "state.npz"}


@pytest.mark.parametrize("out", ["", " ", "scene.toml", "scene.toml/out", "a\0b", "x" * 300])
@pytest.mark.parametrize("command", ["solve", "sweep", "plot"])
def test_what_is_no_folder_exits_4_before_anything(scene, tmp_path, monkeypatch, out, command):
    """The empty name too, which is the working directory to Python."""
    if (command, out) == ("plot", "scene.toml"):
        return  # a picture may be drawn over a file
    monkeypatch.chdir(tmp_path)
    before = {p: p.read_bytes() for p in tmp_path.iterdir()}
    for name in ("cli.solve", "analysis.sweep.sweep", "driver.state.load"):
        monkeypatch.setattr(f"iga_membrane.{name}", lambda *a, **k: pytest.fail("computed"))
    assert main([command, "scene.toml", "--out", out]) == 4
    assert {p: p.read_bytes() for p in tmp_path.iterdir()} == before


@pytest.mark.parametrize("out", ["", " ", 5, "a\0b"])
def test_a_sweep_in_python_refuses_what_is_no_folder(out, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises((iga.OutputError, iga.SceneError), match="out = "):
        iga.sweep(lambda angle: pytest.fail("computed"), {"angle": [90.0]}, out=out)
    assert not list(tmp_path.iterdir())


def test_the_current_folder_is_one_like_any_other(scene, tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert main(["solve", str(scene), "--out", "."]) == 0
    assert (tmp_path / "here" / "result.json").exists()


@pytest.mark.parametrize("kind", KINDS)
def test_a_first_scene_is_read_and_has_units(kind, tmp_path, capsys):
    path = tmp_path / "scene.toml"
    assert main(["init", str(path), "--kind", kind]) == 0
    assert "solve" in capsys.readouterr().out
    scene = iga.load_scene(path).scene
    assert scene.kind == kind
    assert scene.unit_system == "SI"
    assert main(["init", str(path)]) == 4  # it is there already
    # what is commented out is right too
    text = path.read_text()
    for line in ("# elements = 20", '# model = "full"', "# max_cpu_s = 600"):
        assert line in text
        table = "discretization" if "max" not in line else "solver"
        text = text.replace(f"# [{table}]", f"[{table}]").replace(line, line[2:])
    path.write_text(text)
    assert iga.load_scene(path).scene.sector.model == "full"


def test_the_kinds_of_first_scenes_are_those_of_scene_files():
    assert set(KINDS) <= set(READERS)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_a_first_scene_is_solved(kind, tmp_path):
    assert main(["init", str(tmp_path / "scene.toml"), "--kind", kind]) == 0
    assert main(["solve", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out")]) == 0


def test_a_photograph_is_measured(tmp_path, capsys):
    from PIL import Image

    r, z, _ = sessile(100.0, 2e-3)
    image = photograph(r, z, seed=1).clip(0, 255).astype("uint8")
    Image.fromarray(image).save(tmp_path / "drop.png")
    out = tmp_path / "fit"
    assert main(["fit", str(tmp_path / "drop.png"), "--scale", "8 um", "--out", str(out)]) == 0
    found = json.loads((out / "fit.json").read_text())
    assert found["values"]["contact_angle"] == pytest.approx(100.0, abs=0.2)
    assert found["units"] == "SI"
    assert found["unit_of"]["volume"] == "m^3"
    assert "contact_angle 100" in capsys.readouterr().out
    names = ["fit.json", "overlay.png", "points.csv", "profile.csv"]
    assert sorted(p.name for p in out.iterdir()) == names
    for wrong in (["--scale", "3 uL"], ["--density", "1 mm"], ["--fit", "angle"]):
        line = ["fit", str(tmp_path / "drop.png"), "--scale", "8 um", "--out", str(out), *wrong]
        assert main(line) == 2
    assert main(["fit", str(tmp_path / "none.png"), "--scale", "8 um", "--out", str(out)]) == 2


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_shows_examples_that_it_understands(command, capsys):
    """The lines of its help are parsed without an error."""
    with pytest.raises(SystemExit) as ended:
        main([command, "--help"])
    assert ended.value.code == 0
    shown = re.findall(rf"python -m iga_membrane ({command}.*)", capsys.readouterr().out)
    assert shown
    understood = parser(dict.fromkeys(COMMANDS, lambda given: 0))
    for line in shown:
        understood.parse_args(shlex.split(line.partition(" >")[0]))


@pytest.mark.parametrize(
    ("line", "meant"),
    [
        (["slove", "scene.toml", "--out", "o"], "solve"),
        (["solve", "scene.toml", "--out", "o", "--vtx"], "--vtu"),
        (["plot", "out", "--color", "presure"], "pressure"),
        (["init", "scene.toml", "--kind", "sesile_droplet"], "sessile_droplet"),
        (["fit", "drop.png", "--scal", "8 um", "--out", "o", "--gravty", "1"], "--gravity"),
    ],
)
def test_a_slip_is_told_what_was_meant(line, meant, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    try:
        code = main(line)
    except SystemExit as ended:
        code = ended.code
    assert code == 2
    assert f'did you mean "{meant}"?' in capsys.readouterr().err
