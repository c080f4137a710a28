"""Rows of named values as comma separated text, as a pandas frame, as an xarray dataset."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .arrays import Array
from .optional import optional

Row = Mapping[str, Any]


def names_of(rows: Sequence[Row]) -> list[str]:
    """Names of all columns, in the order in which rows bring them."""
    return list(dict.fromkeys(name for row in rows for name in row))


def column(rows: Sequence[Row], name: str) -> Array:
    """(rows,) numbers; not a number where a row has none."""
    return np.array([_number(row.get(name)) for row in rows])


def csv_text(rows: Sequence[Row]) -> str:
    """Comma separated values; an empty cell where a row has none."""
    text = io.StringIO()
    table = csv.DictWriter(text, names_of(rows), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    return text.getvalue()


def dataframe(rows: Sequence[Row]) -> Any:
    """``pandas.DataFrame`` of rows.

    Raises
    ------
    OutputError
        If pandas is not installed.
    """
    pandas = optional("pandas", "to_dataframe", "tables")
    return pandas.DataFrame(list(rows), columns=names_of(rows))


def dataset(rows: Sequence[Row], along: Sequence[str]) -> Any:
    """``xarray.Dataset`` of rows on the grid of some of their columns.

    Parameters
    ----------
    rows : one for each point of the grid, the last of the columns varying fastest.
    along : those columns, which become the coordinates.

    Raises
    ------
    OutputError
        If xarray is not installed.
    """
    xarray = optional("xarray", "to_xarray", "tables")
    axes = {name: list(dict.fromkeys(row[name] for row in rows)) for name in along}
    shape = [len(values) for values in axes.values()]
    table = {name: _cells(rows, name).reshape(shape) for name in names_of(rows)}
    return xarray.Dataset(
        {name: (list(along), table[name]) for name in table if name not in axes}, coords=axes
    )


def _cells(rows: Sequence[Row], name: str) -> Array:
    """Numbers, or text where a column holds any."""
    if any(isinstance(row.get(name), str) for row in rows):
        return np.array([str(row.get(name, "")) for row in rows])
    return column(rows, name)


def _number(value: Any) -> float:
    return float(value) if isinstance(value, (int, float)) else np.nan
