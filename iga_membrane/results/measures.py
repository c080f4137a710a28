"""What a state measures: energies, areas, heights, angles, in the names of the result file."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..contact.patches import ContactPatches
from ..problems.scene import Scene
from ..solids import Plane, Sphere, SphereLattice, Spheres
from ..surface.surface import Surface
from ..terms import (
    BodyDensity,
    Scale,
    SphereContactLine,
)
from ..terms import variations as vary
from .apparent import apparent_angle, cassie_baxter_angle
from .bridge_measures import bridge_measures
from .contact_line import ContactLine, contact_line
from .contact_patches import substrate_patches
from .farthest import highest, widest
from .forces import line_on_sphere, pull_on_sphere
from .wetted_cap import WettedCap

UP = np.array([0.0, 0.0, 1.0])
"""Axis of the scene's frame along which heights are told."""


def measures(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array
) -> dict[str, Any]:
    """Measures of a state for the full body, in the user's units.

    Parameters
    ----------
    surface : in the scene's scale.

    Notes
    -----
    ``pressure`` is that at the world's origin, ``dE/dV``; None where a measure has no value.
    """
    scale = scene.units
    values: dict[str, Any] = energies(scene, assembly, surface)
    if scene.line_inside is not None:
        values |= _surface_energies(scene, assembly, surface, values)
    body = assembly.density(multipliers)
    values["pressure"] = -float(body.at(scale.to_local(np.zeros(3)))) * scale.pressure
    ends = sum(t.ends for t in scene.by_form.volumes)
    carries = assembly.contact.carries
    values["volume"] = volume(assembly, surface) * scale.length**3 + ends
    if scene.kind == "asperity_cell":
        values["V_liq"] = values.pop("volume")
        values |= _cell(scene, assembly, surface, body, values)
    elif scene.kind == "capillary_bridge":
        values |= bridge_measures(scene, assembly, surface, multipliers)
    elif scene.kind == "sessile_droplet" and (carries or not assembly.edges.wetted):
        values |= _on_solids(scene, assembly, surface, body, values)
    elif scene.kind == "sessile_droplet":
        wet = assembly.copies * assembly.edges.wet_areas(surface.points)[0] * scale.length**2
        values |= _droplet(scene, surface, wet, body, scale)
    elif scene.kind == "film_between_rings":
        values |= _film(surface, body, scale)
        values["volume"] = values.pop("volume") - ends + _under_rings(surface) * scale.length**3
    elif scene.kind == "liquid_sheet":
        values["V_liq"] = values.pop("volume") - ends + _under_hole(scene, assembly, surface)
        values |= _sheet(scene, assembly, surface, multipliers)
    return {name: None if value is None else float(value) for name, value in values.items()}


def height_of(scene: Scene, place: Array) -> float:
    """Height of a place (3,) of the scene's frame: above the substrate's plane z = 0; of a free
    droplet above the world's."""
    scale = scene.units
    return float(scale.to_world(place)[2] if scene.free else place[2] * scale.length)


def energies(scene: Scene, assembly: Assembly, surface: Surface) -> dict[str, float]:
    """Energies by kind and areas; the potential energy of weight is zero at the origin."""
    scale, copies = scene.units, assembly.copies
    local = scene.local_terms()
    gravity = sum((t.density() for t in local.weights), BodyDensity())
    area, wetting, wet = assembly.interface(surface)
    weight = assembly.body_integral(surface, gravity)
    tension = sum(t.gamma for t in local.surface_tensions)
    e_surf = copies * (tension * area + wetting) * scale.energy
    lift = _world_weight(scene, assembly, surface)
    return {
        "energy": copies * assembly.energy(surface) * scale.energy + lift,
        "E_surf": e_surf,
        "E_grav": copies * weight * scale.energy + lift,
        "A_LG": copies * area * scale.length**2,
        "A_wet": copies * wet * scale.length**2,
    }


def _surface_energies(
    scene: Scene, assembly: Assembly, surface: Surface, values: dict[str, float]
) -> dict[str, float]:
    """Energies and areas where the membrane covers the wetted area, without penalty and
    stabilization."""
    scale, table = scene.units, assembly.table
    (term, edge), edge_place = assembly.edges.wetted[0], surface.space.edge_place
    at = vary.element_points(table, surface.points)
    free = np.flatnonzero(table.parameters[:, 0, 1] > edge_place(term.edge)[1])
    area, _ = vary.energies(table.part(free), at.part(free), [])
    wet = term.energy(edge, surface.points, 1.0, BodyDensity())
    gain = -(term.strength + term.gamma * term.covered)
    e_surf = assembly.copies * (assembly.tension * area - gain * wet) * scale.energy
    liquid = volume(assembly, surface) * scale.length**3 + _under_hole(scene, assembly, surface)
    pressed = sum(t.density().constant for t in scene.by_form.pressures) * liquid
    return {
        "energy": e_surf + values["E_grav"] + pressed,
        "E_surf": e_surf,
        "A_LG": assembly.copies * area * scale.length**2,
        "A_wet": assembly.copies * wet * scale.length**2,
    }


def volume(assembly: Assembly, surface: Surface) -> float:
    """Liquid volume of the full body in the scene's scale, as the flux of ``z e_z``."""
    return assembly.copies * assembly.body_integral(surface, BodyDensity(1.0))


def _world_weight(scene: Scene, assembly: Assembly, surface: Surface) -> float:
    """Potential energy of the frame's origin: weight times its height."""
    origin = np.array(scene.units.origin)
    if not origin.any():
        return 0.0
    inside = volume(assembly, surface) * scene.units.length**3
    pull = [t.density_of_liquid * np.array(t.acceleration) for t in scene.by_form.weights]
    return float(-inside * sum(pull, np.zeros(3)) @ origin)


def _on_solids(
    scene: Scene,
    assembly: Assembly,
    surface: Surface,
    body: BodyDensity,
    values: dict[str, float],
) -> dict[str, Any]:
    """A drop whose membrane goes on over its foot: it lies on solids or passes through them."""
    scale, found = scene.units, substrate_patches(scene, assembly, surface, body)
    wet = float(found.areas.sum()) * scale.length**2
    # the middle of a foot that the membrane leaves out
    known = values["A_wet"] * assembly.contact.lies
    lying = wet * assembly.contact.lies
    top = highest(surface, UP)
    base = base_area(scene, found) + known / scale.length**2
    foot = float(np.sqrt(base / np.pi))
    angles: dict[str, Any] = {}
    rough = isinstance(scene.substrate, (SphereLattice, Spheres))
    if rough and base > 0:
        height = float(top[2])
        young = float(found.angles @ found.areas / found.areas.sum())
        angles = {
            "apparent_angle": apparent_angle(height, body, assembly.tension),
            "cassie_baxter_angle": cassie_baxter_angle(
                float(found.areas.sum()), float(found.projected.sum()), base, young
            ),
        }
    # how far an own pattern of asperities reaches is not known
    if rough or isinstance(scene.substrate, (Plane, Sphere)) or assembly.contact.passes:
        angles["contact_radius"] = foot * scale.length
    if assembly.contact.passes and not rough and len(found.which):
        angles["contact_angle_measured"] = float(found.angles.mean())
    return angles | {
        "A_LG": values["A_LG"] - lying,
        "A_wet": wet + known,
        "height": float(top[2]) * scale.length,
        "equator_radius": _width(surface) * scale.length,
        "p_apex": -float(body.at(top)) * scale.pressure,
        "p_base": -float(body.at(np.zeros(3))) * scale.pressure,
    }


def _cell(
    scene: Scene,
    assembly: Assembly,
    surface: Surface,
    body: BodyDensity,
    values: dict[str, float],
) -> dict[str, float]:
    """Contact with the one sphere of a cell and the membrane's sag beside it."""
    assert isinstance(scene.substrate, Sphere)
    scale, solid = scene.units, scene.units.local_sphere(scene.substrate)
    found = substrate_patches(scene, assembly, surface, body)
    force = -float(found.total[2])
    edge, corner = _edge_heights(surface)
    heights = {"z_edge": edge * scale.length, "z_corner": corner * scale.length}
    if not len(found.which):
        return heights | {"A_wet": 0.0, "F_sphere": 0.0}  # a failed state off its sphere
    polar, contact = float(found.polar[0]), float(found.heights[0])
    radius = solid.radius * np.sin(polar)
    wet = float(found.areas.sum())
    lying = wet * assembly.contact.lies
    press = -body.constant * float(found.projected.sum())
    return heights | {
        "A_LG": values["A_LG"] - lying * scale.length**2,
        "A_wet": wet * scale.length**2,
        "phi_deg": float(np.degrees(polar)),
        "contact_radius": radius * scale.length,
        "cap_height": solid.radius * (1.0 - np.cos(polar)) * scale.length,
        "contact_angle_measured": float(found.angles[0]),
        "sag": (contact - edge) * scale.length,
        "F_sphere": force * scale.force,
        "F_press": press * scale.force,
        "F_line": (force - press) * scale.force,
    }


def _edge_heights(surface: Surface) -> tuple[float, float]:
    """Mean height of the membrane at the middles of a cell's sides and at its corners; on a circle
    both are that of the rim."""
    if surface.space.bases[0].periodic:
        rim = float(surface.net[:, 0, 2].mean())
        return rim, rim
    ends = np.array([0.0, 0.5, 1.0])
    grid = surface.at(np.stack(np.meshgrid(ends, ends, indexing="ij"), axis=-1), 1).position[..., 2]
    sides = (grid[0, 1] + grid[1, 0] + grid[2, 1] + grid[1, 2]) / 4.0
    corners = (grid[0, 0] + grid[0, 2] + grid[2, 0] + grid[2, 2]) / 4.0
    return float(sides), float(corners)


def base_area(scene: Scene, found: ContactPatches) -> float:
    """Area of the foot (dimensionless): of the wet spheres' lattice cells, of the convex hull of
    a list of spheres, of the wet spot on a single solid."""
    solid = scene.units.local_solid(scene.substrate) if scene.substrate is not None else None
    on_sphere = found.which >= 0
    if isinstance(solid, SphereLattice):
        return float(on_sphere.sum() * solid.area_per_sphere)
    if isinstance(solid, Spheres) and on_sphere.sum() >= 3:
        from scipy.spatial import ConvexHull

        return float(ConvexHull(found.centers[on_sphere, :2]).volume)
    return float(found.projected.sum())


def _width(surface: Surface) -> float:
    """Largest distance of the membrane from the vertical axis through its middle."""
    x = surface.grid(33, 33, 1).position[..., :2]
    middle = 0.5 * (x.max(axis=(0, 1)) + x.min(axis=(0, 1)))
    point = widest(surface, middle)
    return float(np.linalg.norm(point[:2] - middle))


def _droplet(
    scene: Scene, surface: Surface, wet: float, body: BodyDensity, scale: Scale
) -> dict[str, float]:
    """Heights, radii and angle of a drop on a plane or on a sphere."""
    apex, solid = _apex(scene, surface), sphere_of(scene)
    line = contact_line(surface, scene.line_inside or "xi2=0", solid=solid)
    length = float(line.arc.sum())
    values = {
        "height": height_of(scene, apex),
        "equator_radius": _equator(surface, line) * scale.length,
        "p_apex": -float(body.at(apex)) * scale.pressure,
        "contact_angle_measured": float(np.degrees(line.angle @ line.arc / length)),
    }
    if solid is None:
        base = -float(body.at(np.zeros(3))) * scale.pressure
        return values | {"contact_radius": float(np.sqrt(wet / np.pi)), "p_base": base}
    # the wetted cap's area gives its mean polar angle: 1 - cos = A / (2 pi r^2)
    share = wet / scale.length**2 / (2.0 * np.pi * solid.radius**2)
    polar = 2.0 * np.arcsin(np.sqrt(0.5 * share))
    top = np.array(solid.center) + [0.0, 0.0, solid.radius]
    level = top - [0.0, 0.0, solid.radius * share]
    return values | {
        "alpha_deg": float(np.degrees(polar)),
        "contact_radius": solid.radius * float(np.sin(polar)) * scale.length,
        "z_contact": height_of(scene, level),
        "p_contact": -float(body.at(level)) * scale.pressure,
        "p_top": -float(body.at(top)) * scale.pressure,
    }


def _apex(scene: Scene, surface: Surface) -> Array:
    """The pole of a droplet; of one between two particles its highest point."""
    if scene.free and len(scene.particles) > 1:
        return highest(surface, scene.units.axes[2])
    if surface.space.pole is not None and scene.sector.model in ("quarter", "eighth"):
        return np.asarray(surface.net[0, -1])
    return highest(surface, UP)


def _sheet(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array
) -> dict[str, float]:
    """Contact on the particle, as means along the line, and the vertical forces on it."""
    scale, solid = scene.units, sphere_of(scene)
    if solid is None:
        # a patch closed by its pole, or an open square
        middle = [0.0, 1.0] if surface.space.pole is not None else [0.5, 0.5]
        return {"sag": -float(surface.at(middle, 1).position[2]) * scale.length}
    forces = pull_on_sphere(scene, assembly, surface, multipliers)
    line = line_on_sphere(scene, assembly, surface)
    length = float(line.arc.sum())
    away = line.position - np.array(solid.center)
    radius = np.linalg.norm(away[:, :2], axis=1)
    polar = float(np.arctan2(radius, away[:, 2]) @ line.arc) / length
    height = solid.radius - float(away[:, 2] @ line.arc) / length
    gamma = assembly.tension
    return {
        "phi_deg": float(np.degrees(polar)),
        "psi_deg": 180.0 - solid.contact_angle - float(np.degrees(polar)),
        "contact_radius": float(radius @ line.arc) / length * scale.length,
        "cap_height": height * scale.length,
        "z_contact": float(line.position[:, 2] @ line.arc) / length * scale.length,
        "V_cap": WettedCap(line, solid).volume_over_cone * scale.length**3,
        "F_total": float(forces.total[2]) * scale.force,
        "F_P": float(forces.pressure[2]) * scale.force,
        "F_CL": float(forces.total[2] - forces.pressure[2]) * scale.force,
        "F_CL_line": -float(line.conormal[:, 2] @ line.arc) * gamma * scale.force,
        "contact_angle_measured": float(np.degrees(line.angle @ line.arc / length)),
    }


def _under_hole(scene: Scene, assembly: Assembly, surface: Surface) -> float:
    """What the flux of ``z e_z`` through a covered sphere leaves out: the cap inside the fixed edge
    of its membrane."""
    lines = assembly.edges.wetted
    line = lines[0][0] if lines else None
    if line is None or line.ball is None or not line.covered:
        return 0.0
    sectors = np.arange(surface.space.bases[0].elements // assembly.copies)
    table = surface.space.edge_table("xi2=0", elements=sectors)
    cap = SphereContactLine(line.gamma, line.ball)
    inside = cap.energy(table, surface.points, 0.0, BodyDensity(1.0))
    return assembly.copies * inside * scene.units.length**3


def sphere_of(scene: Scene) -> Sphere | None:
    """The sphere on which the membrane's first line lies, in the scene's scale; None on a plane."""
    terms = scene.local_terms()
    if terms.wetting:
        return terms.wetting[0].ball
    passed = terms.unfitted
    return passed.solid if passed is not None and isinstance(passed.solid, Sphere) else None


def own_asperity(scene: Scene) -> int | None:
    """Number of the asperity, one of many, on which alone a droplet ends; else None."""
    solid, own = scene.substrate, sphere_of(scene)
    if own is None or not isinstance(solid, (SphereLattice, Spheres)):
        return None
    return int(solid.nearest(scene.units.to_world(np.array(own.center))).which)


def _film(surface: Surface, body: BodyDensity, scale: Scale) -> dict[str, float]:
    """Neck, pull on the rings and slope at them; the tension is 1 in the scene's scale."""
    ring = surface.space.bases[0]
    phi = ring.breaks[:-1]
    middle = surface.at(np.column_stack([phi, np.full(len(phi), 0.5)]), 1).position
    top = contact_line(surface, "xi2=1")
    radius = np.linalg.norm(top.position[:, :2], axis=1)
    outward = np.einsum("ki,ki->k", top.conormal[:, :2], top.position[:, :2]) / radius
    slope = np.arctan2(outward, top.conormal[:, 2])
    area = 0.5 * float(radius @ top.arc)
    return {
        "neck_radius": float(np.linalg.norm(middle[:, :2], axis=1).mean()) * scale.length,
        "force": (float(top.conormal[:, 2] @ top.arc) + body.constant * area) * scale.force,
        "end_slope_deg": float(np.degrees(slope @ top.arc / top.arc.sum())),
    }


def _under_rings(surface: Surface) -> float:
    """What the flux of ``z e_z`` through the film leaves out: the discs of its rings."""
    total = 0.0
    for edge, sign in (("xi2=1", 1.0), ("xi2=0", -1.0)):
        line = contact_line(surface, edge)
        radius = np.linalg.norm(line.position[:, :2], axis=1)
        total += sign * float(0.5 * (radius * line.position[:, 2]) @ line.arc)
    return total


def _equator(surface: Surface, line: ContactLine) -> float:
    """Largest distance from the axis through the middle of the contact line."""
    middle = line.arc @ line.position[:, :2] / line.arc.sum()
    point = widest(surface, middle)
    return float(np.linalg.norm(point[:2] - middle))
