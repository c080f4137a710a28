"""Contact: exact gradient and Hessian of the multipliers' and of the penalty's energy."""

import numpy as np
import pytest
from helpers import UNIT_VOLUME, example
from taylor import lagrangian_slopes, remainder_slopes

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.terms import Contact

PENALTY, HARD = 50.0, 1e4


def cell(model, penalty, center=(0.0, 0.0, -1.0)):
    return iga.asperity_cell(
        iga.Sphere(180.0, 1.0, center),
        size=4.0,
        pressure=0.5,
        discretization=iga.Discretization(elements=10, model=model),
        penalty=penalty,
    )


def rough(model, penalty, offset=(0.0, 0.0)):
    return iga.sessile_droplet(
        iga.SphereLattice(180.0, 0.4, 0.9, offset=offset),
        volume=UNIT_VOLUME,
        gravity=1.0,
        discretization=iga.Discretization(elements=6, model=model),
        penalty=penalty,
    )


def own(penalty):
    """Pillars whose surface has two different curvatures."""
    return iga.sessile_droplet(
        example("pillars").Pillars(0.4, 0.3, 0.9),
        volume=UNIT_VOLUME,
        gravity=1.0,
        discretization=iga.Discretization(elements=8, model="full"),
        penalty=penalty,
    )


def scenes():
    for law in ("exact", "penalty"):
        penalty = PENALTY if law == "penalty" else None
        for model in ("full", "quarter", "eighth"):
            yield pytest.param(cell(model, penalty), id=f"cell {model} {law}")
        yield pytest.param(cell("full", penalty, (0.2, -0.3, -0.9)), id=f"cell off centre {law}")
        yield pytest.param(rough("eighth", penalty), id=f"lattice eighth {law}")
        yield pytest.param(rough("full", penalty, (0.1, 0.2)), id=f"lattice full {law}")
        yield pytest.param(own(penalty), id=f"pillars {law}")
    for model, offset in (("eighth", (0.0, 0.0)), ("full", (0.1, 0.2))):
        yield pytest.param(rough(model, HARD, offset), id=f"lattice {model} hard penalty")


SCENES = list(scenes())


def state(scene, seed=0):
    """A membrane sunk in the solid, its tractions far from the border between wet and dry."""
    assembly, rng = Assembly(scene), np.random.default_rng(seed)
    contact, surface = assembly.contact, scene.local_surface()
    deep = [surface.moved(surface.points - [0, 0, d]) for d in np.linspace(0.05, 0.2, 40)]

    def margin(moved):
        return np.abs(contact.touch(moved.points).at.gap).min()

    surface = max(deep, key=margin)
    motion = assembly.spines.on(surface)
    gap = contact.touch(surface.points).at.gap
    reach = margin(surface)
    if contact.exact:
        wet = gap < 0.2 * contact.length
        # both signs of the gap carry traction
        tractions = rng.uniform(0.5, 2.0, gap.shape)
        contact.multipliers = np.where(wet, gap / contact.delta + tractions, 0.0).clip(0.0)
        traction = contact.multipliers - gap / contact.delta
        reach = float(np.abs(traction * contact.delta).min())
    touch = contact.touch(surface.points)
    assert (touch.traction > 0).any()
    assert not (touch.traction > 0).all()
    multipliers = rng.uniform(0.5, 2.0, assembly.multipliers)
    direction = rng.standard_normal(assembly.size)
    # steps of the control points keep to the gauge of the shifts
    gauge = assembly.spines.gauge
    direction -= gauge @ np.linalg.lstsq(gauge, direction)[0]
    largest = np.linalg.norm(motion.displacement(direction), axis=1).max()
    direction *= min(0.3, 0.9 * 2**8 * reach) / largest
    return assembly, surface, multipliers, direction, motion


@pytest.mark.parametrize("scene", SCENES)
def test_taylor_remainders_of_contact_alone_fall_at_their_order(scene):
    assembly, surface, _, direction, motion = state(scene)
    contact, table = assembly.contact, assembly.contact.table
    displacement = motion.displacement(direction)

    def value(step):
        return contact.energy(surface.points + step * displacement)

    touch = contact.touch(surface.points)
    gradient = (contact.forces(touch) * displacement[table.functions]).sum()
    near, blocks = contact.hessian(touch, displacement)
    first, second = remainder_slopes(value, gradient, blocks.sum())
    assert np.isfinite(first)
    assert 1.9 <= first < 2.5
    assert second >= 2.9
    assert set(near) == set(np.flatnonzero((touch.traction > 0).any(axis=1)))


@pytest.mark.parametrize("scene", SCENES)
def test_taylor_remainders_with_all_terms_fall_at_their_order(scene):
    assembly, surface, multipliers, direction, motion = state(scene)
    first, second = lagrangian_slopes(assembly, surface, multipliers, motion, direction)
    assert 1.9 <= first < 2.5
    assert second >= 2.9


@pytest.mark.parametrize("scene", SCENES)
def test_the_matrix_is_the_derivative_of_the_gradient(scene):
    assembly, surface, multipliers, direction, motion = state(scene)
    system = assembly.system(surface, motion.directions, multipliers)
    dense = system.matrix.dense()
    assert np.abs(dense - dense.T).max() <= 1e-12 * np.abs(dense).max()
    h = 1e-4

    def residual(step):
        moved = surface.moved(surface.points + motion.displacement(step * direction))
        return assembly.system(moved, motion.directions, multipliers).residual(multipliers)

    near, far = (residual(k * h) - residual(-k * h) for k in (1, 2))
    difference = (8.0 * near - far) / (12.0 * h)
    exact = dense @ direction
    assert np.linalg.norm(difference - exact) <= 1e-7 * np.linalg.norm(exact)


@pytest.mark.parametrize("penalty", [1e2, 1e4, 1e6, 1e9])
@pytest.mark.parametrize("make", [cell, rough], ids=["cell", "lattice"])
def test_gradient_of_any_penalty_agrees_with_central_differences(make, penalty):
    """Q1: with steps too short to wet or dry a quadrature point."""
    assembly, surface, _, direction, motion = state(make("full", penalty))
    contact, h = assembly.contact, 1e-5
    displacement = motion.displacement(direction)
    touch = contact.touch(surface.points)
    assert np.abs(touch.at.gap).min() > 10.0 * h * np.abs(displacement).max()
    exact = (contact.forces(touch) * displacement[contact.table.functions]).sum()
    high, low = (contact.energy(surface.points + s * displacement) for s in (h, -h))
    scale = np.abs(contact.forces(touch)).max() * np.abs(displacement).max()
    assert abs((high - low) / (2.0 * h) - exact) <= 1e-8 * scale


def test_multipliers_that_hold_the_gap_add_no_energy():
    assembly, surface, *_ = state(cell("quarter", None))
    contact = assembly.contact
    gap = contact.touch(surface.points).at.gap
    contact._lift = gap.copy()  # every point lies just on the solid
    contact.multipliers = np.random.default_rng(1).uniform(0.1, 1.0, gap.shape)
    assert contact.energy(surface.points) == pytest.approx(0.0, abs=1e-14)
    assert np.abs(contact.forces(contact.touch(surface.points))).max() > 1e-3


@pytest.mark.parametrize(
    ("values", "said"),
    [({"penalty": 0.0}, "solver.penalty"), ({"depth": -1.0}, "depth")],
)
def test_bad_laws_of_contact_are_refused_by_name(values, said):
    with pytest.raises(iga.SceneError, match=said):
        Contact(iga.Plane(180.0), **values)
