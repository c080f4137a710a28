"""The way to a droplet with contact lines on spheres: what it starts from, and along which contact
angles it is approached if that fails."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..solids import Spheres
from ..terms import Contact, SphereContactLine, Term, TrimmedContactLine
from .scene import Ramp, Scene
from .spec import Foot
from .whole_foot import PREDICTABLE, with_angle

EASY = 60.0, 130.0
"""Contact angles of particles, in degrees, between which their menisci are good starts."""
EASIEST = 90.0
"""The angle from which a solve between them is approached if its own start fails."""
AROUND = 12.0
"""Degrees above its own angle from which a scene is approached if its own start fails."""


@dataclass(frozen=True)
class Raised:
    """A scene with contact lines on asperities, at contact angles of at least a value.

    Attributes
    ----------
    scene : with any lines; terms : others than those of its solid.
    line : what the solid costs, contact lines inside the membrane or a contact area; predictor :
        terms of the solid that give a start.
    """

    scene: Scene
    terms: tuple[Term, ...]
    line: Contact | TrimmedContactLine
    predictor: tuple[Term, ...]

    def __call__(self, angle: float) -> Scene:
        solid = self.scene.substrate
        assert solid is not None
        raised = with_angle(solid, angle)
        near = replace(self.scene, terms=[*self.terms, *self.predictor], ramp=None, origin=None)
        return replace(
            self.scene,
            terms=[*self.terms, replace(self.line, solid=raised)],
            substrate=raised,
            ramp=None,
            predictor=near,
            origin=None,
        )


def from_another_angle(scene: Scene, terms: Sequence[Term], built: Foot) -> Scene:
    """A scene with contact lines on asperities, and the way to it from an angle where its start is
    good."""
    solid, line = scene.substrate, built.terms[0]
    assert solid is not None
    assert isinstance(line, (Contact, TrimmedContactLine))
    started = Raised(scene, tuple(terms), line, tuple(built.predictor))
    least, good = float(np.min(solid.contact_angle)), PREDICTABLE[0]
    if least < good:
        ramp = Ramp("substrate.contact_angle", (good, least), started, only=True)
        return replace(scene, ramp=ramp)
    # another angle may have a better start; its wet set may be another one, too
    easier = min(least + AROUND, 0.5 * (least + 180.0))
    ramp = Ramp("substrate.contact_angle", (easier, least), started)
    return replace(started(least), ramp=ramp)


@dataclass(frozen=True)
class Turned:
    """A droplet with particles at other contact angles, all on the way from easy ones as far as
    that of one particle.

    Attributes
    ----------
    scene : at any angles; alone : the same droplet without particles.
    easy, angles : (k,) contact angles of the particles, in degrees, from which and to which.
    lead : number of the one particle.
    """

    scene: Scene
    alone: Scene
    easy: Array
    angles: Array
    lead: int

    def __call__(self, angle: float) -> Scene:
        easy, angles, lead = self.easy, self.angles, self.lead
        way = angles[lead] - easy[lead]
        turned = easy + (angle - easy[lead]) / way * (angles - easy) if way else angles
        terms = [_turned(term, turned) for term in self.scene.terms]
        return replace(self.scene, terms=terms, ramp=None, predictor=self.alone, origin=None)


def _turned(term: Term, angles: Array) -> Term:
    """A term with the contact angles of the particles, if it knows them."""
    if isinstance(term, SphereContactLine):
        return replace(term, sphere=replace(term.sphere, contact_angle=float(angles[0])))
    if not isinstance(term, TrimmedContactLine):
        return term
    assert isinstance(term.solid, Spheres)
    every = np.array(term.solid.contact_angle)
    every[len(every) - len(angles) :] = angles
    return replace(term, solid=replace(term.solid, contact_angle=every))


def from_alone(scene: Scene, alone: Scene) -> Scene:
    """A droplet whose membrane passes through particles: it starts from the droplet alone, and if
    that fails from particles at easier angles."""
    angles = np.array([each.contact_angle for each in scene.particles])
    easy = np.where((angles < EASY[0]) | (angles > EASY[1]), np.clip(angles, *EASY), EASIEST)
    lead = int(np.abs(angles - easy).argmax())
    at = Turned(scene, alone, easy, angles, lead)
    values = float(easy[lead]), float(angles[lead])
    ramp = Ramp(f"particle[{lead}].contact_angle", values, at)
    return replace(at(values[1]), ramp=ramp if values[0] != values[1] else None)
