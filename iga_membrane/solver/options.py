"""Choices of a solve, checked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from ..checks import flag, integer, number
from ..errors import SceneError
from ..files import check_folder

ON_FAIL = ("raise", "return")
"""What to do with a solution that is no success."""


@dataclass(frozen=True)
class SolverOptions:
    """How to solve; every tolerance is relative to the scene's own length and tension.

    Attributes
    ----------
    tolerance : largest displacement of the last Newton step over the scene's length.
    max_iterations : Newton iterations at one load.
    min_load_step : load stepping stops below this part of the load.
    quadrature : Gauss points per direction; if None ``degree + 1``, but ``degree`` (at least 3)
        round a smooth ring.
    max_cpu_s : CPU seconds of the solve's own thread after which it stops, INTERRUPTED.
    max_memory_gb : a scene whose matrices would need more is refused.
    audit : whether to check the result on an independent path; without it, UNVERIFIED.
    follow_instability : whether to go on from an unstable equilibrium, along its softest mode, to
        the next one below (:mod:`.saddle`), within the symmetry of the model. The way is not the
        droplet's own: of several stable states it may find another than the liquid would.
    start : a state file to start from, or to go on from where a path of loads was interrupted.
    checkpoint : a state file to be written after every converged load step. Its folder is checked
        before any work; a disk that fills up later is a warning, and the step before stays.
    """

    tolerance: float = 1e-8
    max_iterations: int = 50
    min_load_step: float = 5e-4
    quadrature: int | None = None
    max_cpu_s: float = 600.0
    max_memory_gb: float = 8.0
    audit: bool = True
    follow_instability: bool = False
    start: str | Path | None = None
    checkpoint: str | Path | None = None

    def __post_init__(self) -> None:
        number("solver.tolerance", self.tolerance, least=1e-14, most=1e-2)
        integer("solver.max_iterations", self.max_iterations, least=1, most=100_000)
        number("solver.min_load_step", self.min_load_step, least=1e-9, most=1.0)
        if self.quadrature is not None:
            integer("solver.quadrature", self.quadrature, least=1, most=64)
        number("solver.max_cpu_s", self.max_cpu_s, above=0.0)
        number("solver.max_memory_gb", self.max_memory_gb, above=0.0)
        flag("solver.audit", self.audit)
        flag("solver.follow_instability", self.follow_instability)
        for name in ("start", "checkpoint"):
            path = getattr(self, name)
            if path is not None and Path(path).suffix != ".npz":
                raise SceneError(f"solver.{name} = {str(path)!r}: must be a state file, .npz")

    def check_folder(self) -> None:
        """Make the folder of the checkpoint and prove that it can be written.

        Raises
        ------
        OutputError
        """
        if self.checkpoint is not None:
            check_folder(Path(self.checkpoint).parent)

    def numerical(self) -> SolverOptions:
        """The choices that change numbers, without files and limits."""
        plain = SolverOptions()
        return replace(
            self,
            start=None,
            checkpoint=None,
            max_cpu_s=plain.max_cpu_s,
            max_memory_gb=plain.max_memory_gb,
        )
