"""Whether and how this machine draws: pyvista, off screen where there is no display."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from typing import Any

from ..errors import OutputError
from ..optional import optional

REMEDY = "on Debian or Ubuntu: apt-get install libegl1 libgl1-mesa-dri"
_PROBE = """
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
import vtkmodules.vtkRenderingOpenGL2
renderer = vtkRenderer()
renderer.SetBackground(1, 0, 0)
window = vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(16, 16)
window.AddRenderer(renderer)
image = vtkWindowToImageFilter()
image.SetInput(window)
image.Update()
raise SystemExit(image.GetOutput().GetScalarComponentAsDouble(8, 8, 0, 0) != 255)
"""


def check_drawing() -> None:
    """Prove that pictures can be drawn here.

    Raises
    ------
    OutputError
    """
    optional("vtkmodules", "a picture")
    if not can_draw():
        raise OutputError(f"pictures cannot be drawn on this machine: {REMEDY}")


def can_draw() -> bool:
    """Whether one small picture can be drawn, tried once in a process of its own.

    Without the right driver VTK does not raise but kills the process.
    """
    return trial().wait() == 0


@cache
def trial() -> subprocess.Popen[bytes]:
    """That process; started early it costs no time."""
    _headless()
    quiet = subprocess.DEVNULL
    return subprocess.Popen([sys.executable, "-c", _PROBE], stdout=quiet, stderr=quiet)


def _headless() -> None:
    """Off-screen rendering by EGL where there is no display; must precede the import of vtk."""
    if sys.platform == "linux" and not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")


def pyvista() -> Any:
    """The library, ready to draw without a display."""
    _headless()
    return optional("pyvista", "a picture or a .vtu file")
