"""Invariants and limits that no other file holds (N10, N12, P11, P14, L4, Q17, Q20), and the
randomized extremes (Z)."""

import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from helpers import droplet, some, worst
from robustness.extreme_scenes import KINDS, extreme_scenes, score

import iga_membrane as iga
from iga_membrane.analysis.job import solve_point
from iga_membrane.analysis.portable import Portable
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.reference import drop_on_plane
from iga_membrane.solvers.newton import FLOOR, NewtonOptions, newton
from iga_membrane.solvers.stability import stability_of
from iga_membrane.splines import points_of
from iga_membrane.terms import variations

UNIT = iga.Plane(contact_angle=90)


@pytest.mark.parametrize("bond", some((0.0, 1.0, 20.0), {1}))
def test_the_wet_area_falls_with_the_contact_angle(bond):
    """Q17"""
    angles = np.linspace(20, 170, 12)
    wet = [iga.solve(droplet(a, bond, elements=10)).measures["A_wet"] for a in angles]
    assert (np.diff(wet) < 0).all()


def test_the_order_of_asperities_does_not_matter():
    """Q4"""
    places = (-1.05, -0.35, 0.35, 1.05)
    rows = np.array([[x, y, -0.3] for x in places for y in places])

    def on(centers):
        spheres = iga.Spheres(180.0, centers, 0.3)
        mesh = iga.Discretization(elements=24)
        return iga.solve(
            iga.sessile_droplet(spheres, volume=4.0, gravity=1.0, discretization=mesh),
            on_fail="return",
        )

    one, two = on(rows), on(np.random.default_rng(5).permutation(rows))
    assert one.status is two.status
    for name in ("energy", "pressure", "height", "A_LG", "A_wet"):
        assert two.measures[name] == pytest.approx(one.measures[name], rel=1e-12), name
    forces = [
        sorted((*np.round(row["center"], 9), row["force"]) for row in s.contact["asperities"])
        for s in (one, two)
    ]
    assert len(forces[0]) >= 4
    assert np.array(forces[1]) == pytest.approx(np.array(forces[0]), rel=1e-10, abs=1e-12)


def test_contact_forces_only_push():
    """Q17: every asperity is pressed, never pulled."""
    lattice = iga.SphereLattice(180.0, 0.25, 0.7)
    mesh = iga.Discretization(elements=40)
    solution = iga.solve(
        iga.sessile_droplet(lattice, volume=4.19, gravity=1.0, hold="xy", discretization=mesh)
    )
    rows = solution.contact["asperities"]
    assert rows
    assert all(row["force"] > 0 for row in rows)
    assert all(row["force_vector"][2] < 0 for row in rows)


@pytest.mark.parametrize("angle", [30, 120, 170])
def test_accepted_steps_never_raise_the_energy(angle, monkeypatch):
    """Q17: the merit function falls with every step; at fixed volume it is the energy."""
    from iga_membrane.solvers import newton as module

    search, begin, after = module.search, [], []

    def watched(assembly, system, surface, displacement, direction, longest):
        part, moved = search(assembly, system, surface, displacement, direction, longest)
        if moved is not None:
            for where, state in ((begin, surface), (after, moved)):
                found = assembly.energies(state)
                where.append(found.total - direction.multipliers @ found.constraints)
        return part, moved

    monkeypatch.setattr(module, "search", watched)
    solution = iga.solve(droplet(angle, 2.0, elements=10))
    assert solution.success
    assert len(begin) >= 3
    # the missing volume counts too (kappa), so the energy may rise while it is filled
    missing = np.array(begin) - np.array(after)
    assert (missing[-2:] >= -1e-11).all()


CODE = """
import iga_membrane as iga
from helpers import droplet
solution = iga.solve(droplet(130, 3.0, elements=10))
print([value.hex() for value in solution.measures.values()])
print(solution.surface.points.tobytes().hex())
"""


def test_a_fresh_process_with_another_hash_seed_gives_the_same_bits():
    """Q20"""
    found = set()
    for seed in ("0", "1", "12345"):
        path = os.pathsep.join([*sys.path])
        environment = os.environ | {"PYTHONHASHSEED": seed, "PYTHONPATH": path}
        run = subprocess.run(
            [sys.executable, "-c", CODE], capture_output=True, text=True, check=True,
            env=environment,
        )  # fmt: skip
        found.add(run.stdout)
    assert len(found) == 1


def test_without_compiled_loops_the_answer_is_the_same(monkeypatch):
    """N12"""
    scene = droplet(120, 1.0, elements=10, model="full")
    monkeypatch.setattr(variations, "COMPILED_FROM", 0)
    compiled = iga.solve(scene)
    monkeypatch.setenv("IGA_MEMBRANE_NO_NUMBA", "1")
    plain = iga.solve(scene)
    for name, value in compiled.measures.items():
        assert plain.measures[name] == pytest.approx(value, rel=1e-12), name
    assert abs(plain.newton_iterations - compiled.newton_iterations) <= 1


def test_missing_compiled_loops_are_told_once(monkeypatch, caplog):
    """N12"""
    variations._loaded.cache_clear()
    monkeypatch.setattr(variations, "COMPILED_FROM", 0)
    monkeypatch.delattr(iga, "_kernels", raising=False)
    monkeypatch.setitem(sys.modules, "iga_membrane._kernels", None)
    for _ in range(2):
        assert iga.solve(droplet(120, 1.0, elements=6)).success
    variations._loaded.cache_clear()
    assert caplog.text.count("compiled loops cannot be used") == 1


def test_loops_that_cannot_be_cached_are_compiled_and_told(monkeypatch, caplog):
    """N12"""
    from iga_membrane import _kernels

    def without_a_place(cache=False, **options):
        if cache:
            raise RuntimeError("no locator available")
        return lambda function: function

    monkeypatch.setattr(_kernels.numba, "njit", without_a_place)
    assert _kernels._compiled(abs) is abs
    assert caplog.text.count("no folder for the cache") == 1


COMPILED = """
import json
import iga_membrane as iga
from helpers import droplet
from iga_membrane.terms import variations
variations.COMPILED_FROM = 0
print(json.dumps(dict(iga.solve(droplet(130, 3.0, elements=16, model="full")).measures)))
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "environment", [{"OMP_NUM_THREADS": "2"}, {"NUMBA_CACHE_DIR": "/dev/null/none"}]
)
def test_threads_and_a_cache_that_cannot_be_written_change_nothing(environment):
    """N12"""
    runs = []
    own = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    for more in ({"OMP_NUM_THREADS": "1"}, environment):
        run = subprocess.run(
            [sys.executable, "-c", COMPILED], capture_output=True, text=True, check=True,
            env=own | more,
        )  # fmt: skip
        runs.append(json.loads(run.stdout))
    assert runs[1] == pytest.approx(runs[0], rel=1e-10)


@pytest.mark.parametrize("angle", [60, 120, 150])
def test_the_finest_tolerance_stops_at_the_floor_of_rounding(angle):
    """N10: whether the last step is smaller is up to rounding; the answer and its words are not."""
    finest = 1e-14
    solution = iga.solve(droplet(angle, 1.0, elements=30), iga.SolverOptions(tolerance=finest))
    assert solution.success
    assert solution.newton_iterations <= 15
    last = solution.iterations[-1]
    assert last.residual < 1e-12
    told = f"rounding ended the iteration, at a relative residual of {last.residual:.0e}"
    assert last.step <= finest or told in solution.message
    exact = drop_on_plane(1.0, angle)
    assert worst(solution.measures, exact, ("energy", "p_base")) <= 1e-11


def test_an_iteration_that_no_tolerance_ends_is_ended_by_rounding():
    """N10"""
    scene = droplet(150, 1.0, elements=12)
    assembly = Assembly(scene)
    never = NewtonOptions(tolerance=0.0)
    found = newton(assembly, scene.local_surface(), None, scene.meridian_grading, never)
    assert found.status is None
    assert found.floor is not None
    assert found.floor <= FLOOR
    assert len(found.iterations) <= 15


@pytest.mark.parametrize("fold", ["swapped", "collapsed"])
def test_a_folded_start_is_mended(fold):
    """P11"""
    start = iga.sessile_droplet(UNIT, volume=1.0).surface
    net = start.net.copy()
    if fold == "swapped":
        net[:, [3, 9]] = net[:, [9, 3]]
    else:
        net[:, 2:6] = net[:, 2:3]
    solution = iga.solve(folded(start, net))
    clean = iga.solve(iga.sessile_droplet(UNIT, volume=1.0))
    assert solution.measures["energy"] == pytest.approx(clean.measures["energy"], rel=1e-6)


FOLDS = {
    "mirrored": (lambda net: (net * [-1.0, -1.0, 1.0])[::-1], r"folded in element \(0, 0\)"),
    "ring turned back": (lambda net: net[np.r_[:2, 5:1:-1, 6 : len(net)]], "folded in element"),
    "below the plane": (lambda net: net * [1.0, 1.0, -1.0], "below the substrate"),
    "inside out": (lambda net: net[:, ::-1], "off the plane"),
}


@pytest.mark.parametrize("fold", FOLDS)
def test_a_start_that_no_droplet_can_have_is_refused(fold):
    """P11"""
    start = iga.sessile_droplet(UNIT, volume=1.0).surface
    change, said = FOLDS[fold]
    with pytest.raises((iga.SceneError, iga.GeometryError), match=said):
        iga.solve(folded(start, change(start.net)))


@pytest.mark.parametrize("rows", [slice(4, 8), slice(3, 6), slice(6, 12)])
def test_a_start_that_crosses_itself_is_refused_with_its_element(rows):
    """P11: some rings lie on the other side of the axis."""
    start = iga.sessile_droplet(UNIT, volume=1.0).surface
    net = start.net.copy()
    net[:, rows, :2] *= -1.0
    with pytest.raises(iga.GeometryError, match=r"folded in element \((\d+), (\d+)\)") as error:
        folded(start, net)
    _, j = (int(n) for n in re.search(r"\((\d+), (\d+)\)", str(error.value)).groups())
    degree = start.space.degree
    degree = degree if isinstance(degree, int) else degree[1]
    assert rows.start - degree - 1 <= j < rows.stop


def folded(start, net):
    moved = start.moved(points_of(start.space, net))
    return iga.sessile_droplet(UNIT, volume=1.0, start=moved)


@pytest.mark.parametrize("apart", [0.0, 1e-12, -1e-12])
def test_the_gap_is_continuous_between_spheres_that_touch(apart):
    """P14"""
    spheres = iga.Spheres(180, [[-1.0, 0, 0], [1.0 + apart, 0, 0]], 1.0)
    height = np.linspace(0.0, 2.0, 21)
    for side in (0.0, 1e-12, -1e-12):
        middle = np.column_stack([np.full(21, 0.5 * apart + side), np.zeros(21), height])
        found = spheres.nearest(middle)
        exact = np.hypot(1.0, height) - 1.0
        assert found.gap == pytest.approx(exact, abs=1e-9)
        assert np.isfinite(found.normal).all()
        assert np.linalg.norm(found.normal, axis=1) == pytest.approx(1.0)


def softest_motion(scene, solution):
    """Heights on a film, and how far its softest motion goes outwards there."""
    assembly = Assembly(scene)
    surface = solution.surface.moved(scene.units.to_local(solution.surface.points))
    multipliers = np.array([solution.multipliers[term.name] for term in assembly.constraints])
    moved = surface.moved(stability_of(scene, assembly, surface, multipliers).mode)
    at, way = surface.grid(9, 41, 1), moved.grid(9, 41, 1).position
    return at.position[..., 2], np.einsum("...i,...i->...", way, at.normal)


@pytest.mark.parametrize(
    ("held_by", "limit"),
    [("pressure", 0.5 * np.pi), ("volume", np.pi)],
)
def test_a_cylinder_loses_stability_at_its_length(held_by, limit):
    """L4: Plateau-Rayleigh with pinned ends, L = pi R at fixed pressure, 2 pi R at fixed volume."""
    brackets, alike = [], []
    for part in (0.999, 1.001):
        height = part * limit
        value = 1.0 if held_by == "pressure" else 2.0 * np.pi * height
        scene = iga.film_between_rings(half_height=height, **{held_by: value})
        solution = iga.solve(scene, on_fail="return")
        assert solution.measures["neck_radius"] == pytest.approx(1.0, abs=1e-6)
        assert solution.success is (part < 1.0), solution.message
        assert solution.lambda_min > 0
        brackets.append(solution.bracket)
        z, bulge = softest_motion(scene, solution)
        wave = np.cos if held_by == "pressure" else np.sin
        turn = np.pi * z / (2.0 * height if held_by == "pressure" else height)
        alike.append(abs((bulge * wave(turn)).sum()) / np.sqrt((bulge**2).sum()))
        alike[-1] /= np.sqrt((wave(turn) ** 2).sum())
    below, beyond = brackets
    assert below is None
    assert (beyond.index_lo, beyond.index_hi) == (0, 1)
    assert limit * 0.999 < beyond.lo < limit < beyond.hi < limit * 1.001
    assert min(alike) >= 0.99


def outcomes(seed, count, kinds):
    for extreme in extreme_scenes(seed, count):
        if extreme.kind in kinds:
            options = iga.SolverOptions(max_cpu_s=120.0)
            record = solve_point(Portable(extreme.scene), {}, options)
            yield extreme, record, *score(extreme, record)


QUICK = ("droplet", "cap", "contact area", "tilted", "held", "sphere", "film",
         "bridge", "cap of volume", "cap of pressure", "sheet", "leaning sheet",
         "cap ends on particle", "droplet ends on particle", "free droplet",
         "pulled droplet")  # fmt: skip
"""Kinds of which no scene takes more than some seconds."""


@pytest.mark.parametrize(("kinds", "least"), some([(QUICK[::2], 15), (QUICK[1::2], 7)], {1}))
def test_extreme_scenes_are_solved_or_named(kinds, least):
    """Z, a small sample; ``benchmarks/reliability.py`` runs three hundred."""
    ends = [
        (end, extreme.exists(), extreme, error)
        for extreme, _, end, error in outcomes(20, 36, kinds)
    ]
    assert not [row for row in ends if row[0] in ("wrong", "crashed")]
    known = [end == "solved" for end, exists, *_ in ends if exists]
    assert len(known) >= least
    assert np.mean(known) >= 0.95


@pytest.mark.slow
@pytest.mark.parametrize("seed", [21, 22])
def test_hundreds_of_extreme_scenes_are_never_wrong_silently(seed):
    ends = [(e.exists(), end, e, error) for e, _, end, error in outcomes(seed, 300, KINDS)]
    assert len(ends) >= 300
    assert not [row for row in ends if row[1] in ("wrong", "crashed")]
    known = [end == "solved" for exists, end, *_ in ends if exists]
    assert np.mean(known) >= 0.95
