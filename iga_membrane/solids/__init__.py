"""Rigid solids: gap, normal, contact angle."""

from .plane import Plane

__all__ = ["Plane"]
