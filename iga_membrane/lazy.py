"""Parts of the package that are loaded when they are first used."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def part(module: str, name: str) -> Any:
    """What a module of the package, "view.picture", calls by a name."""
    return getattr(import_module(f"{__package__}.{module}"), name)
