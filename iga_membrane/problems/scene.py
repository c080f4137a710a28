"""A scene: a surface, what it pays for, how it may move. Data only; nothing here solves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, cast

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import array, listed, number, record, words
from ..dofs.boundary_conditions import Sector, Support, Supports
from ..errors import SceneError
from ..overview import Overview, Told, flat_rows
from ..quantities import DIMENSIONLESS
from ..solids import Plane, Solid, Sphere
from ..splines import Grading
from ..surface.surface import Surface
from ..terms import Scale, Term
from ..terms.own import scaled_term
from ..terms.terms import Terms
from .changed import Origin, adapted, origin_of
from .recipe import Recipe
from .well_posed import check_mirrors, check_parts

OF_TITLE = ("scene", "units")
"""Words of a description that stand in the title of an overview."""


@dataclass(frozen=True)
class Ramp:
    """A way to a scene: scenes of one space along a parameter.

    Attributes
    ----------
    parameter : its path in the scene file, "gravity.acceleration".
    values : what it is at equal parts of the load, from 0 to 1.
    scene_at : value of the parameter to the scene.
    asked : whether the user wants the way itself, not only its end: no direct solve is tried.
    only : whether a direct solve is known to fail.
    bound : value from which on a balance of forces known in closed form rules out every
        equilibrium, or None.
    """

    parameter: str
    values: tuple[float, ...]
    scene_at: Callable[[float], Scene] = field(repr=False)
    asked: bool = False
    only: bool = False
    bound: float | None = None

    @property
    def stops(self) -> Array:
        """Loads of the values; load steps end there."""
        return np.linspace(0.0, 1.0, len(self.values))

    def value(self, load: float) -> float:
        """The parameter at a load in [0, 1]."""
        return float(np.interp(load, self.stops, self.values))

    def short_of_bound(self, load: float) -> float:
        """Distance of the value at a load from the bound, over it; infinite without one."""
        return np.inf if self.bound is None else 1.0 - self.value(load) / self.bound

    def load_at_bound(self, after: float) -> float:
        """The first load after another at which the value is the bound, which it passes."""
        assert self.bound is not None
        stops = self.stops[self.stops > after]
        loads = np.concatenate([[after], stops])
        values = [self.value(load) for load in loads]
        first = int(np.argmax(np.array(values) >= self.bound))
        before = values[first - 1]
        part = (self.bound - before) / (values[first] - before)
        return float(loads[first - 1] + part * (loads[first] - loads[first - 1]))

    def __call__(self, load: float) -> Scene:
        value = self.value(load)
        scene = self.scene_at(value)
        record(f"scene_at({value:g})", scene, Scene)
        return scene


@dataclass(frozen=True)
class TangentEdge:
    """An edge that leaves a solid tangentially.

    Attributes
    ----------
    edge : of the patch; solid : in the scene's scale.
    carries : whether it is a plane that alone carries the whole liquid.
    """

    edge: str
    solid: Plane | Sphere
    carries: bool = False


class FreeEdge:
    """Edges at 0 or 180 degrees: the membrane leaves smooth solids tangentially, at places to be
    found. A place is a coordinate of the edge on its solid, a radius or an angle.
    """

    def edges(self, scene: Scene) -> list[TangentEdge]:
        """The edges."""
        raise NotImplementedError

    def surface_at(self, scene: Scene, place: Array) -> Surface:
        """A scene's start with its edges at places (k,)."""
        raise NotImplementedError

    def place_of(self, surface: Surface) -> Array:
        """(k,) coordinates of a surface's edges, in the scene's scale."""
        raise NotImplementedError

    def foretold(self, scene: Scene) -> Surface:
        """A scene's start, with the edges where its own weight and volume foretell them."""
        return scene.surface

    def fixed_at(self, scene: Scene, place: Array) -> Scene:
        """A scene with its edges at other places."""
        return replace(scene, surface=self.surface_at(scene, place))


@dataclass(frozen=True)
class FreeParticles:
    """Particles that move along lines until the forces along them vanish.

    Attributes
    ----------
    which : (k,) their numbers.
    lines : (k, 3) unit vectors; radii : (k,) of the particles; tension : of the liquid.
    outward : (k,) part of the direction out of the liquid along each line.
    least : (k,) displacement at which the substrate stops a particle, -inf without.
    recipe : of the scene with its particles fixed; argument : of it that is theirs.
    held : the particles where they are now, fixed.
    """

    which: Array
    lines: Array
    radii: Array
    tension: float
    outward: Array
    least: Array
    recipe: Recipe = field(repr=False)
    argument: str
    held: tuple[Sphere, ...]

    def scene_at(self, displacement: Array) -> Scene:
        """The scene with its particles fixed at displacements (k,) along the lines."""
        moved = list(self.held)
        for i, line, way in zip(self.which, self.lines, displacement, strict=True):
            x, y, z = (float(c) for c in np.array(moved[i].center) + way * line)
            moved[i] = replace(moved[i], center=(x, y, z))
        several = listed(self.recipe.arguments[self.argument])
        scene: Scene = self.recipe.scene(**{self.argument: moved if several else moved[0]})
        return scene


@dataclass(frozen=True, repr=False)
@checked(
    directions=partial(array, shape=(None, 3)),
    motion="solver.motion",
    hold=words("", "x", "xy", "xyz"),
    liquid_density="liquid.density",
)
class Scene(Told):
    """Everything a solve needs to know.

    Attributes
    ----------
    surface : the start, in world coordinates and the user's units.
    terms : what the membrane pays for; a term that is not listed costs nothing.
    supports : how edges and symmetry restrict the motion.
    scale : units and frame of the computation; by default the surface's size and the tension.
        Sliding edges lie in z = 0 of its frame.
    grading : spread of the control points along the meridians; None leaves them where they are.
    directions : (count, 3) in which the control points move, the same at every step; if None the
        normals of the current surface.
    motion : "spines", one unknown per control point, or "cartesian", three, which needs a
        Stabilization.
    ramp : the way to this scene if a direct solve fails.
    predictor : a scene whose equilibrium is near this one's; contact lines inside the membrane
        start from it.
    start_from : that equilibrium's surface to one of this scene's space, both in their scales, if
        the spaces differ.
    otherwise : how to ask the same in another discretization, tried where this one fails.
    finer : how to ask the same on a finer mesh, tried where the audit finds this one too coarse.
    free_edge : the way to find the places of fixed edges at 0 or 180 degrees.
    free_particles : those that move.
    substrate : the solid that the membrane touches, for its kind and pictures.
    particles : spheres on which it pulls too.
    hold : axes along which the user asked for the centroid to be held.
    acceleration : world vector that weighs particles and the liquid on them.
    liquid_density : of that liquid.
    kind : name of the family, which decides the measures of a solution.
    description : the scene in words of the scene file, for the result.
    warnings : what a user should know about the input.
    recipe : how the scene was asked for, or None if it was built from its parts.
    origin : what the ways were made for; None makes them this scene's own. A scene of which fields
        were replaced leaves out the ways of the one before (:mod:`.changed`).
    """

    surface: Surface
    terms: Sequence[Term]
    supports: Sequence[Support] = ()
    scale: Scale | None = None
    grading: Grading | None = field(default_factory=Grading)
    directions: Array | None = field(default=None, repr=False)
    motion: str = "spines"
    ramp: Ramp | None = field(default=None, repr=False)
    predictor: Scene | None = field(default=None, repr=False)
    start_from: Callable[[Surface], Surface] | None = field(default=None, repr=False)
    otherwise: Recipe | None = field(default=None, repr=False)
    finer: Recipe | None = field(default=None, repr=False)
    free_edge: FreeEdge | None = field(default=None, repr=False)
    free_particles: FreeParticles | None = field(default=None, repr=False)
    substrate: Solid | None = None
    particles: Sequence[Sphere] = ()
    hold: str = ""
    acceleration: tuple[float, float, float] = (0.0, 0.0, 0.0)
    liquid_density: float = 0.0
    kind: str = "membrane"
    description: Mapping[str, Any] = field(default_factory=dict, repr=False)
    warnings: Sequence[str] = ()
    recipe: Recipe | None = field(default=None, repr=False, compare=False)
    origin: Origin | None = field(default=None, repr=False, compare=False, metadata={"kept": False})

    def __post_init__(self) -> None:
        object.__setattr__(self, "terms", Terms(self.terms))
        object.__setattr__(self, "supports", Supports(self.supports))
        if self.origin is not None:
            for name, value in adapted(self, self.origin).items():
                object.__setattr__(self, name, value)
        check_parts(self)
        if self.scale is None:
            tension = self.by_form.surface_tensions[0].gamma
            object.__setattr__(self, "scale", Scale(self.surface.size, tension))
        check_mirrors(self)
        object.__setattr__(self, "origin", origin_of(self))

    def at(self, path: str, value: float | str) -> Scene:
        """The scene with one number changed.

        Parameters
        ----------
        path : of the number in the words of the scene file, "substrate.contact_angle",
            "liquid.volume", "gravity.acceleration", "particle[0].center[2]".
        value : of the number, in the user's units, or with its own, "4 uL".

        Returns
        -------
        Scene
            Built anew, with the ways round a failing solve that are its own.

        Raises
        ------
        SceneError
            There is no such number, or it is out of its range; or the scene was built from its
            parts, or parts of it were replaced: build it anew instead.
        """
        if self.recipe is None:
            raise SceneError(
                f"path = {path!r}: this scene was built from its parts, or parts of it were "
                "replaced; build it anew with the number changed"
            )
        scene: Scene = self.recipe.at(path, number(str(path), value)).scene()
        return scene

    def bound(self, parameter: str) -> float | None:
        """Value of a parameter from which on a balance of forces rules out every equilibrium, where
        it is known."""
        return (
            self.ramp.bound if self.ramp is not None and self.ramp.parameter == parameter else None
        )

    @property
    def line_inside(self) -> str | None:
        """The line of a membrane that covers the wetted area too, where it leaves the solid."""
        return next((t.edge for t in self.by_form.wetting if t.covered), None)

    @property
    def lateral_load(self) -> dict[str, float]:
        """Body force per volume along the axes x and y of the frame, where there is any
        (dimensionless)."""
        bodies = [t.density().gradient for t in self.local_terms().bodies]
        x, y, z = (sum(parts) for parts in zip(*bodies, strict=True)) if bodies else (0, 0, 0)
        noise = 1e-12 * (abs(x) + abs(y) + abs(z))
        return {axis: -pull for axis, pull in (("x", x), ("y", y)) if abs(pull) > noise}

    @property
    def loose_axes(self) -> str:
        """Axes along which the membrane is free to slide on a plane; particles hold it."""
        kinds = self.by_kind
        lies_on_it = any(isinstance(t.solid, Plane) for t in self.by_form.obstacles)
        held = self.particles or kinds.fixed or kinds.mirrors
        if held or not (kinds.on_plane or lies_on_it):
            return ""
        return "".join(axis for axis in "xy" if axis not in self.sector.mirrored)

    def overview(self) -> Overview:
        """Its kind and its description, a row for each table of the scene file."""
        words = {key: value for key, value in self.description.items() if key not in OF_TITLE}
        words = words or {"terms": [term.name for term in self.terms]}
        rows = [*flat_rows(words), *(("warning", text) for text in self.warnings)]
        return Overview(f"{self.kind.replace('_', ' ')}, {self.unit_system}", rows)

    @property
    def unit_system(self) -> str:
        """Of its numbers: "SI" if they were given with units, else "dimensionless"."""
        return str(self.description.get("units", DIMENSIONLESS))

    @property
    def units(self) -> Scale:
        """The scale, never None."""
        assert self.scale is not None
        return self.scale

    @property
    def free(self) -> bool:
        """Whether the liquid touches nothing but particles, of which one is its substrate."""
        return self.substrate in self.particles

    @property
    def up(self) -> Array:
        """(3,) unit vector along which forces are normal: that of the substrate or of a level rim;
        of a free droplet against gravity, or without any its frame's z."""
        pull = np.array(self.acceleration) * self.free
        size = float(np.linalg.norm(pull))
        return -pull / size if size else self.units.axes[:, 2]

    @property
    def meridian_grading(self) -> Grading | None:
        """The grading of a ring patch; other patches, and membranes that lie on a solid, keep
        their parametrization."""
        lying = self.by_form.obstacles or self.by_form.passed
        regular = self.surface.space.bases[0].periodic and not lying
        return self.grading if regular else None

    @property
    def sector(self) -> Sector:
        """The part of a closed patch that is computed."""
        return self.by_kind.sector

    def local_surface(self) -> Surface:
        """The start in the scene's scale and frame; edges that slide on planes exactly in them.

        Raises
        ------
        SceneError
            If a sliding edge lies off the plane.
        """
        points = self.units.to_local(self.surface.points)
        for support in self.local_supports().flat:
            edge = self.surface.space.edge_functions(support.edge)
            off = float(np.abs(points[edge, 2] - support.level).max())
            if off > 1e-6:
                raise SceneError(
                    f"surface: its sliding edge {support.edge} lies {off:g} lengths off the "
                    "plane; start with the edge in the plane"
                )
            points[edge, 2] = support.level
        return self.surface.moved(points)

    def along_spines(self, surface: Surface) -> Scene:
        """The scene without what holds control points in the membrane's plane, from a state in its
        scale."""
        terms = [term for term in self.terms if term not in self.by_form.stabilizations]
        start = surface.moved(self.units.to_world(surface.points))
        return replace(self, surface=start, terms=terms, motion="spines", ramp=None, origin=None)

    @property
    def by_form(self) -> Terms:
        """The terms by their form, in the user's units."""
        return cast(Terms, self.terms)

    @property
    def by_kind(self) -> Supports:
        """The supports by their kind, in the user's units."""
        return cast(Supports, self.supports)

    def local_supports(self) -> Supports:
        """The supports in the scene's scale and frame."""
        return self._local_supports

    @cached_property
    def _local_supports(self) -> Supports:
        return Supports(support.scaled(self.units) for support in self.supports)

    def local_terms(self) -> Terms:
        """The terms in the scene's scale and frame."""
        return self._local_terms

    @cached_property
    def _local_terms(self) -> Terms:
        return Terms(scaled_term(term, self.units) for term in self.terms)
