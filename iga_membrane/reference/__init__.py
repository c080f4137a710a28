"""The independent witness: closed forms and axisymmetric solutions that share no code with the
rest of the package (it imports numpy and scipy only).

Units: surface tension 1, angles in degrees through the liquid, pressures liquid minus gas.
"""

from .bridge import Bridge, bridge_between, limit_of_stability
from .caps import cap_on_plane
from .catenoid import catenoid
from .young_laplace import drop_on_plane, profile_on_plane

__all__ = [
    "Bridge",
    "bridge_between",
    "cap_on_plane",
    "catenoid",
    "drop_on_plane",
    "limit_of_stability",
    "profile_on_plane",
]
