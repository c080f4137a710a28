"""Particles on droplets and sheets: convergence, where they are solved, pull-off, free droplets.

    python benchmarks/particles.py [converge|agree|free|pull|resting|grid|...]

Prints the tables of docs/results/particles.md.
"""

from __future__ import annotations

import sys
from itertools import product
from time import process_time

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0
PLANE = iga.Plane(150.0)
LIMIT = iga.SolverOptions(max_cpu_s=120.0)


def profile(bond: float) -> tuple[np.ndarray, float]:
    """(k, 2) r and z of the droplet without particles, from its line to its top; its height."""
    alone = iga.solve(iga.sessile_droplet(PLANE, volume=VOLUME, gravity=bond))
    x = alone.surface.grid(3, 2001, 1).position[0]
    return np.stack([np.hypot(x[:, 0], x[:, 1]), x[:, 2]], axis=1), alone.measures["height"]


def on_droplet(
    angle: float, radius: float, place: np.ndarray, bond: float, line: str = "auto", **mesh
) -> iga.Scene:
    particle = iga.Sphere(angle, radius, (float(place[0]), 0.0, float(place[1])), 1.0)
    return iga.sessile_droplet(
        PLANE,
        volume=VOLUME,
        gravity=bond,
        hold="x",
        particles=[particle],
        contact_line=line,
        discretization=iga.Discretization(**mesh),
    )


def pull(solution: iga.Solution) -> np.ndarray:
    return solution.forces[0].effective - solution.forces[0].weight


def at_polar(x: np.ndarray, height: float, polar: float) -> np.ndarray:
    """Place seen from half the height at an angle from the top."""
    seen = np.degrees(np.arctan2(x[:, 0], x[:, 1] - 0.5 * height))
    return x[np.abs(seen - polar).argmin()]


def at_rest(x: np.ndarray, height: float, radius: float) -> np.ndarray:
    """Place beside the droplet of a particle on the plane, its centre on the profile."""
    low = x[x[:, 1] < 0.5 * height]
    return np.array([low[np.abs(low[:, 1] - radius).argmin(), 0], radius])


def converge() -> None:
    x, height = profile(0.5)
    place = at_polar(x, height, 95.0)
    print("| line | elements | unknowns | F_x | F_z | horizontal balance | iterations | CPU s |")
    print("|---|---|---|---|---|---|---|---|")
    for line, meshes in {
        "trimmed": (12, 16, 24, 36, 54),
        "conforming": (9, 12, 18, 27, 40),
    }.items():
        for elements in meshes:
            start = process_time()
            found = iga.solve(on_droplet(90.0, 0.2, place, 0.5, line, elements=elements))
            force = pull(found)
            off = abs(found.hold_force[0] - force[0]) / np.linalg.norm(force)
            print(
                f"| {line} | {elements} | {found.unknowns} | {force[0]:.7f} | {force[2]:.7f} | "
                f"{off:.1e} | {found.newton_iterations} | {process_time() - start:.1f} |",
                flush=True,
            )


def agree() -> None:
    """Default meshes of both discretizations against a conforming one of twice the elements: worst
    error of a component of the force over the force, of p_base and of the energy."""
    print("| angle | radius | polar | line | status | force | p_base | energy | unknowns | CPU s |")
    print("|---" * 10 + "|")
    x, height = profile(0.5)
    usual = product((60.0, 90.0, 120.0), (0.1, 0.2, 0.4), (20.0, 65.0, 95.0, 120.0))
    for angle, radius, polar in [*usual, *product((15.0, 165.0), (0.2,), (65.0, 95.0))]:
        place = at_polar(x, height, polar)
        if place[1] >= radius:
            _compare(angle, radius, polar, place)


def _compare(angle: float, radius: float, polar: float, place: np.ndarray) -> None:
    found = {}
    for line in ("conforming", "trimmed"):
        start = process_time()
        solution = iga.solve(on_droplet(angle, radius, place, 0.5, line), LIMIT, on_fail="return")
        found[line] = solution, process_time() - start
    elements = 2 * found["conforming"][0].scene.surface.space.bases[1].elements
    fine = iga.solve(
        on_droplet(angle, radius, place, 0.5, "conforming", elements=elements),
        LIMIT,
        on_fail="return",
    )
    size = np.linalg.norm(pull(fine))
    for line, (solution, seconds) in found.items():
        off = [np.abs(pull(solution) - pull(fine)).max() / size]
        off += [abs(solution.measures[k] / fine.measures[k] - 1.0) for k in ("p_base", "energy")]
        errors = " | ".join(f"{e:.0e}" for e in off) if fine.success else "| |"
        print(
            f"| {angle:g} | {radius:g} | {polar:g} | {line} | {solution.status.name} | {errors} | "
            f"{solution.unknowns} | {seconds:.1f} |",
            flush=True,
        )


def free() -> None:
    """Ten random directions each; the weightless drop on a sphere is the closed form."""
    from iga_membrane.initial.profiles import drop_on_sphere

    print("| angle | radius | pressure | A_wet | largest force | CPU s |")
    print("|---|---|---|---|---|---|")
    ways = np.random.default_rng(0).standard_normal((10, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    for angle in (20.0, 60.0, 90.0, 120.0, 160.0):
        for radius in (0.1, 0.3, 0.5):
            polar, cap = drop_on_sphere(angle, radius, VOLUME)
            wet = 4.0 * np.pi * radius**2 * np.sin(0.5 * polar) ** 2
            start, errors = process_time(), []
            for way in ways:
                particle = iga.Sphere(angle, radius, tuple(float(c) for c in 1.2 * way))
                found = iga.solve(iga.sessile_droplet(None, volume=VOLUME, particles=[particle]))
                measured = found.measures
                errors.append(
                    [
                        abs(measured["pressure"] * cap.radius / 2.0 - 1.0),
                        abs(measured["A_wet"] / wet - 1.0),
                        np.abs(found.forces[0].effective).max(),
                    ]
                )
            worst = " | ".join(f"{e:.0e}" for e in np.max(errors, axis=0))
            seconds = (process_time() - start) / len(ways)
            print(f"| {angle:g} | {radius:g} | {worst} | {seconds:.2f} |", flush=True)


def pulled() -> None:
    print("| angle | sheet | largest F_CL / bound | at | detaches between | limit | CPU s |")
    print("|---|---|---|---|---|---|---|")
    for angle in (30.0, 60.0, 90.0, 120.0, 150.0):
        for size in (5.0, 20.0):
            start = process_time()
            particle = iga.Sphere(angle, 1.0, (0.0, 0.0, -1.0), 0.0, "vertical")
            found = iga.pull_off(iga.liquid_sheet(particle, size=size, boundary="circle"))
            line = max(s.forces[0].contact_line[2] for s in found.solutions)
            bound = 2.0 * np.pi * np.cos(0.5 * np.radians(angle)) ** 2
            print(
                f"| {angle:g} | {size:g} | {line / bound:.7f} | {found.at:.4f} | "
                f"{found.bracket.lo:.5f}, {found.bracket.hi:.5f} | {found.limit} | "
                f"{process_time() - start:.1f} |",
                flush=True,
            )


HEAD = "| Bo | angle | radius | place | status | F_x | F_z | balance x | z | iterations | CPU s |"


def said(found: iga.Solution) -> str:
    """Status with its kind and bracket."""
    words = [found.status.name, found.kind or ""]
    if found.bracket is not None:
        words.append(f"{found.bracket.parameter} {found.bracket.lo:.4g}, {found.bracket.hi:.4g}")
    return " ".join(word for word in words if word)


def row(
    angle: float, radius: float, place: np.ndarray, bond: float, name: str, limit: float = 120.0
) -> bool:
    start, options = process_time(), iga.SolverOptions(max_cpu_s=limit)
    found = iga.solve(on_droplet(angle, radius, place, bond), options, on_fail="return")
    force, size = pull(found), max(bond * VOLUME, 1.0)
    sideways = abs(found.hold_force[0] - force[0]) / size
    upwards = abs(found.contact["support_force"] - force[2] - bond * VOLUME) / size
    print(
        f"| {bond:g} | {angle:g} | {radius:g} | {name} | {said(found)} | "
        f"{force[0]:.5f} | {force[2]:.5f} | {sideways:.0e} | {upwards:.0e} | "
        f"{found.newton_iterations} | {process_time() - start:.1f} |",
        flush=True,
    )
    return found.success


def resting() -> None:
    """On the plane, the centre on the profile of the droplet alone; balances over the larger of
    the weight and gamma R."""
    print(HEAD, "|---" * 11 + "|", sep="\n")
    solved = []
    for bond in (0.0, 0.25, 1.0):
        x, height = profile(bond)
        for angle in (60.0, 90.0, 120.0):
            for radius in (0.1, 0.2, 0.3):
                place = at_rest(x, height, radius)
                solved.append(row(angle, radius, place, bond, "resting"))
    print(f"\n{sum(solved)} of {len(solved)} CONVERGED_STABLE")


def grid() -> None:
    """A particle that would cut the plane rests on it."""
    print(HEAD, "|---" * 11 + "|", sep="\n")
    solved = []
    x, height = profile(0.5)
    for angle in (15.0, 50.0, 90.0, 130.0, 165.0):
        for radius in (0.05, 0.2, 0.5):
            for polar in (20.0, 65.0, 95.0, 120.0):
                place, name = at_polar(x, height, polar), f"{polar:g}"
                if place[1] < radius:
                    place, name = at_rest(x, height, radius), "resting"
                solved.append(row(angle, radius, place, 0.5, name, limit=60.0))
    print(f"\n{sum(solved)} of {len(solved)} CONVERGED_STABLE")


ASPERITIES = iga.SphereLattice(150.0, 0.1, 0.3, offset=(0.15, 0.15))


def on_asperities(particles, **mesh) -> iga.Scene:
    return iga.sessile_droplet(
        ASPERITIES,
        volume=VOLUME,
        gravity=1.0,
        hold="x" if len(particles) == 1 else "none",
        particles=particles,
        discretization=iga.Discretization(**mesh),
    )


def missing(found: iga.Solution) -> float:
    """What forces and weight leave, over the weight."""
    on_solids = [each["force_vector"] for each in found.contact["asperities"]]
    on_solids += [each.effective for each in found.forces]
    left = np.sum(on_solids, axis=0) + [0.0, 0.0, VOLUME] - found.hold_force
    return float(np.abs(left).max()) / VOLUME


def whole() -> None:
    """The scene of examples/whole_system.py, refined."""
    print("| elements | unknowns | F_z | F_z | F_z | forces left / weight | iterations | CPU s |")
    print("|---" * 8 + "|")
    particles = [
        iga.Sphere(80.0, 0.25, (0.83, 0.0, 1.08)),
        iga.Sphere(90.0, 0.3, (-0.62, 0.0, 1.26)),
        iga.Sphere(100.0, 0.2, (0.1, 0.0, 1.42)),
    ]
    for elements in (50, None, 72, 90):
        start = process_time()
        found = iga.solve(on_asperities(particles, elements=elements))
        forces = " | ".join(f"{each.effective[2]:.5f}" for each in found.forces)
        count = found.surface.space.bases[0].elements // 2
        print(
            f"| {count} | {found.unknowns} | {forces} | {missing(found):.0e} | "
            f"{found.newton_iterations} | {process_time() - start:.1f} |",
            flush=True,
        )


def rough() -> None:
    """One particle whose centre is on the surface of the droplet alone, held sideways."""
    print(
        "| polar | angle | radius | elements | status | F_x | F_z | forces left / weight | CPU s |"
    )
    print("|---" * 9 + "|")
    alone = iga.solve(on_asperities([]))
    ticks = np.linspace(-0.999, 0.999, 401)
    x = alone.surface.at(np.stack(np.meshgrid(ticks, ticks), axis=-1), 1).position.reshape(-1, 3)
    profile = np.stack([np.hypot(x[:, 0], x[:, 1]), x[:, 2]], axis=1)
    for polar in (20.0, 50.0, 80.0):
        place = at_polar(profile, alone.measures["height"], polar)
        for angle, radius in ((90.0, 0.15), (90.0, 0.25), (90.0, 0.4), (45.0, 0.25), (130.0, 0.25)):
            start = process_time()
            particle = iga.Sphere(angle, radius, (float(place[0]), 0.0, float(place[1])))
            found = iga.solve(on_asperities([particle]), LIMIT, on_fail="return")
            force, count = pull(found), found.surface.space.bases[0].elements // 2
            print(
                f"| {polar:g} | {angle:g} | {radius:g} | {count} | {found.status.name} | "
                f"{force[0]:.5f} | {force[2]:.5f} | {missing(found):.0e} | "
                f"{process_time() - start:.1f} |",
                flush=True,
            )


STUDIES = {
    "converge": converge,
    "agree": agree,
    "free": free,
    "pull": pulled,
    "resting": resting,
    "grid": grid,
    "whole": whole,
    "rough": rough,
}

if __name__ == "__main__":
    for study in sys.argv[1:] or STUDIES:
        print(f"\n## {study}\n")
        STUDIES[study]()
