"""A membrane that crosses itself is seen, one that nearly does is not (N14)."""

import numpy as np
import pytest
from helpers import some

import iga_membrane as iga
from iga_membrane.driver import ending
from iga_membrane.verification.self_intersection import crossing


def folded(gap, c, bulge, shear):
    """A tube whose shoulders at ``s = +-sqrt(c)`` are a gap apart; below 0 they cross.

    Its meridian ``z = s ((s^2 - c)^2 + d), r = 2 + bulge s^2`` is in the spline space.
    """
    d = gap / (2.0 * np.sqrt(c))

    def profile(t):
        s = 2.4 * t - 1.2
        return 2.0 + bulge * s * s, s * ((s * s - c) ** 2 + d), 4.8 * bulge * s

    tube = iga.axisymmetric(iga.ring_space("bspline", 5, 12), profile)
    return tube.moved(tube.points + shear * tube.points[:, [2]] * [1.0, 0.4, 0.0])


CASES = [(c, bulge, shear) for c in (0.35, 0.6) for bulge, shear in
         [(0.8, 0.0), (-0.8, 0.0), (0.5, 0.3), (1.2, -0.5), (-0.6, 0.7)]]  # fmt: skip


@pytest.mark.parametrize("case", some([(case,) for case in CASES], range(0, 10, 2)))
def test_crossing_is_seen_and_near_miss_is_not(case):
    assert crossing(folded(1e-6, *case)) is None
    for depth in (1e-2, 0.1):
        place = crossing(folded(-depth, *case))
        assert place is not None
        assert np.hypot(place[0] - case[2] * place[2], place[1] - 0.4 * case[2] * place[2]) == (
            pytest.approx(2.0 + case[1] * case[0], rel=0.2)
        )


@pytest.mark.parametrize(
    "surface", [iga.sphere(1.0), iga.cap(1.0, 30.0), iga.cap(1.0, 170.0), iga.cylinder(1.0, 2.0)]
)
def test_round_surfaces_do_not_cross(surface):
    assert crossing(surface) is None


def test_equilibrium_that_crosses_itself_is_no_success(monkeypatch):
    scene = iga.film_between_rings(half_height=0.4)
    assert iga.solve(scene).success
    monkeypatch.setattr(ending, "crossing", lambda surface: surface.points[0])
    found = iga.solve(scene, on_fail="return")
    assert (found.status, found.kind) == (iga.Status.TOPOLOGY_CHANGE, "self-contact")
    assert "meets itself at (" in found.message
