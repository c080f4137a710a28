"""Taylor test: with exact derivatives the remainder must fall with the step at its order."""

from __future__ import annotations

import numpy as np

STEPS = 2.0 ** -np.arange(8, 14)


def remainder_slopes(value, gradient, curvature):
    """Smallest slopes of the first and the second remainder.

    Parameters
    ----------
    value : step -> float, a function along a direction.
    gradient, curvature : its exact first and second derivative at 0.
    """
    start = value(0.0)
    first = np.array([abs(value(h) - start - h * gradient) for h in STEPS])
    second = np.array(
        [abs(value(h) - start - h * gradient - 0.5 * h**2 * curvature) for h in STEPS]
    )
    floor = 1e-13 * abs(start)
    return _slope(first, floor), _slope(second, floor)


def lagrangian(assembly, surface, multipliers, motion, direction):
    """Step -> Lagrangian of a state moved along a direction of the unknowns."""

    def value(step):
        moved = surface.moved(surface.points + motion.displacement(step * direction))
        energies = assembly.energies(moved)
        return energies.total - multipliers @ energies.constraints

    return value


def lagrangian_slopes(assembly, surface, multipliers, motion, direction):
    """Slopes of the remainders of an assembly's Lagrangian with its own gradient and Hessian."""
    system = assembly.system(surface, motion.directions, multipliers)
    gradient = system.residual(multipliers) @ direction
    curvature = direction @ (system.matrix @ direction)
    value = lagrangian(assembly, surface, multipliers, motion, direction)
    return remainder_slopes(value, gradient, curvature)


def _slope(errors, floor):
    """Median rate between the last halvings at which the remainder is above rounding."""
    keep = errors[errors > floor][-4:]
    if len(keep) < 3:
        return np.inf  # the remainder is rounding: the function is a polynomial of lower degree
    return np.median(np.log2(keep[:-1] / keep[1:]))
