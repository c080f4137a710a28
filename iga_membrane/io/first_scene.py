"""Commented scene files to begin with, one for each kind of scene."""

from __future__ import annotations

_LIQUID = """\
[liquid]
surface_tension = "72.8 mN/m"       # water; plain numbers are in SI where any has a unit
density = "998 kg/m^3"
"""
_GRAVITY = """
[gravity]
acceleration = "9.81 m/s^2"         # left out: none
# direction = [0, 0, -1]            # up is z
"""
_MESH = """
# [discretization]                  # the default is fine enough for most scenes
# elements = 20
# model = "full"                    # full | half | quarter | eighth; the smallest that is enough

# [solver]
# max_cpu_s = 600
"""
_SCENES = {
    "sessile_droplet": f"""\
# A droplet on a plane. Solve it: python -m iga_membrane solve THIS_FILE --out out --png
scene = "sessile_droplet"

{_LIQUID}volume = "3 uL"
{_GRAVITY}
[substrate]
kind = "plane"                      # plane | sphere | sphere_lattice | spheres | height_map | ...
contact_angle = 115.0               # degrees, through the liquid

# A texture in the place of the plane:
# [substrate]
# kind = "height_map"
# shape = "egg_carton"
# amplitude = "20 um"
# period = "500 um"
# contact_angle = 115.0
{_MESH}
# [[path]]                          # follow the droplet along a number
# parameter = "substrate.contact_angle"
# values = [90.0, 115.0]
""",
    "liquid_sheet": f"""\
# A liquid sheet with a round rim, loaded by a particle in its middle.
scene = "liquid_sheet"

{_LIQUID}
[sheet]
boundary = "circle"                 # square | circle
size = "5 mm"                       # side or diameter
pressure = 0.0                      # liquid minus gas; or volume

[[particle]]
radius = "0.5 mm"
center = [0.0, 0.0, "-0.3 mm"]
contact_angle = 90.0                # degrees
density = "1500 kg/m^3"
{_GRAVITY}{_MESH}""",
    "asperity_cell": f"""\
# One asperity of a rough surface under a membrane with pressure.
scene = "asperity_cell"

{_LIQUID}
[substrate]
kind = "sphere"
radius = "10 um"
contact_angle = 110.0               # degrees

[cell]
shape = "square"                    # square | circle
size = "40 um"                      # distance between asperities
pressure = "200 Pa"
{_MESH}""",
    "capillary_bridge": f"""\
# A liquid bridge between a sphere and a plane.
scene = "capillary_bridge"

{_LIQUID}volume = "0.5 uL"

[lower]
kind = "plane"                      # plane | sphere | disc
contact_angle = 60.0                # degrees

[upper]
kind = "sphere"
radius = "2 mm"
contact_angle = 60.0

[gap]
distance = "0.3 mm"
{_MESH}""",
    "film_between_rings": f"""\
# A film, or a liquid bridge if it has a volume, between two rings.
scene = "film_between_rings"

{_LIQUID}
[rings]
radius = "1 mm"
half_height = "0.4 mm"
# volume = "2.2 uL"                 # or pressure = "30 Pa"
{_MESH}""",
}
KINDS = tuple(_SCENES)
"""Kinds of scenes that there is a file for."""


def first_scene(kind: str) -> str:
    """The text of a scene file (TOML) with comments, ready to be solved."""
    return _SCENES[kind]
