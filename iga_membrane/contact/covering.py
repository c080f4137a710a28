"""The paper's whole membrane: it covers the wetted area, and a line inside it carries it too."""

from __future__ import annotations

from .obstacle import Obstacle


class Covering(Obstacle):
    """A membrane that lies on its solid up to a line along which the paper's line load acts."""

    carries = False
