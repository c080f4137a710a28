"""Laws, solids, spaces and terms of users that are wrong are blamed by their names, before a solve
where that can be seen, and in its message where it cannot."""

import re
from dataclasses import dataclass, replace

import numpy as np
import pytest
from helpers import droplet, example

import iga_membrane as iga
from iga_membrane.terms import BodyDensity, BodyTerm, LineTerm, Term

BALL = iga.Sphere(90.0, 0.5, (0.0, 0.0, -0.7))
HERE = __name__


@dataclass(frozen=True)
class Repulsion(iga.GapTerm):
    """Falls off with the gap; ``spoil`` makes what it returns wrong."""

    spoil: object
    solid: iga.Solid = BALL
    reach: float = 0.15

    def law(self, gap):
        f = 0.2 * np.exp(-gap / self.reach)
        return self.spoil(gap, f, -f / self.reach, f / self.reach**2)


def film(law):
    square = iga.sheet(2.0, elements=4)
    edges = [iga.Fixed(edge) for edge in ("xi1=0", "xi1=1", "xi2=0", "xi2=1")]
    return iga.Scene(square, [iga.SurfaceTension(1.0), law], edges)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda g, f, df, ddf: f, "expected f, slope, curvature: 3 arrays"),
        (lambda g, f, df, ddf: (f, df), "3 arrays"),
        (lambda g, f, df, ddf: (f, df, ddf[:1]), "curvature has shape"),
        (lambda g, f, df, ddf: (f, None, ddf), "slope has shape ()"),
        (lambda g, f, df, ddf: (f + 0j, df, ddf), "f has shape .* dtype complex128"),
        (lambda g, f, df, ddf: (f, 1.01 * df, ddf), "slope = .* is not the derivative of f"),
        (lambda g, f, df, ddf: (f, -df, ddf), "slope = .* is not the derivative of f"),
        (lambda g, f, df, ddf: (f, df, 0.0 * ddf), "curvature = .* not the derivative of slope"),
        (lambda g, f, df, ddf: (f, df, np.nan * ddf), "curvature is not finite at the start"),
        (lambda g, f, df, ddf: 1 / 0, "raised ZeroDivisionError"),
    ],
)
def test_a_wrong_law_of_the_gap_is_blamed_before_the_solve(spoil, said):
    with pytest.raises(iga.SceneError, match=rf"{HERE}\.Repulsion\.law\b.*{said}"):
        iga.solve(film(Repulsion(spoil)))


@pytest.mark.parametrize("reach", [1e-3, 0.15, 30.0])
@pytest.mark.parametrize(
    "law",
    [
        lambda g, k: (np.exp(-g / k), -np.exp(-g / k) / k, np.exp(-g / k) / k**2),
        lambda g, k: (-1e-4 * k / g**2, 2e-4 * k / g**3, -6e-4 * k / g**4),
        lambda g, k: (np.where(g < 0.4, (g - 0.4) ** 2 / k, 0.0), np.where(g < 0.4, g - 0.4, 0.0)
                      * 2 / k, np.where(g < 0.4, 2 / k, 0.0)),
        lambda g, k: (1.0 + 0 * g, 0 * g, 0 * g),
    ],
)  # fmt: skip
def test_right_laws_of_any_reach_are_taken(law, reach):
    from iga_membrane.terms.own import check_own_terms

    scene = film(Repulsion(lambda g, *rest: law(g, reach)))
    check_own_terms(scene.local_terms(), scene.local_surface(), scene.units)


def test_a_law_that_ends_is_blamed_where_the_solve_fails():
    """Attraction that the membrane follows to where the law has no value."""

    def ends(g, *rest):
        with np.errstate(invalid="ignore", divide="ignore"):
            depth = np.sqrt(g - 0.15)
            return 8.0 * depth, 4.0 / depth, -2.0 / depth**3

    solution = iga.solve(film(Repulsion(ends)), on_fail="return")
    assert not solution.success
    assert re.search(rf"{HERE}\.Repulsion\.law returned f = nan at gap 0\.\d+:", solution.message)


class Ridge:
    """The solid of the guide, its answers spoilt."""

    scale, contact_angle = 0.4, 180.0

    def __init__(self, **spoilt):
        self.spoilt = spoilt

    def center_of(self, which):
        return np.zeros((*np.shape(which), 3)) - [0.0, 0.0, self.scale]

    def radius_of(self, which):
        return np.full(np.shape(which), np.inf)

    def nearest(self, points):
        which = np.zeros(points.shape[:-1], int)
        away = (points - self.center_of(which)) * [1.0, 0.0, 1.0]
        distance = np.linalg.norm(away, axis=-1)
        normal = away / distance[..., None]
        ridge = normal[..., ::-1] * [1.0, 0.0, -1.0] / np.sqrt(distance)[..., None]
        right = {"gap": distance - self.scale, "normal": normal, "bend": 0.0 * distance,
                 "which": which, "ridge": ridge}  # fmt: skip
        return iga.Nearest(**{k: self.spoilt.get(k, lambda v: v)(v) for k, v in right.items()})


class Silent(Ridge):
    def nearest(self, points):
        return None


class Scalar(Ridge):
    def center_of(self, which):
        return [0.0, 0.0, -self.scale]


def on(solid):
    return iga.sessile_droplet(solid, volume=1.0, gravity=1.0)


@pytest.mark.parametrize(
    ("solid", "said"),
    [
        (Silent(), r"Silent\.nearest: returned None, expected a Nearest"),
        (Scalar(), r"Scalar\.center_of: center has shape \(3,\)"),
        (Ridge(gap=lambda v: v[..., None]), r"Ridge\.nearest: gap has shape .*, expected"),
        (Ridge(gap=lambda v: list(v)), r"Ridge\.nearest.*gap = .*: must be an array"),
        (Ridge(normal=lambda v: v[..., :2]), r"Ridge\.nearest.*normal"),
        (Ridge(bend=lambda v: v[..., None]), r"Ridge\.nearest: bend has shape"),
        (Ridge(which=lambda v: v + 0.5), r"Ridge\.nearest.*which"),
        (Ridge(normal=lambda v: -v), r"Ridge\.nearest: normal . direction = .* of gap"),
        (Ridge(normal=lambda v: 1.01 * v), r"Ridge\.nearest: normal has the length 1.01"),
        (Ridge(gap=lambda v: 1.01 * v), r"Ridge\.nearest: normal . direction = .* of gap"),
        (Ridge(ridge=lambda v: 1.01 * v), r"Ridge\.nearest: \(bend, ridge\) . direction"),
        (Ridge(bend=lambda v: v + 1.0), r"Ridge\.nearest: \(bend, ridge\) . direction"),
    ],
)
def test_a_wrong_solid_is_blamed_before_the_solve(solid, said):
    with pytest.raises(iga.SceneError, match=rf"{HERE}\.{said}"):
        on(solid)


def test_right_solids_are_taken():
    assert on(Ridge()).kind == "sessile_droplet"
    assert on(example("pillars").Pillars(0.15, 0.15, 0.6)).kind == "sessile_droplet"


def test_a_wrong_solid_of_a_law_is_blamed():
    spoilt = Ridge(ridge=lambda v: 1.1 * v)
    scene = film(Repulsion(lambda g, *right: right, solid=spoilt))
    with pytest.raises(iga.SceneError, match=rf"{HERE}\.Ridge\.nearest"):
        iga.solve(scene)


def uniform(elements, degree):
    return iga.bspline_basis(iga.open_knots(np.linspace(0.0, 1.0, elements + 1), degree), degree)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda b: {"operators": 1.01 * b.operators}, "add up to"),
        (lambda b: {"operators": b.operators * np.nan}, "operators.* finite"),
        (lambda b: {"operators": b.operators[:-1]}, "operators: shape"),
        (lambda b: {"functions": b.functions + 1}, "functions: numbers"),
        (lambda b: {"operators": b.operators[::-1]}, "it says continuity 2, but its derivative 0"),
        (lambda b: {"breaks": b.breaks**2}, "it says continuity 2, but its derivative 1 jumps"),
    ],
)
def test_a_wrong_space_is_blamed(change, said):
    def spoilt(elements, degree):
        basis = uniform(elements, degree)
        return replace(basis, **change(basis))

    mesh = iga.Discretization(space=spoilt, degree=3, elements=8)
    with pytest.raises(iga.SceneError, match=said) as caught:
        iga.sessile_droplet(iga.Plane(120), volume=1.0, discretization=mesh)
    assert "spoilt" in str(caught.value)


@dataclass(frozen=True)
class Field(BodyTerm):
    """A body term whose answers are given."""

    answer: object
    image: object = None
    name = "field"

    def density(self):
        return self.answer

    def scaled(self, scale):
        return self if self.image is None else self.image


@pytest.mark.parametrize(
    ("term", "said"),
    [
        (Field(1.0), r"Field\.density: returned 1.0, expected a BodyDensity"),
        (Field(BodyDensity(np.nan)), r"Field\.density = nan: must be finite"),
        (Field(BodyDensity(), "x"), r"Field\.scaled: returned 'x', expected a Term"),
    ],
)
def test_a_wrong_term_is_blamed(term, said):
    scene = droplet(120.0, elements=4)
    with pytest.raises(iga.SceneError, match=rf"{HERE}\.{said}"):
        replace(scene, terms=[*scene.terms, term], ramp=None)


class Formless(Term):
    """What it pays for is not said."""

    name, forms = "formless", ()

    def scaled(self, scale):
        return self


class Unheard(Formless):
    forms = ("volts",)


@pytest.mark.parametrize("kind", [Formless, Unheard])
def test_a_term_that_counts_in_no_form_is_refused(kind):
    scene = droplet(90.0)
    with pytest.raises(iga.SceneError, match=rf"{HERE}\.{kind.__name__}\.forms = .*AreaTerm"):
        replace(scene, terms=[*scene.terms, kind()])


@dataclass(frozen=True)
class Length(LineTerm):
    """A line tension times the length of an edge; ``spoil`` makes derivatives wrong."""

    spoil: object = lambda name, right: right
    gamma: float = 1.0
    edge: str = "xi2=0"
    name = "line_tension"

    @property
    def strength(self):
        return 0.3

    def scaled(self, scale):
        return self

    def _curve(self, table, points):
        d = table.d @ points[table.functions]
        return d, np.linalg.norm(d, axis=-1)

    def energy(self, table, points, strength, body):
        return self.spoil(
            "energy", strength * (self._curve(table, points)[1] * table.weights).sum()
        )

    def forces(self, table, points, strength, body):
        d, length = self._curve(table, points)
        t = d * (strength * table.weights / length)[..., None]
        return self.spoil("forces", table.d.transpose(0, 2, 1) @ t)

    def hessian(self, table, points, strength, body):
        d, length = self._curve(table, points)
        t = d / length[..., None]
        across = (np.eye(3) - t[..., :, None] * t[..., None, :]) * (
            strength * table.weights / length
        )[..., None, None]
        return self.spoil("hessian", np.einsum("eqa,eqb,eqij->eaibj", table.d, table.d, across))


def spoils(what, how):
    return lambda name, right: how(right) if name == what else right


@pytest.mark.parametrize(
    ("term", "said"),
    [
        (Length(spoils("forces", lambda v: 1.01 * v)), r"Length\.forces: forces \. motion"),
        (Length(spoils("forces", lambda v: v[:-1])), r"Length\.forces: forces has shape"),
        (Length(spoils("hessian", lambda v: 0.99 * v)), r"Length\.hessian: hessian \. motion"),
        (Length(spoils("hessian", lambda v: v.sum(axis=2))), r"Length\.hessian: hessian has shape"),
        (Length(spoils("energy", lambda v: np.nan)), r"Length\.energy: energy is not finite"),
        (Length(spoils("energy", lambda v: "x")), r"Length\.energy: energy has shape"),
    ],
)
def test_a_wrong_line_term_is_blamed_before_the_solve(term, said):
    ring = iga.drop_space("bspline", 3, 4)
    flat = iga.axisymmetric(ring, lambda t: (1.0 - t, 0.0 * t, -np.ones_like(t)))
    scene = iga.Scene(flat, [iga.SurfaceTension(1.0), term], [iga.Fixed("xi2=0")])
    with pytest.raises(iga.SceneError, match=rf"{HERE}\.{said}"):
        iga.solve(scene)


def test_a_right_line_term_is_taken():
    from iga_membrane.terms.own import check_own_terms

    ring = iga.drop_space("bspline", 3, 4)
    flat = iga.axisymmetric(ring, lambda t: (1.0 - t, 0.0 * t, -np.ones_like(t)))
    scene = iga.Scene(flat, [iga.SurfaceTension(1.0), Length()], [iga.Fixed("xi2=0")])
    check_own_terms(scene.local_terms(), scene.local_surface(), scene.units)


def bad_measure(solution):
    return "high"


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda: iga.trace(lambda angle: droplet(angle).surface, [90.0, 91.0]), "must be a Scene"),
        (lambda: iga.trace(lambda angle: angle.scene, [90.0, 91.0]), "raised AttributeError"),
        (lambda: iga.critical_value(lambda angle: None, bad_measure, 80.0, 90.0), "a Scene"),
        (lambda: iga.critical_value(lambda angle: droplet(angle, elements=4), bad_measure, 80, 90),
         rf"{HERE}\.bad_measure"),
        (lambda: iga.axisymmetric(iga.ring_space("bspline", 2, 4), lambda t: (t, t, 1.0)),
         "dr/dt has shape"),
    ],
)  # fmt: skip
def test_wrong_functions_of_studies_are_blamed(ask, said):
    with pytest.raises(iga.SceneError, match=said):
        ask()
