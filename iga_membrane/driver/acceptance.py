"""Whether a state is a success: what its audit, its contact and its stability object to."""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Mask
from ..assembly.lagrangian import Assembly
from ..problems.scene import Scene
from ..results.contact_line import contact_line
from ..results.contact_patches import contact_patches, engulfed, touches_base, unsupported
from ..results.measures import own_asperity, sphere_of
from ..solids import Plane, Sphere, SphereLattice, Spheres
from ..solvers.stability import Stability
from ..status import Status
from ..surface.inside import inside
from ..surface.surface import Surface
from ..verification.evidence import TOLERANCE, Audit


def _unheld(scene: Scene) -> str:
    """Axes along which nothing but the computation holds the membrane."""
    return "".join(axis for axis in scene.loose_axes if axis not in scene.hold)


def judge(
    scene: Scene, verdict: Stability, checked: Audit | None, inside: float
) -> tuple[Status, str]:
    """Status of a converged state."""
    slipping = {a: f for a, f in scene.lateral_load.items() if a in _unheld(scene)}
    if slipping and not any(line.holds for line in scene.by_form.lines):
        pull = float(np.linalg.norm(list(slipping.values())))
        force = pull * inside * scene.units.force
        return Status.NO_EQUILIBRIUM, (
            f"nothing balances a tangential force of {force:.6g}: a smooth plane holds no droplet "
            'against it; hold the centroid (droplet.hold = "xy") or level the plane'
        )
    if checked is not None:
        found = defect(checked, _tolerated_depth(scene))
        if found is not None:
            return found
    if verdict.index > 0 and verdict.smallest < 0:
        return Status.CONVERGED_SADDLE, (
            f"equilibrium, but unstable: {verdict.index} motion(s) lower the energy (eigenvalue "
            f"{verdict.smallest:.3g}); {_way_out(scene, verdict)}"
        )
    if verdict.marginal or verdict.index > 0:
        return Status.CONVERGED_MARGINAL, (
            f"equilibrium, but the smallest eigenvalue {verdict.smallest:.1e} is below its own "
            f"error {verdict.error:.1e}"
        )
    if checked is None or not checked.gathered:
        return Status.UNVERIFIED, "converged and stable, but not audited"
    return Status.CONVERGED_STABLE, "converged, audited and stable"


def _way_out(scene: Scene, verdict: Stability) -> str:
    """What to do about an unstable equilibrium."""
    if verdict.held_index == 0:
        return (
            'the droplet would roll or slide off; hold its centroid by droplet.hold = "xy" to see '
            "this state"
        )
    if verdict.beyond_model:
        return (
            f'the "{scene.sector.model}" model is symmetric against that; take '
            f'discretization.model = "{verdict.within}" and disturb the start to leave it'
        )
    return "disturb the start to leave it"


def _tolerated_depth(scene: Scene) -> float:
    """Depth in the solid over its contact length."""
    law = scene.by_form.obstacle
    if law is not None:
        return law.depth
    curved = sphere_of(scene) is not None
    return TOLERANCE.indentation if curved else TOLERANCE.penetration


def defect(checked: Audit, depth: float) -> tuple[Status, str] | None:
    """The audit's first objection, or None.

    Parameters
    ----------
    depth : in the substrate that is allowed, in the units of the audit's ``penetration``.
    """
    found = next((check for check in checked.checks(depth) if check.objects), None)
    return None if found is None else (found.status, found.message)


def rests_on_a_point(scene: Scene) -> tuple[Status, str, str] | None:
    """How a droplet ends that nothing presses onto solids that it does not wet at all, or None:
    it has no foot there, whatever the mesh makes of it."""
    terms = scene.local_terms()
    pressed = terms.gaps or any(any(t.density().gradient) for t in terms.bodies)
    alone = terms.volumes and not scene.particles
    meets = [t.repels for t in terms.obstacles] + [t.repels for t in terms.wetting]
    if not (meets and all(meets) and alone) or terms.passed or pressed:
        return None
    return (
        Status.TOPOLOGY_CHANGE,
        "touches_in_a_point",
        "nothing presses the droplet onto its solid, which it does not wet at 180 degrees: it "
        "touches it in a point at most; give it weight, or a smaller contact angle",
    )


def contact_objection(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array
) -> tuple[Status, str | None, str] | None:
    """What makes a converged state on a contact area no success, or None."""
    feet = contact_patches(scene, assembly, surface, assembly.density(multipliers))
    if touches_base(scene, assembly, surface, feet):
        return (
            Status.TOPOLOGY_CHANGE,
            "touches_base",
            "the liquid touches the plane under the asperities",
        )
    coarse = assembly.contact.objection(surface.points)
    if coarse is not None:
        return Status.UNDERRESOLVED, None, coarse
    beside = unsupported(scene, assembly, surface)
    if beside:
        return (
            Status.UNDERRESOLVED,
            None,
            f"the membrane has come down on {beside} asperities beside its finely meshed foot, "
            "which are no supports there: hold the droplet (droplet.hold) or start nearer to it",
        )
    inside = engulfed(scene, assembly, surface)
    if inside:
        return (
            Status.TOPOLOGY_CHANGE,
            "engulfed",
            f"{inside} spheres lie inside the liquid: the membrane has passed them; start from "
            "the flat solution or with a smaller load",
        )
    lost = assembly.contact.without_line(feet.which, len(scene.particles))
    if lost:
        return (
            Status.TOPOLOGY_CHANGE,
            "detached",
            f"the droplet does not touch particle[{lost[0]}] any more: bring it nearer",
        )
    return None


def leaves_its_rim(scene: Scene, surface: Surface) -> tuple[Status, str, str] | None:
    """How a membrane ends whose contact line does not stay on the rim of a disc, or None: by the
    angles along it, which Gibbs' range bounds."""
    for term in scene.local_terms().rims:
        line = contact_line(surface, term.edge, solid=term.face)
        angles = np.degrees(line.angle)
        young, most = term.contact_angle, term.contact_angle + term.turn_of_rim
        if angles.min() < young - GIBBS:
            way = (
                f"recedes over the face, at {angles.min():.4g} degrees of {young:g} at least; "
                "give a Plane of that contact angle in its place"
            )
        elif angles.max() > most + GIBBS:
            way = f"runs down the side, at {angles.max():.4g} degrees of {most:g} at most"
        else:
            continue
        said = f"the contact line does not stay on the rim of the disc: it {way}"
        return Status.TOPOLOGY_CHANGE, "leaves_its_rim", said
    return None


GIBBS = 0.01
"""Degrees by which angles along a rim may leave Gibbs' range: default meshes have them within 1e-3
where the exact ones are at its end."""
EQUILIBRIA = frozenset({
    Status.CONVERGED_STABLE, Status.CONVERGED_SADDLE, Status.CONVERGED_MARGINAL,
})  # fmt: skip
"""Ends in which the forces balance."""


def leaves_its_asperity(
    scene: Scene, surface: Surface, status: Status, message: str
) -> tuple[Status, str, str] | None:
    """How a droplet ends that stood on one asperity of many, where it is not on it alone, or None.

    Beyond its limit on that asperity there may be an equilibrium on several.
    """
    own = own_asperity(scene)
    if own is None:
        return None
    if status is Status.LIMIT_POINT:
        said = f"the droplet does not stay on one asperity: {message}"
        return Status.TOPOLOGY_CHANGE, "leaves its asperity", said
    if status not in EQUILIBRIA:
        return None
    assert scene.substrate is not None
    solid = scene.units.local_solid(scene.substrate)
    assert isinstance(solid, (SphereLattice, Spheres))
    x = surface.grid(*SAMPLED, 1).position
    at = solid.nearest(x)
    met = at.which[(at.gap < 0.0) & (at.which != own)]
    others = np.setdiff1d(solid.within(float(np.linalg.norm(x[..., :2], axis=-1).max())), own)
    sphere = sphere_of(scene)
    assert sphere is not None
    swallowed = _swallowed(x, sphere, solid.center_of(others))
    if not (met.size or swallowed.any()):
        return None
    kind = "touches_base" if (met < 0).any() else "touches another asperity"
    said = "the droplet that stood on one asperity has come down beside it"
    return Status.TOPOLOGY_CHANGE, kind, said


def _swallowed(x: Array, sphere: Sphere, points: Array) -> Mask:
    """(k,) whether points (k, 3) lie in the liquid between a membrane and the sphere it ends on.

    Parameters
    ----------
    x : (n, m, 3) points of the membrane, rings from the contact line to its pole.
    """
    center, top = np.array(sphere.center), np.array([0.0, 0.0, 1.0])
    part = np.linspace(0.0, 1.0, 33)[:-1, None]
    out = part * (x[:, :1] - center) / sphere.radius + (1.0 - part) * top
    cap = center + sphere.radius * out / np.linalg.norm(out, axis=-1, keepdims=True)
    return inside(np.concatenate([cap, x], axis=1), points)


SAMPLED = 129, 129
"""Points along both parameters at which a membrane is looked at."""
NARROW = 0.02, 0.05
"""Width of a sheet over its rim's size, and gap between rim and particle over its radius, that
leave no room for a sheet."""


def too_soft(scene: Scene, assembly: Assembly, multipliers: Array) -> tuple[Status, str] | None:
    """A penalty that cannot hold the membrane out of the spheres: it gives way by the traction
    ``p + 2 gamma / r`` over the penalty."""
    law = scene.local_terms().obstacle
    if law is None or law.penalty is None:
        return None
    length = assembly.contact.length
    curved = 0.0 if isinstance(law.solid, Plane) else 2.0 * assembly.tension / length
    pressure = abs(assembly.density(multipliers).constant)
    depth = (pressure + curved) / law.penalty / length
    if depth <= 2.0 * law.depth:
        return None
    return Status.PENETRATION, (
        f"a penalty of {law.penalty:.3g} gives way by {depth:.1e} radii, {law.depth:.0e} is "
        "allowed: raise solver.penalty, use exact contact, or raise solver.penetration_tolerance"
    )


def overload(scene: Scene, assembly: Assembly, multipliers: Array) -> str:
    """Whether the pressure is more than a lattice carries at 180 degrees, in words.

    A sphere carries at most ``(p + 2 gamma / r) pi r^2``, with the membrane at its equator, and far
    from the droplet's rim it must carry the pressure on its cell of the lattice.
    """
    law = scene.local_terms().obstacle
    if law is None or not isinstance(law.solid, SphereLattice):
        return ""
    disc = np.pi * law.solid.radius**2
    most = 2.0 * assembly.tension / law.solid.radius * disc / (law.solid.area_per_sphere - disc)
    pressure = -assembly.density(multipliers).constant
    if not pressure > most:
        return ""
    unit = scene.units.pressure
    return (
        f"; the pressure came to {pressure * unit:.4g}, and a wide lattice of these asperities "
        f"carries {most * unit:.4g} at most: take a smaller spacing, or less volume or gravity"
    )


def rolling(scene: Scene) -> str:
    """What may help a droplet that its particles push over asperities, in words."""
    free = [axis for axis in "xy" if axis not in scene.sector.mirrored + scene.hold]
    if not (scene.particles and free and isinstance(scene.substrate, (SphereLattice, Spheres))):
        return ""
    held = "x" if free == ["x"] else "xy"
    return f'; or let it not roll away from its particles by droplet.hold = "{held}"'


def reaches_boundary(scene: Scene, surface: Surface) -> bool:
    """Whether a sheet's contact line has come to its rim."""
    solid = sphere_of(scene)
    if scene.kind != "liquid_sheet" or solid is None or scene.directions is not None:
        return False
    inner, rim = surface.net[:, 0], surface.net[:, -1]
    width = float(np.linalg.norm(rim - inner, axis=1).min())
    size = float(np.ptp(rim, axis=0).max())
    between = float(solid.gap(contact_line(surface, "xi2=1").position).min())
    return width <= NARROW[0] * size or between <= NARROW[1] * solid.radius
