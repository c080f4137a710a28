"""Photographs of droplets as a camera against the light would take them, from profiles that share
no code with what measures them."""

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import erf

from iga_membrane.reference import profile_on_plane

PIXEL, NOISE = 8e-6, 0.4
WATER = 998.0 * 9.81 / 0.0728


@cache
def sessile(angle, width, weight=WATER):
    """Profile (r, z) and volume of the sessile drop of a width (largest diameter)."""
    volume = 0.5 * width**3
    for _ in range(30):
        length = (3 * volume / (4 * np.pi)) ** (1 / 3)
        r, z = profile_on_plane(weight * length**2, angle, points=1501)
        # the widest place lies between points
        wide = 2 * length * (r.max() if angle <= 90 else _vertex(r))
        if abs(wide / width - 1) < 1e-9:
            break
        volume *= (width / wide) ** 3
    return length * r, length * z, volume


def _vertex(values):
    """The largest value of the parabola through the largest of some values and its neighbours."""
    k = int(values.argmax())
    a, b, c = values[k - 1 : k + 2]
    return b - 0.125 * (c - a) ** 2 / (a - 2 * b + c)


def hanging(curvature, weight, radius):
    """The first drop below a needle that has bulged: profile (r, z), z = 0 at the needle's end,
    and volume; None where no profile of that curvature at its apex comes back to that radius."""

    def slope(s, y):
        r, d, turn, _ = y
        return [np.cos(turn), np.sin(turn), 2 * curvature - weight * d - np.sin(turn) / r,
                np.pi * r * r * np.sin(turn)]  # fmt: skip

    tiny = 1e-6 / curvature
    found = solve_ivp(slope, (tiny, 8 / curvature), [tiny, 0, tiny * curvature, 0], method="DOP853",
                      rtol=1e-10, atol=1e-13 / curvature, dense_output=True)  # fmt: skip
    s = np.linspace(tiny, found.t[-1], 6001)
    r, d, turn, volume = found.sol(s)
    wide = int(np.argmax(turn > 0.5 * np.pi))
    back = np.flatnonzero((r[wide:] < radius) & (turn[wide:] > 0.0))
    if not wide or not len(back) or r[wide] < radius:
        return None
    k = wide + back[0]
    part = (r[k - 1] - radius) / (r[k - 1] - r[k])
    end, full = (
        d[k - 1] + part * (d[k] - d[k - 1]),
        volume[k - 1] + part * (volume[k] - volume[k - 1]),
    )
    return np.append(r[:k], radius), np.append(d[:k] - end, 0.0), full


@cache
def pendant(part, radius, weight=WATER):
    """The drop on a needle at a part of its largest volume, which it has where its neck is as wide
    as the needle: beyond, smaller curvatures have no drop."""
    low, high = 0.2 / radius, 1.0 / radius
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if hanging(middle, weight, radius) else (middle, high)
    largest = hanging(high, weight, radius)[2]
    low, high = high, 1.0 / radius
    for _ in range(50):
        middle = 0.5 * (low + high)
        full = hanging(middle, weight, radius)[2] > part * largest
        low, high = (middle, high) if full else (low, middle)
    return hanging(0.5 * (low + high), weight, radius)


def photograph(
    r, z, *, seed, ground="dark", blur="ramp", needle=None, noise=NOISE, pixel=PIXEL,
    shape=(400, 420), base=340.37, middle=209.81, grey=0.0, levels=(215.0, 25.0),
):  # fmt: skip
    """Image of a profile of revolution (r, z), of which each row's edges are off by normal noise.

    Parameters
    ----------
    ground : "dark", a solid from border to border; "none"; "mirror".
    blur : "ramp" over one pixel, or "gauss" of one pixel.
    needle : its radius, above the base, in the place of the ground.
    base : row of the base line; middle : column of the axis.
    """
    dice = np.random.default_rng(seed)
    rows, columns = np.arange(shape[0]), np.arange(shape[1])
    height = (base - rows) * pixel
    order = np.argsort(z, kind="stable")
    reach = np.abs(height) if ground == "mirror" else height
    half = np.interp(reach, z[order], r[order], left=-1.0, right=-1.0)
    inside = (reach >= min(z.min(), 0.0)) & (reach <= z.max()) & (half > 0)
    if needle is not None:
        half, inside = np.where(height > 0, needle, half), inside | (height > 0)
    edges = half / pixel * inside
    left = middle - edges + noise * dice.standard_normal(shape[0])
    right = middle + edges + noise * dice.standard_normal(shape[0])
    step = _ramp if blur == "ramp" else _gauss
    dark = step(columns - left[:, None]) * step(right[:, None] - columns) * inside[:, None]
    if ground == "dark":
        solid = step(rows - base)[:, None]
        dark = np.maximum(dark, solid)
    elif ground == "none" and needle is None:
        # rows above the base, and the part of the row that it passes through
        covered = step(base - rows)[:, None]
        lowest = np.flatnonzero(inside)[-1]
        dark[lowest + 1 :] = dark[lowest]
        dark = dark * covered
    image = levels[0] + (levels[1] - levels[0]) * dark
    return image + grey * dice.standard_normal(image.shape)


def _ramp(distance):
    return np.clip(distance + 0.5, 0.0, 1.0)


def _gauss(distance):
    return 0.5 * (1.0 + erf(distance / np.sqrt(2.0)))
