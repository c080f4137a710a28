"""Choices of a solve, checked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from ..arguments import checked
from ..checks import integer, number, state_file
from ..files import check_folder


@dataclass(frozen=True)
@checked(
    "solver",
    tolerance=partial(number, least=1e-14, most=1e-2),
    max_iterations=partial(integer, least=1, most=100_000),
    min_load_step=partial(number, least=1e-9, most=1.0),
    quadrature=partial(integer, least=1, most=64),
    start=state_file,
    checkpoint=state_file,
)
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
    stability : "full", the verdict is that of the whole body whatever part of it is computed; or
        "model", it is that within the symmetry of the computed part.
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
    stability: str = "full"
    start: str | Path | None = None
    checkpoint: str | Path | None = None

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
