"""What a record says of itself: a few lines of text, or in a notebook a table with a picture."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from html import escape
from textwrap import wrap
from typing import Any

import numpy as np

WIDTH = 100
"""Characters of a line."""
LONGEST = 64
"""Characters of one value: longer ones are cut in the middle."""
FEW = 4
"""Values of a list that are shown."""


@dataclass(frozen=True)
class Overview:
    """A heading with names and values.

    Attributes
    ----------
    title : what it is and how it is.
    rows : name and value of what there is to know, the most important first.
    """

    title: str
    rows: Sequence[tuple[str, str]] = ()

    def text(self) -> str:
        """The heading, and under it the names and values, several on a line."""
        pairs = "; ".join(f"{name}\0{value}".replace(" ", "\0") for name, value in self.rows)
        lines = wrap(pairs, WIDTH, break_long_words=False, break_on_hyphens=False)
        return "\n".join([self.title, *(f"  {line}" for line in lines)]).replace("\0", " ")

    def html(self, picture: bytes | None = None) -> str:
        """A table with a row for each name, and a picture (PNG) beside it."""
        rows = "".join(
            f"<tr><th style='text-align:left'>{escape(name)}</th>"
            f"<td style='text-align:left'>{escape(value)}</td></tr>"
            for name, value in self.rows
        )
        table = f"<table>{rows}</table>"
        if picture is not None:
            drawn = b64encode(picture).decode("ascii")
            table = (
                f"<div style='display:flex;align-items:center;gap:1em'>{table}"
                f"<img alt='picture' style='max-width:320px' src='data:image/png;base64,{drawn}'>"
                "</div>"
            )
        return f"<div><strong>{escape(self.title)}</strong>{table}</div>"


class Told:
    """A record that shows itself by its overview, in a notebook with its portrait."""

    def overview(self) -> Overview:
        """What it says of itself."""
        raise NotImplementedError

    def portrait(self) -> bytes | None:
        """A small picture of it (PNG), where there is one and this machine can draw."""
        return None

    def __repr__(self) -> str:
        return self.overview().text()

    def _repr_html_(self) -> str:
        return self.overview().html(self.portrait())


def brief(value: Any) -> str:
    """A value in few characters: the shape of an array, a number in six digits, text cut."""
    match value:
        case np.ndarray():
            return f"<{value.dtype} {'x'.join(map(str, value.shape))}>"
        case float():
            return f"{value:.6g}"
        case list() | tuple():
            told = ", ".join(map(brief, value[:FEW]))
            return f"[{told}]" if len(value) <= FEW else f"[{told}, ...] ({len(value)})"
    text = str(value)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 20]}...{text[-16:]}"


def brief_repr(record: Any) -> str:
    """``__repr__`` of a dataclass that holds data: its fields, of arrays their shapes."""
    shown = [f.name for f in fields(record) if f.repr]
    told = ", ".join(f"{name}={_inside(getattr(record, name))}" for name in shown)
    return f"{type(record).__name__}({told})"


def _inside(value: Any) -> str:
    match value:
        case np.ndarray() | list() | tuple():
            return brief(value)
    return repr(value)


def flat_rows(tables: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """A row for each table of a scene file, or for each value outside of one."""
    for name, value in tables.items():
        match value:
            case Mapping():
                told = _pairs(value)
            case [Mapping() as first, *_]:
                told = f"{len(value)}: {_pairs(first)}"
            case _:
                told = brief(value)
        if told not in ("", "[]"):
            yield name, told


def _pairs(table: Mapping[str, Any]) -> str:
    return ", ".join(f"{key} {brief(item)}" for key, item in table.items())
