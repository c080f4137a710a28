"""One asperity under a membrane with mirror planes around it: a cell of a rough surface.

Liquid above, gas below; the pressure pushes the membrane down beside the sphere whose top is the
origin. On the mirror planes the membrane is horizontal.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import choice, number
from ..errors import SceneError
from ..solids import Sphere
from ..surface.closed import Stretch
from ..surface.ring import axisymmetric, drop_space
from ..surface.shapes import sheet
from ..surface.supports import Sector
from ..surface.surface import Surface
from ..terms import Contact, Pressure, Scale, SurfaceTension
from .asperities import smallest_model
from .liquid import MODELS, Discretization, Liquid, Mesh
from .scene import Ramp, Scene

SHAPES = ("square", "circle")
SUNK = 0.05
"""Depth of the start in the sphere over its radius: contact holds it from the first step."""
FINE = 0.8
"""Part of the elements from the middle to a side that lies over the sphere."""
PER_RADIUS = 12
"""Elements along the sphere's radius, by default."""


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
) -> Scene:
    """Cell of a rough surface under pressure.

    Parameters
    ----------
    sphere : with its contact angle, only 180 degrees yet.
    size : side of the square or diameter of the circle, its middle on the z axis.
    pressure : liquid minus gas, > 0.
    penalty : None for exact contact, else traction over depth in units of tension over squared
        radius.
    penetration_tolerance : depth over the radius beyond which a state is no success.

    Raises
    ------
    SceneError
        A value out of its range; a sphere that does not fit into the cell.
    """
    liquid = liquid or Liquid()
    choice("cell.shape", shape, SHAPES)
    size = number("cell.size", size, above=0.0)
    pressure = number("cell.pressure", pressure, above=0.0)
    r, (x, y, z) = sphere.radius, sphere.center
    if sphere.contact_angle < 180.0:
        raise SceneError(
            f"substrate.contact_angle = {sphere.contact_angle:g}: not available yet in a cell; "
            "180 is"
        )
    reach = max(abs(x), abs(y)) if shape == "square" else float(np.hypot(x, y))
    if reach + r >= 0.5 * size:
        raise SceneError(
            f"cell.size = {size:g}: the sphere must fit into it, so it must be > "
            f"{2.0 * (reach + r):g}"
        )
    along = size / r * (1.0 if shape == "square" else 0.5)
    asked = discretization or Discretization()
    mesh = asked.mesh(degree=2, elements=int(np.ceil(PER_RADIUS * along)))
    smallest = smallest_model(sphere, size, (0.0, 0.0))
    model = mesh.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": the sphere stands at x, y = {x:g}, {y:g}; '
            f'"{smallest}" is the smallest model here'
        )
    surface = _flat(shape, size, reach + 1.1 * r, z + (1.0 - SUNK) * r, mesh)
    law = None if penalty is None else penalty * liquid.surface_tension / r**2

    def at(value: float) -> Scene:
        return asperity_cell(
            sphere,
            size=size,
            pressure=value,
            shape=shape,
            liquid=liquid,
            discretization=Discretization(mesh.space, mesh.degree, mesh.elements, model),
            penalty=penalty,
            penetration_tolerance=penetration_tolerance,
        )

    return Scene(
        surface,
        [
            SurfaceTension(liquid.surface_tension),
            Pressure(pressure),
            Contact(sphere, law, penetration_tolerance),
        ],
        [Sector(model)],
        scale=Scale(r, liquid.surface_tension),
        directions=np.tile([0.0, 0.0, 1.0], (surface.space.count, 1)),
        ramp=Ramp("cell.pressure", (0.1 * pressure, pressure), at),
        substrate=sphere,
        kind="asperity_cell",
        description=_describe(sphere, size, pressure, shape, liquid, mesh, model),
    )


def _flat(shape: str, size: float, wide: float, height: float, mesh: Mesh) -> Surface:
    """Flat membrane, its normal down; even elements within ``wide`` of the middle."""
    half, slope = 0.5 * size, 2.0 * wide / size / FINE
    stretch = Stretch(FINE, slope) if slope < 1.0 else Stretch()
    if shape == "square":
        flat = sheet(2.0, elements=mesh.elements, degree=mesh.degree)
        points = half * stretch(flat.points[:, [1, 0, 2]])
        return flat.moved(points + [0.0, 0.0, height])

    def profile(t: Array) -> tuple[Array, Array, Array]:
        return half * stretch(1.0 - t), 0.0 * t, np.full_like(t, -half * stretch.slope)

    disc = axisymmetric(drop_space("bspline", mesh.degree, mesh.elements), profile)
    return disc.moved(disc.points * [1.0, -1.0, 1.0] + [0.0, 0.0, height])


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
