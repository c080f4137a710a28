"""Libraries that only some calls need."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .errors import OutputError

_BROUGHT_BY = {"PIL": "pillow", "vtkmodules": "pyvista", "trame_pyvista": "trame-pyvista"}
"""Modules that are not named like what is to be installed."""


def optional(module: str, wanted_by: str, extra: str = "") -> Any:
    """A library, or a module of one, loaded when it is needed.

    Parameters
    ----------
    module : its name.
    wanted_by : what needs it, for the message.
    extra : of this package, that brings it; "" if the package itself requires it.

    Raises
    ------
    OutputError
        If it cannot be loaded; the message names it and what to install.
    """
    try:
        import_module(module.partition(".")[0])
        return import_module(module)
    except ImportError as error:
        name = module.partition(".")[0]
        library = _BROUGHT_BY.get(name, name)
        group = f' (or "iga-membrane[{extra}]")' if extra else ""
        raise OutputError(
            f"{wanted_by} needs {library}, which is not installed or broken ({error}): "
            f"pip install {library}{group}"
        ) from error
