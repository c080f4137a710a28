"""Every status can be reached, and what comes with it (section "status contract")."""

from time import process_time

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet, particle_sheet, pinned_cap
from robustness.contract import check_contract, critical_film

import iga_membrane as iga
from iga_membrane.driver import evaluate as conclude
from iga_membrane.splines import points_of

TENSION = iga.SurfaceTension(1.0)
OPENING = np.radians(115.0)


def leaning():
    mesh = iga.Discretization(elements=8)
    plane = iga.Plane(contact_angle=120)
    return iga.sessile_droplet(plane, volume=1.0, gravity=(0.1, 0.0, -1.0), discretization=mesh)


def with_a_point_at_the_centre():
    sheet = particle_sheet(90, elements=6, model="full")
    net = sheet.surface.net.copy()
    net[0, 0] = [0.0, 0.0, -1.0]
    start = sheet.surface.moved(points_of(sheet.surface.space, net))
    return particle_sheet(90, elements=6, model="full", start=start)


def overfull_cap():
    mesh = iga.Discretization("bspline", 2, 8)
    return iga.liquid_sheet(size=2.0, boundary="circle", pressure=2.1, discretization=mesh)


ENDS = {
    "CONVERGED_STABLE": (lambda: droplet(90, elements=6), {}),
    "CONVERGED_SADDLE": (
        lambda: pinned_cap(OPENING, [TENSION, iga.Pressure(2.0 * np.sin(OPENING))], "eighth"),
        {},
    ),
    "CONVERGED_MARGINAL": (critical_film, {}),
    "LIMIT_POINT": (overfull_cap, {}),
    "NO_EQUILIBRIUM": (leaning, {}),
    "TOPOLOGY_CHANGE": (lambda: droplet(180, 0.0), {}),
    "STALLED": (lambda: droplet(120, 1.0, elements=8), {"quadrature": 1}),
    "MAX_ITER": (lambda: droplet(150, 20.0, elements=8), {"max_iterations": 2}),
    "LINEAR_SOLVE_FAILED": (
        lambda: iga.Scene(
            iga.sheet(1.0, elements=4), [TENSION, iga.Pressure(0.1)], [iga.Symmetry("x")]
        ),
        {},
    ),
    "NONFINITE": (with_a_point_at_the_centre, {}),
    "PENETRATION": (
        lambda: iga.sessile_droplet(
            iga.Plane(180.0), volume=UNIT_VOLUME, gravity=1.0, penalty=10.0
        ),
        {},
    ),
    "UNDERRESOLVED": (lambda: droplet(120, 1.0, elements=8), {"quadrature": 2}),
    "INTERRUPTED": (lambda: droplet(150, 1.0, elements=8), {"max_cpu_s": 1e-3}),
    "UNVERIFIED": (lambda: droplet(90, elements=6), {"audit": False}),
}
"""A scene and options that end in each."""
UNTOLD = {"NONFINITE", "INTERRUPTED"}
"""The start has no residual, or no time was left for one."""
UNJUDGED = {*UNTOLD, "LINEAR_SOLVE_FAILED", "CONVERGED_MARGINAL"}
"""There is no factorization to count eigenvalues with, or no time left for it."""


def test_no_status_is_forgotten():
    assert set(ENDS) == {status.name for status in iga.Status}


@pytest.mark.parametrize("name", ENDS)
def test_every_status_is_reached_and_carries_what_is_known(name):
    make, options = ENDS[name]
    scene = make()
    solution = iga.solve(scene, iga.SolverOptions(**options), on_fail="return")
    assert solution.status.name == name
    assert solution.success == (name == "CONVERGED_STABLE")
    if solution.success:
        return
    if name in UNTOLD:
        assert np.isfinite(solution.surface.points).all()
        assert len(solution.message) > 20
    else:
        check_contract(solution)
    if name not in UNJUDGED:
        assert solution.index is not None
        assert np.isfinite(solution.lambda_min)
    if any(isinstance(term, iga.Volume) for term in scene.terms):
        assert np.isfinite(solution.volume_error)
    if solution.contact and name not in (*UNJUDGED, "UNVERIFIED"):
        assert np.isfinite(solution.contact["max_penetration"])
        assert len(solution.contact["deepest_point"]) == 3


@pytest.mark.parametrize("name", ["MAX_ITER", "CONVERGED_SADDLE"])
def test_the_error_carries_the_result(name):
    make, options = ENDS[name]
    with pytest.raises(iga.SolveError, match=name) as caught:
        iga.solve(make(), iga.SolverOptions(**options))
    solution = caught.value.solution
    assert str(caught.value) == f"{name}: {solution.message}"
    assert solution.status.name == name


AUDITED = {
    "droplet": lambda: droplet(150, 1.0),
    "droplet, full model": lambda: droplet(150, 1.0, model="full"),
    "droplet, full model, 32 elements": lambda: droplet(150, 1.0, model="full", elements=32),
    "droplet at 180 degrees": lambda: droplet(180, 1.0),
    "droplet on a sphere": lambda: iga.sessile_droplet(
        iga.Sphere(120.0, 1.0, (0.0, 0.0, -1.0)), volume=UNIT_VOLUME, gravity=1.0, hold="xy"
    ),
    "sheet": lambda: particle_sheet(90),
    "square sheet": lambda: particle_sheet(90, boundary="square"),
    "cap": lambda: iga.liquid_sheet(size=2.0, boundary="circle", pressure=1.5),
    "film": lambda: iga.film_between_rings(half_height=0.6),
    "cell": lambda: iga.asperity_cell(
        iga.Sphere(150.0, 0.05, (0.0, 0.0, -0.05)), size=0.2, pressure=2.0
    ),
    "asperities at 180 degrees": lambda: iga.sessile_droplet(
        iga.SphereLattice(180.0, 0.05, 0.2), volume=UNIT_VOLUME, gravity=1.0, hold="xy"
    ),
    "asperities at 150 degrees": lambda: iga.sessile_droplet(
        iga.SphereLattice(150.0, 0.05, 0.2), volume=UNIT_VOLUME, gravity=1.0, hold="xy"
    ),
    "particle on a droplet": lambda: iga.sessile_droplet(
        iga.Plane(150.0),
        volume=UNIT_VOLUME,
        gravity=0.5,
        hold="xy",
        particles=[iga.Sphere(90.0, 0.2, (0.0, 0.0, 1.9))],
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", AUDITED)
def test_audit_costs_a_quarter_at_most(name, monkeypatch):
    spent = []
    original = conclude._audited

    def timed(*arguments):
        began = process_time()
        found = original(*arguments)
        spent.append(process_time() - began)
        return found

    monkeypatch.setattr(conclude, "_audited", timed)
    scene, shares = AUDITED[name](), []
    for _ in range(4):  # the first one compiles
        spent.clear()
        began = process_time()
        assert iga.solve(scene).success
        shares.append(sum(spent) / (process_time() - began))
    print(f"{name}: audit {min(shares[1:]):.3f} of the solve")
    assert min(shares[1:]) <= 0.25
