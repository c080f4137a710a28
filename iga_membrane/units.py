"""Quantities with their units as text, by a fixed table, in SI."""

from __future__ import annotations

import re

from .arguments import checked
from .checks import refusal, suggestion

UNITS = {
    # length
    "m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9,
    # volume
    "m^3": 1.0, "cm^3": 1e-6, "mm^3": 1e-9, "um^3": 1e-18,
    "l": 1e-3, "ml": 1e-6, "ul": 1e-9, "nl": 1e-12, "pl": 1e-15, "fl": 1e-18,
    # surface tension
    "N/m": 1.0, "mN/m": 1e-3, "dyn/cm": 1e-3, "J/m^2": 1.0,
    # density
    "kg/m^3": 1.0, "g/cm^3": 1e3,
    # acceleration
    "m/s^2": 1.0, "cm/s^2": 1e-2,
    # pressure
    "Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "mbar": 1e2, "bar": 1e5,
}  # fmt: skip
"""Unit to its size in SI; a micro sign is a u, a cube may be written with 3, litres with L."""


@checked()
def si(quantity: str) -> float:
    """A number with a unit as a number in SI.

    Parameters
    ----------
    quantity : like "72.8 mN/m", "1 uL", "998 kg/m^3"; the number and the unit apart by a space.

    Returns
    -------
    Metres, cubic metres, newtons per metre, kilograms per cubic metre, or pascals.

    Raises
    ------
    SceneError
        No text, no number, no unit, or a unit that the table does not have.
    """
    number, _, unit = quantity.strip().partition(" ")
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?", number):
        raise refusal("quantity", quantity, "must begin with a number", "write it like '1 uL'")
    if not unit.strip():
        raise refusal("quantity", quantity, "has no unit", f"known are {', '.join(UNITS)}")
    known = _plain(unit.strip())
    if known not in UNITS:
        hint = suggestion(known, UNITS).removeprefix("; ")
        raise refusal("quantity", quantity, "unknown unit", f"{hint} known: {', '.join(UNITS)}")
    return float(number) * UNITS[known]


def _plain(unit: str) -> str:
    """The table's spelling of a unit."""
    text = unit.replace("\u00b5", "u").replace("\u03bc", "u").replace("\u00b3", "^3")
    text = re.sub(r"(?<=[ms])([23])$", r"^\1", text.replace("\u00b2", "^2"))
    return text[:-1] + "l" if text in ("L", "mL", "uL", "nL", "pL", "fL") else text


EARTH = 9.7, 9.9
"""Accelerations that can only be metres per squared second."""
PLAUSIBLE = {
    "liquid.surface_tension": (1e-3, 1.0, "N/m"),
    "liquid.density": (0.1, 3e4, "kg/m^3"),
    "liquid.volume": (0.0, 1e-3, "m^3"),
}
"""Ranges in SI: liquids have tensions of 0.01 to 0.6 and densities of 500 to 14000, droplets much
less than a litre; with a factor for what is rare."""


def says_si(acceleration: float) -> bool:
    """Whether an acceleration tells that a scene is in SI."""
    return EARTH[0] <= acceleration <= EARTH[1]


def implausible(
    acceleration: float, tension: float, density: float, volume: float | None
) -> tuple[str, ...]:
    """What is hard to believe in a scene whose acceleration says that it is in SI."""
    if not says_si(acceleration):
        return ()
    given = zip(PLAUSIBLE.items(), (tension, density, volume), strict=True)
    return tuple(
        f"{field} = {value:g}: gravity of {acceleration:g} reads as m/s^2, and {value:g} {unit} is "
        f"hard to believe (expected {least:g} to {most:g}); give all fields in SI, as iga.si does"
        for (field, (least, most, unit)), value in given
        if value is not None and value and not least <= abs(value) <= most
    )


def length_as_text(length: float, *, si: bool) -> str:
    """``4.5 mm`` in SI, else the number in the user's own unit."""
    if not si:
        return f"{length:.2g}"
    units = ((1.0, "m"), (1e-3, "mm"), (1e-6, "um"))
    size, unit = next((pair for pair in units if length >= pair[0]), (1e-9, "nm"))
    return f"{float(f'{length / size:.2g}'):g} {unit}"
