"""Pictures in space: droplet, substrate, contact lines; safe on machines without a screen."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import partial
from typing import Any, Literal

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import (
    POSITIVE,
    direction,
    either,
    integer,
    items,
    number,
    pair,
    refusal,
    vector,
    words,
)
from ..driver.solution import Solution
from ..errors import SceneError
from ..optional import optional
from ..quantities import labelled
from .drawing import check_drawing, pyvista, trial
from .marks import add_forces, add_lines
from .mesh import RESOLUTION, membrane, outside, trimming_solid
from .solids import add_solids

Color = Literal["none", "mean_curvature", "pressure", "gap", "residual"]
View = Literal["oblique", "foot", "side", "top"] | tuple[float, float, float]

VIEWS = {"oblique": (1.0, -2.2, 0.55), "foot": (1.0, -2.2, 0.2), "side": (0.0, -1.0, 0.0),
         "top": (0.0, 0.0, 1.0)}  # fmt: skip
"""Directions from the middle of the picture to the eye, in the scene's frame."""
PARALLEL = ("side", "top")
"""Views without perspective, where lengths can be measured."""
DISTANCE = 1.6
"""Of the eye from the middle of the picture, over the diagonal of what is drawn."""
HALF_HEIGHT = DISTANCE * float(np.tan(np.radians(15.0)))
"""Of a picture without perspective, over the diagonal of what is drawn, at zoom 1."""
LIQUID = {"color": "#5b9bd5", "specular": 0.6, "specular_power": 25, "ambient": 0.15}

MOST = 0.02, 0.98
"""Parts of the area between which the colours lie: the spots on the paper's asperities are 0.7 % of
it."""


def _limits(field: str, value: Any) -> tuple[float, float]:
    """A lowest and a larger highest value."""
    low, high = pair(field, value)
    if not low < high:
        raise refusal(field, value, "a lowest and a highest value are needed", "sort them")
    return low, high


@checked(
    size=partial(items, each=partial(integer, least=16, most=16_384), count=2),
    resolution=RESOLUTION,
    opacity=partial(number, least=0.0, most=1.0),
    view=either(words(*VIEWS), direction),
    zoom=POSITIVE,
    focus=either(words("asperity"), vector),
    limits=_limits,
)
def plot(
    solution: Solution,
    path: str | os.PathLike[str] | None = None,
    *,
    color: Color = "mean_curvature",
    size: tuple[int, int] = (1200, 900),
    resolution: int = 129,
    opacity: float | None = None,
    traction: bool = False,
    forces: bool = False,
    view: View = "oblique",
    zoom: float = 1.0,
    focus: Sequence[float] | Literal["asperity"] | None = None,
    limits: tuple[float, float] | None = None,
) -> Any:
    """Draw a solution.

    Parameters
    ----------
    solution : converged or not.
    path : file to write: .png a picture, .html a page that turns and zooms in any browser and needs
        nothing else; if None nothing is written.
    color : "mean_curvature" (exact, from the spline), "pressure", "gap" to the nearest solid,
        "residual", the error ``|2 H + p / gamma|`` over ``1 / L`` on a logarithmic scale, or
        "none", plain liquid.
    size : of the picture in pixels.
    resolution : points along each direction of the patch.
    opacity : of the liquid, 0 to 1; by default 1, but 0.7 with ``traction`` or ``forces``.
    traction : whether to draw the pull of the membrane on the solid along its contact lines.
    forces : whether to draw the forces on particles.
    view : "oblique", "foot" (low), "side" or "top" (both without perspective), or the direction
        from the middle of the picture to the eye, in the scene's frame.
    zoom : enlargement.
    focus : world point in the middle of the picture, or "asperity", the wet one nearest to the eye;
        the membrane's middle if omitted.
    limits : lowest and highest value of the colours; most of the values if omitted.

    Returns
    -------
    pyvista.Plotter or None
        Without a path the plotter, to add to and to ``show()``, in a notebook too.

    Notes
    -----
    Asperities that carry a part of the droplet are drawn red, wet spots dark, contact lines red.
    Where the membrane passes through solids only its part outside is drawn.

    Raises
    ------
    SceneError
        A word that is none of those; an asperity where none is wet.
    OutputError
        If this machine cannot draw, with what to install; for .html without trame-pyvista.
    """
    axes = solution.scene.units.axes
    eye = _eye(view, axes)
    middle, span, near = _frame(solution, focus, eye)
    if path is not None:
        trial()
    pv = pyvista()
    name = None if color == "none" else color
    mesh = membrane(solution, resolution, () if name is None else (name,), near)
    through = trimming_solid(solution)
    if through is not None:
        mesh = outside(through, mesh)
    if path is not None:
        check_drawing()
    plotter = pv.Plotter(off_screen=path is not None, window_size=size)
    plotter.set_background("white")
    # arrows tangent to the membrane show through it
    shown = (0.7 if traction or forces else 1.0) if opacity is None else opacity
    look = LIQUID if name is None else _colours(solution, mesh, name, limits)
    plotter.add_mesh(mesh, smooth_shading=True, opacity=shown, **look)
    add_solids(plotter, pv, solution, 0.5 if forces else 1.0)
    add_lines(plotter, pv, solution, traction)
    if forces:
        aside = np.cross(axes[:, 2], eye)
        add_forces(plotter, pv, solution, aside / max(float(np.linalg.norm(aside)), 1e-12))
    _look(plotter, view, axes, eye, middle, span / zoom)
    plotter.enable_anti_aliasing("ssaa")
    if path is None:
        return plotter
    _write(plotter, str(path))
    plotter.close()
    return None


def _write(plotter: Any, path: str) -> None:
    """A picture, or by its ending a page."""
    if path.endswith(".html"):
        optional("trame_pyvista", "an .html page", "html")
        plotter.trame.export_html(path)
    else:
        plotter.screenshot(path)


def _look(plotter: Any, view: View, axes: Array, eye: Array, middle: Array, span: float) -> None:
    """Place the camera so that it sees a span round the middle."""
    up = axes[:, 1] if view == "top" else axes[:, 2]
    plotter.camera_position = [middle + DISTANCE * span * eye, middle, up]
    if view in PARALLEL:
        plotter.enable_parallel_projection()
        plotter.camera.parallel_scale = HALF_HEIGHT * span


def _eye(view: View, axes: Array) -> Array:
    """(3,) unit vector from the middle of the picture to the eye, in world axes."""
    eye = axes @ np.array(VIEWS[view] if isinstance(view, str) else view)
    eye = eye / np.abs(eye).max()
    return np.asarray(eye / np.linalg.norm(eye))


def extent(solution: Solution) -> tuple[Array, float]:
    """Middle and diagonal of the membrane's bounding box, in world axes."""
    x = solution.surface.grid(65, 65, 1).position.reshape(-1, 3)
    low, high = x.min(axis=0), x.max(axis=0)
    return 0.5 * (low + high), float(np.linalg.norm(high - low))


def _frame(
    solution: Solution, focus: Any, eye: Array
) -> tuple[Array, float, tuple[Array, float] | None]:
    """Middle and size of the picture, and the part of the membrane to draw if not all of it."""
    middle, span = extent(solution)
    if focus is None:
        return middle, span, None
    if not isinstance(focus, str):
        return np.array(focus), span, None
    wet = solution.contact.get("asperities", ())
    if not wet:
        raise SceneError('focus = "asperity": no asperity is wet here; give a point [x, y, z]')
    first = max(wet, key=lambda each: float(np.dot(each["center"], eye)))
    substrate = solution.scene.substrate
    assert substrate is not None
    radius = float(substrate.radius_of(np.array(first["index"])))
    radius = radius if np.isfinite(radius) else substrate.scale
    center = np.array(first["center"])
    top = center + 0.5 * radius * solution.scene.units.axes[:, 2]
    return top, 8.0 * radius, (center, 8.0 * radius)


def _colours(
    solution: Solution, mesh: Any, name: str, limits: tuple[float, float] | None
) -> dict[str, Any]:
    """How to colour the mesh by a field on it."""
    unit = solution.scene.units
    title = labelled(name, name.replace("_", " "), solution.scene.unit_system)
    bar = {"title": title.replace(" (", "\n("), "color": "black", "fmt": "%.3g", "vertical": True,
           "position_x": 0.87, "position_y": 0.25, "height": 0.5,
           "title_font_size": 22, "label_font_size": 22}  # fmt: skip
    look = {"scalars": name, "cmap": "viridis", "specular": 0.3, "scalar_bar_args": bar}
    if name == "residual":
        mesh[name] = np.maximum(np.abs(mesh[name]) / unit.pressure, 1e-16)
        low, high = np.percentile(mesh[name], [5.0, 99.5])
        return look | {"cmap": "magma", "log_scale": True,
                       "clim": limits or (low, max(high, 10.0 * low)),
                       "scalar_bar_args": bar | {"fmt": "%.0e"}}  # fmt: skip
    size = {"mean_curvature": 1.0 / unit.length, "pressure": unit.pressure, "gap": unit.length}
    return look | {"clim": limits or _range(mesh, name, size[name])}


def _range(mesh: Any, name: str, unit: float) -> tuple[float, float]:
    """Colour range of nearly all of the area, so that contact spots, small and strongly curved, do
    not rule it; wide enough not to show rounding as a pattern."""
    cells = mesh.compute_cell_sizes(length=False, volume=False).point_data_to_cell_data()
    values = cells[name]
    order = np.argsort(values)
    below = np.cumsum(cells["Area"][order])
    low, high = np.interp(MOST, below / below[-1], values[order])
    middle = 0.5 * (low + high)
    half = max(0.5 * (high - low), 1e-2 * max(unit, abs(middle)))
    return float(middle - half), float(middle + half)
