"""A ball that passes through a solid of any shape: its outer part is where a droplet starts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..dofs.boundary_conditions import Model, Sector
from ..errors import SceneError
from ..initial.closed_droplet import ball, smallest_model
from ..initial.liquid import MODELS
from ..solids import Solid
from ..solids.fan import on_surface
from ..solids.wettability import cosine_of, varies
from ..splines import pillow_space
from ..surface.closed import Stretch, closed_surface
from ..surface.surface import Surface
from ..terms import TrimmedContactLine
from .spec import BALL, Foot, Question

ELEMENTS = 32, 128
"""From the middle of such a ball's foot to its widest place, at least and at most."""
PER_SCALE = 3.0
"""Elements along the length over which the solid or its wettability changes."""
ACROSS = 16.0
"""Elements from the middle of the foot to the line, whatever the angle, at least."""
FEET = 0.1, 4.0
"""Radii of the feet that are tried, from 178 to 10 degrees, over that of a ball of the volume."""
STEEP = 0.3
"""Least vertical part of the normal in such a foot: a ball that reaches farther comes out of the
side of a fibre."""
RINGS, ROUND = 24, 32
"""Places in a foot, along its radius and round it."""


@dataclass(frozen=True)
class _Cap:
    """A weightless drop on a level plane.

    Attributes
    ----------
    radius : of its ball; cosine : of its contact angle; level : height of the plane.
    """

    radius: float
    cosine: float
    level: float

    @property
    def foot(self) -> float:
        """Radius of its contact line."""
        return self.radius * float(np.sqrt(max(0.0, 1.0 - self.cosine**2)))


def through_any(parts: Question) -> Foot:
    """A ball through a solid, with the volume and the mean contact angle of the drop.

    Raises
    ------
    SceneError
        What such a start does not have.
    """
    solid, scale = parts.substrate, parts.scale
    if parts.law.penalty is not None or parts.start is not None or parts.asked.space != "bspline":
        raise SceneError(
            "solver.contact_line: contact lines on this solid need the scene's own start, no "
            'penalty and space "bspline"'
        )
    local = scale.local_solid(solid)
    cap = _cap_on(local, float(-parts.bond[2]))
    mesh = parts.asked.mesh(degree=2, elements=_elements(local, cap))
    space = pillow_space(mesh.degree, mesh.elements)
    points, directions = closed_surface(space, ball(cap.radius), Stretch())
    points[:, 2] += cap.level - cap.radius * (1.0 + cap.cosine)
    line = TrimmedContactLine(parts.liquid.surface_tension, solid)
    surface = Surface(space, scale.to_world(points))
    sector = Sector(_model_of(parts, local))
    return Foot(surface, sector, mesh, [line], grading=None, directions=directions)


def _cap_on(solid: Solid, bond: float) -> _Cap:
    """The spherical cap of the volume ``BALL`` whose energy on a solid is least.

    Parameters
    ----------
    bond : of gravity towards the solid.

    Notes
    -----
    A cap of the height h on a foot of the radius a has the volume ``pi h (3 a^2 + h^2) / 6`` and
    the area ``pi (a^2 + h^2)``; it stands on the mean level of the surface in its foot, and gains
    ``cos(theta)`` per area of that surface.
    """
    unit = np.sqrt((np.arange(RINGS) + 0.5) / RINGS)  # rings of equal area
    turn = 2.0 * np.pi * (np.arange(ROUND) + 0.5) / ROUND
    feet = np.geomspace(*FEET, 60)
    energies, caps = [], []
    for foot in feet:
        r, phi = (v.ravel() for v in np.meshgrid(foot * unit, turn, indexing="ij"))
        chart = np.stack([r * np.cos(phi), r * np.sin(phi), np.zeros(r.shape)], axis=-1)
        x, normal, found = on_surface(solid, chart)
        if not (found & (normal[:, 2] > STEEP)).all():
            break  # beyond the solid's side
        cosines = cosine_of(solid.contact_angle, x, solid.nearest(x).which)[0]
        gain = np.pi * foot**2 * float((cosines / normal[:, 2]).sum()) / len(r)
        level, height = float(x[:, 2].mean()), _height(float(foot))
        radius = 0.5 * (foot**2 + height**2) / height
        middle = (
            level + height - radius + 0.75 * (2.0 * radius - height) ** 2 / (3.0 * radius - height)
        )
        energies.append(np.pi * (foot**2 + height**2) - gain + bond * BALL * middle)
        caps.append(_Cap(float(radius), float(1.0 - height / radius), level))
    if not caps:
        raise SceneError("substrate: there is none under the droplet, about the z axis")
    return caps[int(np.argmin(energies))]


def _height(foot: float) -> float:
    """Height of the cap of the volume ``BALL`` on a foot of a radius."""
    roots = np.roots([np.pi / 6.0, 0.0, 0.5 * np.pi * foot**2, -BALL])
    return float(roots[np.abs(roots.imag) < 1e-9 * np.abs(roots)].real.max())


def _elements(solid: Solid, cap: _Cap) -> int:
    """Elements from the middle of the ball's foot to its widest place."""
    angle = solid.contact_angle
    width = min(solid.scale, angle.width) if varies(angle) else solid.scale
    quarter = 0.5 * np.pi * cap.radius
    wanted = max(PER_SCALE * quarter / width, ACROSS * quarter / max(cap.foot, 1e-3 * quarter))
    return int(np.clip(np.ceil(wanted), *ELEMENTS))


def _model_of(parts: Question, local: Solid) -> Model:
    """The model asked for, or the smallest that gravity and the solid allow."""
    x, y, _ = (float(b) for b in parts.bond)
    smallest = smallest_model(local, 1.5, (x, y))
    model = parts.asked.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": gravity or the substrate have no such mirror '
            f'planes; "{smallest}" is the smallest model here'
        )
    return model
