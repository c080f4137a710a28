"""Terms: what the membrane pays for, with exact first and second variations."""

from .contact import Contact
from .contact_line import PlaneContactLine
from .edge_gap import EdgeGap
from .gravity import Gravity
from .sphere_wetting import SphereContactLine
from .tension import SurfaceTension
from .term import AreaTerm, BodyDensity, BodyTerm, Constraint, LineTerm, Scale, Term
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
    "Gravity",
    "LineTerm",
    "PlaneContactLine",
    "Pressure",
    "Scale",
    "SphereContactLine",
    "SurfaceTension",
    "Term",
    "TrimmedContactLine",
    "Volume",
]
