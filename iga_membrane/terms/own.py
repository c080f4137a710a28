"""A term of the user's own: what it returns and its derivatives, checked before any work."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..checks import name_of, real, shown
from ..errors import SceneError
from ..own import answer_of, called, check_slopes, is_own
from ..solids.own import check_solid
from ..surface.surface import Surface
from .gap import GapTerm, LocalGap
from .term import AreaTerm, BodyDensity, BodyTerm, Constraint, LineTerm, Scale, Term


def scaled_term(term: Term, scale: Scale) -> Term:
    """A term in a scale, or an error that names both.

    Raises
    ------
    SceneError
    """
    try:
        found = called(term.scaled, scale)
    except SceneError as error:
        raise SceneError(
            f"{name_of(term)} in units of length {scale.length:g} and tension "
            f"{scale.tension:g}: {error}"
        ) from error
    if not isinstance(found, Term):
        raise SceneError(f"{name_of(term)}.scaled: returned {shown(found)}, expected a Term")
    if isinstance(found, BodyTerm):
        density = called(found.density)
        if not isinstance(density, BodyDensity):
            raise SceneError(
                f"{name_of(term)}.density: returned {shown(density)}, expected a BodyDensity"
            )
        _finite(f"{name_of(term)}.density", [density.constant, *density.gradient])
    if isinstance(found, AreaTerm):
        _finite(f"{name_of(term)}.tension", [called(found.tension)])
    if isinstance(found, Constraint):
        _finite(f"{name_of(term)}.target", [found.target])
    return found


def check_own_terms(terms: tuple[Term, ...], start: Surface, scale: Scale) -> None:
    """Compare the derivatives of users' laws and lines with differences, at a scene's start.

    Parameters
    ----------
    terms : in a scene's scale.
    start : in it too.

    Raises
    ------
    SceneError
        The message names the method that is wrong.
    """
    for term in terms:
        if isinstance(term, LocalGap):
            _check_law(term.term, start, scale)
        elif isinstance(term, LineTerm) and is_own(term):
            _check_line(term, start)


def _check_law(term: GapTerm, start: Surface, scale: Scale) -> None:
    points = scale.to_world(start.on(start.space.table(2)).position.reshape(-1, 3))
    if is_own(term.solid):
        check_solid(term.solid, scale.origin, scale.length)
    gap = term.solid.nearest(points).gap
    law, names = term.law, ("f", "slope", "curvature")
    found = answer_of(law, called(law, gap), names, gap.shape, finite=False)
    length = np.maximum(np.abs(gap), 1e-3 * np.abs(gap).max())
    for k in (0, 1):

        def values(step: Array, k: int = k) -> Array:
            return np.asarray(law(gap + step)[k], float)

        check_slopes(law, (names[k + 1], names[k]), values, found[k + 1], length)


def _check_line(term: LineTerm, start: Surface) -> None:
    table = start.space.edge_table(term.edge)
    elements, local = table.functions.shape
    x, nothing = start.points, BodyDensity()
    strength = real(f"{name_of(term)}.strength", term.strength)
    moved = np.random.default_rng(0).uniform(-1.0, 1.0, x.shape)

    def energy(points: Array) -> Array:
        call = term.energy
        found = called(call, table, points, strength, nothing)
        return answer_of(call, [found], ["energy"], ())[0].reshape(1)

    def forces(points: Array) -> Array:
        call = term.forces
        found = called(call, table, points, strength, nothing)
        return answer_of(call, [found], ["forces"], (elements, local, 3))[0]

    call = term.hessian
    shape = (elements, local, 3, local, 3)
    found = called(call, table, x, strength, nothing)
    (hessian,) = answer_of(call, [found], ["hessian"], shape)
    way = moved[table.functions]
    work = np.array([(forces(x) * way).sum()])
    bent = np.einsum("eaibj,ebj->eai", hessian, way)
    check_slopes(
        term.forces, ("forces . motion", "energy"), lambda h: energy(x + h[0] * moved), work, 1.0
    )
    check_slopes(
        call,
        ("hessian . motion", "forces"),
        lambda h: forces(x + h[0] * moved).reshape(1, -1),
        bent.reshape(1, -1),
        1.0,
    )


def _finite(told: str, values: list[float]) -> None:
    for value in values:
        if not np.isfinite(real(told, value)):
            raise SceneError(f"{told} = {value!r}: must be finite; mend the function")
