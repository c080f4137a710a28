"""Second variations by pairs of control points against those by rows of directions."""

import numpy as np
import pytest
from helpers import droplet

import iga_membrane as iga
from iga_membrane.terms import BodyDensity, pairs
from iga_membrane.terms import variations as vary

BODIES = [BodyDensity(), BodyDensity(-0.7), BodyDensity(0.3, (0.5, -0.7, 1.1))]


def surfaces():
    for space, degree in (("bspline", 2), ("bspline", 3), ("nurbs", 2), ("lagrange", 2)):
        yield droplet(110, space=space, degree=degree, elements=6, model="full").surface
    yield iga.sheet(1.0, elements=9)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("surface", list(surfaces()))
def test_pairs_of_control_points_give_the_second_variation_of_the_liquid(surface, body):
    rng = np.random.default_rng(2)
    table = surface.space.table()
    bent = surface.points + 0.01 * rng.standard_normal(surface.points.shape)
    at = vary.element_points(table, bent)
    directions = rng.standard_normal((*table.functions.shape, 3))
    wanted = vary.hessian(table, at, 1.3, body, directions)
    numbers = pairs.hessian(
        table, lambda some: pairs.liquid(table.weights[some], at.part(some), 1.3, body)
    )
    first, second = np.triu_indices(table.functions.shape[1])
    matrix = np.zeros((3, 3, *numbers.shape[1:]))
    for (i, j), number in zip(pairs.COMPONENTS, numbers, strict=False):
        matrix[i, j] = matrix[j, i] = number
    for k, number in enumerate(numbers[6:]):
        i, j = (k + 1) % 3, (k + 2) % 3
        matrix[i, j] += number
        matrix[j, i] -= number
    matrix[:, :, :, first == second] *= 2.0
    found = np.einsum("ijep,epi,epj->ep", matrix, directions[:, first], directions[:, second])
    assert found == pytest.approx(wanted[:, first, second], abs=1e-13 * np.abs(wanted).max())


def test_elements_inside_a_patch_share_their_functions():
    alike = iga.sheet(1.0, elements=9).space.table().alike
    # bicubic and clamped: two elements next to each edge are of their own
    assert [kinds.shape for kinds in alike] == [(16, 1), (8, 5), (1, 25)]


def test_elements_of_one_kind_have_the_same_rows():
    space = droplet(110, degree=3, elements=8, model="full").surface.space
    table = space.table()
    for kinds in table.alike:
        for rows in (table.values, table.d1, table.d2):
            assert rows[kinds] == pytest.approx(rows[kinds[:, :1]].repeat(kinds.shape[1], 1))
