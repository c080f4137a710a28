"""Rigid solids: gap, normal, contact angle."""

from .plane import Plane
from .sphere import Sphere

__all__ = ["Plane", "Sphere"]
