"""The liquid and the discretization of its surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ..checks import choice, integer, number
from ..errors import SceneError

Model = Literal["full", "half", "quarter", "eighth"]
MODELS: tuple[Model, ...] = ("full", "half", "quarter", "eighth")


@dataclass(frozen=True)
class Liquid:
    """A liquid of constant surface tension.

    Attributes
    ----------
    surface_tension : gamma > 0.
    density : rho_s >= 0.
    """

    surface_tension: float = 1.0
    density: float = 1.0

    def __post_init__(self) -> None:
        tension = number("liquid.surface_tension", self.surface_tension, above=0.0)
        object.__setattr__(self, "surface_tension", tension)
        object.__setattr__(self, "density", number("liquid.density", self.density, least=0.0))


@dataclass(frozen=True)
class Discretization:
    """Space and mesh of one patch.

    Attributes
    ----------
    space : "bspline", "nurbs" (both C1 or smoother) or "lagrange" (C0).
    degree : 2 to 4, for "lagrange" 1 to 4.
    elements : along the main parameter direction; a droplet's ring has twice as many.
    model : "full", "half", "quarter", "eighth", or None for the smallest the scene allows.
    """

    space: str = "bspline"
    degree: int = 4
    elements: int = 20
    model: Model | None = None

    def __post_init__(self) -> None:
        choice("discretization.space", self.space, ("bspline", "nurbs", "lagrange"))
        if self.space != "lagrange" and isinstance(self.degree, int) and self.degree < 2:
            raise SceneError(
                f"discretization.degree = {self.degree}: degree {self.degree} is not C1, C1 needed "
                f'for curvature and contact lines: degree >= 2 in space "{self.space}"'
            )
        integer("discretization.degree", self.degree, least=1, most=4)
        integer("discretization.elements", self.elements, least=3, most=4096)
        if self.model is not None:
            choice("discretization.model", self.model, MODELS)
