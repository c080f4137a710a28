"""Many spheres: the nearest one, the derivatives of its gap, and points between two."""

import numpy as np
import pytest

import iga_membrane as iga

ANYWHERE = np.random.default_rng(0).uniform([-1, -1, -0.3], [1, 1, 0.3], (4000, 3))


def lattice(arrangement="square", offset=(0.0, 0.0), base=None):
    return iga.SphereLattice(180.0, 0.1, 0.27, arrangement, offset, base)


def several_sizes(base=None):
    rng = np.random.default_rng(1)
    return iga.Spheres(180.0, rng.uniform(-1, 1, (60, 3)), rng.uniform(0.02, 0.4, 60), base)


def two_sizes():
    rng = np.random.default_rng(4)
    return iga.Spheres(180.0, rng.uniform(-1, 1, (60, 3)), rng.choice([0.05, 0.3], 60))


def same_sizes():
    return iga.Spheres(180.0, np.random.default_rng(2).uniform(-1, 1, (60, 3)), 0.1)


SOLIDS = {
    "square": lattice(),
    "square, moved": lattice(offset=(0.04, -0.11)),
    "hexagonal": lattice("hexagonal"),
    "hexagonal, moved": lattice("hexagonal", (-0.06, 0.09)),
    "on a base": lattice(base=-0.15),
    "list": same_sizes(),
    "two sizes": two_sizes(),
    "several sizes": several_sizes(),
    "several sizes on a base": several_sizes(base=-0.2),
}


def brute_force(solid, points):
    """Smallest gap over every sphere in reach and the base, and the sphere's number."""
    which = solid.within(3.0)
    centers, radii = solid.center_of(which), solid.radius_of(which)
    away = points[:, None] - centers
    gaps = np.sqrt(np.einsum("...i,...i->...", away, away)) - radii
    first = gaps.argmin(axis=1)
    gap, owner = gaps[np.arange(len(points)), first], which[first]
    if solid.base is not None:
        height = points[:, 2] - solid.base
        owner, gap = np.where(height < gap, -1, owner), np.minimum(gap, height)
    return gap, owner


@pytest.mark.parametrize("solid", SOLIDS.values(), ids=SOLIDS)
def test_nearest_surface_is_that_of_a_search_over_all_spheres(solid):
    found = solid.nearest(ANYWHERE)
    gap, owner = brute_force(solid, ANYWHERE)
    assert np.array_equal(found.gap, gap)
    assert np.array_equal(found.which, owner)
    spheres = owner >= 0
    assert spheres.any()
    assert (solid.base is None) == spheres.all()
    rim = ANYWHERE[spheres] - found.gap[spheres, None] * found.normal[spheres]
    off = np.linalg.norm(rim - solid.center_of(owner[spheres]), axis=-1)
    assert off == pytest.approx(solid.radius_of(owner[spheres]), abs=1e-14)


@pytest.mark.parametrize("count", [1, 9, 49, 400, 10_000])
def test_search_among_few_and_many_is_that_over_all(count):
    """P9"""
    rng = np.random.default_rng(count)
    radius = 0.3 / np.sqrt(count)
    solid = iga.Spheres(180.0, rng.uniform([-1, -1, -radius], [1, 1, 0], (count, 3)), radius)
    points = rng.uniform([-1, -1, -0.1], [1, 1, 0.1], (300, 3))
    found, (gap, owner) = solid.nearest(points), brute_force(solid, points)
    assert np.array_equal(found.gap, gap)
    assert np.array_equal(found.which, owner)


@pytest.mark.parametrize("arrangement", ["square", "hexagonal"])
def test_a_lattice_is_the_list_of_its_spheres(arrangement):
    solid = lattice(arrangement, (0.03, 0.02))
    which = solid.within(3.0)
    listed = iga.Spheres(180.0, solid.center_of(which), solid.radius)
    one, two = solid.nearest(ANYWHERE), listed.nearest(ANYWHERE)
    assert np.array_equal(one.gap, two.gap)
    assert np.array_equal(one.normal, two.normal)
    assert np.array_equal(one.which, which[two.which])
    # as many spheres as cells
    assert len(which) * solid.area_per_sphere == pytest.approx(9.0 * np.pi, rel=2e-2)


@pytest.mark.parametrize("solid", SOLIDS.values(), ids=SOLIDS)
def test_normal_and_bend_are_the_derivatives_of_the_gap(solid):
    rng = np.random.default_rng(3)
    points = rng.uniform([-0.5, -0.5, -0.05], [0.5, 0.5, 0.2], (400, 3))
    points = points[solid.nearest(points).gap > -0.05]
    d = rng.standard_normal(points.shape)
    d /= np.linalg.norm(d, axis=1)[:, None]
    at, steps = solid.nearest(points), 1e-3 * 2.0 ** -np.arange(3)
    # only where the whole line has one nearest sphere
    ends = [solid.nearest(points + s * steps[0] * d).which for s in (-1, 1)]
    one = (ends[0] == at.which) & (ends[1] == at.which)
    assert one.sum() > 100
    slope = np.einsum("ki,ki->k", at.normal, d)
    curve = at.bend * (1.0 - slope**2)
    first, second = (np.array([np.abs(e)[one].max() for e in errors]) for errors in zip(*[
        (
            solid.nearest(points + h * d).gap - at.gap - h * slope,
            solid.nearest(points + h * d).gap - at.gap - h * slope - 0.5 * h**2 * curve,
        )
        for h in steps
    ], strict=True))  # fmt: skip
    assert np.log2(first[:-1] / first[1:]).min() >= 1.9
    assert np.log2(second[:-1] / second[1:]).min() >= 2.9
    assert second[-1] < 1e-6


@pytest.mark.parametrize("apart", [-1e-12, 0.0, 1e-12], ids=["overlap", "touch", "separate"])
def test_gap_is_continuous_between_two_spheres(apart):
    radius = 0.05
    half = radius + 0.5 * apart
    pair = iga.Spheres(180.0, [[-half, 0, 0], [half, 0, 0]], radius)
    if apart >= 0:
        row = iga.SphereLattice(180.0, radius, 2.0 * half, offset=(half, 0.0))
        solids = [(pair, 0.0), (row, -radius)]
    else:
        solids = [(pair, 0.0)]
    height = np.linspace(0.0, 2.0 * radius, 101)
    for solid, level in solids:
        middle = np.column_stack([0.0 * height, 0.0 * height, height + level])
        sides = [solid.nearest(middle + s * np.array([1e-10, 0, 0])) for s in (-1.0, 1.0)]
        at = solid.nearest(middle)
        for one in (at, *sides):
            for values in (one.gap, one.normal, one.bend):
                assert np.isfinite(values).all()
            assert np.abs(one.gap - (np.hypot(half, height) - radius)).max() <= 1e-9
        # the slope has one value on each side, and they are mirror images
        assert (sides[0].which != sides[1].which).all()
        assert sides[0].normal == pytest.approx(sides[1].normal * [-1, 1, 1], abs=1e-8)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: iga.SphereLattice(180.0, 0.0, 0.2), "substrate.radius"),
        (lambda: iga.SphereLattice(180.0, 0.1, 0.19), "substrate.spacing"),
        (lambda: iga.SphereLattice(180.0, 0.1, float("nan")), "substrate.spacing"),
        (lambda: iga.SphereLattice(181.0, 0.1, 0.2), "substrate.contact_angle"),
        (lambda: iga.SphereLattice(180.0, 0.1, 0.2, "cubic"), "substrate.arrangement"),
        (lambda: iga.SphereLattice(180.0, 0.1, 0.2, offset=(0.0, np.inf)), "substrate.offset"),
        (lambda: iga.SphereLattice(180.0, 0.1, 0.2, base=0.1), "substrate.base"),
        (lambda: iga.Spheres(180.0, [], 0.1), "substrate.centers"),
        (lambda: iga.Spheres(180.0, [[0, 0]], 0.1), r"substrate.centers\[0\]"),
        (lambda: iga.Spheres(180.0, [[0, 0, 0]], [0.1, 0.2]), "substrate.radii"),
        (lambda: iga.Spheres(180.0, [[0, 0, 0], [1, 0, 0]], [0.1, -0.2]), r"substrate.radii\[1\]"),
        (lambda: iga.Spheres([180.0, 0.0], [[0, 0, 0], [1, 0, 0]], 0.1), "contact_angle"),
        (lambda: iga.Spheres(180.0, [[0, 0, 0]], 0.1, base=float("inf")), "substrate.base"),
    ],
)
def test_bad_asperities_are_refused_by_name(make, said):
    with pytest.raises(iga.SceneError, match=said):
        make()
