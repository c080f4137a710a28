"""Diagrams of sweeps and paths: curves of a column, and phases over two parameters."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import partial
from typing import Any, Protocol, runtime_checkable

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import either, items, text
from ..errors import SceneError
from ..quantities import DIMENSIONLESS, labelled
from .figure import figure, write_figure

LABELS = {
    "angle": "contact angle (deg)",
    "acceleration": "acceleration of gravity",
    "bond": "Bond number",
    "bond_number": "Bond number",
    "F_e_z": "vertical force on the particle",
}
"""Column to what is written on an axis; other columns stand for themselves."""


STYLES = ("-", "--", ":", "-.")
"""Of the lines of several columns."""


@runtime_checkable
class Table(Protocol):
    """What has columns: a sweep or a path."""

    def column(self, name: str) -> Array:
        """(rows,) numbers."""


@checked(y=either(text, partial(items, each=text, least=1)))
def plot_curves(
    table: Table,
    path: str | os.PathLike[str],
    *,
    x: str,
    y: str | Sequence[str],
    by: str | None = None,
) -> None:
    """Draw columns of a sweep or path against another.

    Parameters
    ----------
    table : an :class:`iga_membrane.Sweep` or :class:`iga_membrane.Path`.
    path : of the picture; its ending chooses the format (.png, .pdf, .svg).
    x : parameter or measure along the axis, "contact_angle".
    y : one or several measures or forces, "F_e_z".
    by : parameter with a curve of its own for each of its values.

    Raises
    ------
    SceneError
        A column without any number.
    OutputError
        If the file cannot be written, or matplotlib is not installed.
    """
    names = [y] if isinstance(y, str) else list(y)
    across = _column(table, x)
    groups = np.zeros(len(across)) if by is None else _column(table, by)
    made, axes = figure(path)
    for k, name in enumerate(names):
        values = _column(table, name)
        for j, group in enumerate(np.unique(groups)):
            some = np.flatnonzero((groups == group) & np.isfinite(values))
            some = some[np.argsort(across[some], kind="stable")]
            first = f"{group:g}" if by is not None and k == 0 else None
            look = {"ls": STYLES[k % len(STYLES)], "color": f"C{j}"}
            axes.plot(across[some], values[some], marker=".", label=first, **look)
    low, high = axes.get_ylim()
    if low < 0.0 < high:
        axes.axhline(0.0, color="0.6", lw=0.8, zorder=0)
    axes.set(xlabel=_label(x, table), ylabel=_label(names[0], table) if len(names) == 1 else "")
    if by is not None:
        axes.legend(title=_label(by, table), title_fontsize=8, frameon=False, fontsize=8)
    if len(names) > 1:
        _tell_styles(
            made, axes, [_label(name, table) for name in names], "C0" if by is None else "black"
        )
    write_figure(made, path)


def _tell_styles(made: Any, axes: Any, told: Sequence[str], color: str) -> None:
    """A legend of the styles of several columns."""
    styles = [axes.plot([], [], ls, color=color)[0] for ls in STYLES[: len(told)]]
    made.legend(styles, told, loc="outside upper center", ncols=2, frameon=False, fontsize=8)


@checked()
def plot_phases(
    table: Table,
    path: str | os.PathLike[str],
    *,
    x: str,
    y: str,
    of: str,
    names: tuple[str, str] = ("no", "yes"),
    curve: tuple[str, Array, Array] | None = None,
) -> None:
    """Draw where over two parameters a column is positive.

    Parameters
    ----------
    table : a sweep over both parameters.
    path : of the picture; its ending chooses the format (.png, .pdf, .svg).
    x, y : the parameters along the axes.
    of : measure or force whose sign tells the phases, "F_e_z", or a truth value, "lifts". A
        number is interpolated between the points, which are marked; a truth value is that of the
        nearest one.
    names : of the phases where it is not positive and where it is.
    curve : name, values of x and values of y of a line drawn over them, such as a boundary that
        ``critical_value`` has found.

    Notes
    -----
    What has no result is left white.

    Raises
    ------
    SceneError
        A column without any number; not a grid of the two parameters.
    OutputError
        If the file cannot be written, or matplotlib is not installed.
    """
    across, up, values = (_column(table, name) for name in (x, y, of))
    (xs, i), (ys, j) = (np.unique(each, return_inverse=True) for each in (across, up))
    if len(xs) < 2 or len(ys) < 2 or len(values) != len(xs) * len(ys):
        raise SceneError(
            f"plot_phases: {len(values)} points are no grid of {len(xs)} values of {x} and "
            f"{len(ys)} of {y}; sweep over these two parameters only"
        )
    grid = np.full((len(ys), len(xs)), np.nan)
    grid[j, i] = values
    made, axes = figure(path)
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    colours = ("#dfe3e8", "#7fb3d5")
    truth = set(np.unique(values[np.isfinite(values)])) <= {0.0, 1.0}
    if truth or not np.nanmin(grid) < 0.0 < np.nanmax(grid):
        phase = np.where(np.isnan(grid), np.nan, grid > 0.0)
        map_of = ListedColormap(colours)
        axes.pcolormesh(xs, ys, phase, cmap=map_of, vmin=0, vmax=1, shading="nearest")
    else:
        known = np.ma.masked_invalid(grid)
        axes.contourf(xs, ys, known, [known.min() - 1.0, 0.0, known.max() + 1.0], colors=colours)
        axes.contour(xs, ys, known, [0.0], colors="black", linewidths=1.2)
    solved = np.isfinite(values)
    axes.plot(across[solved], up[solved], ".", ms=2, color="0.45")
    axes.set(
        xlabel=_label(x, table), ylabel=_label(y, table), xlim=axes.get_xlim(), ylim=axes.get_ylim()
    )
    key = [Patch(color=c, label=n) for c, n in zip(colours, names, strict=True)]
    if curve is not None:
        key += axes.plot(curve[1], curve[2], "--", color="C3", lw=1.5, label=curve[0])
    axes.legend(handles=key, loc="upper right", fontsize=8)
    write_figure(made, path)


def _column(table: Table, name: str) -> Array:
    values = table.column(name)
    if not np.isfinite(values).any():
        raise SceneError(f"{name!r}: no column of that name has a number in it")
    return values


def _label(name: str, table: Table) -> str:
    """The last part of a path in the scene file says what a parameter is; with its unit."""
    plain = name.rsplit(".", 1)[-1]
    text = LABELS.get(plain, plain if plain.startswith("F_") else plain.replace("_", " "))
    return labelled(plain, text, getattr(table, "units", DIMENSIONLESS))
