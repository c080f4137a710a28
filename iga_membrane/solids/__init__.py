"""Rigid solids: gap, normal, contact angle."""

from .lattice import SphereLattice, Spheres
from .nearest import Nearest, Solid
from .plane import Plane
from .sphere import Sphere

__all__ = ["Nearest", "Plane", "Solid", "Sphere", "SphereLattice", "Spheres"]
