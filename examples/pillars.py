"""A substrate of one's own: a droplet on pillars with flat tops and rounded rims.

A droplet of Bond number 1 lies at 180 degrees on a square lattice of round pillars. With a rim as
wide as the pillar the tops are half spheres, and the droplet is that on the package's own spheres.
Flatter tops carry the same weight on a larger wet area, and the droplet stands higher.

A substrate answers five questions (`iga_membrane.Solid`). The one that takes thought is the
gap, with its gradient and the two principal curvatures of the surface of equal gap.

``python examples/pillars.py`` prints the numbers and draws ``pillars.png``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0
HALF = 500
"""Pillars are numbered from minus to plus this along both axes."""


@dataclass(frozen=True)
class Pillars:
    """Round pillars on a square lattice, their tops in z = 0.

    Attributes
    ----------
    radius : of a pillar; rim : radius of the fillet round its top, at most that of the pillar.
    spacing : between the axes of neighbours; a pillar stands at x = y = 0.
    contact_angle : Young's angle in degrees.
    """

    radius: float
    rim: float
    spacing: float
    contact_angle: float = 180.0

    @property
    def scale(self) -> float:
        """Length over which contact changes."""
        return self.rim

    def nearest(self, points: Any) -> iga.Nearest:
        """Gap and its derivatives at points (..., 3).

        The nearest surface is that of a circle of radius ``radius - rim`` under the top, filled to
        a disc and drawn out downwards, at the distance ``rim``.
        """
        i, j = (np.rint(points[..., k] / self.spacing) for k in (0, 1))
        x, y = points[..., 0] - self.spacing * i, points[..., 1] - self.spacing * j
        around = np.maximum(np.hypot(x, y), 1e-300)
        zero = np.zeros_like(x)
        away = np.stack([x / around, y / around, zero], axis=-1)
        out = np.maximum(around - (self.radius - self.rim), 0.0)
        up = np.maximum(points[..., 2] + self.rim, 0.0)
        distance = np.maximum(np.hypot(out, up), 1e-300)
        cos, sin = out / distance, up / distance
        normal = cos[..., None] * away + sin[..., None] * [0.0, 0.0, 1.0]
        # curvatures along the meridian, none on top and sides, and round the pillar
        along = np.where((out > 0.0) & (up > 0.0), 1.0 / distance, 0.0)
        across = np.where(out > 0.0, cos / around, 0.0)
        meridian = sin[..., None] * away - cos[..., None] * [0.0, 0.0, 1.0]
        parallel = np.stack([-away[..., 1], away[..., 0], zero], axis=-1)
        ridge = np.where((along > across)[..., None], meridian, parallel)
        ridge = ridge * np.sqrt(np.abs(along - across))[..., None]
        which = ((i + HALF) * 2 * HALF + j + HALF).astype(int)
        return iga.Nearest(distance - self.rim, normal, np.minimum(along, across), which, ridge)

    def center_of(self, which: Any) -> Any:
        """(..., 3) points inside pillars by their numbers."""
        i, j = np.divmod(np.asarray(which), 2 * HALF)
        height = np.full(np.shape(which), -self.rim)
        return np.stack([self.spacing * (i - HALF), self.spacing * (j - HALF), height], axis=-1)

    def radius_of(self, which: Any) -> Any:
        """(...) infinite: pillars are no spheres."""
        return np.full(np.shape(which), np.inf)


def droplet(solid: iga.Solid, elements: int | None = None) -> iga.Solution:
    """The droplet of Bond number 1 on a substrate."""
    mesh = iga.Discretization(elements=elements)
    scene = iga.sessile_droplet(solid, volume=VOLUME, gravity=1.0, discretization=mesh)
    return iga.solve(scene)


def main(
    rims: Sequence[float] = (0.1, 0.08, 0.06), radius: float = 0.1, elements: int | None = 100
) -> list[dict[str, float]]:
    """Droplets on pillars with rounded rims."""
    rows = []
    for rim in rims:
        drop = droplet(Pillars(radius, rim, 4.0 * radius), elements)
        row = {"rim": rim, "carried": drop.contact["support_force"] / VOLUME}
        row |= {name: drop.measures[name] for name in ("height", "pressure", "A_wet")}
        row["pillars"] = drop.contact["wet_solids"]
        rows.append(row)
    return rows


if __name__ == "__main__":
    for row in main():
        print("  ".join(f"{name} {value:.6g}" for name, value in row.items()))
    droplet(Pillars(0.1, 0.06, 0.4)).plot("pillars.png", color="pressure")
