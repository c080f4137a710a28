"""The way to a droplet with contact lines on spheres: what it starts from, and along which contact
angles it is approached if that fails."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..solids import Spheres
from ..terms import SphereContactLine, Term, TrimmedContactLine
from .scene import Ramp, Scene
from .spec import Foot
from .whole_foot import PREDICTABLE, with_angle

EASY = 60.0, 130.0
"""Contact angles of particles, in degrees, between which their menisci are good starts."""
EASIEST = 90.0
"""The angle from which a solve between them is approached if its own start fails."""
AROUND = 12.0
"""Degrees above its own angle from which a scene is approached if its own start fails."""


def from_another_angle(scene: Scene, terms: Sequence[Term], built: Foot) -> Scene:
    """A scene with contact lines on asperities, and the way to it from an angle where its start is
    good."""
    solid = scene.substrate
    assert solid is not None

    def started(angle: float) -> Scene:
        """The scene at contact angles of at least ``angle``."""
        raised = with_angle(solid, angle)
        line = replace(built.terms[0], solid=raised)  # type: ignore[type-var]
        near = replace(scene, terms=[*terms, *built.predictor], ramp=None, origin=None)
        return replace(
            scene,
            terms=[*terms, line],
            substrate=raised,
            ramp=None,
            predictor=near,
            origin=None,
        )

    least, good = float(np.min(solid.contact_angle)), PREDICTABLE[0]
    if least < good:
        ramp = Ramp("substrate.contact_angle", (good, least), started, only=True)
        return replace(scene, ramp=ramp)
    # another angle may have a better start; its wet set may be another one, too
    easier = min(least + AROUND, 0.5 * (least + 180.0))
    ramp = Ramp("substrate.contact_angle", (easier, least), started)
    return replace(started(least), ramp=ramp)


def from_alone(scene: Scene, alone: Scene) -> Scene:
    """A droplet whose membrane passes through particles: it starts from the droplet alone, and if
    that fails from particles at easier angles."""
    angles = np.array([each.contact_angle for each in scene.particles])
    easy = np.where((angles < EASY[0]) | (angles > EASY[1]), np.clip(angles, *EASY), EASIEST)
    lead = int(np.abs(angles - easy).argmax())

    def at(angle: float) -> Scene:
        """All angles on the way from the easy ones, as far as that of one particle."""
        way = angles[lead] - easy[lead]
        turned = easy + (angle - easy[lead]) / way * (angles - easy) if way else angles

        def through(term: Term) -> Term:
            if isinstance(term, SphereContactLine):
                return replace(term, sphere=replace(term.sphere, contact_angle=float(turned[0])))
            if not isinstance(term, TrimmedContactLine):
                return term
            assert isinstance(term.solid, Spheres)
            every = np.array(term.solid.contact_angle)
            every[len(every) - len(turned) :] = turned
            return replace(term, solid=replace(term.solid, contact_angle=every))

        turned_terms = [through(t) for t in scene.terms]
        return replace(scene, terms=turned_terms, ramp=None, predictor=alone, origin=None)

    values = float(easy[lead]), float(angles[lead])
    ramp = Ramp(f"particle[{lead}].contact_angle", values, at)
    return replace(at(values[1]), ramp=ramp if values[0] != values[1] else None)
