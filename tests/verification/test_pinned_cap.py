"""Membranes pinned on a rim, without a particle: exact caps, their largest pressure (L1, L2), and
the square sheet under a small load."""

import numpy as np
import pytest

import iga_membrane as iga

HEMISPHERE = 2.0 * np.pi / 3.0


def cap(*, size=2.0, boundary="circle", degree=None, elements=None, **options):
    mesh = iga.Discretization("bspline", degree, elements)
    return iga.liquid_sheet(size=size, boundary=boundary, discretization=mesh, **options)


def exact_cap(depth):
    """Spherical cap on a circle of radius 1."""
    return {
        "A_LG": np.pi * (1.0 + depth**2),
        "V_liq": np.pi * depth * (3.0 + depth**2) / 6.0,
        "sag": depth,
        "pressure": 4.0 * depth / (1.0 + depth**2),
    }


def depth_of(volume):
    """Depth of the cap of a volume: ``pi h (3 + h^2) / 6 = V``."""
    return 2.0 * np.sinh(np.arcsinh(3.0 * volume / np.pi) / 3.0)


@pytest.fixture(scope="module")
def flat():
    return iga.solve(cap(pressure=0.0)).surface


@pytest.mark.parametrize("depth", [0.1, 0.4, 0.8])
def test_a_flat_sheet_bulges_to_the_cap_of_its_pressure(depth, flat):
    exact = exact_cap(depth)
    solution = iga.solve(cap(pressure=exact["pressure"], start=flat))
    assert solution.newton_iterations > 1
    for name, value in exact.items():
        assert solution.measures[name] == pytest.approx(value, rel=1e-8), name


@pytest.mark.parametrize("depth", [0.4, 1.0, 1.5])
def test_a_flat_sheet_bulges_to_the_cap_of_its_volume(depth, flat):
    exact = exact_cap(depth)
    solution = iga.solve(cap(volume=exact["V_liq"], start=flat))
    assert solution.newton_iterations > 1
    for name, value in exact.items():
        assert solution.measures[name] == pytest.approx(value, rel=1e-8), name


def test_suction_is_pressure_upside_down():
    down, up = (iga.solve(cap(pressure=p)).measures for p in (1.5, -1.5))
    assert up["V_liq"] == pytest.approx(-down["V_liq"], rel=1e-12)
    assert up["A_LG"] == pytest.approx(down["A_LG"], rel=1e-12)


@pytest.mark.parametrize(
    ("degree", "elements"),
    [
        (2, 8),
        *(pytest.param(*m, marks=pytest.mark.slow) for m in ((3, 8), (4, 20), (None, None))),
    ],
)
def test_no_cap_above_the_pressure_of_the_hemisphere(degree, elements):
    scene = cap(pressure=2.1, degree=degree, elements=elements)
    solution = iga.solve(scene, on_fail="return")
    assert solution.status is iga.Status.LIMIT_POINT
    bracket = solution.bracket
    assert bracket.parameter == "sheet.pressure"
    assert bracket.lo <= 2.0 <= bracket.hi
    assert bracket.hi - bracket.lo <= 1e-3
    assert (bracket.index_lo, bracket.index_hi) == (0, 1)


@pytest.mark.parametrize(
    ("degree", "elements"),
    [
        (2, 8),
        (3, 8),
        (4, 8),
        *(pytest.param(d, n, marks=pytest.mark.slow) for d in (2, 3, 4) for n in (16, 32)),
    ],
)
def test_a_pressure_barely_too_high_is_never_a_success(degree, elements):
    scene = cap(pressure=2.0001, degree=degree, elements=elements)
    solution = iga.solve(scene, on_fail="return")
    assert not solution.success
    assert solution.status is iga.Status.LIMIT_POINT


def test_a_volume_passes_the_hemisphere_and_its_pressure_does_not():
    volumes = (1.0, 1.6, HEMISPHERE, 2.5, 3.2, 4.0)
    path = iga.trace(lambda v: cap(volume=v, elements=12), volumes, parameter="sheet.volume")
    assert path.values == volumes
    assert all(s.success and s.index == 0 for s in path.solutions)
    for volume, solution in zip(volumes, path.solutions, strict=True):
        pressure = solution.measures["pressure"]
        assert abs(pressure - exact_cap(depth_of(volume))["pressure"]) <= 1e-4
        if volume == HEMISPHERE:
            continue
        # the same surface, now held by its pressure: beyond the hemisphere it would run away
        scene = cap(pressure=pressure, start=solution.surface, elements=12)
        held = iga.solve(scene, on_fail="return")
        assert held.measures["V_liq"] == pytest.approx(volume, rel=1e-6)
        if volume < HEMISPHERE:
            assert held.success
        else:
            assert held.status is iga.Status.CONVERGED_SADDLE
            assert held.index == 1


@pytest.mark.parametrize(("near", "far"), [(1.9999, 0.5), (1.999, -1.0), (1.9, -1.99)])
def test_a_long_step_away_from_a_fold_stays_on_its_branch(near, far):
    """L8: two caps have each pressure; the larger one is unstable, and near the fold they meet."""
    path = iga.trace(lambda p: cap(pressure=p), (near, far), parameter="sheet.pressure")
    assert path.success
    assert all(s.index == 0 for s in path.solutions)
    depth = 2.0 / abs(far) - np.sqrt(4.0 / far**2 - 1.0)
    volume = np.sign(far) * exact_cap(depth)["V_liq"]
    assert path.solutions[-1].measures["V_liq"] == pytest.approx(volume, rel=1e-8)


def test_a_square_sheet_under_a_small_load_is_the_linear_membrane():
    k = np.arange(1.0, 20.0, 2.0)
    series = (-1.0) ** ((k - 1) / 2) / (k**3 * np.cosh(0.5 * np.pi * k))
    linear = 0.125 - 4.0 / np.pi**3 * series.sum()
    assert linear == pytest.approx(0.07367135, abs=1e-8)
    size, tension = 3.0, 2.0
    off = []
    for load in (0.01, 0.1, 0.2, 0.4):  # p s / gamma
        scene = iga.liquid_sheet(
            size=size,
            liquid=iga.Liquid(surface_tension=tension),
            pressure=load * tension / size,
            discretization=iga.Discretization(elements=16),
        )
        off.append(iga.solve(scene).measures["sag"] / (load * linear * size) - 1.0)
    assert abs(off[0]) <= 5e-6
    # what is left is the geometric nonlinearity, quadratic in the load
    assert np.array(off[1:]) == pytest.approx(0.0201 * np.array([0.1, 0.2, 0.4]) ** 2, rel=1e-2)


@pytest.mark.parametrize("elements", [7, 8])
def test_all_models_of_a_square_sheet_agree(elements):
    found = [
        iga.solve(
            iga.liquid_sheet(
                size=1.0,
                pressure=1.0,
                discretization=iga.Discretization(elements=elements, model=model),
            )
        ).measures
        for model in ("full", "half", "quarter", "eighth")
    ]
    for other in found[1:]:
        assert other == pytest.approx(found[0], rel=1e-10, abs=1e-12)
