"""Typed errors: every message states the rule, the value and the remedy."""

from __future__ import annotations

from typing import Any


class SceneError(ValueError):
    """The question is ill-posed: a field has a value that no scene can have.

    Raised before any assembly. The message names the field, the value, the allowed range and,
    where there is one, the remedy.
    """


class GeometryError(ValueError):
    """A surface is not a surface: folded, degenerate or with a non-finite control point."""


class OutputError(OSError):
    """A result cannot be written where it was asked for."""


class StateError(ValueError):
    """A state file cannot be trusted: corrupt, cut off, foreign, newer, or of another scene."""


class SolveError(RuntimeError):
    """A solve that did not end in ``CONVERGED_STABLE``.

    Attributes
    ----------
    solution : iga_membrane.Solution
        The best state found, with its status, history and measures.
    """

    def __init__(self, message: str, solution: Any = None) -> None:
        super().__init__(message)
        self.solution = solution
