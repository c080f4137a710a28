import numpy as np
import pytest

import iga_membrane as iga


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


def test_rings_cannot_be_exchanged():
    surface = iga.sessile_droplet(iga.Plane(contact_angle=90), volume=1.0).surface
    with pytest.raises(iga.SceneError, match="only open"):
        iga.to_geomdl(surface)
