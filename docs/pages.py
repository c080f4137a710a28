"""Pages that are made from the sources when the documentation is built: gallery, tutorials and
reference."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

DOCS = Path(__file__).parent
EXAMPLES = DOCS.parent / "examples"
TITLES = {
    "Problems and scene files": ("problems", "initial", "io"),
    "Solids": ("solids",),
    "Terms": ("terms",),
    "Solving and solutions": ("driver", "solvers", "results", "verification", "status"),
    "Studies": ("analysis",),
    "Photographs": ("photograph",),
    "Pictures and files": ("view",),
    "Surfaces and their motion": ("surface", "dofs"),
    "Spline spaces": ("splines",),
    "Units and progress": ("units", "progress"),
    "Errors": ("errors",),
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
    entries, names = ["# Gallery\n", '<div class="thumbnails">\n'], []
    for example in examples():
        title, more = said(example)
        picture = picture_of(example)
        shown = f"![{title}](../{picture.relative_to(DOCS).as_posix()})\n" if picture else ""
        code = f"```{{literalinclude}} ../../examples/{example.name}\n:language: python\n```\n"
        page = [f"# {title}\n", shown, more + "\n", f"## {example.name}\n", code]
        _write(folder / f"{example.stem}.md", "\n".join(page))
        entries.append(_thumbnail(example.stem, title, picture))
        names.append(example.stem)
    tree = "\n".join(["```{toctree}", ":hidden:", "", *names, "```"])
    _write(folder / "index.md", "\n".join([*entries, "</div>\n", tree, ""]))


def _thumbnail(stem: str, title: str, picture: Path | None) -> str:
    """A picture with its title that leads to the page; the style is in _static/pages.css."""
    shown = f"![{title}](../{picture.relative_to(DOCS).as_posix()})" if picture else ""
    return f"[{shown} {title}]({stem}.md)\n"


def write_tutorials(folder: Path) -> None:
    """A page for every notebook, its words and its code; tests run the notebooks."""
    folder.mkdir(exist_ok=True)
    entries, names = ["# Tutorials\n"], []
    for book in sorted((DOCS / "notebooks").glob("*.ipynb")):
        cells = json.loads(book.read_text())["cells"]
        page = []
        for cell in cells:
            text = "".join(cell["source"])
            page.append(text if cell["cell_type"] == "markdown" else f"```python\n{text}\n```")
        source = f"The notebook: `docs/notebooks/{book.name}`."
        _write(folder / f"{book.stem}.md", "\n\n".join([*page, source, ""]))
        title, _, more = "".join(cells[0]["source"]).partition("\n\n")
        entries.append(f"## [{title.removeprefix('# ')}]({book.stem}.md)\n\n{more}\n")
        names.append(book.stem)
    tree = "\n".join(["```{toctree}", ":hidden:", "", *names, "```"])
    _write(folder / "index.md", "\n".join([*entries, tree, ""]))


def write_reference(folder: Path, homes: Mapping[str, Sequence[str]]) -> None:
    """All public names, room by room."""
    folder.mkdir(exist_ok=True)
    of_room: dict[str, list[str]] = {}
    for home, names in homes.items():
        of_room.setdefault(home.partition(".")[0], []).extend(names)
    page = ["API reference", "=============", "", ".. currentmodule:: iga_membrane", ""]
    for title, rooms in TITLES.items():
        names = [name for room in rooms for name in of_room.pop(room, [])]
        page += [title, "-" * len(title), "", ".. autosummary::", "   :toctree:", ""]
        page += [f"   {name}" for name in names] + [""]
    assert not of_room, of_room
    _write(folder / "index.rst", "\n".join(page))


def _write(path: Path, text: str) -> None:
    """Only what has changed, so that builds do not read all pages anew."""
    text = re.sub(r"\n{3,}", "\n\n", text)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)
