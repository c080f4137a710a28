"""Quadrature of elements that a level line cuts, on circles where areas and lengths are known."""

import numpy as np
import pytest

from iga_membrane.splines import cut


def circle_cut(middle, radius, elements, points):
    """Area outside a circle in the unit square, and the circle's length."""
    e1, e2 = np.divmod(np.arange(elements**2), elements)

    def level(rows, u):
        x = (np.stack([e1, e2], axis=1)[rows][:, None] + u) / elements - middle
        distance = np.linalg.norm(x, axis=-1)
        slope = x / distance[..., None] / elements
        return distance - radius, slope, np.zeros(distance.shape, int)

    made = cut(level, elements**2, points)
    area = ((made.sign > 0).sum() + made.area.weights.sum()) / elements**2
    x = (np.stack([e1, e2], axis=1)[made.line.rows][:, None] + made.line.u) / elements - middle
    across = np.take_along_axis(x, made.across[:, None, None], axis=2)[..., 0] / radius
    return area, (made.line.weights / elements / np.abs(across)).sum(), made


@pytest.mark.parametrize(("elements", "error"), [(4, 3e-6), (8, 1e-6), (16, 1e-11)])
def test_a_circle_is_cut_with_the_order_of_its_gauss_rule(elements, error):
    area, length, _ = circle_cut(np.array([0.52, 0.47]), 0.31, elements, 6)
    assert area == pytest.approx(1.0 - np.pi * 0.31**2, abs=0.1 * error)
    assert length == pytest.approx(2.0 * np.pi * 0.31, abs=error)


@pytest.mark.parametrize("radius", [0.011, 0.02, 0.05])
def test_a_loop_inside_one_element_is_found(radius):
    area, length, made = circle_cut(np.array([0.37, 0.61]), radius, 4, 6)
    assert (made.sign == 0).sum() == 1
    assert area == pytest.approx(1.0 - np.pi * radius**2, abs=1e-7)
    assert length == pytest.approx(2.0 * np.pi * radius, rel=1e-4)


def test_random_circles_are_cut_everywhere():
    random = np.random.default_rng(3)
    for _ in range(100):
        middle, radius = random.uniform(0.3, 0.7, 2), random.uniform(0.02, 0.29)
        area, length, _ = circle_cut(middle, radius, 5, 6)
        assert area == pytest.approx(1.0 - np.pi * radius**2, abs=3e-7)
        assert length == pytest.approx(2.0 * np.pi * radius, abs=1e-5)


def test_lines_of_two_solids_in_one_element_are_told_apart():
    middles = np.array([[0.3, 0.5], [0.7, 0.5]])

    def level(rows, u):
        away = u[..., None, :] - middles
        distance = np.linalg.norm(away, axis=-1)
        which = distance.argmin(axis=-1)
        nearest = np.take_along_axis(away, which[..., None, None], axis=-2)[..., 0, :]
        least = distance.min(axis=-1)
        return least - 0.18, nearest / least[..., None], which

    made = cut(level, 1, 8)
    assert made.area.weights.sum() == pytest.approx(1.0 - 2.0 * np.pi * 0.18**2, abs=1e-7)


def test_ends_of_graphs_lie_on_the_sides_they_cross():
    _, _, made = circle_cut(np.array([0.52, 0.47]), 0.31, 8, 4)
    height = np.take_along_axis(
        made.ends.u[:, 0], made.across[made.ends_line][:, None], axis=1
    )[:, 0]  # fmt: skip
    boxes = np.abs(height * 128 - np.rint(height * 128))
    assert boxes.max() < 1e-12
    # every line that enters an element through such a side leaves another one
    assert abs(made.ends.weights.sum()) <= len(made.ends.rows)
