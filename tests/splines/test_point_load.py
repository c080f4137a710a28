"""Point loads on spline spaces."""

import numpy as np
import pytest

from iga_membrane.splines import periodic_basis, tensor_space
from iga_membrane.splines.point_load import ROBIN, effective_radius


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize("place", [(0.0, 0.0), (0.5, 0.5), (0.3, 0.9)])
def test_effective_radius_is_that_of_a_load_on_an_assembled_torus(degree, place):
    count = 14  # the images' shape adds an error of count^-4
    line = periodic_basis(count, degree)
    space = tensor_space(line, line)
    table = space.table(degree + 1)
    stiffness = np.zeros((space.count, space.count))
    for rows in (table.d1, table.d2):
        blocks = (rows * table.weights[..., None]).transpose(0, 2, 1) @ rows
        np.add.at(stiffness, (table.functions[:, :, None], table.functions[:, None, :]), blocks)
    functions, rows = space.at(np.array([place]) / count + 3.0 / count, 0)
    load = np.zeros(space.count)
    np.add.at(load, functions[0], rows[0, 0][0])
    # balanced by an even load; the potential's mean is zero
    field = np.linalg.lstsq(stiffness, load - load.sum() / space.count)[0]
    field -= field.mean()
    potential = field @ load
    radius = count * np.exp(-2.0 * np.pi * potential - ROBIN)
    assert effective_radius(degree, np.array([place]))[0] == pytest.approx(radius, rel=1e-4)


def test_a_load_amid_an_element_is_narrower_for_even_degrees():
    amid, corner = effective_radius(2, np.array([[0.5, 0.5], [0.0, 0.0]]))
    assert amid < corner
    assert effective_radius(2, np.array([[1.0, 0.0]]))[0] == pytest.approx(corner, rel=1e-12)
