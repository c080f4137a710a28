"""A contact angle with memory: the line stays while its angle is between two."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arguments import checked
from ..checks import contact_angle
from ..errors import SceneError


@dataclass(frozen=True)
@checked("contact_angle", receding=contact_angle, advancing=contact_angle)
class Hysteresis:
    """Receding and advancing contact angle of a solid.

    Attributes
    ----------
    receding : angle in degrees below which the line recedes.
    advancing : angle in degrees above which it advances, > ``receding``.

    Raises
    ------
    SceneError
        The advancing angle is not the larger one.
    """

    receding: float
    advancing: float

    def __post_init__(self) -> None:
        if self.advancing <= self.receding:
            raise SceneError(
                f"contact_angle.advancing = {self.advancing:g}: must be > the receding angle, "
                f"{self.receding:g}; exchange them, or give one number"
            )

    @property
    def young(self) -> float:
        """Angle of the mean cosine, degrees."""
        return float(np.degrees(np.arccos(0.5 * sum(self.cosines))))

    @property
    def cosines(self) -> tuple[float, float]:
        """Of the receding and the advancing angle."""
        receding, advancing = np.cos(np.radians([self.receding, self.advancing]))
        return float(receding), float(advancing)

    def placed(self, angle: float | None) -> float:
        """The angle at which a droplet is placed: the one asked for, or that of the mean cosine.

        Raises
        ------
        SceneError
            An angle out of the range.
        """
        if angle is None:
            return self.young
        if not self.receding <= angle <= self.advancing:
            raise SceneError(
                f"droplet.placed_at = {angle:g}: must be within the hysteresis, {self.receding:g} "
                f"to {self.advancing:g} degrees"
            )
        return angle
