"""What a scene's terms say about contact."""

from __future__ import annotations

import numpy as np

from ..problems.scene import Scene
from ..terms import Contact, TrimmedContactLine


def law_of(scene: Scene) -> Contact | None:
    """The scene's law of contact, in its own scale."""
    return scene.local_terms().obstacle


def line_of(scene: Scene) -> TrimmedContactLine | None:
    """The scene's contact line inside the membrane, in its own scale."""
    return scene.local_terms().unfitted


def same_law(one: Contact, other: Contact) -> bool:
    """Whether two laws of contact are the same, for the same solid."""
    if type(one.solid) is not type(other.solid):
        return False
    laws = [(c.penalty, c.depth, c.adhesion, c.ring, c.compliance) for c in (one, other)]
    fields = [vars(c.solid) for c in (one, other)]
    return laws[0] == laws[1] and all(
        np.array_equal(fields[0][key], fields[1][key])
        for key in fields[0]
        if not key.startswith("_")
    )
