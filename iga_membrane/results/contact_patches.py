"""What the solids under a membrane carry, and which of them it should not have met."""

from __future__ import annotations

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..contact.patches import ContactPatches
from ..dofs.symmetry import in_sector, mirrors
from ..problems.scene import Scene
from ..surface.surface import Surface
from ..terms import BodyDensity


def substrate_patches(
    scene: Scene, assembly: Assembly, surface: Surface, body: BodyDensity
) -> ContactPatches:
    """Contact with the substrate, solid by solid; particles left out."""
    found = contact_patches(scene, assembly, surface, body)
    return found.part(assembly.contact.on_substrate(found.which))


def contact_patches(
    scene: Scene, assembly: Assembly, surface: Surface, body: BodyDensity
) -> ContactPatches:
    """Contact solid by solid, particles too, the mirror images of a sector unfolded.

    Parameters
    ----------
    body : body density of the Lagrangian, so minus the pressure.
    """
    images = mirrors(scene.sector)
    return assembly.contact.patches(surface, images, assembly.tension, body)


def engulfed(scene: Scene, assembly: Assembly, surface: Surface) -> int:
    """How many spheres near the membrane have their centre inside the liquid; where contact lines
    are inside the membrane, of those that have none."""
    behind = assembly.contact.behind(assembly.table, surface)
    return _in_sector(scene, assembly, surface, behind)


def touches_base(scene: Scene, assembly: Assembly, surface: Surface, found: ContactPatches) -> bool:
    """Whether a membrane on asperities has come down to the plane under them.

    Parameters
    ----------
    found : what carries it.
    """
    substrate = scene.substrate
    base = None if substrate is None else getattr(scene.units.local_solid(substrate), "base", None)
    if base is None:
        return False
    return assembly.contact.reaches(base, assembly.table, surface.points, found.which)


def unsupported(scene: Scene, assembly: Assembly, surface: Surface) -> int:
    """How many spheres of the sector a membrane has met that it does not notice."""
    met = assembly.contact.unsupported(assembly.table, surface.points)
    return _in_sector(scene, assembly, surface, met)


def _in_sector(scene: Scene, assembly: Assembly, surface: Surface, centers: Array) -> int:
    """How many centres (k, 3) lie in the sector that is computed."""
    if not len(centers):
        return 0
    near = 1e-9 * assembly.contact.length
    return int(in_sector(surface.space, scene.sector, centers, near).sum())
