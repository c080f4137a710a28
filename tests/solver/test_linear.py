import numpy as np
import pytest

from iga_membrane.linalg.bordered import Bordered, Matrix, SparsePattern
from iga_membrane.linalg.inverse_root import SingularMatrix


def chain(size, negative, dense):
    """Tridiagonal matrix of two-node elements, with some diagonal entries pulled below zero."""
    pairs = np.stack([np.arange(size - 1), np.arange(1, size)], axis=1)
    matrix = Matrix(size, None if dense else SparsePattern(size, [pairs], np.arange(size)[:, None]))
    matrix.add(pairs, np.broadcast_to([[2.0, -1.0], [-1.0, 2.0]], (size - 1, 2, 2)).copy())
    ends = np.array([[0], [size - 1]])
    matrix.add(ends, np.full((2, 1, 1), 2.0))
    matrix.add(np.arange(negative)[:, None] * 3, np.full((negative, 1, 1), -12.0))
    return matrix


@pytest.mark.parametrize("dense", [True, False])
@pytest.mark.parametrize("negative", [0, 1, 3])
@pytest.mark.parametrize("held", [0, 1, 2])
def test_step_and_index_agree_with_plain_linear_algebra(dense, negative, held):
    n = 400
    matrix = chain(n, negative, dense)
    rng = np.random.default_rng(held)
    border = rng.standard_normal((n, held))
    top, bottom = rng.standard_normal(n), rng.standard_normal(held)
    factor = Bordered(matrix, border)
    s, q = factor.solve(top, bottom)
    k = matrix.dense()
    assert k @ s + border @ q == pytest.approx(top, abs=1e-10)
    assert border.T @ s == pytest.approx(bottom, abs=1e-10)
    null = np.linalg.qr(border, mode="complete")[0][:, held:]
    assert factor.index == (np.linalg.eigvalsh(null.T @ k @ null) < 0).sum()


@pytest.mark.parametrize("negative", [0, 2])
@pytest.mark.parametrize("shifted", [False, True])
def test_unknowns_that_couple_with_all_others_agree_with_plain_linear_algebra(negative, shifted):
    n, k = 40, 2
    rng = np.random.default_rng(negative)
    pairs = np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)
    matrix = Matrix(n + k, SparsePattern(n, [pairs], np.arange(n)[:, None]))
    last = np.broadcast_to(np.arange(n, n + k), (n - 1, k))
    half = rng.standard_normal((n - 1, 2 + k, 2 + k))
    blocks = half + half.transpose(0, 2, 1) + 3.0 * np.diag([1.0, 1.0, 0.0, 0.0])
    matrix.add(np.hstack([pairs, last]), blocks)
    matrix.add(np.arange(negative)[:, None] * 3, np.full((negative, 1, 1), -20.0))
    border = rng.standard_normal((n + k, 1))
    shift = 0.3 * np.abs(matrix.diagonal()) if shifted else None
    full = matrix.dense() + np.diag(shift if shifted else np.zeros(n + k))
    assert full == pytest.approx(full.T)
    vector = rng.standard_normal(n + k)
    assert matrix @ vector == pytest.approx(matrix.dense() @ vector)
    factor = Bordered(matrix, border, shift)
    block = np.array([[5.0, 1.0], [1.0, 4.0]])
    stiff = full.copy()
    stiff[n:, n:] += block
    for one, k_plain in ((factor, full), (factor.stiffened(block), stiff)):
        s, q = one.solve(vector, np.array([0.7]))
        assert k_plain @ s + border @ q == pytest.approx(vector, abs=1e-9)
        assert border.T @ s == pytest.approx([0.7], abs=1e-9)
        null = np.linalg.qr(border, mode="complete")[0][:, 1:]
        assert one.index == (np.linalg.eigvalsh(null.T @ k_plain @ null) < 0).sum()
    saddle = np.block([[full, border], [border.T, np.zeros((1, 1))]])
    follow = np.linalg.inv(saddle)[n : n + k, n : n + k]
    assert factor.last(k) == pytest.approx(np.linalg.inv(follow), rel=1e-8)


def test_fixed_points_are_left_out():
    matrix = Matrix(2)
    matrix.add(np.array([[0, -1], [1, -1]]), np.ones((2, 2, 2)))
    assert matrix.dense() == pytest.approx(np.eye(2))


@pytest.mark.parametrize("dense", [True, False])
def test_a_singular_matrix_is_an_error_not_a_number(dense):
    pairs = np.array([[0, 1], [1, 2]])
    matrix = Matrix(3, None if dense else SparsePattern(3, [pairs], np.arange(3)[:, None]))
    matrix.add(pairs, np.broadcast_to([[1.0, -1.0], [-1.0, 1.0]], (2, 2, 2)).copy())
    with pytest.raises(SingularMatrix):
        Bordered(matrix, np.zeros((3, 0))).solve(np.array([1.0, 0.0, 0.0]), np.zeros(0))


def test_not_a_number_is_an_error():
    matrix = Matrix(2)
    matrix.add(np.array([[0, 1]]), np.full((1, 2, 2), np.nan))
    with pytest.raises(SingularMatrix, match="not finite"):
        Bordered(matrix, np.zeros((2, 0)))
