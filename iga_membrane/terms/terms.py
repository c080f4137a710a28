"""The terms of a membrane by their form: each says itself where it counts (``Term.forms``)."""

from __future__ import annotations

from collections.abc import Iterable

from ..checks import name_of
from ..errors import SceneError
from .contact import Contact
from .gap import GapTerm, LocalGap
from .gravity import Gravity
from .line_load import NormalLineLoad
from .rim_line import RimLine
from .sphere_wetting import SphereContactLine
from .stabilization import Stabilization
from .tension import SurfaceTension
from .term import AreaTerm, BodyTerm, Constraint, LineTerm, Term, WettingLine
from .trimmed import TrimmedContactLine
from .volume import Centroid, Pressure, Volume


class Terms(tuple[Term, ...]):
    """What a membrane pays for, in its order and by form.

    Attributes
    ----------
    areas : energies per area of the membrane; surface_tensions : those of the liquid.
    bodies : energies per volume, without constraints; weights, pressures : some of them.
    constraints : body integrals that are held; volumes, centroids : some of them.
    lines : energies along edges; wetting : contact lines; on_spheres : those on spheres; rims :
        those at rest on rims of discs; others : those that are neither contact lines nor, as those
        that are pressed, hold them on solids.
    gaps : laws of the gap in a scene's scale; laws : in the user's units.
    obstacles : solids that the membrane may lie on; passed : those that it passes through.
    stabilizations : what holds the control points in the membrane's plane.
    """

    areas: list[AreaTerm]
    surface_tensions: list[SurfaceTension]
    bodies: list[BodyTerm]
    weights: list[Gravity]
    pressures: list[Pressure]
    constraints: list[Constraint]
    volumes: list[Volume]
    centroids: list[Centroid]
    lines: list[LineTerm]
    wetting: list[WettingLine]
    on_spheres: list[SphereContactLine]
    rims: list[RimLine]
    others: list[LineTerm]
    pressed: list[NormalLineLoad]
    gaps: list[LocalGap]
    laws: list[GapTerm]
    obstacles: list[Contact]
    passed: list[TrimmedContactLine]
    stabilizations: list[Stabilization]

    def __new__(cls, terms: Iterable[Term]) -> Terms:
        self = super().__new__(cls, terms)
        for form in cls.__annotations__:
            setattr(self, form, [])
        for term in self:
            if not term.forms or not set(term.forms) <= set(cls.__annotations__):
                raise SceneError(
                    f"{name_of(term)}.forms = {term.forms!r}: must name lists of Terms in which it "
                    "counts; derive it from AreaTerm, BodyTerm, Constraint, LineTerm or GapTerm"
                )
            for form in term.forms:
                getattr(self, form).append(term)
        return self

    @property
    def tension(self) -> float:
        """Energy per area of the membrane."""
        return sum(term.tension() for term in self.areas)

    @property
    def volume(self) -> Volume | None:
        """The prescribed volume, if one is."""
        return next(iter(self.volumes), None)

    @property
    def obstacle(self) -> Contact | None:
        """The law of contact of the solid that the membrane may lie on, if there is one."""
        return next(iter(self.obstacles), None)

    @property
    def unfitted(self) -> TrimmedContactLine | None:
        """The contact lines inside the membrane, if there are any."""
        return next(iter(self.passed), None)
