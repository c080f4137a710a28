"""One-dimensional bases: every space is built from them, through Bezier extraction.

A :class:`Basis` is a piecewise polynomial basis on a line or on a ring. B-splines (clamped or
periodic) and Lagrange polynomials differ only in the extraction matrices and in which functions
live on which element, so everything above sees one class.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array, Index
from ..checks import POSITIVE, Rule, array, either, function, integer, items, refusal, words
from ..errors import SceneError
from ..overview import brief_repr
from ..own import called
from .bernstein import bernstein, extraction
from .knots import DEGREE, ELEMENTS, check_knots, greville, increasing, open_knots


@dataclass(frozen=True, eq=False)
@checked(
    degree=DEGREE,
    breaks=increasing,
    operators=partial(array, shape=(None, None, None)),
    abscissae=partial(array, shape=(None,)),
    continuity=partial(integer, least=-1, most=31),
    knots=partial(array, shape=(None,)),
)
class Basis:
    """Piecewise polynomial basis.

    Attributes
    ----------
    degree : polynomial degree ``p``.
    breaks : (m + 1,) element boundaries.
    operators : (m, p + 1, p + 1) Bezier extraction, functions by Bernstein polynomials.
    functions : (m, p + 1) global number of each local function.
    abscissae : (n,) the point of each function: Greville point or node.
    continuity : continuous derivatives at element boundaries.
    periodic : whether the ends of the domain are joined.
    joints : parameters inside the domain where patches meet, with continuity 1 on a ring and 0 on
        a line.
    knots : (n + p + 1,) the clamped knot vector of a B-spline basis on a line, else None.
    """

    degree: int
    breaks: Array
    operators: Array
    functions: Index
    abscissae: Array
    continuity: int
    periodic: bool = False
    knots: Array | None = field(default=None, repr=False)
    joints: tuple[float, ...] = ()

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        """One operator and one set of functions for each element."""
        local, elements = self.degree + 1, len(self.breaks) - 1
        shapes = {"operators": (elements, local, local), "functions": (elements, local)}
        for name, shape in shapes.items():
            given = np.shape(getattr(self, name))
            if given != shape:
                raise SceneError(
                    f"{name}: shape {given} given, {shape} expected for {elements} elements "
                    f"(breaks) of degree {self.degree}"
                )
        if not 0 <= self.functions.min() <= self.functions.max() < len(self.abscissae):
            raise SceneError(
                f"functions: numbers from {self.functions.min()} to {self.functions.max()} given, "
                f"but {len(self.abscissae)} abscissae: one for each function is needed"
            )

    @property
    def smooth(self) -> bool:
        """Whether derivatives below the degree are continuous everywhere."""
        return self.continuity >= 1 and not self.joints

    @property
    def count(self) -> int:
        """Number of basis functions."""
        return len(self.abscissae)

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.breaks) - 1

    @property
    def sizes(self) -> Array:
        """(m,) element lengths."""
        return np.diff(self.breaks)

    @cached_property
    def kinds(self) -> Index:
        """(m,) number of the set of functions that each element has."""
        sizes = self.sizes[:, None] / self.sizes[0]
        own = np.hstack([sizes, self.operators.reshape(self.elements, -1)])
        return np.asarray(np.unique(np.round(own, 12) + 0.0, axis=0, return_inverse=True)[1])

    def on_elements(self, u: Array, derivative: int = 0) -> Array:
        """Values at the same local points of every element: (m, len(u), p + 1)."""
        polynomials = bernstein(u, self.degree, derivative)
        table = polynomials @ self.operators.transpose(0, 2, 1)
        return np.asarray(table / self.sizes[:, None, None] ** derivative)

    def locate(self, t: ArrayLike) -> tuple[Index, Array]:
        """Element and local coordinate in [0, 1] of each point; a ring wraps round."""
        x = np.asarray(t, float)
        first, last = self.breaks[0], self.breaks[-1]
        if self.periodic:
            x = first + np.mod(x - first, last - first)
        element = np.clip(np.searchsorted(self.breaks, x, "right") - 1, 0, self.elements - 1)
        return element, (x - self.breaks[element]) / self.sizes[element]

    def at(self, t: ArrayLike, derivative: int = 0) -> tuple[Index, Array]:
        """Functions alive at each point and their values: two arrays (points, p + 1)."""
        element, u = self.locate(t)
        return self.functions[element], self.inside(element, u[:, None], derivative)[:, 0]

    def inside(self, elements: Index, u: Array, derivative: int = 0) -> Array:
        """Values (k, q, p + 1) of the functions of elements (k,) at local points (k, q)."""
        polynomials = bernstein(u, self.degree, derivative)
        values = polynomials @ self.operators[elements].transpose(0, 2, 1)
        return np.asarray(values / self.sizes[elements][:, None, None] ** derivative)

    def matrix(self, t: ArrayLike, derivative: int = 0) -> Array:
        """Dense collocation matrix (points, n): ``matrix @ coefficients`` is the curve at ``t``."""
        functions, values = self.at(t, derivative)
        result = np.zeros((len(functions), self.count))
        np.add.at(result, (np.arange(len(functions))[:, None], functions), values)
        return result

    def derivative_at_abscissae(self) -> Array:
        """Dense matrix of first derivatives at the abscissae.

        Where the basis has a kink (a node between two Lagrange elements), the mean of both sides.
        """
        if self.smooth:
            return self.matrix(self.abscissae, 1)
        step = 1e-9 * self.sizes.min()
        inside = (
            self.abscissae
            if self.periodic
            else np.clip(self.abscissae, self.breaks[0] + step, self.breaks[-1] - step)
        )
        return 0.5 * (self.matrix(inside - step, 1) + self.matrix(inside + step, 1))


@checked(degree=partial(integer, least=0, most=32), continuity=partial(integer, least=-1))
def bspline_basis(knots: ArrayLike, degree: int, *, continuity: int = 1) -> Basis:
    """B-splines on a clamped knot vector.

    Parameters
    ----------
    knots : not decreasing, the first and the last ``degree + 1`` times.
    degree : 1 or more, above the continuity.
    continuity : that is needed at inner knots.

    Raises
    ------
    SceneError
        Degree below 2 or a knot vector that is not ``continuity`` times differentiable.
    """
    if degree < 1 or degree <= continuity:
        raise SceneError(
            f"degree = {degree}, continuity = {continuity}: degree {degree} is not C{continuity}: "
            f"C{continuity} needed, so degree >= {continuity + 1}; curvature and contact lines "
            "need C1"
        )
    t = check_knots(knots, degree, continuity)
    breaks, counts = np.unique(t, return_counts=True)
    spans = np.searchsorted(t, breaks[1:-1], "right") - 1
    spans = np.concatenate([[degree], spans]).astype(np.int64)
    windows = t[spans[:, None] + np.arange(1 - degree, degree + 1)]
    return Basis(
        degree,
        breaks,
        extraction(windows, degree),
        spans[:, None] - degree + np.arange(degree + 1),
        greville(t, degree),
        degree - int(counts[1:-1].max(initial=1)),
        knots=t,
    )


def uniform_basis(start: float, end: float, elements: int, degree: int) -> Basis:
    """B-splines on equal knots that go on beyond both ends: the middle of an endless line."""
    size = (end - start) / elements
    window = np.arange(1 - degree, degree + 1) * size
    return Basis(
        degree,
        np.linspace(start, end, elements + 1),
        np.repeat(extraction(window[None], degree), elements, axis=0),
        np.arange(elements)[:, None] + np.arange(degree + 1),
        start + (np.arange(elements + degree) - 0.5 * (degree - 1)) * size,
        degree - 1,
    )


@checked(elements=ELEMENTS, degree=DEGREE, length=POSITIVE)
def periodic_basis(
    elements: int, degree: int, length: float = 1.0, joints: Sequence[int] = ()
) -> Basis:
    """B-splines on a ring of equal elements; function ``i`` starts at knot ``i``.

    Parameters
    ----------
    elements : more than the degree.
    degree : 2 or more.
    length : of the ring.
    joints : elements at whose start patches meet with continuity 1.

    Raises
    ------
    SceneError
        A degree below 2, or too few elements.
    """
    if degree < 2:
        raise SceneError(f"degree {degree} is not C1: C1 needed, so degree >= 2 (got {degree})")
    if elements <= degree:
        raise SceneError(f"elements = {elements}: a ring of degree {degree} needs > {degree}")
    _joints(joints, 0, elements)
    size = length / elements
    multiplicity = np.ones(elements, int)
    multiplicity[list(joints)] = degree - 1
    knots = np.repeat(np.arange(elements), multiplicity)
    count = len(knots)
    last = np.cumsum(multiplicity) - 1  # the knot at which each element starts
    around = last[:, None] + np.arange(1 - degree, degree + 1)
    windows = knots[around % count] + elements * (around // count)
    functions = (last[:, None] - degree + np.arange(degree + 1)) % count
    ahead = np.arange(count)[:, None] + np.arange(1, degree + 1)
    abscissae = (knots[ahead % count] + elements * (ahead // count)).mean(axis=1) % elements
    return Basis(
        degree,
        np.linspace(0.0, length, elements + 1),
        extraction(windows * size, degree),
        functions,
        abscissae * size,
        degree - 1,
        periodic=True,
        joints=tuple(size * j for j in joints),
    )


@checked(breaks=increasing, degree=partial(integer, least=1, most=4))
def lagrange_basis(breaks: ArrayLike, degree: int, *, periodic: bool = False) -> Basis:
    """Lagrange polynomials on equidistant nodes of each element: C0, degree 1 to 4.

    Parameters
    ----------
    breaks : (elements + 1,) ends of the elements.
    degree : 1 to 4.
    periodic : whether the ends of the domain are joined.

    Raises
    ------
    SceneError
        Another degree.
    """
    if not 1 <= degree <= 4:
        raise SceneError(f"degree = {degree}: a lagrange space has degree 1 to 4")
    t = np.asarray(breaks, float)
    elements = len(t) - 1
    nodes = np.arange(degree + 1) / degree
    operator = np.linalg.inv(bernstein(nodes, degree)).T
    functions = np.arange(elements)[:, None] * degree + np.arange(degree + 1)
    abscissae = (t[:-1, None] + np.diff(t)[:, None] * nodes[:-1]).ravel()
    if periodic:
        functions = functions % (elements * degree)
    else:
        abscissae = np.append(abscissae, t[-1])
    operators = np.repeat(operator[None], elements, axis=0)
    return Basis(degree, t, operators, functions, abscissae, 0, periodic)


BasisOf = Callable[[int, int], Basis]
"""A spline space of one's own: number of elements and degree to a basis on [0, 1]."""
POLYNOMIALS = ("bspline", "lagrange")
KIND: Rule = either(words(*POLYNOMIALS), partial(function, arguments=2))


@checked(kind=KIND, elements=ELEMENTS, degree=DEGREE)
def line_basis(
    kind: str | BasisOf, elements: int, degree: int, joints: Sequence[int] = ()
) -> Basis:
    """Basis on [0, 1].

    Parameters
    ----------
    kind : "bspline" (of full smoothness) or "lagrange" on equal elements, or a function from the
        number of elements and the degree to a basis.
    joints : inner elements at whose start splines have continuity 0.
    elements, degree : of the basis.

    Raises
    ------
    SceneError
        If a function returns no basis on [0, 1], or has no place for joints.
    """
    if callable(kind):
        return _own_basis(kind, elements, degree, joints)
    breaks = np.linspace(0.0, 1.0, elements + 1)
    if kind == "lagrange":
        return lagrange_basis(breaks, degree)
    _joints(joints, 1, elements)
    if not len(joints):
        return bspline_basis(open_knots(breaks, degree), degree)
    kinks = tuple(float(breaks[j]) for j in joints)
    knots = np.sort(np.concatenate([open_knots(breaks, degree), np.repeat(kinks, degree - 1)]))
    return replace(bspline_basis(knots, degree, continuity=0), continuity=degree - 1, joints=kinks)


def _joints(joints: Sequence[int], least: int, elements: int) -> None:
    """Refuse joints that are no elements, or given twice."""
    rule = partial(integer, least=least, most=elements - 1)
    if len(set(items("joints", joints, each=rule))) < len(joints):
        raise refusal("joints", list(joints), "each element can have one joint", "give it once")


def _own_basis(kind: BasisOf, elements: int, degree: int, joints: Sequence[int]) -> Basis:
    """A basis of the user's, or an error that says what is wrong with it."""
    name = getattr(kind, "__name__", type(kind).__name__)
    if joints:
        raise SceneError(f'discretization.space = {name}: has no joints; take "bspline" here')
    basis = called(kind, elements, degree)
    if not isinstance(basis, Basis):
        raise SceneError(
            f"discretization.space = {name}: {name}({elements}, {degree}) must return a Basis, got "
            f"{type(basis).__name__}"
        )
    if basis.periodic or basis.breaks[0] != 0.0 or basis.breaks[-1] != 1.0:
        raise SceneError(
            f"discretization.space = {name}: its elements reach from {basis.breaks[0]:g} to "
            f"{basis.breaks[-1]:g}, a meridian from 0 to 1 is needed"
        )
    total = basis.operators.sum(axis=1)
    if np.abs(total - 1.0).max() > 1e-9:
        raise SceneError(
            f"discretization.space = {name}: its functions add up to {total.min():.6g} to "
            f"{total.max():.6g}, 1 is needed: the functions (columns of operators) must add up"
        )
    _check_continuity(name, basis)
    ends = basis.matrix([0.0, 1.0])
    if not (np.isclose(ends[0, 0], 1.0) and np.isclose(ends[1, -1], 1.0)):
        raise SceneError(
            f"discretization.space = {name}: its first and last function must be 1 at the ends, as "
            "those of a clamped knot vector are"
        )
    return basis


def _check_continuity(name: str, basis: Basis) -> None:
    """Refuse a basis of the user's that is less smooth than it says."""
    inner = np.arange(basis.elements - 1)
    for order in range(min(basis.continuity, 1) + 1):
        sides = []
        for elements, end in ((inner, 1.0), (inner + 1, 0.0)):
            values = basis.inside(elements, np.full((len(inner), 1), end), order)[:, 0]
            side = np.zeros((len(inner), basis.count))
            np.put_along_axis(side, basis.functions[elements], values, axis=1)
            sides.append(side)
        jump = np.abs(sides[1] - sides[0])
        if len(inner) and jump.max() > 1e-8 * np.abs(sides).max():
            k = int(np.argmax(jump.max(axis=1)))
            raise SceneError(
                f"discretization.space = {name}: it says continuity {basis.continuity}, but its "
                f"derivative {order} jumps by {jump.max():.3g} at {basis.breaks[k + 1]:g}; mend "
                "operators or functions"
            )


@checked(kind=words(*POLYNOMIALS), elements=ELEMENTS, degree=DEGREE, length=POSITIVE)
def ring_basis(
    kind: str, elements: int, degree: int, length: float, joints: Sequence[int] = ()
) -> Basis:
    """Uniform basis on a ring of circumference ``length``; ``joints`` as in
    :func:`periodic_basis`.

    Parameters
    ----------
    kind : "bspline" or "lagrange".
    elements, degree : of the basis.
    length : of the ring.
    joints : as in :func:`periodic_basis`.
    """
    if kind == "lagrange":
        return lagrange_basis(np.linspace(0.0, length, elements + 1), degree, periodic=True)
    return periodic_basis(elements, degree, length, joints)
