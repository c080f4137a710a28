"""What a failed solve hands over, and faults put into a solve on purpose (status contract; N1-N4,
N7, N8, N13, S9)."""

import json
import subprocess
import sys
import time

import numpy as np
import pytest
from helpers import (
    UNIT_VOLUME,
    droplet,
    droplet_file,
    particle_sheet,
    path_file,
    pinned_cap,
    some,
    within,
)
from robustness.contract import check_contract, finite, unheld_droplet

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.cli import main
from iga_membrane.deadline import OutOfTime
from iga_membrane.driver import evaluate as conclude_module
from iga_membrane.driver import solve as solve_module
from iga_membrane.driver.result_file import result
from iga_membrane.solvers import direction
from iga_membrane.status import REMEDY

HARD = {
    "drop": lambda: droplet(30, 100.0, elements=8),
    "contact area": lambda: droplet(180, 100.0, elements=8),
    "sheet": lambda: particle_sheet(15, elements=6, center=(0, 0, -0.3), gravity=0.1),
}


@pytest.mark.parametrize("name", HARD)
def test_a_solve_cut_short_returns_its_best_state(name, monkeypatch):
    """N1: two iterations are too few; nothing else may help."""
    options = iga.SolverOptions(max_iterations=2)
    with pytest.raises(iga.SolveError, match="max_iterations") as caught:
        iga.solve(HARD[name](), options)
    solution = caught.value.solution
    assert solution.status is iga.Status.MAX_ITER
    check_contract(solution)
    residuals = [step.residual for step in solution.iterations]
    assert min(residuals) <= residuals[0]
    assert solution.volume_error is None or np.isfinite(solution.volume_error)
    assert solution.lambda_min is not None
    assert solution.audit is not None


def test_a_failed_droplet_says_how_far_it_came(tmp_path):
    options = iga.SolverOptions(max_iterations=2)
    solution = iga.solve(droplet(150, 20.0, elements=8), options, on_fail="return")
    record = result(solution)
    assert record["success"] is False
    assert record["volume_error"] == pytest.approx(solution.audit.volume, rel=1e-5)
    assert record["contact"]["max_penetration"] is not None
    assert len(record["contact"]["deepest_point"]) == 3
    assert record["iterations"][0]["residual"] > 0
    assert record["last_good_load"] is None
    assert record["index"] is not None
    solution.save(tmp_path / "failed.npz")
    assert iga.load(tmp_path / "failed.npz").status is iga.Status.MAX_ITER


def test_the_last_good_load_of_a_path_is_named():
    path = iga.trace(
        lambda p: iga.liquid_sheet(
            size=2.0, boundary="circle", pressure=p, discretization=iga.Discretization(elements=6)
        ),
        [0.0, 1.0, 2.2],
        parameter="sheet.pressure",
        on_fail="return",
    )
    good = path.end.last_good_load
    assert good.status is None
    assert good.value == pytest.approx(path.bracket.lo)
    assert 1.99 < good.value < 2.0 + 1e-3


def test_every_status_of_an_iteration_has_a_remedy():
    raised = {"STALLED", "MAX_ITER", "LINEAR_SOLVE_FAILED", "NONFINITE", "INTERRUPTED"}
    assert {status.name for status in REMEDY} == raised


@pytest.mark.parametrize("when", some((1, 2, 3, 5), {0, 2}))
@pytest.mark.parametrize("how", ["nan", "inf"])
def test_a_kernel_that_returns_no_number_is_survived_or_named(monkeypatch, tmp_path, when, how):
    """N2: the forces of one iteration are not finite."""
    calls = []
    original = Assembly.system

    def broken(self, *arguments):
        system = original(self, *arguments)
        calls.append(1)
        if len(calls) == when:
            system.gradient[0] = float(how)
        return system

    monkeypatch.setattr(Assembly, "system", broken)
    scene = droplet(120, 1.0, elements=8)
    solution = iga.solve(scene, on_fail="return")
    assert np.isfinite(solution.surface.points).all()
    assert finite(result(solution))
    solution.save(tmp_path / "state.npz")
    with np.load(tmp_path / "state.npz", allow_pickle=False) as saved:
        numbers = [saved[name] for name in saved.files if saved[name].dtype.kind == "f"]
    assert numbers
    assert all(np.isfinite(array).all() for array in numbers)
    if not solution.success:
        assert solution.status is iga.Status.NONFINITE
    else:
        monkeypatch.undo()
        clean = iga.solve(scene)
        assert solution.measures["energy"] == pytest.approx(clean.measures["energy"], rel=1e-8)


@pytest.mark.parametrize("when", [1, 2, 3, 6])
def test_an_energy_that_is_not_finite_is_no_obstacle(monkeypatch, when):
    """N2: a trial step is cut, or load stepping goes round; the answer is the same."""
    clean = iga.solve(droplet(120, 1.0, elements=8))
    calls = []
    original = Assembly.energies_at

    def broken(self, points, at):
        found = original(self, points, at)
        calls.append(1)
        if len(calls) == when:
            object.__setattr__(found, "total", float("nan"))
        return found

    monkeypatch.setattr(Assembly, "energies_at", broken)
    solution = iga.solve(droplet(120, 1.0, elements=8))
    assert solution.measures["energy"] == pytest.approx(clean.measures["energy"], rel=1e-8)


def test_a_rigid_motion_that_nothing_holds_takes_no_long_step():
    """N3: a drop on a plane without a held centroid is free to slide, and is told to be."""
    free = unheld_droplet()
    solution = iga.solve(free)
    assert any("translation along x, translation along y" in text for text in solution.warnings)
    start = free.local_surface().points
    moved = free.units.to_local(solution.surface.points) - start
    assert np.abs(moved).max() <= 1.0


def test_a_start_on_a_saddle_is_not_a_success():
    """N4: the large cap under pressure balances, but every touch makes it grow or shrink."""
    opening = np.radians(115.0)
    terms = [iga.SurfaceTension(1.0), iga.Pressure(2.0 * np.sin(opening))]
    solution = iga.solve(pinned_cap(opening, terms, "eighth", elements=12), on_fail="return")
    assert solution.status is iga.Status.CONVERGED_SADDLE
    assert solution.lambda_min <= -1e-6


def test_contact_that_flips_at_every_step_ends(monkeypatch):
    """N7: half of the contact points are let go and taken back in turn."""
    from iga_membrane.contact.obstacle import Obstacle

    original, turn = Obstacle.touch, []

    def flipping(self, points):
        touch = original(self, points)
        turn.append(1)
        touch.traction[len(turn) % 2 :: 2] *= 1.0 + 0.5 * (-1) ** len(turn)
        return touch

    monkeypatch.setattr(Obstacle, "touch", flipping)
    options = iga.SolverOptions(max_iterations=20, max_cpu_s=20.0)
    mesh = iga.Discretization(elements=8, degree=2, model="eighth")
    lattice = iga.SphereLattice(180, 0.5, 1.5)
    scene = iga.sessile_droplet(lattice, volume=4.19, gravity=0.5, discretization=mesh)
    solution = iga.solve(scene, options, on_fail="return")
    assert solution.status in (iga.Status.STALLED, iga.Status.MAX_ITER)
    check_contract(solution)


@pytest.mark.parametrize("part", [0.01, -0.01])
def test_a_hessian_wrong_by_a_percent_costs_the_order_but_not_the_answer(monkeypatch, part):
    """N8: convergence becomes linear, which the history shows; the answer stays."""
    clean = iga.solve(droplet(120, 1.0, elements=8))
    original = Assembly.system

    def skewed(self, *arguments):
        system = original(self, *arguments)
        system.matrix.dense()[: self.size // 2, : self.size // 2] *= 1.0 + part
        return system

    monkeypatch.setattr(Assembly, "system", skewed)
    solution = iga.solve(droplet(120, 1.0, elements=8), on_fail="return")
    steps = np.array([step.step for step in solution.iterations if step.taken == 1.0])
    order = np.log(steps[2:] / steps[1:-1]) / np.log(steps[1:-1] / steps[:-2])
    assert order[-1] < 1.5
    assert solution.measures["energy"] == pytest.approx(clean.measures["energy"], rel=1e-8)


def test_the_cpu_limit_is_kept():
    """N13: at most a fifth beyond, and the best state comes back."""
    scene = droplet(178, 200.0, elements=40, degree=4, model="half")
    iga.solve(scene, iga.SolverOptions(max_cpu_s=0.1), on_fail="return")  # compiled
    with within(1.2 * 0.5 + 0.5):  # and what the parts of a result cost
        solution = iga.solve(scene, iga.SolverOptions(max_cpu_s=0.5), on_fail="return")
    assert solution.status is iga.Status.INTERRUPTED
    check_contract(solution)
    assert "max_cpu_s" in solution.message
    assert solution.volume_error is not None


def test_an_interrupted_solve_is_judged_in_the_time_that_is_left(monkeypatch):
    """The limit comes between two pieces of the third Newton step."""
    original, calls = Assembly.system, []

    def late(self, *arguments):
        calls.append(1)
        if len(calls) == 3:
            raise OutOfTime
        return original(self, *arguments)

    monkeypatch.setattr(Assembly, "system", late)
    solution = iga.solve(droplet(150, 1.0, elements=8), on_fail="return")
    assert solution.status is iga.Status.INTERRUPTED
    check_contract(solution)
    assert len(solution.iterations) == 2
    assert solution.index == 0
    assert solution.lambda_min > 0
    assert np.isfinite(solution.contact["max_penetration"])


def test_an_equilibrium_that_was_not_judged_in_time_is_no_success(monkeypatch):
    def late(*arguments):
        raise OutOfTime

    monkeypatch.setattr(conclude_module, "stability_of", late)
    solution = iga.solve(droplet(150, 1.0, elements=8), on_fail="return")
    assert solution.status is iga.Status.INTERRUPTED
    assert "before it was judged" in solution.message
    check_contract(solution)


FINE = {
    "contact lines": (150.0, "eighth", 2.0),
    "contact areas": (180.0, "eighth", 2.0),
    "contact areas, full model": (180.0, "full", 2.0),
}
"""Contact angle, model, limit. What a result costs cannot be cut short: with contact lines in
the full model 1.3 CPU s."""


@pytest.mark.slow
@pytest.mark.parametrize("name", FINE)
def test_the_cpu_limit_is_kept_on_fine_asperities(name):
    """N13: every piece of a Newton step, and what the result costs, within a fifth."""
    angle, model, limit = FINE[name]
    mesh = iga.Discretization(elements=80, model=model)
    lattice = iga.SphereLattice(angle, radius=0.05, spacing=0.2)
    scene = iga.sessile_droplet(lattice, volume=UNIT_VOLUME, gravity=20.0, discretization=mesh)
    iga.solve(scene, iga.SolverOptions(max_cpu_s=0.1), on_fail="return")  # compiled
    with within(1.2 * limit):
        solution = iga.solve(scene, iga.SolverOptions(max_cpu_s=limit), on_fail="return")
    print(f"{name}, {limit:g} s: {solution.status.name}, {solution.unknowns} unknowns")
    assert solution.status is iga.Status.INTERRUPTED


def test_too_little_memory_is_named(monkeypatch):
    with pytest.raises(iga.SceneError, match="max_memory_gb"):
        iga.solve(droplet(120, elements=100), iga.SolverOptions(max_memory_gb=1e-4))

    def full(*arguments, **options):
        raise MemoryError

    monkeypatch.setattr(direction, "Bordered", full)
    solution = iga.solve(droplet(120, elements=8), on_fail="return")
    assert solution.status is iga.Status.LINEAR_SOLVE_FAILED
    assert "memory" in solution.message
    monkeypatch.undo()
    monkeypatch.setattr(solve_module, "Assembly", full)
    with pytest.raises(iga.SceneError, match="fit into memory"):
        iga.solve(droplet(120, elements=8))


def test_the_command_line_names_a_lack_of_memory(tmp_path, monkeypatch, capsys):
    def full(*arguments, **options):
        raise MemoryError

    monkeypatch.setattr("iga_membrane.cli.solve", full)
    (tmp_path / "scene.toml").write_text(droplet_file(120.0, elements=8))
    code = main(["solve", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out")])
    assert code == 3
    assert "out of memory" in capsys.readouterr().err


ANGLES = [90.0, 110.0, 130.0, 150.0]
PATH = path_file("substrate.contact_angle", ANGLES)
STRUCK = """
import os, signal, sys, time
from iga_membrane import cli, files
from iga_membrane.solvers import direction
from iga_membrane.assembly.lagrangian import Assembly

signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where tests run in background
place, scene, out = sys.argv[1:]
owner, name = {"assembly": (Assembly, "system"), "factorization": (direction, "Bordered"),
               "write": (files.os, "fsync")}[place]
original, struck = getattr(owner, name), []

def striking(*arguments, **options):
    if not struck and os.path.exists(out + "/state.previous.npz"):
        struck.append(1)
        print(time.monotonic(), flush=True)
        os.kill(os.getpid(), signal.SIGINT)
    return original(*arguments, **options)

setattr(owner, name, striking)
sys.exit(cli.main(["solve", scene, "--out", out]))
"""


@pytest.mark.parametrize("place", some(("assembly", "factorization", "write"), {1}))
def test_one_interrupt_is_enough_and_the_path_goes_on(tmp_path, place):
    """S9: Ctrl-C after two steps of a path, in the midst of the third."""
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    text = droplet_file(90.0, 1.0, PATH, elements=8)
    scene.write_text(text)
    run = subprocess.run(
        [sys.executable, "-c", STRUCK, place, str(scene), str(out)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert time.monotonic() - float(run.stdout) <= 2.0
    assert run.returncode == 130
    assert run.stderr == "interrupted\n"
    left = sorted(p.name for p in out.iterdir())
    assert left == ["state.npz", "state.previous.npz"]
    with pytest.raises(iga.StateError, match="no solution yet"):
        iga.load(out / "state.npz")
    start = f'[solver]\nstart = "{out / "state.npz"}"\n[[path]]'
    (tmp_path / "again.toml").write_text(text.replace("[[path]]", start))
    assert main(["solve", str(tmp_path / "again.toml"), "--out", str(out)]) == 0
    assert main(["solve", str(scene), "--out", str(tmp_path / "whole")]) == 0
    one, two = (
        json.loads((folder / "result.json").read_text()) for folder in (out, tmp_path / "whole")
    )
    assert one["measures"] == pytest.approx(two["measures"], rel=1e-10)


def test_a_cell_that_has_left_its_sphere_ends_with_a_status():
    """Just above the largest pressure an iterate may touch nothing at all."""
    scene = iga.asperity_cell(
        iga.Sphere(180.0, 1.0, (0.0, 0.0, -1.0)),
        size=4.0,
        pressure=0.5,
        discretization=iga.Discretization(elements=10, model="quarter"),
    )
    lost = iga.solve(scene, on_fail="return")
    assert not lost.success
    assert lost.message
