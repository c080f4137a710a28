"""The liquid and the discretization of its surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

from ..arguments import checked
from ..checks import either, function
from ..dofs.boundary_conditions import Model
from ..errors import SceneError
from ..fields import FIELDS
from ..quantities import Quantity
from ..splines import BasisOf

MODELS: tuple[Model, ...] = ("full", "half", "quarter", "eighth")


def _in_si(tension: float, density: float) -> tuple[Quantity, Quantity]:
    return Quantity(tension, "surface tension"), Quantity(density, "density")


@dataclass(frozen=True)
@checked("liquid")
class Liquid:
    """A liquid of constant surface tension.

    Attributes
    ----------
    surface_tension : gamma > 0.
    density : rho_s, less that of its surroundings; negative where it is lighter.
    """

    surface_tension: float = 1.0
    density: float = 1.0

    @classmethod
    def water(cls) -> Liquid:
        """At 20 degrees Celsius in SI: 72.8 mN/m, 998 kg/m^3."""
        return cls(*_in_si(72.8e-3, 998.0))

    @classmethod
    def glycerol(cls) -> Liquid:
        """At 20 degrees Celsius in SI: 63 mN/m, 1261 kg/m^3."""
        return cls(*_in_si(63e-3, 1261.0))

    @classmethod
    def ethanol(cls) -> Liquid:
        """At 20 degrees Celsius in SI: 22.3 mN/m, 789 kg/m^3."""
        return cls(*_in_si(22.3e-3, 789.0))

    @classmethod
    def mercury(cls) -> Liquid:
        """At 20 degrees Celsius in SI: 485 mN/m, 13546 kg/m^3."""
        return cls(*_in_si(485e-3, 13546.0))


@dataclass(frozen=True)
@checked(
    "discretization",
    space=either(FIELDS["discretization.space"], partial(function, arguments=2)),
)
class Discretization:
    """Space and mesh of one patch; what is None is chosen by the scene.

    Attributes
    ----------
    space : "bspline", "nurbs" (both C1 or smoother) or "lagrange" (C0); or a function from the
        number of elements and the degree to a :class:`Basis` on [0, 1], for the meridians.
    degree : 2 to 4, for "lagrange" 1 to 4.
    elements : along the main parameter direction; a droplet's ring has twice as many.
    model : "full", "half", "quarter", "eighth", or None for the smallest the scene allows.
    """

    space: str | BasisOf = "bspline"
    degree: int | None = None
    elements: int | None = None
    model: Model | None = None

    def __post_init__(self) -> None:
        if self.space in ("bspline", "nurbs") and self.degree == 1:
            raise SceneError(
                f"discretization.degree = {self.degree}: degree {self.degree} is not C1, C1 needed "
                f'for curvature and contact lines: degree >= 2 in space "{self.space}"'
            )

    def mesh(self, *, degree: int = 4, elements: int = 20) -> Mesh:
        """The choices, with a scene's own where there are none."""
        degree = degree if self.degree is None else self.degree
        return Mesh(
            self.space, degree, elements if self.elements is None else self.elements, self.model
        )


def space_name(space: str | BasisOf) -> str:
    """A space in a word."""
    return space if isinstance(space, str) else getattr(space, "__name__", type(space).__name__)


def with_defaults(
    liquid: Liquid | None, discretization: Discretization | None
) -> tuple[Liquid, Discretization]:
    """What a scene was given, or the defaults."""
    return (
        Liquid() if liquid is None else liquid,
        Discretization() if discretization is None else discretization,
    )


@dataclass(frozen=True)
class Mesh:
    """A :class:`Discretization` with every choice made, except perhaps the model."""

    space: str | BasisOf
    degree: int
    elements: int
    model: Model | None

    def described(self, model: str) -> dict[str, Any]:
        """By the names of the scene file."""
        return {
            "space": space_name(self.space),
            "degree": self.degree,
            "elements": self.elements,
            "model": model,
        }
