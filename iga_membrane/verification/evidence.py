"""Evidence: what was measured of a state on an independent path, and how much of it may pass.

What was not gathered is None, printed "n/a": a defect that nobody looked for is not a defect of 0.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

from ..status import Status


@dataclass(frozen=True)
class Tolerance:
    """What the audit lets pass; beyond, the status is not a success.

    Attributes
    ----------
    residual : weak form on doubled quadrature.
    volume : relative error of the volume.
    force : vertical balance; sideways : horizontal one on asperities, where the directions of the
        forces are those of a few contact points on each.
    line : the same from the spline's own tangents.
    angle : error of the mean cosine of the contact angle; where a membrane passes through spheres,
        on each of them.
    penetration : depth below a plane over the scene's length.
    indentation : depth in a sphere over its radius; an edge lies on it only in the mean.
    """

    residual: float = 1e-3
    volume: float = 1e-4
    force: float = 1e-3
    sideways: float = 5e-3
    line: float = 2e-2
    angle: float = 2e-2
    penetration: float = 1e-6
    indentation: float = 1e-2


TOLERANCE = Tolerance()


@dataclass(frozen=True)
class Check:
    """One question to a state.

    Attributes
    ----------
    name : of the audit's entry; what : the same in words.
    value : the defect, relative; None where no evidence was gathered.
    limit : on its size.
    status : that a larger defect means; remedy : against it.
    """

    name: str
    what: str
    value: float | None
    limit: float
    status: Status = Status.UNDERRESOLVED
    remedy: str = "take more discretization.elements or a higher degree"

    @property
    def objects(self) -> bool:
        """Whether the defect is larger than its limit, or no number."""
        return self.value is not None and not abs(self.value) <= self.limit

    @property
    def message(self) -> str:
        """What it objects to, with the remedy."""
        return (
            f"the audit's {self.what} is {self.value:.1e} (allowed {self.limit:.0e}): {self.remedy}"
        )

    def __str__(self) -> str:
        return f"{self.name} " + ("n/a" if self.value is None else f"{self.value:.1e}")


@dataclass(frozen=True)
class Audit:
    """Defects of a state, all relative; None where nothing was there to be checked.

    Attributes
    ----------
    residual : norm of the weak form over the norm of its absolute contributions.
    volume : over the prescribed volume.
    force : vertical balance of the liquid on a plane, ``p A_wet - line - weight`` over the sum of
        the three, and on other solids what they carry less the weight, over the weight; in a cell
        what the sphere carries less the pressure on the cell. The line's force is that of Young's
        angle.
    sideways : horizontal force of the solids on the liquid over the same, along the axes that the
        model does not rule out.
    line : vertical balance of the membrane alone, of its pressure, of solids that it lies on, and
        of the pull along held edges and contact lines by the spline's own tangents: converges
        slower, so it tells how well these are resolved; of a film, of both its halves.
    angle : mean cosine of the measured contact angle minus that of Young's, on the solid where it
        is worst; where a membrane lies on a solid at 180 degrees, weighted by what points carry.
    penetration : depth in the solid on a sampling four times denser than the quadrature, over the
        scene's length (plane) or the sphere's radius; there also the line's distance from it.
    indentation : the same of a particle beside a plane, over its radius.
    deepest : the point of the sampling that lies deepest, or nearest to the solid, in the scene's
        scale.
    """

    residual: float | None
    volume: float | None = None
    force: float | None = None
    sideways: float | None = None
    line: float | None = None
    angle: float | None = None
    penetration: float | None = None
    indentation: float | None = None
    deepest: tuple[float, float, float] | None = None

    @property
    def defects(self) -> dict[str, float | None]:
        """Name to value."""
        return {f.name: getattr(self, f.name) for f in fields(self) if f.name != "deepest"}

    @property
    def gathered(self) -> tuple[str, ...]:
        """Names of the defects that were looked for."""
        return tuple(name for name, value in self.defects.items() if value is not None)

    def checks(self, depth: float = TOLERANCE.penetration) -> tuple[Check, ...]:
        """The questions in the order of what they say of a state.

        Parameters
        ----------
        depth : in the substrate that is allowed, in the units of ``penetration``.
        """
        most, deeper = TOLERANCE, "take more discretization.elements"
        sunk = Status.PENETRATION
        return (
            Check("penetration", "depth in the substrate, in radii (plane: lengths),",
                  self.penetration, depth, sunk, f"{deeper} or raise solver.penetration_tolerance"),
            Check("indentation", "depth in a particle, in radii,",
                  self.indentation, most.indentation, sunk, deeper),
            Check("residual", "residual on doubled quadrature", self.residual, most.residual),
            Check("volume", "volume error", self.volume, most.volume),
            Check("force", "vertical force balance", self.force, most.force),
            Check("sideways", "horizontal force balance", self.sideways, most.sideways),
            Check("line", "force balance along edges and contact lines", self.line, most.line),
            Check("angle", "error of the contact angle's cosine", self.angle, most.angle),
        )  # fmt: skip
