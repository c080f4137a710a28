"""Motions of a whole patch by their parity in the mirror planes of the part that is computed.

A state with mirror planes has a second variation that does not couple motions of different parity,
so that of the whole body falls into blocks, one for each irreducible representation of its mirror
group (C2v of a quarter, C4v of an eighth). Every block needs the elements of the computed part
only: on the image of that part by a plane, a motion is the same one, times its sign there. The
two-dimensional representation E of C4v is one pair of equal blocks; its motions are those of a
quarter that are odd in x and even in y, so it needs a second image of the eighth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index
from ..splines import Space
from ..splines.polar import CORNERS
from .boundary_conditions import Model
from .symmetry import FOLDS, net_image, reflection


@dataclass(frozen=True)
class Parity:
    """How motions of the whole patch change in its mirror planes.

    Attributes
    ----------
    model : whose planes these are.
    signs : 1 (even) or -1 (odd) for each plane, in the order of ``FOLDS``.
    alike : number of blocks of the whole body that are equal to this one.
    within : the smallest model in which such motions are even, so that they can be followed there.
    """

    model: Model
    signs: tuple[int, ...] = ()
    alike: int = 1
    within: Model = "full"

    def planes(self, sense: int) -> list[tuple[Array, int]]:
        """Mirror matrices (3, 3) with their signs, for a patch of a :func:`.sector.sense`."""
        folds = FOLDS[self.model]
        return [(reflection(sense * f), sign) for f, sign in zip(folds, self.signs, strict=True)]

    def images(self, model: Model, sense: int) -> list[Array]:
        """Matrices (3, 3) that carry the part that a model computes to those on which these motions
        are not the same but for a sign."""
        more = FOLDS[model][len(FOLDS[self.model]) :]
        return [np.eye(3)] + [reflection(sense * fold) for fold in more]


ODD: dict[Model, tuple[Parity, ...]] = {
    "full": (),
    "half": (Parity("half", (-1,)),),
    "quarter": (
        Parity("quarter", (1, -1), within="half"),
        Parity("quarter", (-1, 1)),
        Parity("quarter", (-1, -1)),
    ),
    "eighth": (
        Parity("quarter", (1, -1), alike=2, within="half"),
        Parity("eighth", (1, 1, -1), within="quarter"),
        Parity("eighth", (-1, -1, 1)),
        Parity("eighth", (-1, -1, -1)),
    ),
}
"""The parities that a model's own motions do not have: with them they are all of the whole patch's.
The first of C4v is E, then B1, B2, A2."""


def parts(space: Space, parity: Parity, model: Model) -> tuple[Index, Array]:
    """How control points take part in the motions of one parity.

    Parameters
    ----------
    model : that is computed.

    Returns
    -------
    leaders : (images, count) on each of the parity's images of the computed part the control point
        that moves each, or -1 where it rests.
    factors : (images, count) motion of each over that of its leader, 0 where it rests.
    """
    own = np.arange(space.count)
    folds = {fold: _permutation(space, fold) for fold in FOLDS[model]}
    group: list[tuple[Index, int]] = [(own, 1)]
    for fold, sign in zip(FOLDS[parity.model], parity.signs, strict=True):
        group += [(folds[fold][image], sign * character) for image, character in group]
    images = np.stack([image for image, _ in group])
    characters = np.array([character for _, character in group])
    leaders = images.min(axis=0)
    factors = characters[images.argmin(axis=0)].astype(float)
    rests = ((images == own) & (characters[:, None] < 0)).any(axis=0)
    leaders = np.where(rests, -1, leaders)
    more = FOLDS[model][len(FOLDS[parity.model]) :]
    through = [own, *(folds[fold] for fold in more)]
    leaders, factors = (np.stack([of[image] for image in through]) for of in (leaders, factors))
    if space.pole is not None:
        _lean(space, parity, leaders, factors)
    return leaders, np.where(leaders < 0, 0.0, factors)


def _lean(space: Space, parity: Parity, leaders: Index, factors: Array) -> None:
    """Let the pole's control points take part: odd in one of x and y, its tangent plane leans."""
    corners = np.arange(space.count - (3 if space.pole else 1), space.count)
    leaders[:, corners] = -1
    if space.pole and len(parity.signs) < 3 and parity.signs != (-1, -1):
        along = parity.signs == (1, -1)
        tilts = np.cos(CORNERS), np.sin(CORNERS)
        for image in range(len(leaders)):
            leaders[image, corners] = corners[0]
            factors[image, corners] = tilts[(image + (not along)) % 2]


def _permutation(space: Space, fold: float) -> Index:
    """(count,) the control point at the mirror image of each; those of a pole stay."""
    n1, n2 = space.net_shape
    if space.pole is None:
        numbers = np.arange(n1 * n2) if space.shared is None else space.shared
        first = np.arange(n1 * n2) if space.leaders is None else space.leaders
        return np.asarray(net_image(space, numbers.reshape(n1, n2), fold).ravel()[first])
    rings = n2 - space.joined_rings
    net = np.arange(n1 * rings).reshape(n1, rings)
    found: Index = np.arange(space.count)
    found[net] = net_image(space, net, fold)
    return found
