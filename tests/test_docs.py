"""The code in README and docs runs as it stands, page by page, each in a folder of its own; links
lead somewhere; the pages are built without a warning."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

import iga_membrane
from iga_membrane.view import drawing

ROOT = Path(__file__).parents[1]
MADE = ("_build", "api", "gallery", "tutorials")
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *(
        page
        for page in sorted((ROOT / "docs").rglob("*.md"))
        if page.relative_to(ROOT / "docs").parts[0] not in MADE
    ),
]


def name_of(page):
    return page.relative_to(ROOT).as_posix()


def blocks(page):
    return re.findall(r"^```python\n(.*?)^```", page.read_text(), re.M | re.S)


LONG = (
    "docs/start.md",
    "docs/guides/particles.md",
    "docs/guides/every_name.md",
    "docs/guides/bridges.md",
    "docs/guides/textures.md",
)
"""Pages whose code takes more than some seconds."""


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(p, marks=[pytest.mark.slow] if name_of(p) in LONG else [], id=name_of(p))
        for p in PAGES
        if blocks(p)
    ],
)
def test_code_blocks_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if not drawing.can_draw():
        monkeypatch.setattr("iga_membrane.view.picture.plot", lambda *a, **k: None)
    names = {"__name__": "__main__"}
    for number, block in enumerate(blocks(page)):
        exec(compile(block, f"{page.name}[{number}]", "exec"), names)


def test_every_public_name_stands_in_code_that_is_run():
    """In an example or in a block of the docs: the tests of both run them."""
    code = [path.read_text() for path in (ROOT / "examples").glob("*.py")]
    code += [block for page in PAGES for block in blocks(page)]
    said = set(re.findall(r"\biga\.(\w+)", "\n".join(code)))
    assert set(iga_membrane.__all__) <= said


def anchors(page):
    """Fragments of a page's headings, as GitHub and myst make them."""
    titles = re.findall(r"^#+ (.*)$", page.read_text(), re.M)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_somewhere(page):
    for target, fragment in re.findall(r"\]\(([^)#]*)(?:#([^)]*))?\)", page.read_text()):
        if target.startswith(("http", "mailto")):
            continue
        place = page.parent / target if target else page
        # gallery and reference are made when the pages are built
        made = place.resolve().relative_to(ROOT).parts[1:2]
        assert place.exists() or (made and made[0] in MADE), target
        if fragment and place.suffix == ".md" and place.exists():
            assert fragment in anchors(place), f"{target}#{fragment}"


@pytest.fixture
def pages(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    import pages

    return pages


def test_every_example_is_a_page_of_the_gallery(pages, tmp_path):
    folder = tmp_path / "gallery"
    pages.write_gallery(folder)
    index = (folder / "index.md").read_text()
    for example in (ROOT / "examples").glob("*.py"):
        page = (folder / f"{example.stem}.md").read_text()
        assert f"examples/{example.name}" in page
        assert f"({example.stem}.md)" in index
        assert pages.picture_of(example) is not None, example.name


def test_every_notebook_is_a_page_with_its_words_and_code(pages, tmp_path):
    pages.write_tutorials(tmp_path / "tutorials")
    index = (tmp_path / "tutorials" / "index.md").read_text()
    for book in (ROOT / "docs" / "notebooks").glob("*.ipynb"):
        page = (tmp_path / "tutorials" / f"{book.stem}.md").read_text()
        assert f"({book.stem}.md)" in index
        assert "import iga_membrane as iga" in page
        for cell in json.loads(book.read_text())["cells"]:
            assert re.sub(r"\n{3,}", "\n\n", "".join(cell["source"])) in page


def test_every_public_name_is_in_the_reference(pages, tmp_path):
    import iga_membrane

    pages.write_reference(tmp_path / "api", iga_membrane._HOME)
    listed = (tmp_path / "api" / "index.rst").read_text().split()
    assert set(iga_membrane.__all__) - {"__version__"} <= set(listed)


def test_the_command_that_builds_the_pages_is_told():
    assert "python -m sphinx -W --keep-going -b html docs" in (ROOT / "CONTRIBUTING.md").read_text()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("builder", "folder", "ending"),
    [
        ("dummy", ".doctrees", "doctree"),  # reads and resolves all, writes nothing
        pytest.param("html", "", "html", marks=pytest.mark.slow),
    ],
)
def test_pages_are_built_without_a_warning(builder, folder, ending, tmp_path):
    build = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", builder]
    run = subprocess.run(
        [*build, str(ROOT / "docs"), str(tmp_path)], capture_output=True, text=True, cwd=ROOT
    )
    assert run.returncode == 0, run.stderr
    assert (tmp_path / folder / "api" / f"iga_membrane.solve.{ending}").exists()
    assert (tmp_path / folder / "gallery" / f"pillars.{ending}").exists()
