"""How a membrane meets its solids: what every model of contact answers.

The Lagrangian, Newton's method, measures and the audit ask these questions of whatever model a
scene has, and never which one it is. This one is the simplest: the membrane ends on its solids,
along edges (:mod:`.edge_lines`), and nothing of it lies on them or passes through them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ..arrays import Array, Index, Mask
from ..dofs.dof_map import FirstOrder, Rows
from ..dofs.spines import Motion
from ..errors import GeometryError
from ..linalg.bordered import Matrix
from ..problems.scene import Scene
from ..splines import Table
from ..surface.surface import Surface
from ..terms import BodyDensity
from ..terms.variations import ElementPoints
from .laws import law_of, line_of
from .patches import ContactPatches


class ContactModel:
    """Contact along edges only.

    Attributes
    ----------
    law : the model in a word, for the result.
    length : over which contact changes; infinite where nothing is near.
    reach : the same, as far as the membrane may roll over it in a step.
    depth_allowed : below a plane on the way, over the scene's length; at its end the audit allows
        none.
    rounds : updates of multipliers so far.
    lies : whether the membrane goes on over the wetted area, and carries : whether it is carried
        there alone, not by a line inside it too.
    passes : whether it goes on through its solids, of which a part is no liquid's surface.
    """

    law = "contact lines"
    length = np.inf
    reach = np.inf
    depth_allowed = 1e-9
    rounds = 0
    lies = carries = passes = False

    def again(self, scene: Scene, made: Callable[[], ContactModel]) -> ContactModel:
        """The model for another scene of the same kind: its solid, angles, law.

        Parameters
        ----------
        made : makes that scene's model anew.

        Raises
        ------
        GeometryError
            If that meets its solid in another way.
        """
        if law_of(scene) is not None or line_of(scene) is not None:
            raise another_way()
        return self

    def released(self) -> ContactModel:
        """The same without idle unknowns, for sums in which every row has its own."""
        return self

    # ---- the state of an iteration

    @property
    def memory(self) -> Array | None:
        """What a solve at the next load needs to know, or None."""
        return None

    def recall(self, memory: Array) -> None:
        """Take the :attr:`memory` of another contact of the same membrane."""

    def by(self, rows: Rows) -> None:
        """Take the rows of the motion, by which forces are asked for."""

    def begin(self, surface: Surface) -> None:
        """Find what is in contact at a start."""

    def follow(self, surface: Surface) -> None:
        """Find what is in contact in a mesh that has moved sideways."""

    def begin_step(self, area: Array) -> None:
        """Count tractions per area (elements, points) of the state where a load step begins."""

    def firm(self, factor: float) -> None:
        """Hold what the liquid does not hold so much firmer than usual."""

    def hold(self, points: Array) -> None:
        """Take note of a state that steps lead away from."""

    def settled_at(self, surface: Surface, near: float) -> bool:
        """Whether contact is settled, multipliers updated if the last step ``near`` the solid (over
        the contact length) was small enough."""
        return True

    def true(self, points: Array) -> bool:
        """Whether a state is one that the model describes."""
        return True

    # ---- what of the mesh counts

    @property
    def tied(self) -> Index | None:
        """(k, local) functions that contact couples although no element has them all, or None."""
        return None

    @property
    def idle(self) -> Index:
        """Unknowns of which nothing counts."""
        return np.zeros(0, int)

    def counts(self, points: Array, elements: int) -> Mask:
        """(elements,) whether an element has a part that counts."""
        return np.ones(elements, bool)

    def parts(
        self, points: Array, at: ElementPoints, rows: Rows
    ) -> list[tuple[Table, ElementPoints]]:
        """Tables by rows of the motion, and the geometry there, that make up the membrane."""
        return [(table, at.part(elements)) for elements, table in rows.groups]

    def extended(self, vectors: Array, motion: Motion) -> Array:
        """Positions or displacements (count, 3) of the control points, those on which nothing
        depends changed along a motion's directions until they follow the others."""
        return vectors

    def largest(self, table: Table, points: Array, displacement: Array) -> float:
        """Size of a displacement (count, 3): the control points'."""
        return float(np.linalg.norm(displacement, axis=-1).max(initial=0.0))

    def near_contact(self, table: Table, points: Array, displacement: Array) -> float:
        """Largest displacement over the contact length near the solid."""
        return 0.0

    # ---- energy, and its derivatives by rows of the motion

    def energy(self, points: Array) -> float:
        """Energy of contact, without that of the wetted surface."""
        return 0.0

    def aids(self, points: Array, tension: float) -> float:
        """Energy of numerical aids, which is no liquid's."""
        return 0.0

    def wetting(self, points: Array) -> tuple[float, float]:
        """Energy of the surface that is wetted inside lines within the membrane, and its area."""
        return 0.0, 0.0

    def wetted(self, points: Array) -> float:
        """That energy where it is no part of :meth:`energy`."""
        return 0.0

    def under(self, points: Array, body: BodyDensity) -> float:
        """Part of a body integral that the flux through the wetted surface brings in."""
        return 0.0

    def add_forces(
        self,
        total: FirstOrder,
        points: Array,
        tension: float,
        body: BodyDensity,
        held: list[BodyDensity],
    ) -> None:
        """Add the derivatives of the energy, and of the body integrals ``held``."""

    def add_hessian(
        self,
        matrix: Matrix,
        rows: Rows,
        points: Array,
        directions: Array,
        tension: float,
        body: BodyDensity,
    ) -> None:
        """Add the second derivatives of the Lagrangian."""

    def loads(self, points: Array) -> Iterator[tuple[Table, Array]]:
        """Functions at contact points, and forces (elements, points, 3) there of the solid on the
        membrane, of one sector."""
        yield from ()

    # ---- what it carries

    def patches(
        self, surface: Surface, images: list[Array], tension: float, body: BodyDensity
    ) -> ContactPatches:
        """Contact solid by solid, particles too, the mirror images of a sector unfolded.

        Parameters
        ----------
        images : matrices (3, 3) that carry the sector to each of its images.
        body : body density of the Lagrangian, so minus the pressure.
        """
        return ContactPatches.none()

    def on_substrate(self, which: Index) -> Mask:
        """(k,) whether solids by their numbers belong to the substrate, and are no particles."""
        return np.ones(np.shape(which), bool)

    def without_line(self, which: Index, particles: int) -> list[int]:
        """Particles, of so many, that are none of the solids (k,) that carry the membrane."""
        return []

    def reaches(self, base: float, table: Table, points: Array, which: Index) -> bool:
        """Whether the membrane has come down to a plane at a height under asperities."""
        return False

    def behind(self, table: Table, surface: Surface) -> Array:
        """(k, 3) centres of spheres near the membrane that are inside the liquid, and should not
        be."""
        return np.zeros((0, 3))

    def unsupported(self, table: Table, points: Array) -> Array:
        """(k, 3) centres of spheres that the membrane has met, but does not notice."""
        return np.zeros((0, 3))

    def objection(self, points: Array) -> str | None:
        """Why the mesh does not do for this model at a state, or None."""
        return None


class Conforming(ContactModel):
    """A membrane that ends on its solids, or touches none."""


def another_way() -> GeometryError:
    """That a scene cannot follow another one."""
    return GeometryError("this scene meets its solid in another way than the one before")
