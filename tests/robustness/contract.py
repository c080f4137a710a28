"""What every end of a solve owes that is no success (the status contract)."""

import json

import numpy as np
from helpers import droplet

import iga_membrane as iga
from iga_membrane.driver.result_file import result


def finite(value):
    """Whether no number in plain data is infinite or undefined."""
    if isinstance(value, dict):
        return all(finite(item) for item in value.values())
    if isinstance(value, (list, tuple)):
        return all(finite(item) for item in value)
    return not isinstance(value, float) or np.isfinite(value)


def check_contract(solution):
    """A finite state, a sentence, the loads tried, the histories of residuals and steps."""
    assert not solution.success
    assert np.isfinite(solution.surface.points).all()
    assert finite(dict(solution.measures))
    assert finite(json.loads(json.dumps(result(solution))))
    assert len(solution.message) > 20
    residuals = [step.residual for step in solution.iterations]
    assert residuals
    assert np.isfinite(residuals).all()
    assert all(np.isfinite([step.step, step.taken]).all() for step in solution.iterations)
    assert solution.load_steps


def critical_film():
    """A flat film under liquid at the very weight that it ceases to carry: the eigenvalue falls by
    that of density times gravity."""

    def film(density):
        return iga.liquid_sheet(
            size=2.0, boundary="circle", volume=0.0, gravity=1.0, liquid_weight=True,
            liquid=iga.Liquid(1.0, density), discretization=iga.Discretization(elements=6),
        )  # fmt: skip

    density = 1.0
    for _ in range(2):  # eigenvalues are good to 1e-6 of themselves
        density += iga.solve(film(density), on_fail="return").lambda_min
    return film(density)


def unheld_droplet():
    """A droplet on a plane whose centroid nothing holds: it is free to slide."""
    scene = droplet(120, model="full", elements=8)
    terms = [t for t in scene.terms if not isinstance(t, iga.Centroid)]
    return iga.Scene(scene.surface, terms, [iga.Sliding()], kind="sessile_droplet")
