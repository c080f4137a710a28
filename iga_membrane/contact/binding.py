"""How a scene's membrane meets its solid: lying on it, or in contact lines inside the membrane."""

from __future__ import annotations

import numpy as np

from ..arrays import Index
from ..dofs.symmetry import mirrors, sector_elements, sector_table
from ..problems.scene import Scene
from ..solids import SphereLattice, Spheres
from ..splines import Table
from ..surface.surface import Surface
from ..terms import AreaTerm, Contact, TrimmedContactLine
from ..terms import variations as vary
from .obstacle import ContactSet
from .subgrid import PointSupports
from .unfitted import Trim


def law_of(scene: Scene) -> Contact | None:
    """The scene's law of contact, in the user's units."""
    return next((t for t in scene.terms if isinstance(t, Contact)), None)


def line_of(scene: Scene) -> TrimmedContactLine | None:
    """The scene's contact line inside the membrane, in its own scale."""
    return next((t for t in scene.local_terms() if isinstance(t, TrimmedContactLine)), None)


def contact_of(scene: Scene, surface: Surface, points: tuple[int, int]) -> ContactSet | None:
    """The scene's contact, or None.

    Parameters
    ----------
    surface : start, of which contact tractions count per area.
    points : Gauss points per direction where a penalty acts.
    """
    term = next((t for t in scene.local_terms() if isinstance(t, Contact)), None)
    if term is None:
        return None
    elements, _ = sector_elements(surface.space, scene.sector)
    if term.ring is not None and isinstance(term.solid, (SphereLattice, Spheres)):
        tension = sum(t.tension() for t in scene.local_terms() if isinstance(t, AreaTerm))
        return PointSupports(scene, term.solid, term.ring, surface, tension, elements)
    points = (1, 1) if term.penalty is None else points
    table = sector_table(surface.space, scene.sector, points)
    area = vary.element_points(table, surface.points).area * table.weights
    contact = ContactSet(term, table, area, surface.space, elements)
    contact.expect(surface.points, term.traction)
    return contact


def trim_of(
    scene: Scene, surface: Surface, table: Table, unknowns: Index, size: int
) -> Trim | None:
    """What the scene's solid cuts out of the membrane, or None.

    Parameters
    ----------
    surface : start, whose elements at the solid say how fine the mesh is there.
    table : functions of the sector's elements.
    unknowns : (rows,) unknown of each control point, -1 for none; size : their number.
    """
    term = line_of(scene)
    if term is None:
        return None
    elements, portion = sector_elements(surface.space, scene.sector)
    at = vary.element_points(table, surface.points)
    beside = term.solid.nearest(at.x)
    close = ((beside.gap < 2.0 * term.solid.scale) & (term.particle(beside.which) < 0)).any(axis=1)
    lengths = np.sqrt((at.area * table.weights).sum(axis=1) / portion)
    element = float(np.median(lengths[close])) / term.solid.scale if close.any() else 1.0
    images = mirrors(scene.sector)
    return Trim(term, surface.space, table, elements, portion, images, element, unknowns, size)


def same_law(one: Contact | None, other: Contact | None) -> bool:
    """Whether two laws of contact are the same, for the same solid."""
    if one is None or other is None or type(one.solid) is not type(other.solid):
        return False
    laws = [(c.penalty, c.depth, c.adhesion, c.ring, c.compliance) for c in (one, other)]
    fields = [vars(c.solid) for c in (one, other)]
    return laws[0] == laws[1] and all(
        np.array_equal(fields[0][key], fields[1][key])
        for key in fields[0]
        if not key.startswith("_")
    )
