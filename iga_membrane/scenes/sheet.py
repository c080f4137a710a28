"""A liquid sheet on a spherical particle (paper section 6.2, figures 8-11).

The rim is fixed at z = 0, the liquid lies above the membrane and gas below.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import choice, line_angle, number
from ..errors import SceneError
from ..solids import Sphere
from ..surface.ring import axisymmetric, ring_space
from ..surface.supports import Fixed, Sector, Sliding
from ..surface.surface import Surface
from ..terms import Gravity, Pressure, Scale, SphereContactLine, SurfaceTension, Term, Volume
from .liquid import Discretization, Liquid
from .scene import Ramp, Scene

BOUNDARIES = ("square", "circle")


def liquid_sheet(
    particle: Sphere,
    *,
    size: float,
    boundary: str = "circle",
    liquid: Liquid | None = None,
    gravity: float = 0.0,
    pressure: float | None = None,
    volume: float | None = None,
    liquid_weight: bool = False,
    discretization: Discretization | None = None,
) -> Scene:
    """Sheet pinned on a rim in z = 0, touching a sphere from above.

    Parameters
    ----------
    particle : fixed sphere on the z axis, with contact angle and density.
    size : diameter of the circular rim.
    boundary : "circle"; "square" is not available yet.
    gravity : acceleration along -z; it weighs the particle, and the sheet if ``liquid_weight``.
    pressure : liquid minus gas at z = 0, 0 if neither it nor a volume is given.
    volume : signed liquid volume below z = 0 less the wetted cap.
    liquid_weight : whether the pressure along the sheet is ``p0 - rho g z``.

    Raises
    ------
    SceneError
        A value out of its range, both pressure and volume, a particle off the axis or not smaller
        than the rim.
    """
    liquid = liquid or Liquid()
    mesh = discretization or Discretization()
    if choice("sheet.boundary", boundary, BOUNDARIES) == "square":
        raise SceneError('sheet.boundary = "square": not available yet in this version')
    size = number("sheet.size", size, above=0.0)
    gravity = number("gravity.acceleration", gravity, least=0.0)
    if pressure is not None and volume is not None:
        raise SceneError("sheet.pressure, sheet.volume: both are prescribed; give one of them")
    rim, r = 0.5 * size / particle.radius, particle.radius
    x, y, z = particle.center
    if x or y:
        raise SceneError(f"particle.center = {[x, y, z]}: must lie on the z axis (x = y = 0)")
    if rim <= 1.0:
        raise SceneError(
            f"particle.radius = {r:g}: must be smaller than the rim's radius {0.5 * size:g}"
        )
    line_angle("particle.contact_angle", particle.contact_angle)
    sector = Sector(mesh.model or "eighth")
    terms: list[Term] = [
        SurfaceTension(liquid.surface_tension),
        SphereContactLine(liquid.surface_tension, particle),
    ]
    if volume is not None:
        # a sheet's volume is signed, so the constraint's positive scale is the rim's own
        whole = np.pi * (0.5 * size) ** 3
        terms.append(Volume(whole, ends=whole - number("sheet.volume", volume)))
    else:
        pressure = number("sheet.pressure", 0.0 if pressure is None else pressure)
        if pressure:
            terms.append(Pressure(pressure))
    if liquid_weight and gravity * liquid.density:
        terms.append(Gravity(liquid.density, (0.0, 0.0, -gravity)))

    def at(angle: float) -> Scene:
        return liquid_sheet(
            Sphere(angle, r, particle.center, particle.density),
            size=size,
            boundary=boundary,
            liquid=liquid,
            gravity=gravity,
            pressure=pressure,
            volume=volume,
            liquid_weight=liquid_weight,
            discretization=Discretization(mesh.space, mesh.degree, mesh.elements, sector.model),
        )

    easy = 90.0
    return Scene(
        _start(particle, rim, mesh),
        terms,
        (Sliding("xi2=0", particle), Fixed("xi2=1"), sector),
        scale=Scale(r, liquid.surface_tension),
        ramp=Ramp("particle[0].contact_angle", easy, particle.contact_angle, at)
        if particle.contact_angle != easy
        else None,
        substrate=particle,
        kind="liquid_sheet",
        particle_pull=gravity,
        liquid_density=liquid.density,
        description=_describe(
            particle, size, boundary, liquid, gravity, pressure, volume, liquid_weight, mesh, sector
        ),
    )


def _start(particle: Sphere, rim: float, mesh: Discretization) -> Surface:
    """Cone from the contact line that meets the sphere at Young's angle to the rim."""
    top = particle.center[2] / particle.radius + 1.0
    theta = np.radians(particle.contact_angle)
    polar = np.linspace(1e-3, np.pi - 1e-3, 4001)
    depth = top - 1.0 + np.cos(polar)
    slope = np.arctan2(-depth, rim - np.sin(polar))
    excess = np.pi - theta - polar - slope
    falls = np.flatnonzero((excess[:-1] > 0) & (excess[1:] <= 0))
    # the last crossing is the stable one; without any, the nearest to one
    k = int(falls[-1]) if len(falls) else int(excess.argmax())
    a, z = np.sin(polar[k]), depth[k]

    def profile(t: Array) -> tuple[Array, Array, Array]:
        return a + (rim - a) * t, z * (1.0 - t), np.full_like(t, rim - a)

    space = ring_space(mesh.space, mesh.degree, mesh.elements, angle=1.0)
    local = axisymmetric(space, profile)
    return local.moved(local.points * particle.radius)


def _describe(
    particle: Sphere,
    size: float,
    boundary: str,
    liquid: Liquid,
    gravity: float,
    pressure: float | None,
    volume: float | None,
    liquid_weight: bool,
    mesh: Discretization,
    sector: Sector,
) -> dict[str, Any]:
    held = {"pressure": pressure, "volume": volume}
    return {
        "scene": "liquid_sheet",
        "liquid": {"surface_tension": liquid.surface_tension, "density": liquid.density},
        "gravity": {"acceleration": gravity, "direction": [0.0, 0.0, -1.0]},
        "particle": [
            {
                "radius": particle.radius,
                "center": list(particle.center),
                "density": particle.density,
                "contact_angle": particle.contact_angle,
                "motion": "fixed",
            }
        ],
        "sheet": {"boundary": boundary, "size": size, "liquid_weight": liquid_weight}
        | {key: value for key, value in held.items() if value is not None},
        "discretization": {
            "space": mesh.space,
            "degree": mesh.degree,
            "elements": mesh.elements,
            "model": sector.model,
        },
    }
