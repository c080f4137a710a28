"""Quantities in SI, and whether a scene in SI can be believed."""

from __future__ import annotations

from typing import cast

from .arguments import checked
from .checks import quantity as read


@checked(quantity=read)
def si(quantity: str) -> float:
    """A number with a unit as a number in SI.

    Parameters
    ----------
    quantity : like "72.8 mN/m", "1 uL", "998 kg/m^3"; the number and the unit apart by a space.

    Returns
    -------
    Metres, cubic metres, newtons per metre, kilograms per cubic metre, pascals; it remembers what
    it is, so that a scene made with it is in SI and refuses it where something else is asked.

    Raises
    ------
    SceneError
        No text, no number, no unit, or a unit that the table does not have.
    """
    return cast(float, quantity)


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
    """What is hard to believe: a liquid that is lighter than nothing; numbers of a scene whose
    acceleration says that it is in SI."""
    lighter = (
        f"liquid.density = {density:g}: the liquid is lighter than its surroundings, and rises "
        "where others fall",
    ) * (density < 0.0)
    if not says_si(acceleration):
        return lighter
    given = zip(PLAUSIBLE.items(), (tension, density, volume), strict=True)
    return lighter + tuple(
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
