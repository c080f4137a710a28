import numpy as np
import pytest
from scipy.sparse import csc_array

from iga_membrane.linalg.inverse_root import SingularMatrix
from iga_membrane.linalg.multifrontal import Elimination, Multifrontal


def patch(side, per_point, seed, lift):
    """Random symmetric matrix of a square net whose points couple two lines away, with its
    places."""
    rng = np.random.default_rng(seed)
    i, j = np.divmod(np.arange(side**2), side)
    near = np.maximum(np.abs(i[:, None] - i), np.abs(j[:, None] - j)) <= 2
    full = rng.standard_normal((side**2 * per_point,) * 2) * np.kron(
        near, np.ones(2 * (per_point,))
    )
    full = full + full.T + lift * np.eye(len(full))
    places = np.repeat(np.stack([i, j], axis=1), per_point, axis=0).astype(float)
    shuffle = rng.permutation(len(full))
    return full[np.ix_(shuffle, shuffle)], places[shuffle]


def factorized(full, places):
    sparse = csc_array(full)
    sparse.setdiag(full.diagonal())
    return Multifrontal(Elimination(sparse.indices, sparse.indptr, places), sparse.data)


@pytest.mark.parametrize(("per_point", "lift"), [(1, 0.0), (1, 5.0), (1, 40.0), (3, 10.0)])
def test_solution_and_inertia_agree_with_plain_linear_algebra(per_point, lift):
    full, places = patch(18, per_point, 7, lift)
    factor = factorized(full, places)
    assert len(factor._elimination.fronts) > 6
    right = np.random.default_rng(1).standard_normal((len(full), 2))
    assert full @ factor.solve(right) == pytest.approx(right, abs=1e-8)
    assert full @ factor.solve(right[:, 0]) == pytest.approx(right[:, 0], abs=1e-8)
    negative = int((np.linalg.eigvalsh(full) < 0).sum())
    assert factor.negative == negative
    assert (negative > 0) == (lift < 40.0)


def test_parts_that_do_not_touch_are_solved_as_one_matrix():
    one, places = patch(12, 1, 3, 40.0)
    none = np.zeros_like(one)
    full = np.block([[one, none], [none, -one]])
    factor = factorized(full, np.vstack([places, places + [100.0, 0.0]]))
    right = np.arange(len(full), dtype=float)
    assert full @ factor.solve(right) == pytest.approx(right, abs=1e-9)
    assert factor.negative == len(one)


def test_unknowns_at_one_place_are_solved_together():
    full, _ = patch(6, 4, 5, 60.0)
    right = np.ones(len(full))
    assert full @ factorized(full, np.zeros((len(full), 2))).solve(right) == pytest.approx(right)


def test_a_singular_front_is_an_error():
    full, places = patch(12, 1, 3, 40.0)
    full[3] = full[:, 3] = 0.0
    with pytest.raises(SingularMatrix):
        factorized(full, places)


def test_entries_that_are_not_finite_are_an_error():
    full, places = patch(12, 1, 3, 40.0)
    full[3, 3] = np.nan
    with pytest.raises(SingularMatrix, match="not finite"):
        factorized(full, places)
