"""A film or a liquid bridge between two equal coaxial rings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..dofs.boundary_conditions import Fixed, Sector
from ..errors import SceneError
from ..initial.liquid import Discretization, Liquid, Mesh, with_defaults
from ..surface.ring import axisymmetric, ring_space
from ..terms import Pressure, Scale, SurfaceTension, Term, Volume
from .recipe import Recipe, family
from .scene import Ramp, Scene

SLENDER = 0.4
"""Half height over radius at which every film starts its ramp: well below any limit."""


@family
@checked("rings")
def film_between_rings(
    *,
    radius: float = 1.0,
    half_height: float,
    liquid: Liquid | None = None,
    volume: float | None = None,
    pressure: float | None = None,
    discretization: Discretization | None = None,
) -> Scene:
    """Membrane between rings at ``z = +-half_height``: a film, or the skin of a liquid bridge.

    Parameters
    ----------
    half_height : > 0.
    radius : of both rings.
    liquid : its surface tension counts; there is no weight.
    volume : of the liquid between the rings, or
    pressure : liquid minus gas; with neither the film is a catenoid.
    discretization : space, degree, elements, model; all chosen by the scene if omitted.

    Raises
    ------
    SceneError
        A value out of its range, or both volume and pressure.
    """
    liquid, asked = with_defaults(liquid, discretization)
    mesh = asked.mesh()
    if volume is not None and pressure is not None:
        raise SceneError("rings.volume, rings.pressure: both are prescribed; give one of them")
    Scale(radius, liquid.surface_tension).check_lengths("rings.half_height", half_height)
    # a catenoid collapses round its axis first; a bridge may give way sideways
    film = volume is None and pressure is None
    model = mesh.model or ("eighth" if film else "half")
    terms: list[Term] = [SurfaceTension(liquid.surface_tension)]
    bulge = 0.0
    if volume is not None:
        cylinder = 2.0 * np.pi * radius**2 * half_height
        terms.append(Volume(volume, ends=cylinder))
        bulge = _bulge(volume / cylinder)
    elif pressure is not None:
        terms.append(Pressure(pressure))

    def profile(t: Array) -> tuple[Array, Array, Array]:
        s = 2.0 * t - 1.0
        return radius * (1.0 + bulge * (1.0 - s * s)), half_height * s, -4.0 * bulge * s * radius

    recipe = Recipe(
        "film_between_rings",
        {
            "radius": radius,
            "half_height": half_height,
            "liquid": liquid,
            "volume": volume,
            "pressure": pressure,
            "discretization": Discretization(mesh.space, mesh.degree, mesh.elements, model),
        },
    )
    space = ring_space(mesh.space, mesh.degree, mesh.elements, angle=0.5 * np.pi)
    start = min(half_height, SLENDER * radius)
    ramp = Ramp("rings.half_height", (start, half_height), Stretched(recipe))
    return Scene(
        axisymmetric(space, profile),
        terms,
        (Fixed("xi2=0"), Fixed("xi2=1"), Sector(model)),
        scale=Scale(radius, liquid.surface_tension),
        ramp=ramp if start < half_height else None,
        kind="film_between_rings",
        recipe=recipe,
        description=_describe(radius, half_height, liquid, volume, pressure, mesh, model),
    )


@dataclass(frozen=True)
class Stretched:
    """Films between rings farther apart, of the same mean radius.

    Attributes
    ----------
    recipe : of the film.
    """

    recipe: Recipe

    def __call__(self, half_height: float) -> Scene:
        asked = self.recipe.arguments
        volume = asked["volume"]
        scaled = None if volume is None else volume * half_height / asked["half_height"]
        return self.recipe.scene(half_height=half_height, volume=scaled)


def _bulge(ratio: float) -> float:
    """Amplitude of the parabolic profile that holds ``ratio`` times the cylinder's volume."""
    # ratio = 1 + 4/3 b + 8/15 b^2
    return float((-4.0 / 3.0 + np.sqrt(16.0 / 9.0 - 32.0 / 15.0 * (1.0 - ratio))) * 15.0 / 16.0) \
        if ratio > 1.0 / 6.0 else -0.99  # fmt: skip


def _describe(
    radius: float,
    half_height: float,
    liquid: Liquid,
    volume: float | None,
    pressure: float | None,
    mesh: Mesh,
    model: str,
) -> Mapping[str, Any]:
    rings = {"radius": radius, "half_height": half_height, "volume": volume, "pressure": pressure}
    return {
        "scene": "film_between_rings",
        "liquid": {"surface_tension": liquid.surface_tension, "density": liquid.density},
        "rings": {key: value for key, value in rings.items() if value is not None},
        "discretization": mesh.described(model),
    }
