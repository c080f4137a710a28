"""What becomes of a scene of which fields were replaced (``dataclasses.replace``).

Ways round a failing solve are functions that know the scene they were made for. A scene remembers
which fields these were made with. Where one of them is replaced, ways that are still those of the
scene before are left out, or refused where there is no solving without them; what follows from
the fields, as gravity from its term, follows again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ..checks import shown
from ..errors import SceneError
from ..terms import Scale, Term
from .posed import Posed

ASKED = (
    "terms", "supports", "scale", "motion", "substrate", "particles", "hold", "acceleration",
    "liquid_density", "kind",
)  # fmt: skip
"""Fields that say what is asked; of the surface its space does."""
WAYS = ("ramp", "predictor", "start_from", "otherwise", "finer", "free_particles")
"""Fields that know a way to solve it. An edge at 180 degrees asks the scene itself."""


@dataclass(frozen=True, eq=False)
class Origin:
    """What a scene was when its ways were made.

    Attributes
    ----------
    asked, ways : fields by their names.
    """

    asked: Mapping[str, Any] = field(repr=False)
    ways: Mapping[str, Any] = field(repr=False)


def origin_of(scene: Posed) -> Origin:
    """What a scene is."""
    asked = {name: getattr(scene, name) for name in ASKED} | {"space": scene.surface.space}
    return Origin(asked, {name: getattr(scene, name) for name in WAYS})


def adapted(scene: Posed, origin: Origin) -> dict[str, Any]:
    """Fields of a scene that follow from what was replaced since its origin.

    Raises
    ------
    SceneError
        What was replaced does not go with the rest.
    """
    now = origin_of(scene).asked
    changed = [name for name, value in now.items() if not _same(value, origin.asked[name])]
    if not changed:
        return {}
    before = origin.asked
    _check(scene, before, changed)
    stale = [name for name in WAYS if (way := getattr(scene, name)) and way is origin.ways[name]]
    fields = ", ".join(changed)
    _check_stale(scene, stale, fields)
    found: dict[str, Any] = dict.fromkeys([*stale, "recipe"])
    weight = _weight(scene, before) if "terms" in changed else {}
    if "predictor" in stale and changed == ["terms"]:
        found["predictor"] = _predictor(scene, before["terms"], weight)
        if found["predictor"] is not None and "start_from" in stale:
            del found["start_from"]
    lost = [name for name in stale if found.get(name, scene) is None]
    told = (
        f"{fields}: replaced after the scene was built; its ways round a failing solve "
        f"({', '.join(lost)}) are left out"
    )
    found |= weight
    if lost:
        found["warnings"] = (*scene.warnings, told)
    if scene.description:
        replaced = sorted({*scene.description.get("replaced", ()), *changed})
        found["description"] = dict(scene.description) | {"replaced": replaced}
    return found


def _check_stale(scene: Posed, stale: Sequence[str], fields: str) -> None:
    """Refuse a scene that cannot be solved without ways that are no more its own."""
    if "free_particles" in stale:
        raise SceneError(
            f"{fields}: replaced in a scene with particles that move, which is solved by scenes "
            "built anew; build it with other arguments, or fix them by free_particles=None"
        )
    if "ramp" in stale and scene.ramp is not None and scene.ramp.asked:
        raise SceneError(
            f"{fields}: replaced in a scene with a path of its own, which leads to the scene "
            "before; give another ramp, or ramp=None"
        )


def _check(scene: Posed, before: Mapping[str, Any], changed: Sequence[str]) -> None:
    """Refuse what contradicts the rest of the scene."""
    alone = {
        "substrate": "the terms know the solid, too",
        "particles": "the terms know them, too",
        "hold": "Centroid terms hold the droplet",
    }
    for name, why in alone.items():
        if name in changed and "terms" not in changed:
            raise SceneError(
                f"{name} = {shown(getattr(scene, name))}: replaced alone, but {why}; "
                f"build the scene anew with another {name}"
            )
    _check_frame(scene, before, changed)
    if "kind" in changed and before["kind"] != "membrane":
        raise SceneError(
            f'kind = "{scene.kind}": a scene of kind "{before["kind"]}" has no measures of '
            "another; build the scene anew"
        )
    lines = [tuple(terms.lines) for terms in (scene.by_form, before["terms"])]
    if scene.free_edge is not None and not (
        {"space", "substrate"}.isdisjoint(changed) and _same(*lines)
    ):
        raise SceneError(
            f"{', '.join(changed)}: replaced where an edge at 180 degrees is looked for; build "
            "the scene anew"
        )


def _check_frame(scene: Posed, before: Mapping[str, Any], changed: Sequence[str]) -> None:
    """Refuse another frame than that of the scene's solid."""
    asked = scene.scale or Scale(scene.surface.size, 1.0)
    frames = [(s.origin, s.rotation) for s in (asked, before["scale"])]
    if "scale" in changed and scene.kind != "membrane" and frames[0] != frames[1]:
        raise SceneError(
            "scale: the frame of this scene is that of its solid; keep origin and rotation"
        )


def _weight(scene: Posed, before: Mapping[str, Any]) -> dict[str, Any]:
    """Acceleration and density of the liquid, which follow the term of its weight."""
    now, then = (tuple(terms.weights) for terms in (scene.by_form, before["terms"]))
    given = (scene.acceleration, scene.liquid_density)
    if _same(now, then) or given != (before["acceleration"], before["liquid_density"]):
        return {}
    if len(now) > 1:
        raise SceneError(
            "terms: several Gravity; replace acceleration and liquid_density with them"
        )
    pull, density = (
        (now[0].acceleration, now[0].density_of_liquid) if now else ((0.0, 0.0, 0.0), 0.0)
    )
    return {"acceleration": pull, "liquid_density": density}


def _predictor(scene: Posed, before: Sequence[Term], weight: Mapping[str, Any]) -> Any:
    """The nearby scene with the terms that were replaced; None where it does not share them."""
    near = scene.predictor
    assert near is not None
    own = [t for t in near.terms if not _among(t, before)]
    instead = [t for t in before if not _among(t, near.terms)]
    if not all(_among(t, scene.terms) for t in instead):
        return None
    kept = [t for t in scene.terms if not _among(t, instead)]
    return replace(near, terms=[*kept, *own], ramp=None, origin=None, **weight)


def _among(term: Term, terms: Sequence[Term]) -> bool:
    return any(_same(term, each) for each in terms)


def _same(one: Any, two: Any) -> bool:
    """Whether two values are equal; arrays that are not the same one are not."""
    if one is two:
        return True
    if isinstance(one, tuple) and isinstance(two, tuple):
        return len(one) == len(two) and all(map(_same, one, two))
    try:
        return bool(one == two)
    except ValueError:
        return False
