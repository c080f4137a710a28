"""Convergence studies measure what they say: rates, costs, tables and pictures."""

import csv
import math

import numpy as np
import pytest
from helpers import UNIT_VOLUME

import iga_membrane as iga
from iga_membrane.analysis.convergence import Run, Study
from iga_membrane.reference import drop_on_plane


def drop(mesh):
    return iga.sessile_droplet(
        iga.Plane(contact_angle=110), volume=UNIT_VOLUME, gravity=2.0, discretization=mesh
    )


@pytest.fixture(scope="module")
def study():
    exact = drop_on_plane(2.0, 110.0)
    return iga.convergence_study(
        drop,
        spaces=[("bspline", 2), ("nurbs", 3), ("lagrange", 1), ("lagrange", 2)],
        elements=(16, 8),
        exact={name: exact[name] for name in ("energy", "p_base")},
    )


@pytest.mark.parametrize(
    ("space", "degree", "order", "least"),
    [("bspline", 2, 3.5, 1e-6), ("nurbs", 3, 5.0, 1e-7), ("lagrange", 1, 1.8, 2e-2),
     ("lagrange", 2, 3.5, 1e-6)],
)  # fmt: skip
def test_energy_converges_with_twice_the_degree(study, space, degree, order, least):
    assert study.rates(space, degree, "energy")[-1] >= order
    assert study.of(space, degree)[-1].errors["energy"] <= least


def test_splines_need_fewer_unknowns_at_equal_error(study):
    run = study.of("bspline", 2)[-1]
    other = study.cost(run.errors["p_base"] * 1.5, "p_base", "lagrange", 2)
    assert run.unknowns <= other / 3.0


def test_cost_is_interpolated_between_runs_only():
    runs = tuple(
        Run("bspline", 2, n, iga.Status.CONVERGED_STABLE, n**2, 1, 1, {"energy": n**-4.0},
            {"solve": 1e-3 * n**2, "assembly": 0.0, "linear": 0.0}, math.nan)
        for n in (4, 8, 16)
    )  # fmt: skip
    made = Study(runs, ("energy",))
    assert made.rates("bspline", 2, "energy") == pytest.approx((4.0, 4.0))
    assert made.cost(6.0**-4, "energy", "bspline", 2) == pytest.approx(36.0)
    assert made.cost(12.0**-4, "energy", "bspline", 2, "cpu") == pytest.approx(0.144)
    assert made.cost(1.0, "energy", "bspline", 2) is None
    assert made.cost(1e-9, "energy", "bspline", 2) is None


def test_table_and_csv_hold_every_run(study, tmp_path):
    lines = study.table().splitlines()
    assert len(lines) == 2 + 8
    assert len({line.count("|") for line in lines}) == 1
    study.save(tmp_path / "study.csv")
    with (tmp_path / "study.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [int(row["elements"]) for row in rows] == [8, 16] * 4
    assert [float(row["error_energy"]) for row in rows] == [r.errors["energy"] for r in study.runs]
    assert all(float(row["cpu_solve"]) > 0 for row in rows)


@pytest.mark.parametrize("against", ["cpu", "unknowns"])
def test_picture_of_error_against_cost(study, tmp_path, against):
    study.plot(tmp_path / "error.png", against=against)
    assert (tmp_path / "error.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(iga.OutputError, match="cannot be written"):
        study.plot(tmp_path / "no" / "error.png")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"exact": {"depth": 1.0}}, "no such measure"),
        ({"exact": {"energy": np.nan}}, "finite"),
        ({"exact": {}}, "exact is empty"),
        ({"elements": ()}, "elements = .*a list of 1 or more"),
        ({"spaces": [("bspline", 1)]}, "not C1"),
        ({"spaces": [("lagrange", 5)]}, "from 1 to 4"),
        ({"repeats": 0}, "repeats"),
    ],
)
def test_bad_studies_are_refused(change, said):
    asked = {"spaces": [("bspline", 2)], "elements": (4,), "exact": {"energy": 1.0}} | change
    with pytest.raises(iga.SceneError, match=said):
        iga.convergence_study(drop, **asked)
