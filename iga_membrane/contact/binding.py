"""Which model of contact a problem has."""

from __future__ import annotations

import numpy as np

from ..dofs.dof_map import Rows
from ..dofs.symmetry import mirrors, sector_elements, sector_table
from ..problems.scene import Scene
from ..solids import SphereLattice, Spheres
from ..surface.surface import Surface
from ..terms import Contact, TrimmedContactLine
from ..terms.variations import element_points
from .covering import Covering
from .laws import law_of, line_of
from .model import Conforming, ContactModel
from .obstacle import Obstacle
from .subgrid import PointSupports
from .unfitted import Unfitted


def model_of(scene: Scene, surface: Surface, points: tuple[int, int], rows: Rows) -> ContactModel:
    """The model of contact of a scene.

    Parameters
    ----------
    surface : start, in the scene's scale: contact tractions count per its area, and its elements at
        the solid say how fine the mesh is there.
    points : Gauss points per direction where a penalty acts.
    rows : of the motion.
    """
    law, line = law_of(scene), line_of(scene)
    if law is not None:
        return _lying(scene, law, surface, points, rows)
    if line is not None:
        return _passing(scene, line, surface, rows)
    return Conforming()


def _lying(
    scene: Scene, law: Contact, surface: Surface, points: tuple[int, int], rows: Rows
) -> Obstacle:
    elements, _ = sector_elements(surface.space, scene.sector)
    if law.ring is not None and isinstance(law.solid, (SphereLattice, Spheres)):
        tension = scene.local_terms().tension
        return PointSupports(scene, law, law.solid, law.ring, surface, tension, elements, rows)
    points = (1, 1) if law.penalty is None else points
    table = sector_table(surface.space, scene.sector, points)
    area = element_points(table, surface.points).area * table.weights
    kind = Obstacle if scene.line_inside is None else Covering
    contact = kind(law, table, area, surface.space, elements, rows)
    contact.expect(surface.points, law.traction)
    return contact


def _passing(scene: Scene, line: TrimmedContactLine, surface: Surface, rows: Rows) -> Unfitted:
    elements, portion = sector_elements(surface.space, scene.sector)
    table = rows.table
    at = element_points(table, surface.points)
    beside = line.solid.nearest(at.x)
    close = ((beside.gap < 2.0 * line.solid.scale) & (line.particle(beside.which) < 0)).any(axis=1)
    lengths = np.sqrt((at.area * table.weights).sum(axis=1) / portion)
    element = float(np.median(lengths[close])) / line.solid.scale if close.any() else 1.0
    images = mirrors(scene.sector)
    own, size = rows.spines.unknowns, rows.size
    smooth = not np.isfinite(line.solid.radius_of(beside.which)).all()
    return Unfitted(
        line, surface.space, table, elements, portion, images, element, own, size, smooth
    )
