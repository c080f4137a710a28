"""Point loads on spline spaces."""

import numpy as np
import pytest

from iga_membrane.splines import periodic_basis, tensor_space
from iga_membrane.splines.point_load import ROBIN, effective_radius


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize(
    "places", [[(0.0, 0.0)], [(0.5, 0.5)], [(0.3, 0.9)], [(0.3, 0.9), (-0.6, 0.9), (0.1, -1.2)]]
)
def test_effective_radius_is_that_of_a_load_on_an_assembled_torus(degree, places):
    count = 18  # the images' shape adds an error of count^-4
    line = periodic_basis(count, degree)
    space = tensor_space(line, line)
    table = space.table(degree + 1)
    stiffness = np.zeros((space.count, space.count))
    for rows in (table.d1, table.d2):
        blocks = (rows * table.weights[..., None]).transpose(0, 2, 1) @ rows
        np.add.at(stiffness, (table.functions[:, :, None], table.functions[:, None, :]), blocks)
    functions, rows = space.at(np.array(places) / count + 3.0 / count, 0)
    load = np.zeros(space.count)
    np.add.at(load, functions, rows[0, 0] / len(places))
    # balanced by an even load; the potential's mean is zero
    field = np.linalg.lstsq(stiffness, load - load.sum() / space.count)[0]
    field -= field.mean()
    potential = field @ load
    squares = np.square(np.subtract.outer(*[np.array(places)] * 2)[:, [0, 1], :, [0, 1]]).sum(
        axis=0
    )
    rise = 0.5 * np.pi * squares.mean() / count**2
    radius = count * np.exp(rise - 2.0 * np.pi * potential - ROBIN)
    assert effective_radius(degree, np.array([places]))[0] == pytest.approx(radius, rel=1e-4)


def test_a_load_amid_an_element_is_narrower_for_even_degrees():
    amid, corner = effective_radius(2, np.array([[[0.5, 0.5]], [[0.0, 0.0]]]))
    assert amid < corner
    assert effective_radius(2, np.array([[[1.0, 0.0]]]))[0] == pytest.approx(corner, rel=1e-12)


def test_a_ring_is_as_wide_as_it_is():
    turn = 0.25 * np.pi * np.arange(1, 8, 2)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    for place in np.random.default_rng(0).uniform(size=(5, 2)):
        for radius in (2.0, 3.0):
            # four points: the mean of the potential of one over the others, and each one's own
            own = effective_radius(2, place[None, None] + radius * ring[:, None])
            apart = np.sqrt(2.0) * radius, np.sqrt(2.0) * radius, 2.0 * radius
            wanted = np.exp(0.25 * (np.log(own).mean() + np.log(apart).sum()))
            found = effective_radius(2, (place + radius * ring)[None])[0]
            assert found == pytest.approx(wanted, rel=0.02)
