"""Droplets on a plane with hysteresis: how they are placed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..errors import SceneError
from ..solids import Plane, Solid, Sphere
from ..solids.hysteresis import Hysteresis


def placed_on(
    substrate: Solid | None, angle: float | None, particles: Sequence[Sphere]
) -> Solid | None:
    """The substrate with the contact angle at which a droplet is placed on it.

    Raises
    ------
    SceneError
        An angle without hysteresis or out of its range; hysteresis with particles.
    """
    found = getattr(substrate, "contact_angle", None)
    if not isinstance(found, Hysteresis):
        if angle is not None:
            raise SceneError(
                f"droplet.placed_at = {angle:g}: needs hysteresis of the contact angle, "
                "Hysteresis(receding, advancing); leave it out"
            )
        return substrate
    if particles:
        raise SceneError(
            "substrate.contact_angle: hysteresis is not available yet with particles; give one "
            "number"
        )
    assert isinstance(substrate, Plane)
    return replace(substrate, contact_angle=found.placed(angle))
