"""From a photograph to contact angle and volume, and to the droplet itself.

A camera against the light sees a dark droplet on a dark solid. The script makes such a photograph
of water at 105 degrees, 8 um per pixel with noisy edges, writes it as ``drop.png``, measures it as
one would measure one's own, and solves the droplet that was found.

``python examples/goniometer.py`` prints what was found and draws ``goniometer.png``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

import iga_membrane as iga

WATER = iga.Liquid("72.8 mN/m", "998 kg/m^3")
ANGLE, VOLUME, PIXEL = 105.0, 4e-9, 8e-6


def take_photograph(path: str | Path, seed: int = 0) -> None:
    """The droplet of the script as a camera sees it."""
    plane = iga.Plane(contact_angle=ANGLE)
    drop = iga.solve(iga.sessile_droplet(plane, volume=VOLUME, liquid=WATER, gravity=9.81))
    meridian = np.stack([np.zeros(400), np.linspace(0.0, 1.0, 400)], axis=1)
    x, _, z = drop.surface.at(meridian).position.T / PIXEL
    rows, columns = np.arange(380), np.arange(480)
    height = 330.4 - rows
    order = np.argsort(z)
    half = np.where(
        (height >= 0) & (height <= z.max()), np.interp(height, z[order], x[order]), -9.0
    )
    noise = np.random.default_rng(seed).normal(0.0, 0.4, (2, len(rows)))
    left, right = (half + noise)[:, :, None]
    across = np.minimum(columns - 240.2 + left, right + 240.2 - columns)
    dark = np.clip(np.maximum(across, -height[:, None]) + 0.5, 0.0, 1.0)
    Image.fromarray((215.0 - 190.0 * dark).astype(np.uint8)).save(path)


def main(folder: str | Path = ".", seed: int = 0) -> dict[str, float]:
    """Values, standard errors, and the contact radius of the droplet that was solved."""
    photograph = Path(folder) / "drop.png"
    take_photograph(photograph, seed)
    points = iga.silhouette(photograph, scale="8 um")
    found = iga.fit_profile(points, liquid=WATER, gravity="9.81 m/s^2")
    print(found)
    iga.plot_fit(found, Path(folder) / "goniometer.png")
    return {
        **found.values,
        "angle_error": found.standard_errors["contact_angle"],
        "solved_radius": found.solution.measures["contact_radius"],
    }


if __name__ == "__main__":
    main()
