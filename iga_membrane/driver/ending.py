"""How a solve ended: what its iteration says, revised by all that the evidence objects to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..problems.scene import Scene
from ..solvers.newton import NewtonResult
from ..solvers.stability import Stability
from ..status import REMEDY, Status
from ..surface.surface import Surface
from ..verification.evidence import Audit
from ..verification.self_intersection import crossing
from .acceptance import (
    EQUILIBRIA,
    contact_objection,
    judge,
    leaves_its_asperity,
    leaves_its_rim,
    overload,
    reaches_boundary,
    rests_on_a_point,
    rolling,
    too_soft,
)


@dataclass(frozen=True, eq=False)
class Evidence:
    """What is known of a state.

    Attributes
    ----------
    scene, assembly, result : whose state it is, and how the iteration to it ended.
    inside : volume of the liquid, in the scene's scale.
    audit : None where it was not asked for or not possible.
    stability : None where there is no verdict, and ``doubt`` why.
    late : the CPU limit that was reached before all was gathered, in words, or "".
    """

    scene: Scene
    assembly: Assembly
    result: NewtonResult
    inside: float
    audit: Audit | None
    stability: Stability | None
    doubt: str
    late: str

    @property
    def surface(self) -> Surface:
        """The state."""
        return self.result.surface

    @property
    def multipliers(self) -> Array:
        """Of its constraints."""
        return self.result.multipliers


@dataclass(frozen=True)
class Ending:
    """Status, kind and message of a solve.

    Attributes
    ----------
    status : None while only the iteration is known to have converged.
    """

    status: Status | None
    kind: str | None = None
    message: str = ""


def ending_of(found: Evidence) -> Ending:
    """The ending of a solve, from its evidence."""
    status = found.result.status
    # at 180 degrees an edge may close
    kind = "touches_in_a_point" if status is Status.TOPOLOGY_CHANGE else None
    ending = Ending(status, kind, found.result.message)
    for revise in REVISIONS:
        ending = revise(found, ending)
    return ending


def _with_remedy(found: Evidence, ending: Ending) -> Ending:
    if ending.status not in REMEDY:
        return ending
    remedy = REMEDY[ending.status]
    return replace(ending, message=f"{ending.message}: {remedy}{rolling(found.scene)}")


def _without_verdict(found: Evidence, ending: Ending) -> Ending:
    if ending.status is not None or found.stability is not None:
        return ending
    if found.late:
        late = f"an equilibrium, but {found.late} before it was judged"
        return Ending(Status.INTERRUPTED, None, f"{late}: {REMEDY[Status.INTERRUPTED]}")
    return Ending(Status.CONVERGED_MARGINAL, None, f"no stability verdict: {found.doubt}")


def _judged(found: Evidence, ending: Ending) -> Ending:
    if ending.status is not None or found.stability is None:
        return ending
    scene, assembly = found.scene, found.assembly
    status, message = judge(scene, found.stability, found.audit, found.inside)
    ending = Ending(status, None, message)
    if assembly.contact.carries or assembly.contact.passes:
        objection = contact_objection(scene, assembly, found.surface, found.multipliers)
        ending = ending if objection is None else Ending(*objection)
    point = rests_on_a_point(scene)
    return ending if point is None else Ending(*point)


def _on_its_rim(found: Evidence, ending: Ending) -> Ending:
    if ending.status not in EQUILIBRIA:
        return ending
    left = leaves_its_rim(found.scene, found.surface)
    return ending if left is None else Ending(*left)


def _meets_itself(found: Evidence, ending: Ending) -> Ending:
    contact = found.assembly.contact
    if ending.status is not Status.CONVERGED_STABLE or contact.lies or contact.passes:
        return ending
    place = crossing(found.surface)
    if place is None:
        return ending
    x, y, z = found.scene.units.to_world(place)
    said = f"the membrane meets itself at ({x:.4g}, {y:.4g}, {z:.4g})"
    return Ending(Status.TOPOLOGY_CHANGE, "self-contact", said)


def _rounded(found: Evidence, ending: Ending) -> Ending:
    floor = found.result.floor
    if floor is None:
        return ending
    said = f"; rounding ended the iteration, at a relative residual of {floor:.0e}"
    return replace(ending, message=ending.message + said)


def _sunk(found: Evidence, ending: Ending) -> Ending:
    sunk = too_soft(found.scene, found.assembly, found.multipliers)
    if sunk is None or ending.status is Status.INTERRUPTED:
        return ending
    return Ending(sunk[0], ending.kind, sunk[1])


def _at_the_rim(found: Evidence, ending: Ending) -> Ending:
    failed = found.result.status not in (None, Status.INTERRUPTED)
    if not failed or not reaches_boundary(found.scene, found.surface):
        return ending
    said = "the contact line reaches the rim: no sheet is left between them"
    return Ending(Status.TOPOLOGY_CHANGE, "reaches boundary", said)


def _overloaded(found: Evidence, ending: Ending) -> Ending:
    if ending.status in (Status.CONVERGED_STABLE, Status.INTERRUPTED):
        return ending
    said = overload(found.scene, found.assembly, found.multipliers)
    return replace(ending, message=ending.message + said)


def _off_its_asperity(found: Evidence, ending: Ending) -> Ending:
    assert ending.status is not None
    left = leaves_its_asperity(found.scene, found.surface, ending.status, ending.message)
    return ending if left is None else Ending(*left)


REVISIONS: tuple[Callable[[Evidence, Ending], Ending], ...] = (
    _with_remedy,
    _without_verdict,
    _judged,
    _on_its_rim,
    _meets_itself,
    _rounded,
    _sunk,
    _at_the_rim,
    _overloaded,
    _off_its_asperity,
)
"""What may change an ending, in this order."""
