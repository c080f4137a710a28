"""Libraries that only some calls need are named, with what to install, when they are missing."""

import sys
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module

import pytest
from analysis.sweep_scenes import drop

import iga_membrane as iga
from iga_membrane.optional import optional
from iga_membrane.view import drawing


@pytest.fixture(scope="module")
def solved():
    return iga.solve(drop(120.0))


@pytest.fixture(scope="module")
def swept():
    with ThreadPoolExecutor(1) as executor:
        return iga.sweep(drop, {"angle": [90.0]}, executor=executor)


def without(monkeypatch, library):
    """A Python in which a library is not installed."""
    import_module(library)
    for name in [*sys.modules]:
        if name.partition(".")[0] == library:
            monkeypatch.setitem(sys.modules, name, None)


TABLES = '"iga-membrane[tables]"'
CALLS = {
    "frame of a solution": ("pandas", TABLES, lambda s, w, path: s.to_dataframe()),
    "frame of a sweep": ("pandas", TABLES, lambda s, w, path: w.to_dataframe()),
    "dataset of a solution": ("xarray", TABLES, lambda s, w, path: s.to_xarray()),
    "dataset of a sweep": ("xarray", TABLES, lambda s, w, path: w.to_xarray()),
    "curves": ("matplotlib", "pip install matplotlib",
               lambda s, w, path: iga.plot_curves(w, path / "a.png", x="angle", y="height")),
    "section": ("matplotlib", "pip install matplotlib",
                lambda s, w, path: iga.plot_section(s, path / "a.png")),
    "side": ("matplotlib", "pip install matplotlib",
             lambda s, w, path: iga.plot_side(s, path / "a.png")),
    "surface": ("pyvista", "pip install pyvista", lambda s, w, path: s.save(path / "a.vtu")),
    "picture": ("pyvista", "pip install pyvista", lambda s, w, path: s.plot(path / "a.png")),
    "check": ("vtkmodules", "pip install pyvista", lambda s, w, path: drawing.check_drawing()),
    "splines": ("geomdl", "pip install geomdl", lambda s, w, path: s.save(path / "a.geomdl.json")),
    "geomdl": ("geomdl", "pip install geomdl", lambda s, w, path: iga.to_geomdl(s.surface)),
}  # fmt: skip


@pytest.mark.parametrize("call", CALLS)
def test_a_missing_library_is_named_with_what_to_install(
    call, solved, swept, tmp_path, monkeypatch
):
    library, remedy, run = CALLS[call]
    pytest.importorskip(library)
    without(monkeypatch, library)
    with pytest.raises(iga.OutputError) as raised:
        run(solved, swept, tmp_path)
    assert remedy in str(raised.value)
    assert not list(tmp_path.iterdir())


def test_frames_of_an_older_longer_path_are_removed(solved, tmp_path, monkeypatch):
    """And no other pictures of the folder; a GIF needs pillow."""
    image = pytest.importorskip("PIL.Image")
    monkeypatch.setattr(
        "iga_membrane.view.animation.plot", lambda s, path, **k: image.new("RGB", (9, 9)).save(path)
    )
    for name in ("frame_0002.png", "frame_0007.png", "frame_x.png", "frame_00012.png"):
        (tmp_path / name).write_text("older")
    iga.animate([solved, solved], tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "frame_0000.png", "frame_0001.png", "frame_00012.png", "frame_x.png"
    ]  # fmt: skip
    monkeypatch.setattr("iga_membrane.view.animation.plot", lambda s, path, **k: None)
    without(monkeypatch, "PIL")
    with pytest.raises(iga.OutputError, match="an animation needs pillow"):
        iga.animate([solved], tmp_path / "a.gif")


def test_what_is_there_is_loaded():
    assert optional("json", "a test") is import_module("json")
    assert drawing.pyvista().__name__ == "pyvista"


@pytest.mark.parametrize(
    ("ask", "meant"),
    [
        (lambda: iga.sesile_droplet, "sessile_droplet"),
        (lambda: iga.sessile_droplet(iga.Plane(90), volum=1.0), "volume"),
        (lambda: iga.fit_profile([[0.0, 1.0]], gravty=1.0), "gravity"),
        (lambda: iga.solve(scen=1), "scene"),
    ],
)
def test_a_slip_in_python_is_told_what_was_meant(ask, meant):
    with pytest.raises((AttributeError, TypeError), match=f"did you mean .{meant}.?"):
        ask()
