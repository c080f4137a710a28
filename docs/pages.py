"""Pages that are made from the sources when the documentation is built: gallery and reference."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

DOCS = Path(__file__).parent
EXAMPLES = DOCS.parent / "examples"
ROOMS = {
    "scenes": "Scenes",
    "solids": "Solids",
    "terms": "Terms",
    "solver": "Solving and solutions",
    "analysis": "Studies",
    "view": "Pictures and files",
    "surface": "Surfaces, supports and motion",
    "splines": "Spline spaces",
    "units": "Units",
    "errors": "Errors",
}


def examples() -> list[Path]:
    """The examples, as they are shown: short ones first."""
    return sorted(EXAMPLES.glob("*.py"), key=lambda path: (len(path.read_text()), path.name))


def picture_of(example: Path) -> Path | None:
    """What an example draws."""
    places = (DOCS / folder / f"{example.stem}.png" for folder in ("pictures", "results"))
    return next((place for place in places if place.exists()), None)


def said(example: Path) -> tuple[str, str]:
    """Title and text of an example's docstring."""
    text = ast.get_docstring(ast.parse(example.read_text())) or example.stem
    title, _, more = text.partition("\n\n")
    return " ".join(title.split()).rstrip("."), more


def write_gallery(folder: Path) -> None:
    """A page for every example, and their list."""
    folder.mkdir(exist_ok=True)
    entries, names = ["# Gallery\n"], []
    for example in examples():
        title, more = said(example)
        picture = picture_of(example)
        shown = f"![{title}](../{picture.relative_to(DOCS).as_posix()})\n" if picture else ""
        code = f"```{{literalinclude}} ../../examples/{example.name}\n:language: python\n```\n"
        page = [f"# {title}\n", shown, more + "\n", f"## {example.name}\n", code]
        _write(folder / f"{example.stem}.md", "\n".join(page))
        entries.append(f"## [{title}]({example.stem}.md)\n\n{shown}")
        names.append(example.stem)
    tree = "\n".join(["```{toctree}", ":hidden:", "", *names, "```"])
    _write(folder / "index.md", "\n".join([*entries, tree, ""]))


def write_reference(folder: Path, homes: Mapping[str, Sequence[str]]) -> None:
    """All public names, room by room."""
    folder.mkdir(exist_ok=True)
    rooms: dict[str, list[str]] = {room: [] for room in ROOMS}
    for home, names in homes.items():
        rooms[home.partition(".")[0]] += names
    page = ["API reference", "=============", "", ".. currentmodule:: iga_membrane", ""]
    for room, names in rooms.items():
        title = ROOMS[room]
        page += [title, "-" * len(title), "", ".. autosummary::", "   :toctree:", ""]
        page += [f"   {name}" for name in names] + [""]
    _write(folder / "index.rst", "\n".join(page))


def _write(path: Path, text: str) -> None:
    """Only what has changed, so that builds do not read all pages anew."""
    text = re.sub(r"\n{3,}", "\n\n", text)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)
