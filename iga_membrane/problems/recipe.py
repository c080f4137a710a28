"""How a scene was asked for: a family and its arguments, so that it can be asked for otherwise."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import wraps
from typing import Any, TypeVar, cast

import numpy as np

from ..checks import choice, listed, refusal
from ..errors import SceneError
from ..fields import keys_of
from ..lazy import part
from ..quantities import SI, Quantity, dimension_of, has_units

HOMES = {
    "sessile_droplet": "problems.droplet",
    "liquid_sheet": "problems.sheet",
    "asperity_cell": "problems.cell",
    "film_between_rings": "problems.film",
    "capillary_bridge": "problems.capillary_bridge",
}
"""Families of the package, and where they are loaded from when they are first used."""
_FAMILIES: dict[str, Callable[..., Any]] = {}
Family = TypeVar("Family", bound=Callable[..., Any])


def family(build: Family) -> Family:
    """Decorate a function that builds the scenes of a family: recipes know it by its name, and
    its scenes say in which units they are."""

    @wraps(build)
    def with_units(*arguments: Any, **named: Any) -> Any:
        return in_its_units(build(*arguments, **named))

    _FAMILIES[build.__name__] = with_units
    return cast(Family, with_units)


def in_its_units(scene: Any, *, si: bool = False) -> Any:
    """A scene whose description says that it is in SI, where it is: numbers were given with units.

    Raises
    ------
    SceneError
        A scene in SI whose tension was left out.
    """
    recipe = scene.recipe
    if not (si or has_units([scene.particles, recipe and recipe.arguments])):
        return scene
    tension = scene.description["liquid"]["surface_tension"]
    if tension == 1.0 and not has_units(tension):
        raise refusal(
            "liquid.surface_tension", tension, "was left out or has no unit, beside numbers that "
            "have units", "give it with its own, like '72.8 mN/m'",
        )  # fmt: skip
    return replace(scene, description={**scene.description, "units": SI})


@dataclass(frozen=True)
class Recipe:
    """How a scene was asked for. Data only: it goes into state files.

    Attributes
    ----------
    family : name of the function that builds such scenes.
    arguments : of that function, by their names.
    """

    family: str
    arguments: Mapping[str, Any]

    def __post_init__(self) -> None:
        choice("family", self.family, {*HOMES, *_FAMILIES})

    def scene(self, **changed: Any) -> Any:
        """The :class:`.scene.Scene`, with some arguments changed."""
        if self.family not in _FAMILIES:
            part(HOMES[self.family], self.family)
        return _FAMILIES[self.family](**{**self.arguments, **changed})

    def changed(self, **arguments: Any) -> Recipe:
        """The recipe with other arguments."""
        return replace(self, arguments={**self.arguments, **arguments})

    def at(self, path: str, value: float) -> Recipe:
        """The recipe with one number changed.

        Parameters
        ----------
        path : of the number in the words of the scene file, ``"substrate.contact_angle"``,
            ``"liquid.volume"``, ``"gravity.acceleration"`` (along its direction),
            ``"particle[0].center[2]"``.

        Raises
        ------
        SceneError
            There is no such number, or the value is out of its range.
        """
        found = re.fullmatch(r"([a-z_]+)(?:\[(\d+)\])?\.([a-z_]+)(?:\[(\d+)\])?", str(path))
        if found is None:
            raise self._unknown(path)
        if path in WHOLE and WHOLE[path] in self.arguments:
            return self.changed(**{WHOLE[path]: value})
        table, which, name, axis = found.groups()
        index = None if axis is None else int(axis)
        if path == "gravity.acceleration":
            return self.changed(gravity=_scaled(self.arguments["gravity"], value))
        if table in ("substrate", "particle", "discretization"):
            return self._at_record(path, table, which, name, index, value)
        if name in self.arguments and which is None and table == self._table_of(name):
            return self.changed(**{name: _component(self.arguments[name], index, value, path)})
        return self._at_record(path, table, which, name, index, value)

    def _table_of(self, name: str) -> str | None:
        """The table of the scene file that an argument stands in."""
        tables = (OWN.get(self.family, ""), "liquid", "solver")
        return next((table for table in tables if name in keys_of(table)), None)

    def _at_record(
        self, path: str, table: str, which: str | None, name: str, index: int | None, value: float
    ) -> Recipe:
        """A field of an argument that is a record, or of one in a list of them."""
        owners = [each for each in (table, f"{table}s", TABLES.get(table, "")) if
                  each in self.arguments]  # fmt: skip
        if not owners:
            raise self._unknown(path)
        given = self.arguments[owners[0]]
        several = list(given) if listed(given) else [given]
        number = 0 if which is None else int(which)
        known = number < len(several) and is_dataclass(several[number])
        if not known or name not in {f.name for f in fields(several[number])}:
            raise self._unknown(path)
        before = getattr(several[number], name)
        several[number] = replace(several[number], **{name: _component(before, index, value, path)})
        return self.changed(**{owners[0]: several if listed(given) else several[0]})

    def _unknown(self, path: str) -> SceneError:
        own = [f"{self._table_of(n)}.{n}" for n in self.arguments if self._table_of(n)]
        return SceneError(
            f"path = {path!r}: no number of this {self.family}; name one as in the scene file, "
            f'like "substrate.contact_angle", "particle[0].center[2]", "gravity.acceleration" or '
            f"{', '.join(own)}"
        )


OWN = {
    "sessile_droplet": "droplet",
    "liquid_sheet": "sheet",
    "asperity_cell": "cell",
    "film_between_rings": "rings",
}
WHOLE = {"gap.distance": "gap"}
"""Paths of the scene file that are an argument of their own."""
"""The table of the scene file that a family has to itself."""

TABLES = {"substrate": "sphere", "particle": "particle"}
"""Tables of the scene file, and the argument of a family that is theirs under another name."""


@dataclass(frozen=True)
class Along:
    """The scenes of a recipe along one number.

    Attributes
    ----------
    recipe : of the scenes; path : of the number.
    """

    recipe: Recipe
    path: str

    def __call__(self, value: float) -> Any:
        return self.recipe.at(self.path, value).scene()


def _scaled(gravity: Any, size: float) -> Any:
    """Gravity of another size, in its direction."""
    if not listed(gravity):
        return size
    pull = float(np.linalg.norm(gravity))
    return [size / pull * g for g in gravity] if pull else [0.0, 0.0, -size]


def _component(before: Any, index: int | None, value: float, path: str) -> Any:
    """A value, or a list with one of its components changed, in the units of the one before."""
    if has_units(before):
        value = Quantity(value, dimension_of(path))
    elif float(value).is_integer():
        value = int(value)
    if index is None:
        return value
    given = list(before) if listed(before) else []
    if index >= len(given):
        raise SceneError(f"path = {path!r}: there is no component {index}, only {len(given)}")
    given[index] = value
    return tuple(given)
