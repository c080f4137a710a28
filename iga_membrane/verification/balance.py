"""Vertical balance of a membrane: its pressure, its laws of the gap, and the pull along its edges.

In equilibrium ``int p n_z dA + gamma oint nu_z ds``, ``nu`` the outward conormal of the membrane,
and what solids push add up to nothing. Held edges are no unknowns: no solver makes that sum zero.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..arrays import Array, Mask
from ..assembly.lagrangian import TINY
from ..problems.scene import Scene
from ..results.contact_line import ContactLine, contact_line, vertical_forces
from ..surface.surface import Surface
from ..terms import BodyDensity

FLAT = 1e-6
"""Vertical forces over the tension along all edges below which rounding is part of them: a membrane
whose slopes are smaller is flat to every measure."""
NOTHING = 1e-2
"""Weight over the forces of line and pressure on a sphere below which these are the measure."""


class Loads:
    """Vertical forces on the elements of one sector, added up as they are visited.

    Parameters
    ----------
    copies : of the sector in the whole.

    Attributes
    ----------
    inside : volume of the whole, as the flux of ``z e_z``.
    """

    def __init__(self, copies: int) -> None:
        self._copies, self.inside = copies, 0.0
        self._parts: list[Array] = []

    def add(
        self, body: BodyDensity, position: Array, normal: Array, area: Array, laws: Array | None
    ) -> None:
        """Add elements at their quadrature points.

        Parameters
        ----------
        area : (elements, points) of each point.
        laws : (elements, points, 3) energy gradient of laws of the gap there.
        """
        level = normal[..., 2] * area
        even = body.constant * level.sum(axis=1)
        graded = ((position @ np.array(body.gradient)) * level).sum(axis=1)
        pull = np.zeros_like(even) if laws is None else laws[..., 2].sum(axis=1)
        self._parts.append(-self._copies * np.stack([even, graded, pull], axis=1))
        self.inside += self._copies * float((position[..., 2] * level).sum())

    @property
    def each(self) -> Array:
        """(elements, 3) upward forces, times the copies of each element: of the pressure at the
        origin, of what weight adds to it, and of laws of the gap."""
        return np.concatenate(self._parts)

    @property
    def push(self) -> float:
        """Upward force of pressure and laws on the whole membrane."""
        return float(self.each.sum())

    def missing(self, others: Iterable[float], least: float, some: Mask | None = None) -> float:
        """What is left of the balance with other forces, over the sum of all sizes.

        Parameters
        ----------
        least : size below which that sum does not count.
        some : elements of a part; all if omitted.
        """
        each = self.each if some is None else self.each[some]
        forces = [*each.sum(axis=0).tolist(), *others]
        return abs(sum(forces)) / max(sum(abs(force) for force in forces), least, TINY)


def pull_along(scene: Scene, line: ContactLine, tension: float) -> float:
    """Vertical pull ``gamma oint nu_z ds`` on the membrane along a line, by its own tangents."""
    taut = tension + sum(law.at(line.position).value for law in scene.local_terms().gaps)
    return float((taut * line.conormal[:, 2]) @ line.arc)


def line_balance(
    scene: Scene,
    surface: Surface,
    loads: Loads,
    tension: float,
    points: int,
    *,
    inside: Sequence[float] = (),
    solids: Sequence[float] = (),
) -> float | None:
    """Relative defect of the balance of a membrane that is pulled along lines; None without any.

    Parameters
    ----------
    points : Gauss points along each element of an edge.
    inside : vertical pulls along contact lines inside the membrane, by its own tangents.
    solids : vertical forces of solids on which it lies, and of line loads.
    """
    lines = [contact_line(surface, edge, points) for edge in _held(scene)]
    if not lines and not inside:
        return None
    pulls = [pull_along(scene, line, tension) for line in lines]
    least = FLAT * tension * sum(float(line.arc.sum()) for line in lines)
    if surface.space.is_band and len(lines) == 2 and not solids and not inside:
        return _halves(scene, surface, loads, tension, pulls, points)
    return loads.missing([*pulls, *inside, *solids], least)


def _held(scene: Scene) -> list[str]:
    """Edges along which something pulls: free ones are level by themselves."""
    edges = scene.surface.space.open_edges
    if scene.by_kind.mirrors:
        return list(edges)
    return [edge for edge in edges if edge in scene.by_kind.held]


def _halves(
    scene: Scene, surface: Surface, loads: Loads, tension: float, pulls: list[float], points: int
) -> float:
    """The larger defect of the two halves of a band between two edges: a symmetric one is in
    balance as a whole at any pressure.

    Parameters
    ----------
    pulls : at both edges, the first one first.
    """
    meridian = surface.space.bases[1]
    half = meridian.elements // 2
    middle = contact_line(surface, f"xi2={float(meridian.breaks[half])!r}", points)
    across = pull_along(scene, middle, tension)
    beyond = np.arange(len(loads.each)) % meridian.elements >= half
    least = FLAT * tension * float(middle.arc.sum())
    return max(
        loads.missing([pulls[0], -across], least, ~beyond),
        loads.missing([pulls[1], across], least, beyond),
    )


def body_balance(
    scene: Scene,
    body: BodyDensity,
    inside: float,
    pull: Array,
    carried: float,
    foot: ContactLine | None,
    standing: float,
) -> dict[str, float]:
    """Relative defects of the balance of forces of a liquid that its solids alone carry.

    Parameters
    ----------
    inside : its volume.
    pull : (3,) force on spheres and planes above it; carried : sum of the sizes of its parts.
    foot : the line on the plane z = 0, if there is one; standing : angle there, degrees.
    """
    found: dict[str, float] = {}
    terms, mirrored = scene.local_terms(), scene.sector.mirrored
    held = any(other.holds for other in terms.others)
    weight = float(body.gradient[2] * inside)
    if foot is None:
        # of the weight, unless it is nothing beside what balances at the line
        missing, size = weight + float(pull[2]), max(abs(weight), NOTHING * carried, TINY)
    else:
        forces = vertical_forces(foot, body, terms.tension, standing)
        # where a line is held its angle is its own
        drawn = forces.measured if held else forces.line
        missing = forces.push - drawn - weight - float(pull[2])
        size = abs(forces.push) + abs(drawn) + abs(weight + float(pull[2]))
    found["force"] = abs(missing) / size
    loose = [axis not in mirrored for axis in "xy"]
    if any(loose):
        aside = np.array(body.gradient[:2]) * inside + pull[:2]
        if foot is not None and held:
            aside -= terms.tension * (foot.arc @ foot.conormal[:, :2])
        found["sideways"] = float(np.hypot(*(aside * loose))) / size
    return found
