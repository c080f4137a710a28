"""Terms: what the membrane pays for, with exact first and second variations."""

from .contact import Contact, Ring
from .contact_line import PlaneContactLine
from .edge_gap import EdgeGap
from .gap import GapTerm, LocalGap
from .gravity import Gravity
from .line_load import NormalLineLoad
from .sphere_wetting import SphereContactLine
from .stabilization import Stabilization
from .tension import SurfaceTension
from .term import AreaTerm, BodyDensity, BodyTerm, Constraint, LineTerm, Scale, Term, WettingLine
from .trimmed import TrimmedContactLine
from .volume import Centroid, Pressure, Volume

__all__ = [
    "AreaTerm",
    "BodyDensity",
    "BodyTerm",
    "Centroid",
    "Constraint",
    "Contact",
    "EdgeGap",
    "GapTerm",
    "Gravity",
    "LineTerm",
    "LocalGap",
    "NormalLineLoad",
    "PlaneContactLine",
    "Pressure",
    "Ring",
    "Scale",
    "SphereContactLine",
    "Stabilization",
    "SurfaceTension",
    "Term",
    "TrimmedContactLine",
    "Volume",
    "WettingLine",
]
