import numpy as np
import pytest

import iga_membrane as iga
from iga_membrane.surface.exchange import write_geomdl


@pytest.mark.parametrize("surface", [iga.cap(1.0, 120.0), iga.sheet(2.0, elements=3)])
def test_round_trip_through_geomdl(surface):
    other = iga.to_geomdl(surface)
    back = iga.from_geomdl(other)
    assert back.points == pytest.approx(surface.points, abs=1e-14)
    xi = np.random.default_rng(0).random((25, 2))
    assert np.array(other.evaluate_list(xi.tolist())) == pytest.approx(
        surface.at(xi).position, abs=1e-12
    )
    u, v = 0.37, 0.81
    derivatives = np.array(other.derivatives(u, v, 2)[1][0])
    assert surface.at([[u, v]]).tangents[0, 0] == pytest.approx(derivatives, abs=1e-11)


def test_knots_that_geomdl_accepts_are_checked():
    other = iga.to_geomdl(iga.sheet(2.0, elements=3))
    knots = list(other.knotvector_u)
    knots[4] = float("nan")
    other._knot_vector[0] = knots
    with pytest.raises(iga.SceneError, match=r"knots\[4\] = nan"):
        iga.from_geomdl(other)


def test_a_drop_is_the_same_surface_in_geomdl_whatever_its_space(tmp_path):
    """Rings, poles and Lagrange elements go over by their Bezier points, weights included."""
    from geomdl import exchange

    angle = iga.Plane(contact_angle=110)
    for space in ("bspline", "nurbs", "lagrange"):
        mesh = iga.Discretization(space, degree=3, elements=4)
        surface = iga.sessile_droplet(angle, volume=1.0, discretization=mesh).surface
        path = tmp_path / f"{space}.json"
        write_geomdl(surface, str(path))
        (other,) = exchange.import_json(str(path))
        xi = np.random.default_rng(1).random((25, 2))
        ours = surface.at(xi * [2.0 * np.pi, 1.0], 1).position
        assert np.array(other.evaluate_list(xi.tolist())) == pytest.approx(ours, abs=1e-12)
