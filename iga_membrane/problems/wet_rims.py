"""The edges of a bridge on perfectly wet solids, at 0 degrees, whose places are to be found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..solids import Plane, Sphere
from ..splines import points_of
from ..surface.ring import circle
from ..surface.surface import Surface
from .scene import FreeEdge, Scene, TangentEdge


@dataclass(frozen=True)
class WetRims(FreeEdge):
    """Edges where a membrane leaves perfectly wet solids tangentially, each a circle round the axis
    of the bridge: by its radius on a plane, by its polar angle on a sphere.

    Attributes
    ----------
    ends : edge of the patch, solid in the scene's scale and side (1 below the bridge, -1 above) of
        every such end.
    """

    ends: tuple[tuple[str, Plane | Sphere, float], ...]

    def edges(self, scene: Scene) -> list[TangentEdge]:
        return [TangentEdge(edge, solid) for edge, solid, _ in self.ends]

    def place_of(self, surface: Surface) -> Array:
        return np.array([_place(surface, *end) for end in self.ends])

    def surface_at(self, scene: Scene, place: Array) -> Surface:
        local = scene.surface.moved(scene.units.to_local(scene.surface.points))
        space, net = local.space, local.net.copy()
        ring, along = circle(space.bases[0]), space.bases[1].abscissae[:, None]
        for (edge, solid, side), where in zip(self.ends, place, strict=True):
            k, fading = (0, 1.0 - along) if edge == "xi2=0" else (-1, along)
            if isinstance(solid, Plane):
                r, z = where, solid.point[2]
            else:
                r = solid.radius * np.sin(where)
                z = solid.center[2] + side * solid.radius * np.cos(where)
            shift = r * ring + [0.0, 0.0, z] - local.net[:, k]
            net += shift[:, None] * fading
        return scene.surface.moved(scene.units.to_world(points_of(space, net)))


def _place(surface: Surface, edge: str, solid: Plane | Sphere, side: float) -> float:
    """Mean radius or polar angle of an edge."""
    ring, t = surface.space.bases[0], float(edge == "xi2=1")
    middle = ring.breaks[:-1] + 0.5 * ring.sizes
    s = np.concatenate([ring.breaks[:-1], middle])
    x = surface.at(np.column_stack([s, np.full(len(s), t)]), 1).position
    r = np.hypot(x[:, 0], x[:, 1])
    if isinstance(solid, Plane):
        return float(r.mean())
    return float(np.arctan2(r, side * (x[:, 2] - solid.center[2])).mean())
