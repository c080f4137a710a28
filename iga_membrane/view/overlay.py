"""A profile laid over the photograph that it was measured in."""

from __future__ import annotations

import os

import numpy as np

from ..arguments import checked
from ..photograph.fit import ProfileFit
from ..quantities import labelled
from .figure import figure, write_figure

CURVE, USED, LEFT_OUT, BASE = "#ff9f1c", "#2ec4b6", "#e71d36", "#e71d36"
AROUND = 0.25
"""Of the droplet's size, shown beyond it on every side."""


@checked()
def plot_fit(fit: ProfileFit, path: str | os.PathLike[str]) -> None:
    """Draw a profile, its points and its base line, over the photograph if there is one.

    Parameters
    ----------
    fit : what :func:`iga_membrane.fit_profile` found.
    path : of the picture; its ending chooses the format (.png, .pdf, .svg).

    Raises
    ------
    OutputError
        If the file cannot be written, or matplotlib is not installed.
    """
    made, axes = figure(path)
    x = fit.points[:, 0]
    beside = (1.0 + AROUND) * np.array([x.min(), x.max()])
    base = np.stack([beside, np.full(2, fit.values.get("base", 0.0))], axis=1)
    shown = {"points": fit.points, "curve": fit.curve, "base": base}
    axes.set_aspect("equal")
    if fit.camera is None:
        axes.set(xlabel=labelled("x", "x", fit.units), ylabel=labelled("z", "z", fit.units))
    else:
        shown = {name: fit.camera.pixels(each) for name, each in shown.items()}
        axes.imshow(fit.camera.image, cmap="gray", vmin=-0.1, vmax=1.1)
        low, high = shown["points"].min(axis=0), shown["points"].max(axis=0)
        wide = AROUND * float((high - low).max())
        axes.set(xlim=(low[0] - wide, high[0] + wide), ylim=(high[1] + wide, low[1] - wide))
        axes.set_axis_off()
    axes.plot(*shown["base"].T, "--", color=BASE, lw=0.8)
    axes.plot(*shown["points"][fit.used].T, ".", color=USED, ms=1.5)
    axes.plot(*shown["points"][~fit.used].T, "x", color=LEFT_OUT, ms=3)
    axes.plot(*shown["curve"].T, color=CURVE, lw=1.0)
    told = ", ".join(f"{_word(name)} {fit.told(name)}" for name in NAMED if name in fit.values)
    axes.set_title(told.replace("+-", "±").replace(" deg", "°"), fontsize=8)
    write_figure(made, path)


NAMED = ("contact_angle", "volume", "surface_tension", "angle_front", "angle_rear")
"""Values that stand in the title."""


def _word(name: str) -> str:
    return name.replace("_", " ")
