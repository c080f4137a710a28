"""Every argument of every public name, replaced by each kind of wrong value: a typed error that
names it, at once, or a result where the value is right."""

import functools
import inspect
import time
from pathlib import Path

import numpy as np
import pytest
from helpers import solved

import iga_membrane as iga
import iga_membrane.terms as terms

TYPED = (iga.SceneError, iga.GeometryError, iga.OutputError, iga.StateError)
"""Errors of ours that refuse an argument."""


@functools.cache
def drop():
    return solved(90.0, elements=4, degree=2)


@functools.cache
def basis():
    return iga.line_basis("bspline", 4, 3)


@functools.cache
def ring():
    return iga.ring_space("bspline", 3, 4)


def fields_of(made):
    """The arguments of a record that the package makes itself."""
    import dataclasses

    return {f.name: getattr(made, f.name) for f in dataclasses.fields(made) if f.init}


def angled(angle):
    return iga.sessile_droplet(iga.Plane(angle), volume=1.0)


def meshed(mesh):
    return angled(90.0)


def crowd(contact_angle):
    return angled(contact_angle)


def meridian(t):
    return 1.0 - t, 0.0 * t, -np.ones_like(t)


class Columns:
    """A table with columns x and y."""

    def column(self, name):
        return np.array([0.0, 0.0, 1.0, 1.0]) if name == "x" else np.array([0.0, 1.0, 0.0, 1.0])


@functools.cache
def geomdl_surface():
    return iga.to_geomdl(iga.sheet(1.0, elements=3))


@functools.cache
def table():
    return iga.sheet(1.0, elements=3).space.table()


PLANE, BALL = iga.Plane(90.0), iga.Sphere(90.0, 1.0, (0.0, 0.0, -0.5))
HERE = Path(__file__).parent
GIVEN = {
    # functions: arguments with which they would do their work
    "animate": lambda: {"solutions": [drop()], "path": "film.gif"},
    "asperity_cell": lambda: {"sphere": iga.Sphere(180.0, 1.0), "size": 4.0, "pressure": 0.5},
    "axisymmetric": lambda: {"space": ring(), "profile": meridian},
    "bspline_basis": lambda: {"knots": [0, 0, 0, 0.5, 1, 1, 1], "degree": 2},
    "cap": lambda: {"radius": 1.0, "contact_angle": 60.0},
    "check_derivatives": lambda: {"scene": drop().scene},
    "close_pole": lambda: {"space": ring()},
    "contact_line": lambda: {"surface": drop().surface},
    "contact_lines": lambda: {"solution": drop()},
    "convergence_study": lambda: {"scene_of": meshed, "exact": {"height": 1.0}},
    "critical_value": lambda: {"scene_at": angled, "measure": drop, "low": 60.0, "high": 90.0},
    "cylinder": lambda: {"radius": 1.0, "height": 1.0},
    "disc": lambda: {"radius": 1.0},
    "drop_space": lambda: {"kind": "bspline", "degree": 3, "elements": 4},
    "elevated": lambda: {"surface": iga.sheet(1.0, elements=3)},
    "film_between_rings": lambda: {"half_height": 0.4, "discretization": iga.Discretization()},
    "from_geomdl": lambda: {"surface": geomdl_surface()},
    "lagrange_basis": lambda: {"breaks": [0.0, 0.5, 1.0], "degree": 2},
    "line_basis": lambda: {"kind": "bspline", "elements": 4, "degree": 3},
    "liquid_sheet": lambda: {"particle": BALL, "size": 5.0},
    "load": lambda: {"path": "state.npz"},
    "load_scene": lambda: {"path": "scene.toml"},
    "open_knots": lambda: {"breaks": [0.0, 0.5, 1.0], "degree": 2},
    "periodic_basis": lambda: {"elements": 6, "degree": 3},
    "plot": lambda: {"solution": drop(), "path": "drop.png"},
    "plot_curves": lambda: {"table": Columns(), "path": "curve.png", "x": "x", "y": "y"},
    "plot_phases": lambda: {"table": Columns(), "path": "p.png", "x": "x", "y": "y", "of": "of"},
    "plot_section": lambda: {"solution": drop(), "path": "drop.png"},
    "plot_side": lambda: {"solution": drop(), "path": "drop.png"},
    "pull_off": lambda: {"scene": drop().scene},
    "read_scene": lambda: {"data": {"scene": "sessile_droplet", "liquid": {"volume": 1.0},
                                    "substrate": {"contact_angle": 90.0}}},
    "refined": lambda: {"surface": iga.sheet(1.0, elements=3), "new1": [0.5]},
    "ring_basis": lambda: {"kind": "bspline", "elements": 6, "degree": 3, "length": 1.0},
    "ring_space": lambda: {"kind": "bspline", "degree": 3, "elements": 4},
    "save": lambda: {"solution": drop(), "path": "drop.json"},
    "self_cleaning": lambda: {"scene": drop().scene, "friction": 0.3},
    "sessile_droplet": lambda: {"substrate": PLANE, "volume": 1.0},
    "sheet": lambda: {"size": 1.0},
    "si": lambda: {"quantity": "1 uL"},
    "solve": lambda: {"scene": drop().scene},
    "sphere": dict,
    "sweep": lambda: {"scene_of": crowd, "over": {"contact_angle": [90.0, 100.0]}},
    "tensor_space": lambda: {"one": basis(), "two": basis()},
    "to_geomdl": lambda: {"surface": iga.sheet(1.0, elements=3)},
    "trace": lambda: {"scene_at": angled, "values": [90.0, 100.0]},
    # records that users make
    "BodyDensity": dict,
    "Centroid": lambda: {"axis": "x"},
    "Contact": lambda: {"solid": BALL},
    "Discretization": dict,
    "EdgeGap": lambda: {"sphere": BALL},
    "Fixed": lambda: {"edge": "xi2=0"},
    "Grading": dict,
    "Gravity": lambda: {"density_of_liquid": 1.0, "acceleration": (0.0, 0.0, -1.0)},
    "Joint": dict,
    "Liquid": dict,
    "NormalLineLoad": lambda: {"gamma": 1.0, "solid": BALL, "edge": "xi2=0"},
    "Plane": lambda: {"contact_angle": 90.0},
    "PlaneContactLine": lambda: {"gamma": 1.0, "contact_angle": 90.0},
    "Pressure": lambda: {"pressure": 1.0},
    "Ring": lambda: {"radius": 0.1, "pressure": 1.0},
    "Scale": dict,
    "Scene": lambda: fields_of(drop().scene),
    "Sector": dict,
    "Sliding": dict,
    "SolverOptions": dict,
    "Sphere": lambda: {"contact_angle": 90.0, "radius": 1.0},
    "SphereContactLine": lambda: {"gamma": 1.0, "sphere": BALL},
    "SphereLattice": lambda: {"contact_angle": 180.0, "radius": 0.1, "spacing": 0.4},
    "Spheres": lambda: {"contact_angle": 180.0, "centers": [[0, 0, -1.0]], "radii": 1.0},
    "Spines": lambda: {"surface": drop().surface, "supports": drop().scene.local_supports()},
    "Stabilization": lambda: {"mu": 1.0},
    "Surface": lambda: {"space": drop().surface.space, "points": drop().surface.points},
    "SurfaceTension": lambda: {"gamma": 1.0},
    "Symmetry": lambda: {"axis": "x"},
    "TrimmedContactLine": lambda: {"gamma": 1.0, "solid": BALL},
    "Volume": lambda: {"value": 1.0},
    "WholeMembrane": dict,
    # records that the package makes; users of open doors make some of them too
    "Basis": lambda: fields_of(basis()),
    "Crossing": lambda: {"value": 1.0, "rising": True, "solution": drop()},
    "Derivatives": lambda: {"gradient": 0.0, "hessian": 0.0},
    "Kinematics": lambda: fields_of(drop().surface.grid(3, 3)),
    "LocalGap": lambda: {"term": Law(), "scale": iga.Scale()},
    "Motion": lambda: fields_of(iga.Spines(drop().surface).on(drop().surface)),
    "Nearest": lambda: fields_of(BALL.nearest(np.ones((4, 3)))),
    "Path": lambda: {"parameter": "p", "values": [1.0], "solutions": [drop()], "end": drop()},
    "PullOff": lambda: {"force": 1.0, "at": 0.1, "bracket": bracket(), "limit": "line",
                        "displacements": [0.1], "forces": [1.0], "solutions": [drop()]},
    "SelfCleaning": lambda: {"verdicts": [verdict()], "solution": drop()},
    "Solution": lambda: fields_of(drop()),
    "Space": lambda: fields_of(drop().surface.space),
    "Study": lambda: {"runs": (), "measures": ("height",)},
    "Sweep": lambda: {"parameters": ("x",), "records": [{"parameters": {"x": 1.0}}]},
    "Table": lambda: fields_of(table()),
    "Verdict": lambda: fields_of(verdict()),
}  # fmt: skip
"""Public name to valid arguments."""
NO_ARGUMENTS = {
    "AreaTerm", "BodyTerm", "Constraint", "GapTerm", "LineTerm", "Term",  # abstract
    "Solid",  # a protocol
    "Status",  # an enumeration
    "GeometryError", "OutputError", "SceneError", "SolveError", "StateError",  # carry any message
}  # fmt: skip


def bracket():
    from iga_membrane.solver.load_stepping import Bracket

    return Bracket("p", 0.0, 1.0, 0, 1)


def verdict():
    return iga.Verdict("stays", 0.0, 0.0, 1.0, 0.0)


class Law(iga.GapTerm):
    """No energy at all."""

    solid = BALL

    def law(self, gap):
        return 0.0 * gap, 0.0 * gap, 0.0 * gap


PUBLIC = {
    name: getattr(home, name)
    for home in (terms, iga)
    for name in home.__all__
    if not name.startswith("__")
}
WRONG = {
    "None": None,
    "text": "x",
    "bytes": b"x",
    "truth": True,
    "complex": 1j,
    "10**400": 10**400,
    "-10**5000": -(10**5000),
    "1e308": 1e308,
    "1e-300": 1e-300,
    "-1": -1,
    "nan": float("nan"),
    "inf": float("inf"),
    "five": 5,
    "half": 0.5,
    "function": lambda: None,
    "class": int,
    "table": {},
    "list": [],
    "words": ["x", "y", "z"],
    "ragged": [[1.0], [2.0, 3.0]],
    "cube": np.zeros((2, 2, 2)),
    "not a number": np.array([np.nan] * 3),
    "objects": np.array([None, "x", 1.0], object),
    "object": object(),
}
WRONG_KIND = {"complex", "bytes", "object", "10**400", "-10**5000", "objects", "ragged"}
"""Values that no argument takes."""
CASES = [
    (name, parameter)
    for name in sorted(GIVEN)
    for parameter, kind in inspect.signature(PUBLIC[name]).parameters.items()
    if kind.kind not in (kind.VAR_KEYWORD, kind.VAR_POSITIONAL)
]


class Began(Exception):
    """Work has begun: the arguments were accepted."""


@pytest.fixture(autouse=True)
def _no_work(monkeypatch, tmp_path):
    """Nothing is solved, drawn or written in earnest."""
    monkeypatch.chdir(tmp_path)

    def begun(*given, **more):
        raise Began

    from iga_membrane.analysis import sweep
    from iga_membrane.solver import derivatives, trace
    from iga_membrane.view import drawing, figure, picture

    solve = importlib.import_module("iga_membrane.solver.solve")
    monkeypatch.setattr(solve, "Assembly", begun)
    for module, what in ((trace, "Assembly"),):
        pass


def test_the_table_has_every_public_name():
    assert set(GIVEN) | NO_ARGUMENTS == set(PUBLIC)
