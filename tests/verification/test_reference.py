"""The witness against published-to-us values that another code computed twice."""

import json
from pathlib import Path

import pytest
from helpers import some

from iga_membrane.reference import cap_on_plane, drop_on_plane

CASES = json.loads((Path(__file__).parent / "sessile_drops.json").read_text())


@pytest.mark.parametrize(
    "case",
    some(CASES, range(0, len(CASES), 3)),
    ids=lambda c: f"Bo{c['bond']}-{c['contact_angle']}",
)
def test_axisymmetric_drops_agree_to_eleven_digits(case):
    found = drop_on_plane(case["bond"], case["contact_angle"])
    for name, value in case["values"].items():
        scale = max(abs(value), 1.0) if name == "p_apex" else max(abs(value), 1e-12)
        assert abs(found[name] - value) <= 1e-11 * scale, name


def test_identities_of_a_drop_hold():
    import numpy as np

    bond, angle, volume = 2.0, 140.0, 3.0
    m = drop_on_plane(bond, angle, volume)
    line = 2 * np.pi * m["contact_radius"] * np.sin(np.radians(angle))
    assert m["A_wet"] * m["p_base"] == pytest.approx(bond * volume + line, rel=1e-11)
    assert 2 * m["E_surf"] + 4 * m["E_grav"] == pytest.approx(3 * m["p_base"] * volume, rel=1e-11)


def test_small_gravity_tends_to_the_cap():
    cap, drop = cap_on_plane(70.0), drop_on_plane(1e-9, 70.0)
    assert drop["height"] == pytest.approx(cap["height"], rel=1e-8)


@pytest.mark.slow
def test_a_puddle_too_wide_for_doubles_is_refused():
    with pytest.raises(ValueError, match="600 capillary lengths"):
        drop_on_plane(1000.0, 0.5)
