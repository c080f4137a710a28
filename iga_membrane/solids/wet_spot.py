"""How a membrane is carried by the wet spot on top of a small sphere.

The membrane wets a sphere of radius r up to the polar angle phi and leaves it at the contact angle
theta, so it falls off at the angle phi - psi, ``psi = pi - theta``. In radii, and with the force f
on the sphere over ``2 pi gamma r``,

    u = sin(phi) sin(phi - psi) + q sin(phi)^2,   q = p r / 2 gamma,

which is negative where the sphere pulls. Beside the spot a membrane of small slope under the
pressure p falls off by ``u log(. / sin(phi))`` less ``q (.^2 - sin(phi)^2) / 2``. A mesh that does
not resolve the spot carries it on a ring of radius c and cuts the logarithm off at a radius b
instead, so that its ring is

    D = 1 - cos(phi) + u log(b / sin(phi)) + q (sin(phi)^2 - c^2) / 2

below the sphere's top, while the membrane that it stands for is held by the spot. With
``k sin(psi') = sin(psi)``, ``k cos(psi') = cos(psi) + q`` the load is ``k sin(phi)
sin(phi - psi')``, at least ``-k sin(psi' / 2)^2``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask

STIFFEST = 0.144
"""``dD/du`` below which a spring goes on with the same stiffness."""
SAMPLES = 60
"""Polar angles among which the first so stiff one is looked for."""
HALVINGS, STEPS = 12, 6
"""Bisections and Newton steps that find a polar angle."""


@dataclass(frozen=True, eq=False)
class Carried:
    """What spots carry: u, ``du/dD`` and the work done on them over ``2 pi gamma r^2``, each as
    the depths."""

    load: Array
    stiffness: Array
    work: Array


class WetSpots:
    """Springs that stand for wet spots on spheres.

    Parameters
    ----------
    psi : pi minus the contact angles, in radians.
    cutoff : radii b at which the mesh cuts the logarithm off, over those of the spheres.
    ring : radii c, over those of the spheres.
    pressure : q, half the pressure over the tension, times the spheres' radii.

    Attributes
    ----------
    touching, lowest : depths D at which a dry sphere is met, and a wet one pulls most.
    """

    def __init__(self, psi: Array, cutoff: Array, ring: Array, pressure: Array) -> None:
        self._factor, self._psi = _leaving(psi, pressure)
        self._cutoff, self._pressure = cutoff, pressure
        self.touching = -0.5 * pressure * ring**2
        self._least = 0.5 * psi
        self._most = self._first_stiffest()
        self._end = self._depth(self._most)
        self.lowest = self._depth(self._least)

    def carried(self, depth: Array) -> Carried:
        """By spots whose spheres' tops are at depths D above the mesh."""
        inside = np.clip(depth, self.lowest, self._end)
        phi = self._polar(inside)
        load, rise = self._load(phi), self._rise(phi)
        with np.errstate(divide="ignore", invalid="ignore"):
            stiffness = np.where(phi > self._least, rise / self._slope(phi), 0.0)
        less, more = np.minimum(depth - self.lowest, 0.0), np.maximum(depth - self._end, 0.0)
        steep = stiffness * (more > 0.0)
        work = self._work(phi) + load * (less + more) + 0.5 * steep * more**2
        return Carried(load + steep * more, np.where(less < 0.0, 0.0, stiffness), work)

    def size(self, load: Array) -> Array:
        """Radii of the spots, over those of the spheres, for loads u."""
        return np.sin(_polar_angle(load / self._factor, self._psi))

    def _load(self, phi: Array) -> Array:
        return np.asarray(self._factor * np.sin(phi) * np.sin(phi - self._psi))

    def _rise(self, phi: Array) -> Array:
        """``du/dphi``"""
        return np.asarray(self._factor * np.sin(2.0 * phi - self._psi))

    def _depth(self, phi: Array) -> Array:
        sine = np.maximum(np.sin(phi), 1e-300)
        line = self._load(phi) * np.log(self._cutoff / sine)
        return self.touching + 1.0 - np.cos(phi) + line + 0.5 * self._pressure * sine**2

    def _slope(self, phi: Array) -> Array:
        """``dD/dphi``"""
        sine, cosine = np.maximum(np.sin(phi), 1e-300), np.cos(phi)
        line = self._rise(phi) * np.log(self._cutoff / sine)
        line -= self._factor * cosine * np.sin(phi - self._psi)
        return np.asarray(sine * (1.0 + self._pressure * cosine) + line)

    def _work(self, phi: Array) -> Array:
        """``int u dD`` from a dry sphere on, the small neck before the largest pull included."""
        sine = np.maximum(np.sin(phi), 1e-300)
        line = 0.5 * self._load(phi) ** 2 * np.log(self._cutoff / sine)
        return line + self._rest(phi) - self._rest(np.zeros_like(phi))

    def _rest(self, t: Array) -> Array:
        """Antiderivative of ``u sin(t) - u^2 cot(t) / 2 + q u sin(t) cos(t)``."""
        psi, k = self._psi, self._factor
        one = -0.5 * np.cos(t - psi) + np.cos(3.0 * t - psi) / 12.0 - 0.25 * np.cos(t + psi)
        two = -0.125 * np.cos(2.0 * t) + np.cos(4.0 * t - 2.0 * psi) / 32.0
        two -= 0.125 * t * np.sin(2.0 * psi)
        three = 0.25 * np.cos(4.0 * t - psi) - t * np.sin(psi)
        three -= 0.5 * (np.cos(2.0 * t - psi) + np.cos(2.0 * t + psi))
        return np.asarray(k * (one - 0.5 * k * two + 0.125 * self._pressure * three))

    def _first_stiffest(self) -> Array:
        """Polar angles up to which the springs are softer than the stiffest; at most the
        equator's."""
        part = np.linspace(0.0, 1.0, SAMPLES + 1)[1:].reshape(-1, *([1] * self._least.ndim))
        most = 0.5 * np.pi
        phi = self._least + part * (most - self._least)
        stiff = self._spare(phi) <= 0.0
        first = np.argmax(stiff, axis=0)
        high = np.where(stiff.any(axis=0), np.take_along_axis(phi, first[None], axis=0)[0], most)
        low = np.where(stiff.any(axis=0), high - (most - self._least) / SAMPLES, most)
        for _ in range(40):
            middle = 0.5 * (low + high)
            soft = self._spare(middle) > 0.0
            low, high = np.where(soft, middle, low), np.where(soft, high, middle)
        return low

    def _spare(self, phi: Array) -> Array:
        return self._slope(phi) - STIFFEST * self._rise(phi)

    def _polar(self, depth: Array) -> Array:
        """Polar angles for depths between the lowest and the stiffest."""
        low, high = self._least, self._most
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            beyond = self._depth(middle) > depth
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        phi = 0.5 * (low + high)
        for _ in range(STEPS):
            step = (self._depth(phi) - depth) / np.maximum(self._slope(phi), 1e-300)
            phi = np.clip(phi - step, low, high)
        return np.where(depth > self.lowest, phi, self._least)


def spot_radius(load: Array, psi: Array, pressure: Array) -> Array:
    """Radii of spots that carry loads u, all over those of the spheres.

    Parameters
    ----------
    psi, pressure : as of :class:`WetSpots`.
    """
    factor, turned = _leaving(psi, pressure)
    return np.asarray(np.sin(_polar_angle(load / factor, turned)))


def held(depth: Array, touching: Array, lowest: Array, before: Mask) -> Mask:
    """Which spheres are wet: those that the membrane meets, and those wet ``before`` that it has
    not been torn off, by more than the largest pull."""
    return np.asarray((depth > touching) | (before & (depth > lowest)))


def _leaving(psi: Array, pressure: Array) -> tuple[Array, Array]:
    """k and psi'."""
    across, along = np.sin(psi), np.cos(psi) + pressure
    return np.hypot(across, along), np.arctan2(across, along)


def _polar_angle(load: Array, psi: Array) -> Array:
    """Polar angles with ``sin(phi) sin(phi - psi) = (cos(psi) - cos(2 phi - psi)) / 2`` given."""
    return np.asarray(0.5 * (psi + np.arccos(np.clip(np.cos(psi) - 2.0 * load, -1.0, 1.0))))
