"""Every argument of every public name, replaced by each kind of wrong value: a typed error that
names it, at once, or a result where the value is right."""

import contextlib
import dataclasses
import functools
import inspect
import tempfile
from pathlib import Path

import numpy as np
import pytest
from helpers import droplet_file, solved, within

import iga_membrane as iga
import iga_membrane.terms as terms
from iga_membrane import checks

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
    return {f.name: getattr(made, f.name) for f in dataclasses.fields(made) if f.init}


def angled(angle):
    return iga.sessile_droplet(iga.Plane(angle), volume=1.0)


def weighted(pull):
    return iga.sessile_droplet(PLANE, volume=1.0, gravity=[0.0, 0.0, pull])


@functools.cache
def files():
    """A state file and a scene file."""
    folder = Path(tempfile.mkdtemp())
    drop().save(folder / "state.npz")
    (folder / "scene.toml").write_text(droplet_file(90.0))
    return folder


def height(solution):
    return solution.measures["height"]


@functools.cache
def pulled():
    """A sheet whose particle may move up and down."""
    ball = iga.Sphere(90.0, 1.0, (0.0, 0.0, -0.2), motion="vertical")
    return iga.liquid_sheet(ball, size=5.0, boundary="circle")


def remembering(volume):
    return iga.sessile_droplet(iga.Plane(iga.Hysteresis(80.0, 110.0)), volume=volume)


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
    "Cylinder": lambda: {"contact_angle": 90.0, "radius": 1.0},
    "HeightMap": lambda: {"height": lambda x, y: 6 * (0.0 * x,), "contact_angle": 90.0,
                          "scale": 1.0},
    "Wettability": lambda: {"cosine": lambda x: (0.0 * x[..., 0], 0.0 * x)},
    "patch": lambda: {"inside": 60.0, "outside": 120.0, "radius": 1.0, "border": 0.1},
    "stripes": lambda: {"first": 60.0, "second": 120.0, "period": 1.0, "border": 0.1},
    "capillary_bridge": lambda: {
        "lower": iga.Plane(60.0), "upper": iga.Plane(60.0), "gap": 0.3, "volume": 0.5
    },
    "Disc": lambda: {"radius": 1.0},
    "Hysteresis": lambda: {"receding": 80.0, "advancing": 110.0},
    "evolve": lambda: {"scene_of": remembering, "values": [1.0, 1.1]},
    "check_derivatives": lambda: {"scene": drop().scene},
    "close_pole": lambda: {"space": ring()},
    "contact_line": lambda: {"surface": drop().surface},
    "contact_lines": lambda: {"solution": drop()},
    "convergence_study": lambda: {"scene_of": meshed, "exact": {"height": 1.0}},
    "critical_value": lambda: {"scene_at": weighted, "measure": height, "low": -2.0, "high": 1e9},
    "cylinder": lambda: {"radius": 1.0, "height": 1.0},
    "disc": lambda: {"radius": 1.0},
    "drop_space": lambda: {"kind": "bspline", "degree": 3, "elements": 4},
    "elevated": lambda: {"surface": iga.sheet(1.0, elements=3)},
    "film_between_rings": lambda: {"half_height": 0.4, "discretization": iga.Discretization()},
    "fit_profile": lambda: {"points": arc(), "liquid": iga.Liquid(), "gravity": 1.0},
    "from_geomdl": lambda: {"surface": geomdl_surface()},
    "lagrange_basis": lambda: {"breaks": [0.0, 0.5, 1.0], "degree": 2},
    "line_basis": lambda: {"kind": "bspline", "elements": 4, "degree": 3},
    "linearize": lambda: {"solution": drop()},
    "liquid_sheet": lambda: {"particle": BALL, "size": 5.0},
    "load": lambda: {"path": files() / "state.npz"},
    "load_scene": lambda: {"path": files() / "scene.toml"},
    "open_knots": lambda: {"breaks": [0.0, 0.5, 1.0], "degree": 2},
    "periodic_basis": lambda: {"elements": 6, "degree": 3},
    "plot": lambda: {"solution": drop(), "path": "drop.png"},
    "plot_curves": lambda: {"table": Columns(), "path": "curve.png", "x": "x", "y": "y"},
    "plot_fit": lambda: {"fit": fitted(), "path": "fit.png"},
    "plot_phases": lambda: {"table": Columns(), "path": "p.png", "x": "x", "y": "y", "of": "of"},
    "plot_section": lambda: {"solution": drop(), "path": "drop.png"},
    "plot_side": lambda: {"solution": drop(), "path": "drop.png"},
    "progress_bar": lambda: {"text": "solving"},
    "pull_off": lambda: {"scene": pulled()},
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
    "silhouette": lambda: {"image": shadow()},
    "solve": lambda: {"scene": drop().scene},
    "sphere": dict,
    "sweep": lambda: {"scene_of": crowd, "over": {"contact_angle": [90.0, 100.0]}},
    "tensor_space": lambda: {"one": basis(), "two": basis()},
    "to_geomdl": lambda: {"surface": iga.sheet(1.0, elements=3)},
    "trace": lambda: {"scene_at": angled, "values": [90.0, 100.0]},
    "writer": lambda: {"ending": ".xyz"},
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
    "Mirror": lambda: {"edge": "xi2=0"},
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
    "AreaTerm", "BodyTerm", "Constraint", "GapTerm", "LineTerm", "Term", "WettingLine",  # abstract
    "Solid",  # a protocol
    "Status",  # an enumeration
    "scene_schema",
    "GeometryError", "OutputError", "SceneError", "SolveError", "StateError",  # carry any message
}  # fmt: skip


def bracket():
    from iga_membrane.solvers.load_path import Bracket

    return Bracket("p", 0.0, 1.0, 0, 1)


def verdict():
    return iga.Verdict("stays", 0.0, 0.0, 1.0, 0.0)


def arc():
    """Points of a half circle above z = 0."""
    turn = np.linspace(0.05, np.pi - 0.05, 60)
    return np.stack([np.cos(turn), np.sin(turn)], axis=1)


@functools.cache
def fitted():
    return iga.fit_profile(arc())


def shadow():
    """A dark disc cut by a dark solid, before a bright background."""
    rows, columns = np.mgrid[:120, :160]
    return np.where((rows > 100) | (np.hypot(rows - 90, columns - 80) < 50), 0.0, 1.0)


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
TAKES = {
    "five, half": """
        Contact.depth Contact.adhesion Contact.compliance Contact.traction Cylinder.contact_angle
        Cylinder.radius Grading.first HeightMap.contact_angle HeightMap.scale patch.inside
        patch.outside patch.radius patch.border stripes.first stripes.second stripes.period
        stripes.border
        Liquid.surface_tension NormalLineLoad.gamma Disc.contact_angle Disc.radius
        Disc.edge Hysteresis.receding
        capillary_bridge.gap capillary_bridge.volume capillary_bridge.gravity
        Plane.contact_angle PlaneContactLine.gamma PlaneContactLine.contact_angle Ring.radius
        Scale.length Scale.tension SolverOptions.max_cpu_s
        SolverOptions.max_memory_gb Sphere.contact_angle Sphere.radius Sphere.density
        SphereContactLine.gamma SphereLattice.contact_angle SphereLattice.spacing
        Spheres.contact_angle Spheres.radii Stabilization.mu SurfaceTension.gamma
        TrimmedContactLine.gamma Volume.value WholeMembrane.stabilization WholeMembrane.penalty
        WholeMembrane.penetration_tolerance animate.seconds asperity_cell.pressure
        asperity_cell.penetration_tolerance cap.radius cap.contact_angle cylinder.radius
        cylinder.height disc.radius drop_space.angle film_between_rings.radius
        film_between_rings.half_height fit_profile.gravity liquid_sheet.size liquid_sheet.gravity
        periodic_basis.length progress_bar.total plot.zoom ring_basis.length ring_space.angle
        self_cleaning.friction sessile_droplet.volume sessile_droplet.gravity
        sessile_droplet.penetration_tolerance sheet.size silhouette.scale sphere.radius
    """,
    "None": """
        Contact.ring Cylinder.point Discretization.degree Discretization.model Kinematics.second
        Nearest.turn Scene.scale
        Scene.origin
        Scene.grading Scene.directions Scene.ramp Scene.predictor Scene.free_edge Scene.otherwise
        Scene.finer Scene.recipe
        Scene.free_particles Sliding.solid Solution.audit Solution.bracket
        Solution.progress SolverOptions.start SolverOptions.checkpoint Space.pole Space.shared
        Space.leaders Space.ruled Spines.directions Table.second Table.kinds
        TrimmedContactLine.toward
        asperity_cell.liquid asperity_cell.discretization contact_line.solid
        capillary_bridge.liquid capillary_bridge.discretization
        convergence_study.model convergence_study.options critical_value.options drop_space.kink
        film_between_rings.liquid fit_profile.liquid film_between_rings.discretization
        liquid_sheet.particle
        liquid_sheet.liquid liquid_sheet.discretization liquid_sheet.start liquid_sheet.membrane
        plot.focus plot.limits plot_phases.curve pull_off.options ring_space.kink
        self_cleaning.options sessile_droplet.liquid sessile_droplet.discretization
        evolve.options sessile_droplet.placed_at sessile_droplet.start
        sessile_droplet.penalty sessile_droplet.membrane solve.options
        sweep.executor sweep.options tensor_space.weights trace.options
    """,
    "five": """
        Motion.size Solution.unknowns SolverOptions.max_iterations Space.count Sweep.computed
        WholeMembrane.load_steps asperity_cell.size check_derivatives.seed
        convergence_study.repeats drop_space.degree drop_space.elements drop_space.sectors
        elevated.by line_basis.elements line_basis.degree open_knots.degree
        periodic_basis.elements periodic_basis.degree plot.resolution plot_section.resolution
        plot_side.resolution ring_basis.elements ring_basis.degree ring_space.degree
        ring_space.elements ring_space.sectors sheet.elements sheet.degree
    """,
    "list": """
        Basis.joints Path.values Path.solutions PullOff.displacements PullOff.forces
        PullOff.solutions Scene.supports SelfCleaning.verdicts Solution.forces
        Solution.iterations Solution.load_steps Spines.supports Study.runs Sweep.records
        line_basis.joints load.also periodic_basis.joints refined.new1 refined.new2
        ring_basis.joints sessile_droplet.particles
    """,
    "text": """
        Centroid.axis Path.parameter Solution.message Symmetry.axis
        Solution.stability_scope
        animate.path plot_fit.path plot_curves.path progress_bar.text
        plot_curves.x plot_phases.path plot_phases.x plot_phases.y
        plot_phases.of plot_section.path plot_side.path sessile_droplet.hold trace.parameter
        evolve.parameter
    """,
    "truth": """
        Basis.periodic Crossing.rising PlaneContactLine.covered SolverOptions.audit
        SolverOptions.follow_instability SphereContactLine.covered Stabilization.projected
        Sweep.mixed WholeMembrane.projected lagrange_basis.periodic liquid_sheet.liquid_weight
        plot.traction plot.forces ring_space.corners sweep.allow_mixed sweep.retry_failed
    """,
    "1e308, 1e-300, -1, nan, inf, five, half": """
        BodyDensity.constant Derivatives.gradient Derivatives.hessian PullOff.force PullOff.at
        Verdict.normal Verdict.tangential Verdict.weight Verdict.slide
    """,
    "class": """
        Discretization.space HeightMap.height critical_value.measure pull_off.report solve.report
        sweep.scene_of trace.report evolve.report
    """,
    "class, function": "Wettability.cosine",
    "None, five": """
        Discretization.elements SolverOptions.quadrature contact_line.points drop_space.around
        ring_space.around sweep.workers
    """,
    "cube": """
        Space.combine Table.values Table.d1 Table.d2 Table.weights Table.parameters
    """,
    "table": """
        Scene.description Solution.measures Solution.multipliers Solution.contact
        Solution.cpu_seconds
    """,
    "1e-300, -1, five, half": """
        Centroid.target Pressure.pressure Ring.pressure Volume.ends
    """,
    "None, five, half": """
        Contact.penalty asperity_cell.penalty film_between_rings.volume sweep.timeout
    """,
    "-1, five, half": """
        Gravity.density_of_liquid Liquid.density Scene.liquid_density Sliding.level
        Crossing.value critical_value.low critical_value.high plot_side.azimuth
    """,
    "list, words": """
        Scene.warnings Solution.warnings Study.measures Sweep.parameters
    """,
    "None, text": """
        Solution.kind Solution.mode_within plot.path plot_curves.by sweep.out
    """,
    "None, -1, five, half": """
        Spheres.base film_between_rings.pressure liquid_sheet.pressure liquid_sheet.volume
    """,
    "cube, not a number": """
        Motion.share Nearest.gap Nearest.bend
    """,
    "not a number": """
        Kinematics.position Nearest.normal
    """,
    "None, 1e308, 1e-300, -1, nan, inf, five, half": """
        Solution.lambda_min Solution.volume_error
    """,
    "half": """
        Grading.even
        SolverOptions.min_load_step critical_value.tolerance
    """,
    "None, -1": """
        SphereLattice.base open_knots.continuity
    """,
    "-1, five": """
        Basis.continuity
    """,
    "None, list": """
        Basis.knots
    """,
    "None, not a number": """
        Nearest.ridge
    """,
    "None, class": """
        Scene.start_from
    """,
    "inf, five, half": """
        Sliding.reach
    """,
    "None, -1, five": """
        Solution.index
    """,
    "None, cube, not a number": """
        Solution.mode
    """,
    "None, cube": """
        Space.weights
    """,
    "-1": """
        bspline_basis.continuity
    """,
    "None, half": """
        plot.opacity
    """,
    "text, words": """
        plot_curves.y
    """,
}
"""Values of WRONG that are right somewhere, and where."""
RIGHT = {
    place: set(kinds.split(", ")) for kinds, places in TAKES.items() for place in places.split()
}


SAID_OTHERWISE = {("sessile_droplet", None)}
"""Without a substrate there is a rule about particles."""


class Began(Exception):
    """Work has begun: the arguments were accepted."""


@pytest.fixture(autouse=True)
def _no_work(monkeypatch, tmp_path):
    """Nothing is solved, drawn or written in earnest."""

    def begun(*given, **more):
        raise Began

    drop()
    fitted()
    monkeypatch.setattr("iga_membrane.photograph.fit.nearest_profile", begun)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("iga_membrane.assembly.lagrangian.Assembly.__init__", begun)
    monkeypatch.setattr("iga_membrane.analysis.sweep._running", begun)
    for place in ("picture.pyvista", "picture.trial", "section.figure", "goniometer.figure",
                  "diagrams.figure", "overlay.figure", "animation.extent"):  # fmt: skip
        monkeypatch.setattr(f"iga_membrane.view.{place}", begun)


def accepted(name, parameter, value):
    """Whether a public name takes a value of one of its arguments; it must refuse the others by a
    typed error that names the argument."""
    given = GIVEN[name]() | {parameter: value}
    try:
        with within(0.5):
            PUBLIC[name](**given)
    except Began:
        return True
    except TYPED as error:
        said = str(error)
        place = {"data": "scene"}.get(parameter, parameter)
        named = (
            checks.name_of(value) in said
            or place.strip("s") in said
            or place.replace("_", " ") in said
        )
        assert named or (isinstance(value, str) and said.startswith(f"{value}: ")), said
        assert len(said) < 1000, said
        if value is None or isinstance(value, (bytes, complex)) or type(value) is object:
            assert checks.shown(value) in said or (name, value) in SAID_OTHERWISE, said
        return False
    return True


def test_the_table_has_every_public_name():
    assert set(GIVEN) | NO_ARGUMENTS == set(PUBLIC)
    assert {place.split(".")[0] for place in RIGHT} <= set(GIVEN)


@pytest.mark.parametrize("name", sorted(GIVEN))
def test_wrong_arguments_are_refused_by_name(name):
    with contextlib.suppress(Began):
        PUBLIC[name](**GIVEN[name]())
    for parameter, kind in inspect.signature(PUBLIC[name]).parameters.items():
        if kind.kind not in (kind.VAR_KEYWORD, kind.VAR_POSITIONAL):
            taken = {what for what, value in WRONG.items() if accepted(name, parameter, value)}
            assert taken == RIGHT.get(f"{name}.{parameter}", set()), parameter


def test_an_alias_of_an_annotation_is_what_it_stands_for():
    """numpy's annotations are aliases from 2.5 on, which Python 3.12 and later install."""
    from numpy.typing import NDArray

    from iga_membrane.arguments import rule_of

    aliases = pytest.importorskip("typing_extensions")
    kind = aliases.TypeVar("kind", bound=np.generic)
    arrays = aliases.TypeAliasType("arrays", NDArray[kind], type_params=(kind,))
    length = aliases.TypeAliasType("length", float)
    assert rule_of(length)("x", 2) == 2.0
    with pytest.raises(iga.SceneError):
        rule_of(arrays[np.integer])("x", np.zeros(3))
    assert rule_of(arrays[np.integer])("x", np.zeros(3, int)).shape == (3,)
