"""A surface of constant mean curvature over the unit square, by this package and by two libraries.

``min int sqrt(1 + |grad u|^2) - 2 H u`` with ``u = 0`` on the boundary and H = 1.

Every solver is a function of its number of elements along a side that returns energy and unknowns.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import iga_membrane as iga

CURVATURE = 1.0
Solver = Callable[[int], tuple[float, int]]


def ours(degree: int, model: str | None = None) -> Solver:
    """A sheet pinned on a square rim under the pressure 2 H."""

    def solve(elements: int) -> tuple[float, int]:
        mesh = iga.Discretization(degree=degree, elements=elements, model=model)
        scene = iga.liquid_sheet(None, size=1.0, pressure=2.0 * CURVATURE, discretization=mesh)
        found = iga.solve(scene)
        return found.measures["energy"], found.unknowns

    return solve


def scikit_fem(kind: str) -> Solver:
    """C0 elements of degree 2 on quadrilaterals ("Q2") or triangles ("P2"), plain Newton."""
    import skfem
    from skfem.helpers import dot, grad

    @skfem.BilinearForm
    def tangent(u, v, w):  # type: ignore[no-untyped-def]
        slope = grad(w["height"])
        stretch = np.sqrt(1.0 + dot(slope, slope))
        return (
            dot(grad(u), grad(v)) / stretch - dot(slope, grad(u)) * dot(slope, grad(v)) / stretch**3
        )

    @skfem.LinearForm
    def force(v, w):  # type: ignore[no-untyped-def]
        slope = grad(w["height"])
        return dot(slope, grad(v)) / np.sqrt(1.0 + dot(slope, slope)) - 2.0 * CURVATURE * v

    @skfem.Functional
    def energy(w):  # type: ignore[no-untyped-def]
        slope = grad(w["height"])
        return np.sqrt(1.0 + dot(slope, slope)) - 2.0 * CURVATURE * w["height"]

    def solve(elements: int) -> tuple[float, int]:
        nodes = np.linspace(0.0, 1.0, elements + 1)
        if kind == "Q2":
            mesh, element = skfem.MeshQuad.init_tensor(nodes, nodes), skfem.ElementQuad2()
        else:
            mesh, element = skfem.MeshTri.init_tensor(nodes, nodes), skfem.ElementTriP2()
        basis = skfem.Basis(mesh, element)
        inside = basis.complement_dofs(basis.get_dofs())
        u = basis.zeros()
        for _ in range(20):
            height = basis.interpolate(u)
            system = skfem.condense(
                tangent.assemble(basis, height=height), -force.assemble(basis, height=height),
                I=inside,
            )  # fmt: skip
            step = skfem.solve(*system)
            u = u + step
            if np.abs(step).max() <= 1e-10:
                return float(energy.assemble(basis, height=basis.interpolate(u))), len(inside)
        raise RuntimeError("Newton's method did not converge in 20 iterations")

    return solve


def nutils_splines(degree: int) -> Solver:
    """B-splines of full smoothness, Newton's method of the library."""
    from nutils import function, mesh
    from nutils.expression_v2 import Namespace
    from nutils.solver import System

    def solve(elements: int) -> tuple[float, int]:
        nodes = np.linspace(0.0, 1.0, elements + 1)
        domain, x = mesh.rectilinear([nodes, nodes])
        ns = Namespace()
        ns.x = x
        ns.define_for("x", gradient="d", jacobians=("dV", "dS"))
        basis = domain.basis("spline", degree=degree)
        ns.u = function.dotarg("u", basis)
        ns.p = 2.0 * CURVATURE
        energy = domain.integral("(sqrt(1 + d_i(u) d_i(u)) - p u) dV" @ ns, degree=2 * degree)
        rim = domain.boundary.integral("u^2 dS" @ ns, degree=2 * degree)
        fixed = System(rim, trial="u").solve_constraints(droptol=1e-12)
        state = System(energy, trial="u").solve(constrain=fixed, tol=1e-10)
        free = int(np.isnan(fixed["u"]).sum())
        return float(function.eval(energy, **state)), free

    return solve
