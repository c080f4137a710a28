"""How a droplet meets its solids, and the ways to it where a direct solve fails."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..initial.liquid import Discretization
from ..solids import Plane, Sphere, SphereLattice, Spheres
from ..solids.wettability import least_angle
from ..terms import Centroid, SphereContactLine, Term, TrimmedContactLine
from .bridge import AtGap, Ends, bridge, easy_gap, gap_between
from .contact_setup import foot_of
from .continuation_path import from_alone, from_another_angle
from .free import Displaced, pulled_by
from .free_rim import RimOnPlane
from .moving import moving
from .particle_foot import with_particles
from .recipe import Along, Recipe
from .scene import Ramp, Scene
from .spec import Foot, Question


def built_for(parts: Question, ends: Ends | None) -> Foot:
    """Start, supports and terms where a droplet meets its solids.

    Parameters
    ----------
    ends : the two solids that it bridges, or None.
    """
    if ends is not None:
        return bridge(parts, ends)
    return with_particles(parts) if parts.particles else foot_of(parts)


def ramp_of(
    parts: Question, ends: Ends | None, built: Foot, recipe: Recipe, pull: float
) -> Ramp | None:
    """The way to a droplet from an easier one: two solids that are near, less gravity, a particle
    that pulls less; None where none is known.

    Parameters
    ----------
    built : the droplet's foot, whose mesh the way keeps.
    recipe : of the droplet; pull : size of gravity.
    """
    if ends is not None and (near := easy_gap(parts, ends)) is not None:
        return Ramp("gap", (near, gap_between(ends)), AtGap(recipe, ends))
    solid = parts.substrate
    # at 180 degrees on a plane there is nothing to start from without gravity
    falls = isinstance(solid, Plane) and least_angle(solid.contact_angle) < 180.0
    passes = not isinstance(solid, (Plane, Sphere, SphereLattice, Spheres)) and (
        least_angle(solid.contact_angle) < 180.0
    )
    has_way = falls or passes or isinstance(solid, Sphere) or parts.contact_line == "conforming"
    if parts.bond.any() and has_way:
        asked = recipe.arguments["discretization"]
        mesh = replace(asked, degree=built.mesh.degree, elements=built.mesh.elements)
        recipe = recipe.changed(discretization=mesh)
        return Ramp("gravity.acceleration", (0.0, pull), Along(recipe, "gravity.acceleration"))
    if recipe.arguments["substrate"] is None and parts.held:
        (particle, *_), length = recipe.arguments["particles"], parts.scale.length
        values = 0.0, pulled_by(particle, length)
        return Ramp("particle[0] displacement", values, Displaced(recipe, particle, length))
    return None


def between_particles(scene: Scene, built: Foot, grains: Sequence[Sphere], axis: Array) -> Scene:
    """A free droplet, or one that bridges two solids along an axis (3,)."""
    free = len(grains) == 2 or scene.free
    toward = axis * ([[1.0], [-1.0]] if free else [[-1.0]])[: len(grains)]
    scene, recipe = replace(scene, free_edge=built.free_edge), scene.recipe
    assert recipe is not None
    return moving(scene, grains, toward, scene.units.tension, recipe)


def with_its_particles(
    scene: Scene, built: Foot, grains: Sequence[Sphere], terms: Sequence[Term]
) -> Scene:
    """A droplet with particles on its surface, which starts from the droplet without them.

    Parameters
    ----------
    terms : what it pays for besides its contact.
    """
    line, recipe = built.terms[-1], scene.recipe
    assert isinstance(line, (TrimmedContactLine, SphereContactLine))
    assert recipe is not None
    if built.alone is None:
        alone = recipe.scene(
            particles=(), hold="none", discretization=Discretization(), contact_line="auto"
        )
    else:
        # it must not roll away from its particles
        loose = [a for a in "xy" if a not in built.sector.mirrored and a not in scene.hold]
        bare = [*terms, *(Centroid(axis) for axis in loose)]
        alone = from_another_angle(replace(scene, particles=(), origin=None), bare, built.alone)
    scene = from_alone(replace(scene, start_from=built.start_from), alone)
    toward = np.atleast_2d(np.array(line.toward))
    return moving(scene, grains, toward, scene.units.tension, recipe)


def with_its_ways(scene: Scene, built: Foot, parts: Question, terms: Sequence[Term]) -> Scene:
    """A droplet alone: on a finer mesh, from another angle, or with a search for its edge."""
    recipe, asked = scene.recipe, parts.asked
    assert recipe is not None
    if built.directions is not None and asked.elements is None and parts.start is None:
        twice = replace(asked, model=built.sector.model, elements=2 * built.mesh.elements)
        scene = replace(scene, finer=recipe.changed(discretization=twice))
    if built.predictor:
        return from_another_angle(scene, terms, built)
    return replace(scene, free_edge=RimOnPlane(recipe)) if built.tangent else scene
