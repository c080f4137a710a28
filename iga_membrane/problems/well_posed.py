"""What makes a scene a question with an answer."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..errors import SceneError
from ..terms import LocalGap
from .posed import Posed


def check_parts(scene: Posed) -> None:
    """Refuse parts that do not go together.

    Raises
    ------
    SceneError
    """
    for rule in (
        _check_space,
        _check_names,
        _check_lines,
        _check_directions,
        _check_motion,
        _check_start,
        _check_gaps,
        _check_tension,
        _check_weight,
    ):
        rule(scene)


def _check_space(scene: Posed) -> None:
    space = scene.surface.space
    splines = any(basis.knots is not None for basis in space.bases)
    if space.continuity < 1 and (splines or space.weights is not None):
        raise SceneError("surface: C1 needed between the elements of a spline space")


def _check_names(scene: Posed) -> None:
    names = [term.name for term in scene.terms]
    for name in names:
        if names.count(name) > 1 and name not in ("gravity", "wetting"):
            raise SceneError(f'terms: "{name}" is listed {names.count(name)} times')
    if "pressure" in names and "volume" in names:
        raise SceneError("terms: pressure and volume are both prescribed; give one of them")


def _check_lines(scene: Posed) -> None:
    """Refuse lines that slide freely where they have no place."""
    sliding = [support.edge for support in scene.by_kind.sliding]
    held = [line for line in scene.by_form.wetting if line.edge not in sliding]
    for term in scene.terms:
        for solid in () if term in held else term.solids:
            refuse_perfectly_wet(f'terms: "{term.name}"', solid)
    for line in scene.by_form.wetting:
        if line not in held and line.strength >= line.gamma:
            raise SceneError(
                "contact_angle = 180: a contact line that slides freely has no place at 180 "
                "degrees, where the foot is a contact area; build the scene by "
                "sessile_droplet or liquid_sheet, or hold the edge by Fixed"
            )


def _check_directions(scene: Posed) -> None:
    count = scene.surface.space.count
    if scene.directions is not None and len(scene.directions) != count:
        raise SceneError(
            f"directions: {len(scene.directions)} given, one for each of the {count} "
            "control points is needed"
        )


def _check_motion(scene: Posed) -> None:
    if (scene.motion == "cartesian") != bool(scene.by_form.stabilizations):
        raise SceneError(
            f'motion = "{scene.motion}": "cartesian" needs a Stabilization among the terms, '
            '"spines" none'
        )


def _check_start(scene: Posed) -> None:
    near, count = scene.predictor, scene.surface.space.count
    if near is not None and scene.start_from is None and near.surface.space.count != count:
        raise SceneError(
            "start_from: missing; the predictor has another space, so it must be given, or "
            "predictor=None"
        )


def _check_tension(scene: Posed) -> None:
    if all(term.name != "surface_tension" for term in scene.terms):
        raise SceneError("terms: a membrane needs a SurfaceTension")


def refuse_perfectly_wet(field: str, solid: object) -> None:
    """Refuse a contact angle of 0.

    Raises
    ------
    SceneError
    """
    if np.any(np.asarray(getattr(solid, "contact_angle", 180.0)) == 0.0):
        raise SceneError(
            f"{field}.contact_angle = 0: contact_angle must be > 0 and <= 180 here; on a perfectly "
            "wet solid the liquid spreads to a film, unless it bridges two solids"
        )


def check_mirrors(scene: Posed) -> None:
    """Refuse a model whose mirror planes the terms do not have."""
    model, mirrored = scene.sector.model, scene.sector.mirrored
    for centroid in scene.by_form.centroids:
        if centroid.axis in mirrored:
            raise SceneError(
                f'terms: the "{model}" model is symmetric in {centroid.axis}; a Centroid along '
                f"{centroid.axis} holds nothing there: leave it out or take a larger model"
            )
    for axis in mirrored:
        if axis in scene.lateral_load:
            raise SceneError(
                f'discretization.model = "{model}": gravity leans to {axis}, so the scene has '
                f'no such mirror plane; "{"half" if axis == "x" else "full"}" is the smallest '
                "model here"
            )
    here = scene.units.to_local(scene.surface.points)
    for term in scene.local_terms().gaps:
        for axis in mirrored:
            there = here * np.where(np.arange(3) == "xyz".index(axis), -1.0, 1.0)
            _check_mirror(scene, term, here, there, axis)
        if model == "eighth":
            _check_mirror(scene, term, here, here[:, [1, 0, 2]], "x = y")


def _check_mirror(scene: Posed, term: LocalGap, here: Array, there: Array, plane: str) -> None:
    """Refuse a law of the gap to a solid without a mirror plane of the model."""
    off = np.abs(term.at(there).at.gap - term.at(here).at.gap).max()
    if not off <= 1e-9:
        raise SceneError(
            f'terms: the solid of "{term.name}" has no mirror plane for {plane}, the '
            f'"{scene.sector.model}" model has: take a larger model'
        )


def _check_gaps(scene: Posed) -> None:
    """Refuse a law of the gap where its variations are not known."""
    name = next((law.name for law in scene.by_form.laws), None)
    if name is not None and scene.motion != "spines":
        raise SceneError(f'terms: "{name}" needs motion = "spines"')
    lines = [t.name for t in (*scene.by_form.lines, *scene.by_form.passed)]
    if name is not None and lines:
        raise SceneError(
            f'terms: "{name}" changes the tension at the contact line "{lines[0]}", which is '
            "not available yet; a law of the gap needs fixed edges, or a membrane that lies on "
            "its substrate (180 degrees)"
        )


def check_held(scene: Posed) -> None:
    """Refuse an edge that nothing holds, from which a membrane retracts, and a membrane folded from
    a square whose control points have no directions of their own: normals turn at its corners.

    Raises
    ------
    SceneError
    """
    kinds = scene.by_kind
    held = [*kinds.held, *(edge for joint in kinds.joints for edge in joint.edges)]
    walls = scene.directions is not None or kinds.mirrors
    if scene.surface.space.shared is not None and scene.directions is None:
        raise SceneError(
            "directions: missing; the control points of a membrane that is folded from a square "
            "need directions to move along"
        )
    loose = [edge for edge in scene.surface.space.open_edges if edge not in held]
    if loose and not walls:
        raise SceneError(
            f"supports: nothing holds the membrane's edge {loose[0]}, from which it would "
            "retract; give it Fixed, Sliding, or a Symmetry plane"
        )


def _check_weight(scene: Posed) -> None:
    """Refuse a scene whose liquid and particles are weighed by two gravities."""
    pulls = [t.density_of_liquid * np.array(t.acceleration) for t in scene.by_form.weights]
    own = scene.liquid_density * np.array(scene.acceleration)
    # a sheet may be computed without its liquid's weight
    if not own.any() or (not pulls and scene.kind == "liquid_sheet"):
        return
    off = np.abs(sum(pulls, np.zeros(3)) - own).max()
    if off > 1e-9 * np.abs(own).max():
        raise SceneError(
            "acceleration, liquid_density: they weigh the liquid by "
            f"{own.tolist()} per volume, the terms otherwise; replace both, or the Gravity term "
            "alone, which they follow"
        )
