"""Axisymmetric liquid bridges between two solids, spheres or planes: Young and Laplace by
Chebyshev collocation.

Along the meridian from the lower solid to the upper, with inclination ``psi`` to the r axis and
length S, by the part of the length: ``r' = S cos(psi)``, ``z' = S sin(psi)``,
``psi' = S (p - Bo z - sin(psi) / r)``. The ends lie on the solids at ways l from the axis and meet
them at their contact angles, which may be 0. Newton's method follows the solution from the
cylinder of the same volume, whose contact angles are known, through the angles and then the weight.
As the volume is prescribed, its matrix is singular where axisymmetric stability is lost, at a fold
or where a branch of less symmetry begins.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NODES = 57
"""Nodes of a meridian: measures differ by less than 1e-10 from those of 81."""


@dataclass(frozen=True, eq=False)
class Bridge:
    """A liquid bridge, the lower solid's point on the axis at z = 0, tension 1.

    Attributes
    ----------
    r, z : (NODES,) the meridian at Chebyshev nodes, upwards; inclination : of it, radians.
    pressure : liquid minus gas, at z = 0.
    force : of the liquid on the upper solid, positive = attraction.
    neck_radius : least radius of the meridian.
    contact_radius_lower, contact_radius_upper : of the contact lines.
    A_LG, A_wet : areas; E_surf : energy of the surfaces.
    turns : sign of the determinant of Newton's matrix: it differs between bridges of a family on
        both sides of a loss of axisymmetric stability.
    """

    r: Array
    z: Array
    inclination: Array
    pressure: float
    force: float
    neck_radius: float
    contact_radius_lower: float
    contact_radius_upper: float
    A_LG: float
    A_wet: float
    E_surf: float
    turns: float


def bridge_between(
    radii: tuple[float, float],
    contact_angles: tuple[float, float],
    gap: float,
    volume: float,
    bond: float = 0.0,
) -> Bridge:
    """The bridge that is met first on the way from a cylinder.

    Parameters
    ----------
    radii : of the lower and the upper sphere, infinite for planes.
    contact_angles : degrees, 0 <= angle <= 180.
    gap : shortest distance between the solids.
    bond : ``rho g / gamma``, gravity along -z.

    Raises
    ------
    ValueError
        No cylinder of the volume fits between the solids, or the way from it ends at a fold.
    """
    problem = _Problem(radii, gap, volume)
    state, angles = problem.cylinder()
    asked = np.radians(contact_angles)
    state = problem.followed(state, (*angles, 0.0), (*asked, 0.0))
    if bond:
        state = problem.followed(state, (*asked, 0.0), (*asked, bond))
    return problem.measured(state, (*asked, bond))


def limit_of_stability(
    radii: tuple[float, float],
    contact_angles: tuple[float, float],
    gaps: tuple[float, float],
    volume: float,
) -> float:
    """The gap between two at which axisymmetric stability is lost, at a fold or a bifurcation.

    Raises
    ------
    ValueError
        Stability is not lost between them, or more than once.
    """
    from scipy.optimize import brentq

    def turns(gap: float) -> float:
        try:
            return bridge_between(radii, contact_angles, gap, volume).turns
        except ValueError:
            return -first

    first = bridge_between(radii, contact_angles, gaps[0], volume).turns
    low, high = gaps
    if turns(high) == first:
        raise ValueError(f"no loss of stability between the gaps {low:g} and {high:g}")
    return float(brentq(lambda gap: turns(gap), low, high, xtol=1e-7 * high))


class _Problem:
    """Equations of a bridge between solids of curvatures ``bend``; a state is the values of r, z
    and psi at the nodes, then p, S and the ways l of both ends."""

    def __init__(self, radii: tuple[float, float], gap: float, volume: float) -> None:
        self.bend = 1.0 / np.asarray(radii, float)
        self.gap, self.volume = gap, volume
        n = NODES - 1
        k = np.arange(NODES)
        x = -np.cos(np.pi * k / n)
        c = np.where((k == 0) | (k == n), 2.0, 1.0) * (-1.0) ** k
        apart = x[:, None] - x + np.eye(NODES)
        slope = np.outer(c, 1.0 / c) / apart
        self.slope = 2.0 * (slope - np.diag(slope.sum(axis=1)))
        # Clenshaw and Curtis: integrals of the Chebyshev polynomials of even order
        even = np.arange(0, n + 1, 2)
        half = np.where((even == 0) | (even == n), 0.5, 1.0)
        turn = np.cos(np.outer(np.pi * k / n, even))
        self.weights = turn @ (half * 4.0 / (1.0 - even**2)) / n
        self.weights[[0, -1]] *= 0.5

    def end(self, way: Array) -> tuple[Array, Array, Array, Array]:
        """Radius, depth, polar angle and cap volume of the circles at the ways (2,)."""
        polar = self.bend * way
        r = np.sinc(polar / np.pi) * way
        depth = 0.5 * np.sinc(0.5 * polar / np.pi) ** 2 * way * polar
        return r, depth, polar, np.pi * depth / 6.0 * (3.0 * r**2 + depth**2)

    def cylinder(self) -> tuple[Array, Array]:
        """The cylinder's state and its contact angles."""
        from scipy.optimize import brentq

        def ways(radius: float) -> Array:
            sine = self.bend * radius
            return radius * np.where(sine > 0.0, np.arcsin(sine) / np.where(sine, sine, 1.0), 1.0)

        def excess(radius: float) -> float:
            _, depth, _, cap = self.end(ways(radius))
            return float(np.pi * radius**2 * (self.gap + depth.sum()) - cap.sum() - self.volume)

        widest = min(1.0 / max(self.bend.max(), 1e-300), 10.0 * np.sqrt(self.volume / self.gap))
        if excess(widest) < 0.0:
            raise ValueError(f"volume = {self.volume:g}: no cylinder of it fits between the solids")
        radius = float(brentq(excess, 1e-6 * widest, widest, xtol=1e-14 * widest))
        way = ways(radius)
        _, depth, polar, _ = self.end(way)
        length = self.gap + float(depth.sum())
        t = 0.5 + 0.5 * -np.cos(np.pi * np.arange(NODES) / (NODES - 1))
        one = np.ones(NODES)
        state = [radius * one, -depth[0] + length * t, 0.5 * np.pi * one]
        return np.concatenate([*state, [1.0 / radius, length, *way]]), 0.5 * np.pi - polar

    def equations(self, state: Array, load: tuple[float, ...]) -> tuple[Array, Array]:
        """Residuals and their matrix, for contact angles (radians) and a Bond number."""
        n, d = NODES, self.slope
        r, z, psi = state[: 3 * n].reshape(3, n)
        p, length, way = state[3 * n], state[3 * n + 1], state[3 * n + 2 :]
        one, two, bond = load
        cosine, sine = np.cos(psi), np.sin(psi)
        bent = p - bond * z - sine / r
        edge, depth, polar, cap = self.end(way)
        f = np.zeros(3 * n + 4)
        m = np.zeros((3 * n + 4, 3 * n + 4))
        at = [slice(k * n, (k + 1) * n) for k in range(3)]
        for k, rate in enumerate((cosine, sine, bent)):
            f[at[k]] = d @ state[at[k]] - length * rate
            m[at[k], at[k]] = d
            m[at[k], 3 * n + 1] = -rate
        m[at[0], at[2]] += np.diag(length * sine)
        m[at[1], at[2]] -= np.diag(length * cosine)
        m[at[2], at[0]] -= np.diag(length * sine / r**2)
        m[at[2], at[1]] += np.eye(n) * (length * bond)
        m[at[2], at[2]] += np.diag(length * cosine / r)
        m[at[2], 3 * n] = -length
        # the first node of each has its value at the lower solid instead
        first = [k * n for k in range(3)]
        m[first] = 0.0
        f[first] = r[0] - edge[0], z[0] + depth[0], psi[0] - (np.pi - polar[0] - one)
        m[first, first] = 1.0
        m[first, 3 * n + 2] = -np.cos(polar[0]), np.sin(polar[0]), self.bend[0]
        last = [3 * n, 3 * n + 1, 3 * n + 2]
        f[last] = r[-1] - edge[1], z[-1] - self.gap - depth[1], psi[-1] - polar[1] - two
        m[last, [n - 1, 2 * n - 1, 3 * n - 1]] = 1.0
        m[last, 3 * n + 3] = -np.cos(polar[1]), -np.sin(polar[1]), -self.bend[1]
        w = 0.5 * np.pi * self.weights
        f[-1] = length * (w * r**2) @ sine - cap.sum() - self.volume
        m[-1, at[0]] = 2.0 * length * w * r * sine
        m[-1, at[2]] = length * w * r**2 * cosine
        m[-1, 3 * n + 1] = (w * r**2) @ sine
        m[-1, 3 * n + 2 :] = -np.pi * edge**2 * np.sin(polar)
        return f, m

    def solved(self, state: Array, load: tuple[float, ...]) -> Array | None:
        """Newton's method; None where it fails or leaves the meridians."""
        size = self.volume ** (1.0 / 3.0)
        for _ in range(12):
            f, m = self.equations(state, load)
            step = np.linalg.solve(m, -f)
            state = state + step
            if not (np.isfinite(state).all() and state[:NODES].min() > 0.0):
                return None
            if np.abs(step[: 2 * NODES]).max() < 1e-11 * size:
                return state
        return None

    def followed(self, state: Array, begin: tuple[float, ...], end: tuple[float, ...]) -> Array:
        """The state along straight lines of loads, in steps that halve where Newton fails."""
        done, step = 0.0, 0.25
        while done < 1.0:
            part = min(1.0, done + step)
            load = tuple(a + part * (b - a) for a, b in zip(begin, end, strict=True))
            found = self.solved(state, load)
            near = found is not None and np.abs(found - state)[2 * NODES : 3 * NODES].max() < 0.7
            if found is not None and near:
                state, done, step = found, part, 1.5 * step
                continue
            step *= 0.5
            if step < 1e-6:
                raise ValueError(f"the bridge ends at a fold after {done:.6f} of the way to it")
        return state

    def measured(self, state: Array, load: tuple[float, ...]) -> Bridge:
        n = NODES
        r, z, psi = state[: 3 * n].reshape(3, n)
        p, length, way = float(state[3 * n]), state[3 * n + 1], state[3 * n + 2 :]
        edge, depth, _, cap = self.end(way)
        bond = load[2]
        level = p - bond * z[-1]
        force = 2.0 * np.pi * r[-1] * np.sin(psi[-1]) - np.pi * r[-1] ** 2 * level - bond * cap[1]
        wet = np.pi * (edge**2 + depth**2)
        area = np.pi * length * self.weights @ r
        sign, _ = np.linalg.slogdet(self.equations(state, load)[1])
        return Bridge(
            r, z, psi, p, float(force), self._neck(r), float(edge[0]), float(edge[1]),
            float(area), float(wet.sum()), float(area - np.cos(load[:2]) @ wet), float(sign),
        )  # fmt: skip

    def _neck(self, r: Array) -> float:
        series = np.polynomial.Chebyshev.fit(
            -np.cos(np.pi * np.arange(NODES) / (NODES - 1)), r, NODES - 1, domain=[-1.0, 1.0]
        )
        return float(series(np.linspace(-1.0, 1.0, 20001)).min())
