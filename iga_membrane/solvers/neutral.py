"""Rigid motions against which nothing in a scene resists, known before its equilibrium.

A rigid motion ``v + omega x x`` is neutral if it carries every solid and every rim into itself,
changes no load, and leaves what is held where it is: linear conditions on ``(v, omega)``.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..dofs.spines import Block
from ..dofs.symmetry import mirrors
from ..problems.scene import Scene
from ..solids.wettability import varies
from ..surface.surface import Surface
from ..terms import variations as vary
from .second_variation import SecondVariation, mirrored, normal_motions, rigid_motions

EXACT = 1e-9
"""Part of a rigid motion that counts as none: rounding, far below any load or length."""

SMALL = 1e-6
"""The same in words."""

PLACES = 400
"""Places of the computed part at which solids are looked at."""
AXIAL = 1e-3
"""Part of a turn that moves a body along its normal, or a rim across itself, below which it is one
of revolution: what is left where its control points do not lie quite evenly round the axis. Of
rims it is 2e-5 to 5e-5 on default meshes and 8e-4 with 6 elements, but 3e-3 to 6e-3 with 4."""


def neutral_motions(
    scene: Scene, assembly: Assembly, surface: Surface, moment: Array, held: str
) -> Array:
    """(k, 6) translations and rotations about the origin that are neutral, in the scene's scale.

    Parameters
    ----------
    surface : the state. moment : (4,) volume of its liquid and first moments.
    held : axes along which the centroid is held.
    """
    x = assembly.table.values @ surface.points[assembly.table.functions]
    x = x.reshape(-1, 3)[:: max(1, x[..., 0].size // PLACES)]
    places = np.concatenate([x @ m for m in mirrors(scene.sector)])
    solids = [solid for term in scene.local_terms() for solid in term.solids]
    solids += [support.on for support in scene.local_supports().sliding]
    conditions = [normal_motions(places, solid.nearest(places).normal) for solid in solids]
    fields = [s.contact_angle for s in solids if varies(s.contact_angle)]
    conditions += [normal_motions(places, field.at(places)[1]) for field in fields]
    conditions += [EXACT / AXIAL * _across(surface, edge) for edge in _rims(scene)]
    pull = np.array(assembly.body.gradient)
    conditions.append(np.concatenate([pull, np.zeros(3)])[None])
    conditions.append(np.hstack([np.zeros((3, 3)), vary.cross(np.eye(3), pull).T]))
    for axis in held:
        unit = np.eye(3)["xyz".index(axis)]
        moved = np.concatenate([moment[0] * unit, vary.cross(moment[1:], unit)])
        conditions.append(moved[None] / np.abs(moment).max())
    # of many places, as much as of one
    rows = np.concatenate([c / np.sqrt(len(c)) for c in conditions])
    _, sizes, motions = np.linalg.svd(np.linalg.qr(rows, mode="r"))
    return np.asarray(motions[sizes <= EXACT])


class Neutral:
    """Neutral motions of a scene at a state, block by block.

    Attributes
    ----------
    held : axes along which the scene holds the centroid but its constraints do not, since the
        computed part is mirrored there; loose : those along which it could be held, if a droplet.
    """

    def __init__(
        self, scene: Scene, assembly: Assembly, surface: Surface, state: SecondVariation
    ) -> None:
        constrained = [t.axis for t in scene.by_form.centroids]
        self._scene, self._state = scene, state
        self.held = "".join(axis for axis in scene.hold if axis not in constrained)
        droplet = scene.kind == "sessile_droplet" and not scene.particles
        loose = [a for a in "xy" if a not in scene.hold and a not in constrained]
        self.loose = "".join(loose) if droplet else ""
        moment = state.moment
        self._free = neutral_motions(scene, assembly, surface, moment, scene.hold)
        kept = set(scene.hold).union(constrained)
        self._unpinned = neutral_motions(scene, assembly, surface, moment, "".join(sorted(kept)))

    def pins(self, block: Block) -> Array:
        """(n, k) what has to be held of a block's motions for the rest to resist."""
        state = self._state
        columns = [state.pin(block, motion) for motion in self._of(block, self._unpinned)]
        return np.array(columns).reshape(-1, block.size).T

    def pinned(self, block: Block) -> list[str]:
        """A block's neutral motions in words, those that constraints pin included."""
        scene, own = self._scene, self._of(block, self._free)
        images = self._state.images(block)
        return [described(scene, mirrored(m, motion)) for m in images for motion in own]

    def _of(self, block: Block, motions: Array) -> Array:
        """(k, 6) those of rigid motions with the parity of a block that move the membrane."""
        state = self._state
        parts = np.array([state.part(block, motion) for motion in motions]).reshape(-1, 6)
        _, sizes, basis = np.linalg.svd(parts)
        basis = basis[: int((sizes > SMALL).sum())]
        normal, size = (basis @ gram @ basis.T for gram in (state.normal, state.size))
        low = np.linalg.inv(np.linalg.cholesky(size))
        ratios, moves = np.linalg.eigh(low @ normal @ low.T)
        return _simplest(moves.T[ratios > AXIAL**2] @ low @ basis)


def _simplest(motions: Array) -> Array:
    """Other motions (k, 6) that span the same, each with as many zeros as there can be."""
    rows = motions.copy()
    for k in range(len(rows)):
        column = int((np.abs(rows[k:]) > SMALL * np.abs(rows[k:]).max()).any(axis=0).argmax())
        best = k + int(np.abs(rows[k:, column]).argmax())
        rows[[k, best]] = rows[[best, k]]
        rows[k] /= rows[k, column]
        others = np.arange(len(rows)) != k
        rows[others] -= rows[others, column, None] * rows[k]
    return rows


def _rims(scene: Scene) -> list[str]:
    """Edges that keep their place: fixed ones, but a contact line at 0 or 180 degrees, at which the
    membrane lies; and free ones, which end on a wall."""
    closed = [support.edge for support in scene.by_kind.sliding]
    closed += [edge for joint in scene.by_kind.joints for edge in joint.edges]
    closed += [line.edge for line in scene.by_form.wetting if abs(line.strength) >= line.gamma]
    return [edge for edge in scene.surface.space.open_edges if edge not in closed]


def _across(surface: Surface, edge: str) -> Array:
    """(n, 6) rigid motions of an edge but along itself."""
    table = surface.space.edge_table(edge)
    x, along = (rows @ surface.points[table.functions] for rows in (table.values, table.d))
    along = along / np.linalg.norm(along, axis=-1, keepdims=True)
    moves = rigid_motions(x)
    moves = moves - (moves @ along[..., None]) * along[..., None, :]
    return np.asarray(np.moveaxis(moves, -2, -1).reshape(-1, 6))


def described(scene: Scene, motion: Array) -> str:
    """A rigid motion (6,) of the scene's scale in words: directions in the scene's frame, as for
    ``hold``, places in the world."""
    shift, turn = motion[:3], motion[3:]
    if np.linalg.norm(turn) <= SMALL * np.linalg.norm(motion):
        return f"translation along {_direction(shift)}"
    place = np.round(np.cross(turn, shift) / (turn @ turn), 9) + 0.0  # no -0
    x, y, z = scene.units.to_world(place)
    return f"rotation about {_direction(turn)} through ({x:.4g}, {y:.4g}, {z:.4g})"


def _direction(vector: Array) -> str:
    """A direction in words."""
    unit = vector / np.linalg.norm(vector)
    for axis, name in zip(np.eye(3), "xyz", strict=True):
        if abs(abs(unit @ axis) - 1.0) <= SMALL:
            return name
    return "({:.4g}, {:.4g}, {:.4g})".format(*unit)
