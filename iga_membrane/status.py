"""How a solve can end."""

from __future__ import annotations

from enum import Enum


class Status(Enum):
    """Named end of a solve; only ``CONVERGED_STABLE`` is a success."""

    CONVERGED_STABLE = "converged, audited and stable"
    CONVERGED_SADDLE = "converged to an unstable equilibrium"
    CONVERGED_MARGINAL = "converged, stability undecided"
    LIMIT_POINT = "no equilibrium beyond the given load"
    NO_EQUILIBRIUM = "nothing balances the load"
    TOPOLOGY_CHANGE = "the liquid detaches, merges, pinches or touches"
    STALLED = "the iteration stopped making progress"
    MAX_ITER = "the iteration limit was reached"
    LINEAR_SOLVE_FAILED = "the linear system could not be solved"
    NONFINITE = "a quantity became infinite or undefined"
    PENETRATION = "the membrane lies inside a solid"
    UNDERRESOLVED = "the mesh is too coarse for this scene"
    INTERRUPTED = "stopped from outside"
    UNVERIFIED = "converged, audit switched off"


REMEDY = {
    Status.STALLED: "start nearer to the solution, or take more discretization.elements",
    Status.MAX_ITER: "start nearer to the solution, take more discretization.elements, or raise "
    "max_iterations",
    Status.LINEAR_SOLVE_FAILED: "hold what is free to move, or change discretization.elements",
    Status.NONFINITE: "start nearer to the solution, clear of the centres of spheres",
    Status.INTERRUPTED: "raise solver.max_cpu_s",
}
"""What to change after an iteration that did not converge."""
