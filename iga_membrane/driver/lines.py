"""The contact lines of a solution, solid by solid, in world coordinates."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arguments import checked
from ..arrays import Index
from ..assembly.lagrangian import Assembly
from ..contact.unfitted import is_unfitted
from ..dofs.symmetry import mirrors
from ..problems.scene import Scene
from ..results.contact_line import ContactLine, contact_line, trimmed_line
from ..results.line_chains import closed_lines, seen_once
from ..results.measures import own_asperity
from ..surface.surface import Surface
from .solution import Solution


@dataclass(frozen=True, eq=False)
class LineOnSolid:
    """A contact line on one solid.

    Attributes
    ----------
    solid : its number, as in ``Solution.contact["asperities"]``; -1 for a plane. A droplet's
        particles come after the asperities of its list; on a lattice, that of the asperities which
        the droplet may meet.
    line : geometry along it, in world coordinates and the user's units, once round the solid.
    """

    solid: int
    line: ContactLine


@checked()
def contact_lines(solution: Solution) -> tuple[LineOnSolid, ...]:
    """Contact lines of a solution.

    Parameters
    ----------
    solution : converged or not.

    Returns
    -------
    One for each solid that has a line, in the order of their numbers; none where the membrane lies
    on its solid (180 degrees) or on none.

    Notes
    -----
    Points are those of the quadrature, exact to rounding on lines along edges and to 1e-7 of a
    sphere's radius where the membrane passes through it. Tangents and conormals are those of the
    spline (paper eqs 33-34).
    """
    scene = solution.scene
    surface = solution.surface.moved(scene.units.to_local(solution.surface.points))
    found = []
    if scene.by_form.passed:
        found += _inside(scene, surface)
    for term in scene.local_terms().wetting:
        line = contact_line(surface, term.edge, solid=term.face)
        number = -1
        if term.ball is not None:
            alone = own_asperity(scene)
            number = sum(each.solid >= 0 for each in found) if alone is None else alone
        found.append(LineOnSolid(number, line))
    return tuple(LineOnSolid(each.solid, _world(scene, each.line)) for each in found)


def _inside(scene: Scene, surface: Surface) -> list[LineOnSolid]:
    """Lines inside the membrane, split by their solids and put in order round them."""
    unfitted = Assembly(scene).contact
    if not is_unfitted(unfitted):
        return []
    whole = trimmed_line(unfitted, surface, mirrors(scene.sector))
    line, images = unfitted.on_line(surface.points), mirrors(scene.sector)
    along = line.x.shape[1]
    places = surface.points[line.table.functions].mean(axis=1)
    kept, times = seen_once(np.concatenate([places @ m for m in images]), len(images))
    numbers = (kept[:, None] * along + np.arange(along)).ravel()
    whole = _part(whole, numbers)
    whole = replace(whole, arc=whole.arc * np.repeat(times, along))
    owner = unfitted.solid.nearest(whole.position).which
    found = [
        LineOnSolid(int(owner[some[0]]), _counterclockwise(_part(whole, some)))
        for some in closed_lines(whole.position.reshape(-1, along, 3))
    ]
    return sorted(found, key=lambda each: each.solid)


def _counterclockwise(line: ContactLine) -> ContactLine:
    """The line in the order of its tangents."""
    steps = np.roll(line.position, -1, axis=0) - line.position
    forward = np.einsum("ki,ki->", steps, line.tangent) >= 0.0
    return line if forward else _part(line, np.arange(len(line.arc))[::-1])


def _part(line: ContactLine, some: Index) -> ContactLine:
    return ContactLine(*(values[some] for values in vars(line).values()))


def _world(scene: Scene, line: ContactLine) -> ContactLine:
    scale = scene.units
    return replace(
        line,
        position=scale.to_world(line.position),
        tangent=line.tangent @ scale.axes.T,
        conormal=line.conormal @ scale.axes.T,
        arc=line.arc * scale.length,
    )
