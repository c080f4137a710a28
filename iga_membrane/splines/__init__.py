"""Spline and Lagrange spaces: functions of two parameters, no geometry."""

from .basis import (
    KIND,
    POLYNOMIALS,
    Basis,
    BasisOf,
    bspline_basis,
    lagrange_basis,
    line_basis,
    periodic_basis,
    ring_basis,
    uniform_basis,
)
from .cut import Cut, cut
from .faces import Faces, faces_between, folded_pairs, jumps
from .grading import Grading
from .knots import (
    DEGREE,
    ELEMENTS,
    PATCH,
    check_knots,
    greville,
    insertion_matrix,
    open_knots,
)
from .pillow import pillow_space
from .polar import close_pole, net_of, points_of, ring_angles
from .space import EDGE, Space, line, tensor_space
from .table import EdgeTable, LineTable, Table

__all__ = [
    "DEGREE",
    "EDGE",
    "ELEMENTS",
    "KIND",
    "PATCH",
    "POLYNOMIALS",
    "Basis",
    "BasisOf",
    "Cut",
    "EdgeTable",
    "Faces",
    "Grading",
    "LineTable",
    "Space",
    "Table",
    "bspline_basis",
    "check_knots",
    "close_pole",
    "cut",
    "faces_between",
    "folded_pairs",
    "greville",
    "insertion_matrix",
    "jumps",
    "lagrange_basis",
    "line",
    "line_basis",
    "net_of",
    "open_knots",
    "periodic_basis",
    "pillow_space",
    "points_of",
    "ring_angles",
    "ring_basis",
    "tensor_space",
    "uniform_basis",
]
