"""One asperity under a membrane with mirror planes around it: a cell of a rough surface.

Liquid above, gas below; the pressure pushes the membrane down beside the sphere whose top is the
origin. On the mirror planes the membrane is horizontal.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import words
from ..dofs.boundary_conditions import Mirror, Model, Sector
from ..errors import SceneError
from ..initial.closed_droplet import smallest_model
from ..initial.liquid import MODELS, Discretization, Liquid, Mesh, space_name, with_defaults
from ..initial.profiles import gathered
from ..solids import Sphere
from ..splines.space import EDGES
from ..surface.closed import Stretch
from ..surface.ring import axisymmetric, drop_space
from ..surface.shapes import sheet
from ..surface.surface import Surface
from ..terms import Contact, Pressure, Scale, SurfaceTension, TrimmedContactLine
from .recipe import Along, Recipe, family
from .scene import Ramp, Scene
from .well_posed import refuse_perfectly_wet
from .whole_foot import adhesion

NEARLY = 0.99
"""Part of the largest pressure from which on the way to it begins."""
SHARP = 175.0
"""Contact angle in degrees above which the default mesh does not resolve a contact line."""
PER_RADIUS = 16
"""Elements along the sphere's radius, by default."""
NARROW = 0.2
"""Gap between sphere and walls over the radius below which the default mesh is finer. Near the
largest pressure a round cell's gap of 0.1 needs twice the elements, one of 0.25 none more."""


@family
@checked(
    size="cell.size",
    pressure="cell.pressure",
    shape="cell.shape",
    penalty="solver.penalty",
    penetration_tolerance="solver.penetration_tolerance",
    contact_line=words("auto", "trimmed", "adhesion"),
)
def asperity_cell(
    sphere: Sphere,
    *,
    size: float,
    pressure: float,
    shape: str = "square",
    liquid: Liquid | None = None,
    discretization: Discretization | None = None,
    penalty: float | None = None,
    penetration_tolerance: float = 1e-2,
    contact_line: str = "auto",
) -> Scene:
    """Cell of a rough surface under pressure.

    Parameters
    ----------
    sphere : with its contact angle.
    size : side of the square or diameter of the circle, its middle on the z axis.
    pressure : liquid minus gas, > 0.
    penalty : None for exact contact, else traction over depth in units of tension over squared
        radius.
    penetration_tolerance : depth over the radius beyond which a state is no success.
    contact_line : "trimmed", the membrane passes through the sphere; "adhesion", it lies on a
        sphere that attracts it, for angles near 180 degrees; "auto" chooses.
    shape : "square" or "circle".
    liquid : its surface tension counts; 1 by default.
    discretization : space, degree, elements, model; all chosen by the scene if omitted.

    Raises
    ------
    SceneError
        A value out of its range; a sphere that does not fit into the cell.
    """
    refuse_perfectly_wet("substrate", sphere)
    liquid, asked = with_defaults(liquid, discretization)
    r, (x, y, z) = sphere.radius, sphere.center
    Scale(r, liquid.surface_tension).check_lengths("cell.size", size)
    mesh, model = _mesh(sphere, size, shape, asked)
    if penalty is not None and sphere.contact_angle < 180.0:
        raise SceneError(
            'solver.contact = "penalty": only at 180 degrees; leave it out below, contact lines '
            "need none"
        )
    area = size**2 if shape == "square" else 0.25 * np.pi * size**2
    unit = (x / r, y / r, z / r)
    angle = sphere.contact_angle
    lying = _lies(contact_line, angle)
    drape = _drape(pressure * r / liquid.surface_tension, area / r**2, angle, lying)
    local, directions = _start(shape, size / r, unit, drape, mesh)
    surface = local.moved(r * (local.points + [0.0, 0.0, unit[2] + 1.0]))
    # the wet spot cannot pass the sphere's equator: pi r^2 (p + 2 gamma / r) = p area
    carried = 2.0 * np.pi * r * liquid.surface_tension / (area - np.pi * r**2)
    law = None if penalty is None else penalty * liquid.surface_tension / r**2

    recipe = Recipe(
        "asperity_cell",
        {
            "sphere": sphere,
            "size": size,
            "pressure": pressure,
            "shape": shape,
            "liquid": liquid,
            "discretization": Discretization(mesh.space, mesh.degree, mesh.elements, model),
            "penalty": penalty,
            "penetration_tolerance": penetration_tolerance,
            "contact_line": contact_line,
        },
    )
    beyond = lying and pressure >= carried
    begin = NEARLY * carried if beyond else 0.5 * pressure
    traction = pressure + 2.0 * liquid.surface_tension / r
    lain_on = Contact(
        sphere, law, penetration_tolerance, adhesion(liquid, angle), traction=traction
    )
    passed = TrimmedContactLine(liquid.surface_tension, sphere)
    return Scene(
        surface,
        [
            SurfaceTension(liquid.surface_tension),
            Pressure(pressure),
            lain_on if lying else passed,
        ],
        [Sector(model), *(Mirror(edge) for edge in (EDGES if shape == "square" else ()))],
        scale=Scale(r, liquid.surface_tension),
        directions=directions,
        ramp=Ramp(
            "cell.pressure",
            (begin, pressure),
            Along(recipe, "cell.pressure"),
            only=beyond,
            bound=carried if lying else None,
        ),
        substrate=sphere,
        kind="asperity_cell",
        recipe=recipe,
        description=_describe(sphere, size, pressure, shape, liquid, mesh, model),
    )


def _mesh(sphere: Sphere, size: float, shape: str, asked: Discretization) -> tuple[Mesh, Model]:
    """Mesh and model of a cell into which its sphere fits.

    Raises
    ------
    SceneError
    """
    r, (x, y, _) = sphere.radius, sphere.center
    reach = max(abs(x), abs(y)) if shape == "square" else float(np.hypot(x, y))
    if reach + r >= 0.5 * size:
        raise SceneError(
            f"cell.size = {size:g}: the sphere must fit into it, so it must be > "
            f"{2.0 * (reach + r):g}"
        )
    along = size / r * (1.0 if shape == "square" else 0.5)
    fine = max(1.0, NARROW * r / (0.5 * size - reach - r))
    mesh = asked.mesh(degree=2, elements=int(np.ceil(PER_RADIUS * fine * along)))
    if mesh.space != "bspline":
        raise SceneError(
            f'discretization.space = "{space_name(mesh.space)}": not available yet in a cell; '
            '"bspline" is'
        )
    smallest = smallest_model(sphere, size, (0.0, 0.0))
    model = mesh.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": the sphere stands at x, y = {x:g}, {y:g}; '
            f'"{smallest}" is the smallest model here'
        )
    return mesh, model


def _lies(contact_line: str, angle: float) -> bool:
    """Whether the membrane lies on its sphere."""
    sharp = contact_line == "auto" and angle > SHARP
    return sharp or angle == 180.0 or contact_line == "adhesion"


@dataclass(frozen=True, eq=False)
class _Drape:
    """Round cell of the same area, solved exactly: a wet spot and the surface round it.

    Attributes
    ----------
    share : (k,) parameter from the top; r, z : radius and height there.
    """

    share: Array
    r: Array
    z: Array


def _drape(pressure: float, area: float, contact_angle: float, lying: bool) -> _Drape:
    """Drape over the unit sphere with its top at 0 (tension 1).

    Outside the spot the vertical force through a circle is that of the pressure beyond it,
    ``sin(angle) = p (R^2 - r^2) / (2 r)``; at the line ``angle = phi + theta - pi``. The membrane
    lies on the spot or passes through the sphere under it.
    """
    outer = np.sqrt(area / np.pi)
    hang = np.pi - np.radians(contact_angle)
    phi = np.linspace(hang, min(hang, 0.5 * np.pi) + STEEPEST, 4001)[1:]
    carried = 2.0 * np.sin(phi) * np.sin(phi - hang) / (outer**2 - np.sin(phi) ** 2)
    enough = carried >= pressure
    polar = float(phi[enough.argmax() if enough.any() else carried.argmax()])
    spot, slope = float(np.sin(polar)), polar - hang
    r = spot + (outer - spot) * np.linspace(0.0, 1.0, 4000) ** 2
    angle = np.arcsin(np.minimum(0.5 * pressure * (outer**2 - r**2) / r, np.sin(STEEPEST)))
    fall = np.tan(0.5 * (angle[1:] + angle[:-1]))
    z = np.cos(polar) - 1.0 - np.concatenate([[0.0], np.cumsum(fall * np.diff(r))])
    inside = np.linspace(0.0, 1.0, 400)
    if not lying:
        # through the sphere the membrane goes on as it pleases; its parameter must be smooth
        dome = z[0] + 0.5 * spot * np.tan(slope) * (1.0 - inside**2)
        r, z = np.concatenate([spot * inside, r[1:]]), np.concatenate([dome, z[1:]])
        even = np.linspace(0.0, outer, 8001)
        closer = gathered(even, spot, 1.0 - float(np.cos(slope)) ** 1.5)
        return _Drape(even / outer, closer, np.interp(closer, r, z))
    cap = polar * inside
    r, z = np.concatenate([np.sin(cap), r[1:]]), np.concatenate([np.cos(cap) - 1.0, z[1:]])
    walked = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(r), np.diff(z)))])
    wide = 1.3 * walked[len(cap) - 1] / walked[-1]
    stretch = Stretch(FINE, wide / FINE) if wide < FINE else Stretch()
    even = np.linspace(0.0, 1.0, 8001)
    share = stretch(even) * walked[-1]
    return _Drape(even, np.interp(share, walked, r), np.interp(share, walked, z))


FINE = 0.6
"""Part of the elements over the wet spot and its surroundings."""
STEEPEST = float(np.radians(87.0))


def _start(
    shape: str, size: float, center: tuple[float, float, float], drape: _Drape, mesh: Mesh
) -> tuple[Surface, Array]:
    """Draped start over the unit sphere, and the vertical directions of its control points: they
    hold the walls and make the vertical balance of forces exact."""
    half = 0.5 * size
    if shape == "circle":
        first = float((drape.r[1] - drape.r[0]) / (drape.share[1] - drape.share[0]))

        def profile(t: Array) -> tuple[Array, Array, Array]:
            r = np.interp(1.0 - t, drape.share, drape.r)
            return r, np.interp(1.0 - t, drape.share, drape.z), np.full_like(t, -first)

        disc = axisymmetric(drop_space("bspline", mesh.degree, mesh.elements), profile)
        surface = disc.moved(disc.points * [1.0, -1.0, 1.0])
    else:
        flat = sheet(size, elements=mesh.elements, degree=mesh.degree)
        x, y = flat.points[:, 1] - center[0], flat.points[:, 0] - center[1]
        reach = np.hypot(x, y)
        share = np.clip(reach / drape.r[-1], 0.0, 1.0)
        out = np.interp(share, drape.share, drape.r) / np.maximum(reach, 1e-300)
        moved = np.where(share < 1.0, out - 1.0, 0.0)
        # points on the walls stay on them
        wall_x = 1.0 - (flat.points[:, 1] / half) ** 4
        wall_y = 1.0 - (flat.points[:, 0] / half) ** 4
        x, y = x * (1.0 + moved * wall_x), y * (1.0 + moved * wall_y)
        z = np.interp(np.hypot(x, y), drape.r, drape.z)
        surface = flat.moved(np.stack([x + center[0], y + center[1], z], axis=1))
        surface = _upright(surface)
    up = np.tile([0.0, 0.0, 1.0], (surface.space.count, 1))
    return surface, up


def _upright(surface: Surface) -> Surface:
    """The same start on a square, meeting its walls at right angles: control points next to a wall
    lie straight before those in it."""
    net = surface.net
    for along, end in EDGES.values():
        rows = np.moveaxis(net, 1 - along, 0)
        wall, near = (-1, -2) if end else (0, 1)
        for axis in (1 - along, 2):
            rows[near, :, axis] = rows[wall, :, axis]
    return surface.moved(net.reshape(-1, 3))


def _describe(
    sphere: Sphere,
    size: float,
    pressure: float,
    shape: str,
    liquid: Liquid,
    mesh: Mesh,
    model: str,
) -> dict[str, Any]:
    x, y, z = sphere.center
    substrate: dict[str, Any] = {"contact_angle": sphere.contact_angle}
    if (x, y) == (0.0, 0.0) and z == -sphere.radius:
        substrate |= {"kind": "sphere", "radius": sphere.radius}
    else:
        substrate |= {"kind": "spheres", "centers": [[x, y, z]], "radii": [sphere.radius]}
    return {
        "scene": "asperity_cell",
        "liquid": {"surface_tension": liquid.surface_tension, "density": liquid.density},
        "substrate": substrate,
        "cell": {"shape": shape, "size": size, "pressure": pressure},
        "discretization": mesh.described(model),
    }
