"""Forces on particles that a membrane passes through, for any orientation of their lines.

The force of membrane and liquid is ``-dE/d(centre)``. A particle's place enters the energy through
its contact line and its wetted cap only; :mod:`..contact.unfitted_patches` has that derivative.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Index
from ..assembly.lagrangian import Assembly
from ..contact.unfitted import is_unfitted
from ..dofs.symmetry import mirrors
from ..problems.scene import Scene
from ..surface.surface import Surface
from .contact_patches import contact_patches
from .forces import ParticleForces, paper_forces


def forces_on_particles(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array
) -> tuple[ParticleForces, ...]:
    """Forces on each of a scene's particles, in their order; on a dry one its weight alone.

    Notes
    -----
    The liquid's part is ``F_P = -int p n dA`` over the wetted cap, exactly. Archimedes' term is the
    weight of liquid between the cap and the cone from the line to its centroid, against gravity,
    and ``F_H = F_P - F_B``.
    """
    unfitted, scale = assembly.contact, scene.units
    if not is_unfitted(unfitted):
        return ()
    body = assembly.density(multipliers)
    slope = np.array(body.gradient)
    spots = unfitted.spots(surface, mirrors(scene.sector))
    found = contact_patches(scene, assembly, surface, body)
    line = spots.line
    arc = np.linalg.norm(line.tangent, axis=-1) * line.table.weights
    middle = spots.vectors(np.einsum("kq,kqi->ki", arc, line.x))
    middle = middle / spots.total(arc.sum(axis=1))[:, None]

    def pushed(axis: int) -> Array:
        return spots.cap(lambda x, n, which: (body.constant + x @ slope) * n[..., axis])

    def over_cone(x: Array, normal: Array, which: Index) -> Array:
        apex = middle[np.searchsorted(spots.which, which)]
        return np.asarray(((x - apex) * normal).sum(axis=-1) / 3.0)

    pressed = spots.vectors(np.stack([pushed(k) for k in range(3)], axis=1))
    caps = spots.total(spots.cap(over_cone))
    unit, up, g = scale.force, scene.up, np.array(scene.acceleration)
    order = unfitted.term.particle(found.which)
    result = []
    for k, particle in enumerate(scene.particles):
        center = np.array(particle.center)
        weight = 4.0 / 3.0 * np.pi * particle.radius**3 * particle.density * g
        none = np.zeros(3)
        if k not in order:
            result.append(ParticleForces(center, up, weight, none, none, none, none, {}))
            continue
        i = int(np.flatnonzero(order == k)[0])
        buoyancy = -scene.liquid_density * g * caps[i] * scale.length**3
        pressure = scale.axes @ pressed[i] * unit
        contact = scale.axes @ (found.forces[i] - pressed[i]) * unit
        axis = scale.axes @ unfitted.term.axis(found.which[i : i + 1])[0]
        height = found.radii[i] * (1.0 - np.cos(found.polar[i])) * scale.length
        level = -float(body.at(middle[i])) * scale.pressure
        parts = (float(part @ axis) for part in (weight, contact, buoyancy))
        paper = paper_forces(particle, level, height, *parts)
        result.append(
            ParticleForces(
                center, up, weight, contact, pressure - buoyancy, buoyancy, np.zeros(3), paper
            )
        )
    return tuple(result)
