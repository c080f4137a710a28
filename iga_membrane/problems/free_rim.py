"""The rim of a droplet's foot at 180 degrees on a plane, whose radius is to be found."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..solids import Plane
from ..surface.surface import Surface
from .recipe import Recipe
from .scene import FreeEdge, Scene, TangentEdge
from .smooth_foot import rim_radius, with_rim


@dataclass(frozen=True)
class RimOnPlane(FreeEdge):
    """The rim where a membrane leaves a plane tangentially.

    Attributes
    ----------
    recipe : of the droplet that the scene was built for.
    """

    recipe: Recipe

    def edges(self, scene: Scene) -> list[TangentEdge]:
        return [TangentEdge("xi2=0", Plane(180.0), carries=True)]

    def surface_at(self, scene: Scene, place: Array) -> Surface:
        return with_rim(scene.surface, float(place[0]), scene.units)

    def place_of(self, surface: Surface) -> Array:
        return np.array([rim_radius(surface)])

    def foretold(self, scene: Scene) -> Surface:
        asked = self.recipe.arguments
        volume = next((t.value for t in scene.by_form.volumes), asked["volume"])
        weight = tuple(scene.acceleration), scene.liquid_density
        own = tuple(asked["gravity"]), asked["liquid"].density
        if (volume, weight) == (asked["volume"], own) or not np.any(weight[0]):
            return scene.surface
        heavy = replace(asked["liquid"], density=scene.liquid_density)
        fresh = self.recipe.scene(volume=volume, gravity=scene.acceleration, liquid=heavy)
        return scene.surface.moved(fresh.surface.points)
