"""The point of a surface that lies farthest along a direction or from an axis."""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Mask
from ..surface.kinematics import Kinematics
from ..surface.surface import Surface

SAMPLE = 17, 41
"""Points along both parameters among which those to climb from are found, one on each line."""
STEPS = 25
"""Evaluations at most on the way up; a smooth maximum takes about eight."""
ARRIVED = 1e-9
"""Step over the parameters' range at which a maximum is reached: its value is right to rounding."""


def highest(surface: Surface, up: Array) -> Array:
    """(3,) point that lies farthest along a direction (3,)."""
    return _farthest(surface, up, np.zeros(3), np.zeros((3, 3)))


def widest(surface: Surface, middle: Array) -> Array:
    """(3,) point farthest from the vertical axis through a point (2,)."""
    return _farthest(surface, np.zeros(3), np.append(middle, 0.0), np.diag([1.0, 1.0, 0.0]))


def narrowest(surface: Surface, middle: Array) -> Array:
    """(3,) point nearest to the vertical axis through a point (2,)."""
    return _farthest(surface, np.zeros(3), np.append(middle, 0.0), -np.diag([1.0, 1.0, 0.0]))


def _farthest(surface: Surface, slope: Array, middle: Array, bend: Array) -> Array:
    """Where ``slope . x + 1/2 (x - middle) . bend (x - middle)`` is largest: Newton's method from
    several starts, its steps uphill as every eigenvalue of the Hessian counts by its size."""
    bases = surface.space.bases
    low = np.array([basis.breaks[0] for basis in bases])
    high = np.array([basis.breaks[-1] for basis in bases])

    def value(x: Array) -> Array:
        away = x - middle
        return np.asarray(x @ slope + 0.5 * np.einsum("...i,...i->...", away @ bend, away))

    ticks = [np.linspace(a, b, n) for a, b, n in zip(low, high, SAMPLE, strict=True)]
    grid = np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1)
    first = value(surface.at(grid, 1).position).argmax(axis=1)
    place = np.take_along_axis(grid, first[:, None, None], axis=1)[:, 0]
    best, step = np.full(len(place), -np.inf), np.zeros_like(place)
    point = np.zeros((len(place), 3))
    for _ in range(STEPS):
        trial = place + step
        if bases[0].periodic:
            trial[:, 0] = low[0] + np.mod(trial[:, 0] - low[0], high[0] - low[0])
        trial = np.clip(trial, low, high)
        k = surface.at(trial, 2)
        found = value(k.position)
        better = found > best
        step *= 0.25
        if better.any():
            place[better], best[better], point[better] = (
                trial[better], found[better], k.position[better]
            )  # fmt: skip
            stuck = (trial <= low) & [not bases[0].periodic, True], trial >= high
            uphill = _uphill(k, slope + (k.position - middle) @ bend, bend, stuck)
            longest = (high - low) / (np.array(SAMPLE) - 1.0)
            step[better] = np.clip(uphill, -longest, longest)[better]
        if (np.abs(step[best.argmax()]) < ARRIVED * (high - low)).all():
            break
    return np.asarray(point[best.argmax()])


def _uphill(k: Kinematics, slope: Array, bend: Array, stuck: tuple[Mask, Mask]) -> Array:
    """(n, 2) steps of the parameters.

    Parameters
    ----------
    slope : (n, 3) gradient in space; bend : (3, 3) its derivative.
    stuck : (n, 2) each, whether a parameter can become no smaller, or no larger.
    """
    tangents, second = k.tangents, k.second
    assert second is not None
    gradient = np.einsum("nai,ni->na", tangents, slope)
    free = ~((stuck[0] & (gradient < 0.0)) | (stuck[1] & (gradient > 0.0)))
    both = free[:, :, None] & free[:, None, :]
    gradient = gradient * free
    hessian = np.einsum("nai,ij,nbj->nab", tangents, bend, tangents)
    hessian = (hessian + np.einsum("nabi,ni->nab", second, slope)) * both
    metric = np.einsum("nai,nbi->nab", tangents, tangents) * both
    # poles have no metric along their ring
    size = np.trace(metric, axis1=1, axis2=2)[:, None, None]
    size = np.where(size > 0.0, size, 1.0)
    metric = metric + np.eye(2) * np.where(free[:, :, None], 1e-12 * size, size)
    root = np.linalg.inv(np.linalg.cholesky(metric))
    values, modes = np.linalg.eigh(root @ hessian @ np.swapaxes(root, 1, 2))
    along = np.einsum("nab,nb->na", np.swapaxes(modes, 1, 2) @ root, gradient)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.where(along == 0.0, 0.0, along / np.abs(values))
    return np.nan_to_num(np.einsum("nba,nb->na", np.swapaxes(modes, 1, 2) @ root, along))
