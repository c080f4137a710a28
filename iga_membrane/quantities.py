"""Numbers with units: text, "3 uL", and quantities of pint become numbers in SI that remember it.

What a field or a measure is, a length or a pressure, follows from its name.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from decimal import Decimal
from difflib import get_close_matches
from typing import Any

SIZES: dict[str, dict[str, float]] = {
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9},
    "area": {"m^2": 1.0, "cm^2": 1e-4, "mm^2": 1e-6, "um^2": 1e-12},
    "volume": {"m^3": 1.0, "cm^3": 1e-6, "mm^3": 1e-9, "um^3": 1e-18, "l": 1e-3, "ml": 1e-6,
               "ul": 1e-9, "nl": 1e-12, "pl": 1e-15, "fl": 1e-18},
    "surface tension": {"N/m": 1.0, "mN/m": 1e-3, "dyn/cm": 1e-3, "J/m^2": 1.0, "mJ/m^2": 1e-3},
    "density": {"kg/m^3": 1.0, "g/cm^3": 1e3},
    "acceleration": {"m/s^2": 1.0, "cm/s^2": 1e-2},
    "pressure": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "mbar": 1e2, "bar": 1e5},
    "curvature": {"1/m": 1.0, "1/mm": 1e3},
    "force": {"N": 1.0, "mN": 1e-3, "uN": 1e-6, "nN": 1e-9},
    "torque": {"N m": 1.0},
    "energy": {"J": 1.0, "mJ": 1e-3, "uJ": 1e-6, "nJ": 1e-9},
    "angle": {"deg": 1.0},
}  # fmt: skip
"""Dimension to its units, the first the one of SI (of angles the one of this package), with their
sizes in it; a micro sign is a u, a cube may be written with 3, litres with L."""
UNITS = {unit: (size, of) for of, table in SIZES.items() for unit, size in table.items()}
SI, DIMENSIONLESS = "SI", "dimensionless"
"""In what the numbers of a scene are: with units, or one consistent set without."""

_NAMES = {
    "length": "length radius radii spacing offset center centers base amplitude amplitudes period "
              "periods height width edge size half_height border distance gap point scale up_to "
              "equator_radius contact_radius contact_radius_lower contact_radius_upper z_contact "
              "neck_radius cap_height sag z_edge z_corner height_of_apex retention_width "
              "max_penetration arc x y z",
    "area": "A_LG A_wet wet_area base_wet_area",
    "volume": "volume V_liq V_cap",
    "surface tension": "surface_tension tension",
    "density": "density",
    "acceleration": "acceleration gravity",
    "pressure": "pressure p_apex p_base p_contact p_top residual",
    "curvature": "mean_curvature",
    "force": "force F_CL F_CL_line F_P F_line F_press F_sphere F_total F_G F_H F_B F_e F "
             "support_force hold_force normal tangential onset_force steady_force",
    "torque": "torque",
    "energy": "energy E_surf E_grav",
    "angle": "contact_angle angles contact_angle_measured apparent_angle cassie_baxter_angle "
             "alpha_deg phi_deg psi_deg end_slope_deg receding advancing placed_at angle_min "
             "angle_max angle_front angle_rear angle_left angle_right tilt onset_tilt "
             "first_slip_tilt",
}  # fmt: skip
DIMENSIONS = {name: of for of, names in _NAMES.items() for name in names.split()}
"""Name of a field of the scene file, of a measure or of a column to what it is; names that are not
here are numbers without a dimension."""


class Quantity(float):
    """A number in SI that was given with its unit; what is computed with it is a plain number.

    Attributes
    ----------
    dimension : what it is, "length".
    """

    dimension: str

    def __new__(cls, value: float, dimension: str) -> Quantity:
        made = super().__new__(cls, value)
        made.dimension = dimension
        return made

    def __neg__(self) -> Quantity:
        return Quantity(-float(self), self.dimension)

    def __reduce__(self) -> tuple[Any, ...]:
        return Quantity, (float(self), self.dimension)


def dimension_of(field: str) -> str:
    """What a field, a measure or a column is: "length" of "particle[0].center[2]" or "F_e_z"'s
    "force"; "" without a dimension."""
    name = re.sub(r"\[[^]]*\]$", "", field).rsplit(".", 1)[-1]
    return DIMENSIONS.get(name) or DIMENSIONS.get(re.sub(r"_[xyz](_\d+)?$", "", name), "")


def unit_of(name: str, system: str) -> str:
    """The unit of a measure, a field or a column in a system of units.

    Returns
    -------
    "m^3" in SI; "deg" of angles, whatever the system; "" where there is none.
    """
    dimension = dimension_of(name)
    if not dimension or (system != SI and dimension != "angle"):
        return ""
    return next(iter(SIZES[dimension]))


def labelled(name: str, text: str, system: str) -> str:
    """Text of an axis or a bar of colours with the unit of its name; where it has none because the
    scene has none, that is said."""
    if not dimension_of(name):
        return text
    return f"{text} ({unit_of(name, system) or DIMENSIONLESS})"


def told_value(name: str, value: Any, system: str, digits: int = 6) -> str:
    """A number with the unit of its name, "n/a" where there is none."""
    if value is None:
        return "n/a"
    return f"{value:.{digits}g} {unit_of(name, system)}".rstrip()


def parsed(text: str) -> Quantity:
    """A number with a unit, "72.8 mN/m", the two apart by a space, as a number in SI.

    Raises
    ------
    ValueError
        No number, no unit, or a unit that the table does not have; says which.
    """
    number, _, unit = text.strip().partition(" ")
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?", number):
        raise ValueError("must begin with a number; write it like '1 uL'")
    if not unit.strip():
        raise ValueError(f"has no unit; known are {', '.join(UNITS)}")
    known = _plain(unit.strip())
    if known not in UNITS:
        close = get_close_matches(known, UNITS, 1)
        hint = f'; did you mean "{close[0]}"?' if close else ";"
        raise ValueError(f"unknown unit{hint} known: {', '.join(UNITS)}")
    size, dimension = UNITS[known]
    return Quantity(float(Decimal(number) * Decimal(repr(size))), dimension)


def _plain(unit: str) -> str:
    """The table's spelling of a unit."""
    text = unit.replace("\u00b5", "u").replace("\u03bc", "u").replace("\u00b3", "^3")
    text = re.sub(r"(?<=[ms])([23])$", r"^\1", text.replace("\u00b2", "^2"))
    text = text.replace("\u00b0", "deg").removesuffix("rees").removesuffix("ree")
    return text[:-1] + "l" if text in ("L", "mL", "uL", "nL", "pL", "fL") else text


def in_si(field: str, value: Any) -> Any:
    """A number for a field: text with a unit and a quantity of pint become numbers in SI.

    Where it is not known what a field is, a number in SI is a number like any other, but text and
    what pint says is not: nobody checks it.

    Raises
    ------
    ValueError
        Text that is no quantity, or a quantity of another dimension than the field's; says which.
    """
    dimension = dimension_of(field)
    match value:
        case str():
            value = parsed(value)
        case Quantity() if not dimension:
            return float(value)
        case object(to=convert, magnitude=_):  # of pint, which is not imported
            value = _converted(convert, dimension)
    match value:
        case Quantity(dimension=other) if other != dimension:
            raise ValueError(f"must be {_said(dimension)}; got one of {other}")
    return value


def _converted(to: Callable[[str], Any], dimension: str) -> Quantity:
    """A quantity of pint, by its method, as a number in SI."""
    if not dimension:
        raise ValueError(f"must be {_said(dimension)}; give its magnitude")
    try:
        return Quantity(float(to(next(iter(SIZES[dimension]))).magnitude), dimension)
    except (ValueError, TypeError, AttributeError) as error:
        raise ValueError(f"must be {_said(dimension)}; {error}") from error


def _said(dimension: str) -> str:
    """What a field takes, for a message."""
    if not dimension:
        return "a number without a unit"
    return f"a quantity of {dimension}, in {' or '.join(SIZES[dimension])}"


def in_numbers(field: str, value: Any) -> Any:
    """The value of a field or a table, with quantities as text in it as numbers in SI; text that is
    none stays, for the field's rule to refuse."""
    match value:
        case Mapping():
            of = {key: f"{field}.{key}" for key in value}
            if "parameter" in value:  # of a path: its values are those of another field
                of["values"] = str(value["parameter"])
            return {key: in_numbers(of[key], item) for key, item in value.items()}
        case list():
            return [in_numbers(field, item) for item in value]
        case str() if dimension_of(field):
            try:
                return in_si(field, value)
            except ValueError:
                return value
    return value


def quantities(value: Any) -> Iterator[Quantity]:
    """The quantities among the values of nested records, tables and lists."""
    inside: Iterable[Any] = ()
    match value:
        case Quantity():
            yield value
        case Mapping():
            inside = value.values()
        case list() | tuple():
            inside = value
        case _ if is_dataclass(value):
            inside = [getattr(value, f.name) for f in fields(value)]
    for each in inside:
        yield from quantities(each)


def has_units(value: Any) -> bool:
    """Whether any number among nested values was given with its unit; degrees tell nothing."""
    return any(each.dimension != "angle" for each in quantities(value))
