"""Randomized extreme scenes with a verdict on each result that shares no code with the solver.

``extreme_scenes(seed, count)`` is a Latin hypercube over kinds of scenes: droplets on planes,
tilted planes, spheres and lattices, free droplets, bridges, particles fixed and moving, films,
caps, sheets, cells; contact angles 0.5 to 180, Bond numbers 1e-4 to 1e3, lengths 1e-9 to 1e6,
tensions 1e-6 to 1e6, distorted starts, penalties. Of each is known whether an equilibrium exists
(``True``), is ruled out (``False``), or not (``None``).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from robustness.extreme_kinds import KINDS

import iga_membrane as iga

TOLERANCE = 1e-2
"""Relative error of a measure beyond which a success is a wrong answer."""


@dataclass(frozen=True)
class Extreme:
    """One scene of the hypercube.

    Attributes
    ----------
    kind : name in ``KINDS``; numbers : its place in [0, 1) along each of its directions.
    """

    kind: str
    numbers: tuple[float, ...]

    @property
    def parameters(self) -> dict[str, float]:
        """By name."""
        ranges = KINDS[self.kind].ranges
        found = {}
        for (name, (low, high)), u in zip(ranges.items(), self.numbers, strict=True):
            if low > 0 and high / low > 100:
                found[name] = float(low * (high / low) ** u)
            else:
                found[name] = float(low + (high - low) * u)
        return found

    def scene(self) -> iga.Scene:
        return KINDS[self.kind].scene(**self.parameters)

    def exists(self) -> bool | None:
        """Whether there is an equilibrium: known, ruled out, or not known."""
        known = KINDS[self.kind].exists
        return known(**self.parameters) if callable(known) else known

    def error(self, result: Mapping[str, Any]) -> float:
        """Largest relative error of the measures and laws that are known."""
        kind = KINDS[self.kind]
        expected = kind.expected(result, **self.parameters)
        found = result["measures"] | {k: v for k, v in result["contact"].items() if k != "volume"}
        errors = [
            abs(found[name] - value) / max(abs(value), 1e-300) for name, value in expected.items()
        ]
        errors += [abs(off) for off in kind.defects(result, **self.parameters).values()]
        return float(np.max(errors, initial=0.0))


def latin_hypercube(count, axes, rng):
    """(count, axes) points in the unit cube, as ``scipy.stats.qmc`` draws them, whose argument for
    ``rng`` is called by another name before scipy 1.15."""
    (rng,) = rng.spawn(1)
    within = rng.uniform(size=(count, axes))
    places = np.tile(np.arange(1, count + 1), (axes, 1))
    for row in places:
        rng.shuffle(row)
    return (places.T - within) / count


def extreme_scenes(seed: int, count: int = 300) -> list[Extreme]:
    """A hypercube per kind, in a random order."""
    found = []
    for number, (name, kind) in enumerate(KINDS.items()):
        some = max(1, round(kind.share * count))
        rows = latin_hypercube(some, len(kind.ranges), np.random.default_rng([seed, number]))
        found += [Extreme(name, tuple(row)) for row in rows.tolist()]
    order = np.random.default_rng(seed).permutation(len(found))
    return [found[k] for k in order]


@dataclass(frozen=True)
class Hypercube:
    """Index to scene, for a sweep over processes."""

    seed: int
    count: int

    def __call__(self, index: int) -> iga.Scene:
        return extreme_scenes(self.seed, self.count)[index].scene()


def score(extreme: Extreme, record: Mapping[str, Any]) -> tuple[str, float | None]:
    """How a point ended: ``solved``, ``failed`` (typed), ``refused`` (before any work),
    ``wrong`` (a success that is none) or ``crashed``; and the error of a success."""
    if "result" not in record:
        refused = record["error"].startswith(("SceneError", "GeometryError"))
        return ("refused" if refused else "crashed"), None
    result = record["result"]
    if not result["success"]:
        return "failed", None
    error = extreme.error(result)
    wrong = extreme.exists() is False or not error <= TOLERANCE
    return ("wrong" if wrong else "solved"), error
