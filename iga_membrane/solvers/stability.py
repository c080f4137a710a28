"""Stability of an equilibrium: eigenvalues of the second variation on normal motion.

The problem is ``K v = lambda M v`` on the null space of the constraints, ``M`` being the mass
matrix of normal displacement, so ``lambda`` is an energy per area and squared length and does not
depend on the mesh. The index comes from the inertia of a factorization (Sylvester), the smallest
eigenvalue from inverse iteration: two ways that must agree.

Whatever part of the body was computed, all of it is judged: by the blocks of motions of other
parity in the part's mirror planes (:mod:`..surface.parity`), which take the same element
contributions as the part's own motions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..deadline import check_time
from ..dofs.spines import Block
from ..linalg.bordered import Bordered, Matrix
from ..problems.scene import Scene
from ..surface.surface import Surface
from .neutral import Neutral
from .second_variation import SecondVariation


@dataclass(frozen=True, eq=False)
class Stability:
    """Verdict on an equilibrium.

    Attributes
    ----------
    index : number of negative eigenvalues.
    smallest : eigenvalue of smallest magnitude, negative if the index is not 0.
    error : how far ``smallest`` still moved in the last iteration.
    mode : (count, 3) its motion of the control points.
    scope : "full", or the model within whose symmetry the state was judged.
    model : the computed part; within : the smallest one that has the mode.
    pinned : the rigid motions without resistance that were pinned, in words.
    held_index : index with the centroid held along x and y too, where it is not; else None.
    """

    index: int
    smallest: float
    error: float
    mode: Array
    scope: str = "full"
    model: str = "full"
    within: str = "full"
    pinned: Sequence[str] = field(default=())
    held_index: int | None = None

    @property
    def beyond_model(self) -> bool:
        """Whether the computed part cannot take the motion of the mode."""
        return self.within != self.model

    @property
    def marginal(self) -> bool:
        """Whether the sign of the smallest eigenvalue is undecided."""
        return abs(self.smallest) <= self.error


SOLVED = 1e-4
"""Defect of the linear solves over the accuracy of an eigenvalue, which is good to its square."""
ROUNDED = 32.0
"""Rounding of an eigenvalue over that of one number of the largest on the diagonal."""
ALIKE = 1e-4
"""Relative difference of eigenvalues that are the same by symmetry: those of a patch that is not
quite round differ by its ripple, 1e-8 to 1e-6 on default meshes."""
ROUGH, NEARLY = 0.05, 0.2
"""Accuracy of eigenvalues that are looked at only to see whether they are the smallest, and the
margin by which they must not be."""


def stability_of(
    scene: Scene,
    assembly: Assembly,
    surface: Surface,
    multipliers: Array,
    scope: str = "full",
) -> Stability:
    """Stability of a state in the scene's scale.

    Parameters
    ----------
    scope : "full" for the whole body, "model" for motions with the symmetry of the computed part.

    Raises
    ------
    SingularMatrix
        If a Hessian cannot be factorized.
    """
    state = SecondVariation(assembly, surface, multipliers)
    neutral = Neutral(scene, assembly, surface, state)
    # coarse meshes may have no motion of some parity
    blocks = [b for b in assembly.spines.blocks if b.own or b.moves]
    blocks = blocks[: None if scope == "full" else 1]
    verdicts = [_verdict(state, blocks[0], neutral, np.inf)]
    verdicts += [_verdict(state, block, neutral, verdicts[0].smallest) for block in blocks[1:]]
    index = _total(blocks, [verdict.index for verdict in verdicts])
    worst = _worst(verdicts)
    block = blocks[worst]
    mode = state.motion_of(block).displacement(verdicts[worst].mode)
    return Stability(
        index,
        verdicts[worst].smallest,
        verdicts[worst].error,
        assembly.contact.extended(mode, state.motion),
        "full" if scope == "full" and assembly.spines.whole else assembly.spines.model,
        assembly.spines.model,
        block.parity.within,
        [text for block in blocks for text in neutral.pinned(block)],
        _held_index(state, blocks, neutral) if index and neutral.loose else None,
    )


def _total(blocks: Sequence[Block], indices: Sequence[int]) -> int:
    """Index of a body by those of its blocks."""
    return sum(b.parity.alike * k for b, k in zip(blocks, indices, strict=True))


def _held_index(state: SecondVariation, blocks: Sequence[Block], neutral: Neutral) -> int:
    """Index of a droplet if its centroid were held where it is loose."""
    held = [_factor(state, block, neutral, neutral.loose)[2].index for block in blocks]
    return _total(blocks, held)


def _worst(verdicts: Sequence[Eigenpair]) -> int:
    """The number of the block with the softest motion: of those alike by symmetry, which blocks
    share, the first one, whose motion the computed part may have itself."""
    unstable = any(v.index for v in verdicts)
    asked = [k for k, v in enumerate(verdicts) if bool(v.index) == unstable]
    least = min(verdicts[k].smallest for k in asked)
    alike = ALIKE * abs(least)
    return next(k for k in asked if verdicts[k].smallest <= least + alike)


def _factor(
    state: SecondVariation, block: Block, neutral: Neutral, held: str = ""
) -> tuple[Matrix, Array, Bordered]:
    """Hessian of a block, what is held and pinned, and both factorized."""
    matrix = state.matrix(block)
    border = np.hstack([state.border(block, neutral.held + held), neutral.pins(block)])
    return matrix, border, Bordered(matrix, border)


def _verdict(state: SecondVariation, block: Block, neutral: Neutral, smallest: float) -> Eigenpair:
    """Index of a block; with its critical eigenvalue if it may be below the ``smallest`` known."""
    matrix, border, factor = _factor(state, block, neutral)
    mass = state.mass(block)
    rough = stability(matrix, mass, border, factor, block=1, accuracy=ROUGH)
    if factor.index or rough.smallest < smallest * (1.0 + NEARLY):
        return stability(matrix, mass, border, factor)
    return rough


@dataclass(frozen=True, eq=False)
class Eigenpair:
    """Verdict on one block: its ``index``, the critical eigenvalue ``smallest`` with its ``error``,
    and the ``mode`` (n,) of its unknowns, as in :class:`Stability`."""

    index: int
    smallest: float
    error: float
    mode: Array


def stability(
    matrix: Matrix,
    mass: Matrix,
    border: Array,
    factor: Bordered,
    *,
    block: int = 4,
    accuracy: float = 1e-6,
) -> Eigenpair:
    """Index and critical eigenvalue by inverse subspace iteration.

    Parameters
    ----------
    matrix, mass : K and M; border : (n, m) constraint gradients.
    factor : factorization of the bordered matrix without shift.
    block : vectors iterated; accuracy : relative change of the eigenvalue that ends it.
    """
    n, m = border.shape
    width = min(block, n - m)
    start = np.random.default_rng(0).standard_normal((n, width))
    vectors = _inverse(factor, start, m, accuracy)
    smallest, error = np.inf, np.inf
    # of the quotient v . K v of a vector with v . M v = 1
    rounding = ROUNDED * np.finfo(float).eps * float(np.abs(matrix.diagonal()).max())
    for _ in range(40):
        check_time()
        vectors = _inverse(factor, mass @ vectors, m, accuracy)
        vectors, _ = np.linalg.qr(vectors)
        k = vectors.T @ (matrix @ vectors)
        g = vectors.T @ (mass @ vectors)
        low = np.linalg.cholesky(g)
        reduced = np.linalg.solve(low, np.linalg.solve(low, k).T)
        values, modes = np.linalg.eigh(0.5 * (reduced + reduced.T))
        vectors = vectors @ np.linalg.solve(low.T, modes)
        critical = 0 if factor.index else int(np.abs(values).argmin())
        moved, smallest = abs(float(values[critical]) - smallest), float(values[critical])
        mode = vectors[:, critical]
        floor = rounding * float(mode @ mode)
        error = max(moved, floor)
        if moved <= accuracy * abs(smallest) or abs(smallest) <= floor:
            break
    return Eigenpair(factor.index, smallest, error, vectors[:, critical])


def _inverse(factor: Bordered, columns: Array, m: int, accuracy: float) -> Array:
    """Solutions of a matrix that may be all but singular: what they miss lies along the modes that
    are looked for."""
    zero = np.zeros((m, columns.shape[1]))
    return factor.solve(columns, zero, SOLVED * accuracy, np.inf)[0]
