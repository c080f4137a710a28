"""Eigenvalues of the second variation on a free sphere: ``(l (l + 1) - 2) / R^2`` (N5).

Its halves have them all: modes even across the equator are those of a drop at 90 degrees on a
plane, with its volume prescribed; odd ones those of a half sphere with its rim fixed.
"""

import numpy as np
import pytest
from helpers import UNIT_VOLUME, pinned_cap
from scipy.linalg import eigh, null_space

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly

TENSION = iga.SurfaceTension(1.0)


def eigenvalues(scene, count, pressure=2.0):
    """The lowest ones on the motions that keep the constraints, of a unit sphere."""
    assembly, surface = Assembly(scene), scene.local_surface()
    motion = assembly.motion(surface)
    multipliers = np.full(assembly.multipliers, pressure)
    system = assembly.system(surface, motion.directions, multipliers)
    assert np.linalg.norm(system.residual(multipliers)) < 1e-5 * system.scale
    kept = null_space(system.constraint_gradients.T) if len(multipliers) else np.eye(assembly.size)
    mass = assembly.mass(surface, motion.directions).dense()
    matrix = system.matrix.dense()
    return eigh(kept.T @ matrix @ kept, kept.T @ mass @ kept, eigvals_only=True)[:count]


@pytest.mark.parametrize(
    ("degree", "elements"),
    [(3, 10), *(pytest.param(*m, marks=pytest.mark.slow) for m in ((4, 10), (3, 14), (4, 14)))],
)
def test_free_sphere(degree, elements):
    start = pinned_cap(0.5 * np.pi, [TENSION], degree=degree, elements=elements)
    free = [iga.Sliding("xi2=0"), iga.Sector("full")]
    volume = [TENSION, iga.Volume(0.5 * UNIT_VOLUME)]
    even = eigenvalues(iga.Scene(start.surface, volume, free, scale=iga.Scale()), 9)
    pressed = [TENSION, iga.Pressure(2.0)]
    odd = eigenvalues(iga.Scene(start.surface, pressed, start.supports, scale=iga.Scale()), 6)
    found = np.sort(np.concatenate([even, odd]))
    assert np.abs(found[:3]).max() < 1e-3  # three shifts cost nothing
    np.testing.assert_allclose(found[3:8], 4.0, rtol=1e-3)
    np.testing.assert_allclose(found[8:], 10.0, rtol=1e-3)
    assert len(found) == 15
