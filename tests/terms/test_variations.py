"""Every term and every motion: exact gradient and Hessian (Q1, Q2)."""

import numpy as np
import pytest
from helpers import droplet, pinned_cap
from taylor import lagrangian, lagrangian_slopes

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.splines import line_basis, tensor_space
from iga_membrane.terms import variations as vary

TENSION = iga.SurfaceTension(1.3)
GRAVITY = iga.Gravity(0.7, (0.2, -0.3, -1.1))


def with_terms(scene, terms):
    return iga.Scene(scene.surface, terms, scene.supports, scale=iga.Scale())


def scenes():
    base = droplet(110, degree=3, elements=4, model="full")
    for name, terms in {
        "tension": [TENSION],
        "gravity": [TENSION, GRAVITY],
        "pressure": [TENSION, iga.Pressure(2.0)],
        "volume": [TENSION, iga.Volume(4.0)],
        "centroid": [TENSION, iga.Volume(4.0), iga.Centroid("x"), iga.Centroid("y")],
        "contact line": [TENSION, iga.PlaneContactLine(1.3, 110.0)],
    }.items():
        yield pytest.param(with_terms(base, terms), id=name)
    weight = iga.Gravity(0.7, (0.0, 0.0, -1.1))
    everything = [TENSION, weight, iga.Volume(4.0), iga.PlaneContactLine(1.3, 60.0)]
    for space, degree in (("bspline", 2), ("bspline", 4), ("nurbs", 3), ("lagrange", 2)):
        for model in ("half", "quarter", "eighth"):
            scene = droplet(60, space=space, degree=degree, elements=4, model=model)
            yield pytest.param(with_terms(scene, everything), id=f"{space} {degree} {model}")
    for model in ("full", "eighth"):
        yield pytest.param(on_sphere(model), id=f"sphere {model}")
    for model in ("full", "half"):
        yield pytest.param(between(model), id=f"particle {model}")
    yield pytest.param(pinned_cap(1.0, [TENSION, iga.Volume(1.0)], "half"), id="fixed rim")
    flat = iga.sheet(1.0, elements=4)
    bent = flat.moved(
        np.column_stack([flat.points[:, :2] + 0.5, 0.2 * flat.points[:, 0] * flat.points[:, 1] + 1])
    )
    mirrors = [iga.Symmetry("x"), iga.Symmetry("y"), iga.Fixed("xi1=1")]
    yield pytest.param(iga.Scene(bent, [TENSION, GRAVITY], mirrors), id="symmetry planes")
    yield pytest.param(iga.Scene(tube(), [TENSION, GRAVITY], [iga.Joint()]), id="joint")


def on_sphere(model):
    """A drop whose edge slides on a sphere, off it by a little, with weight and volume."""
    scene = droplet(110, degree=3, elements=4, model=model)
    sphere = iga.Sphere(contact_angle=70.0, radius=1.5, center=(0.0, 0.0, -1.2))
    weight = GRAVITY if model == "full" else iga.Gravity(0.7, (0.0, 0.0, -1.1))
    terms = [TENSION, weight, iga.Volume(4.0)]
    terms.append(iga.SphereContactLine(1.3, sphere))
    supports = [iga.Sliding("xi2=0", sphere), iga.Sector(model)]
    return iga.Scene(scene.surface, terms, supports, scale=iga.Scale())


def between(model):
    """A droplet between a plane and a particle beside it, the lines off them by a little."""
    particle = iga.Sphere(70.0, 0.4, (1.1, 0.0, 0.8))
    built = iga.sessile_droplet(
        iga.Plane(110.0),
        volume=4.0,
        particles=[particle],
        contact_line="conforming",
        discretization=iga.Discretization(degree=3, elements=4, model=model),
    )
    aside = 0.3 if model == "full" else 0.0
    weight = iga.Gravity(0.7, (0.4, aside, -1.1))
    terms = [*built.terms, weight]
    return iga.Scene(built.surface, terms, built.supports, scale=built.scale)


def tube():
    """A tube of an open patch whose two edges meet in a seam."""
    around, up = line_basis("bspline", 8, 3), line_basis("bspline", 3, 3)
    angle = 2 * np.pi * around.abscissae
    circle = np.linalg.solve(
        around.matrix(around.abscissae), np.stack([np.cos(angle), np.sin(angle)], axis=1)
    )
    circle[-1] = circle[0]
    net = np.empty((around.count, up.count, 3))
    net[..., :2] = circle[:, None]
    net[..., 2] = 1.0 + up.abscissae
    return iga.Surface(tensor_space(around, up), net.reshape(-1, 3))


SCENES = list(scenes())


def state(scene, seed=0):
    """An assembly, a surface off equilibrium, multipliers, a direction, and the motion."""
    assembly = Assembly(scene)
    surface = scene.local_surface()
    rng = np.random.default_rng(seed)
    motion = assembly.spines.on(surface)
    surface = surface.moved(surface.points + motion.displacement(
        0.02 * rng.standard_normal(assembly.size)))  # fmt: skip
    motion = assembly.spines.on(surface)
    multipliers = rng.uniform(0.5, 2.0, assembly.multipliers)
    direction = rng.standard_normal(assembly.size)
    direction *= 0.3 / np.linalg.norm(motion.displacement(direction), axis=1).max()
    return assembly, surface, multipliers, direction, motion


@pytest.mark.parametrize("scene", SCENES)
def test_taylor_remainders_fall_at_their_order(scene):
    assembly, surface, multipliers, direction, motion = state(scene)
    first, second = lagrangian_slopes(assembly, surface, multipliers, motion, direction)
    assert first >= 1.9
    assert second >= 2.9


@pytest.mark.parametrize("scene", SCENES)
def test_hessian_is_symmetric_and_the_derivative_of_the_gradient(scene):
    assembly, surface, multipliers, direction, motion = state(scene)
    system = assembly.system(surface, motion.directions, multipliers)
    dense = system.matrix.dense()
    size = np.abs(dense).max()
    assert np.abs(dense - dense.T).max() <= 1e-12 * size
    h = 1e-4

    def residual(step):
        points = surface.points + motion.displacement(step * direction)
        there = assembly.system(surface.moved(points), motion.directions, multipliers)
        return there.residual(multipliers)

    near, far = (residual(k * h) - residual(-k * h) for k in (1, 2))
    difference = (8.0 * near - far) / (12.0 * h)
    exact = dense @ direction
    assert np.linalg.norm(difference - exact) <= 1e-8 * np.linalg.norm(exact)


@pytest.mark.parametrize("scene", SCENES)
def test_gradient_agrees_with_central_differences(scene):
    assembly, surface, multipliers, direction, motion = state(scene)
    system = assembly.system(surface, motion.directions, multipliers)
    value = lagrangian(assembly, surface, multipliers, motion, direction)
    h = 1e-5
    exact = system.residual(multipliers)
    scale = np.linalg.norm(exact) * np.linalg.norm(direction)
    assert abs((value(h) - value(-h)) / (2 * h) - exact @ direction) <= 1e-8 * scale


@pytest.mark.parametrize("scene", SCENES)
def test_gradient_agrees_with_the_complex_step(scene):
    assembly, surface, multipliers, direction, motion = state(scene)
    system = assembly.system(surface, motion.directions, multipliers)
    h = 1e-30
    points = surface.points + 1j * h * motion.displacement(direction)
    at = vary.element_points(assembly.table, points)
    area, bodies = vary.energies(assembly.table, at, [assembly.density(multipliers)])
    total = assembly.tension * area + bodies[0]
    body = assembly.density(multipliers)
    lines = (term.energy(edge, points, term.strength, body) for term, edge in assembly.edges.lines)
    total = total + sum(lines)
    loads = np.append(multipliers[len(assembly.constraints) :], 0.0)
    for gap, edge in assembly.edges.gaps:
        total = total - (loads[assembly.rows.held(edge)] * gap.values(edge, points)).sum()
    exact = system.residual(multipliers)
    scale = np.linalg.norm(exact) * np.linalg.norm(direction)
    assert abs(total.imag / h - exact @ direction) <= 1e-12 * scale


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_compiled_loops_give_the_same_numbers(degree, monkeypatch):
    scene = with_terms(
        droplet(110, degree=degree, elements=5, model="full"),
        [TENSION, GRAVITY, iga.Volume(4.0), iga.PlaneContactLine(1.3, 110.0)],
    )
    plain, surface, multipliers, _, motion = state(scene)
    monkeypatch.setattr(vary, "COMPILED_FROM", 0)
    compiled = Assembly(scene)
    assert compiled._kernels is not None
    one, two = (a.system(surface, motion.directions, multipliers) for a in (plain, compiled))
    assert np.abs(one.matrix.data - two.matrix.data).max() <= 1e-12 * np.abs(one.matrix.data).max()
    monkeypatch.setenv("IGA_MEMBRANE_NO_NUMBA", "1")
    assert vary.compiled_kernels(10**6) is None
