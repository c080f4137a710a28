"""Sphinx: ``python -m sphinx -W --keep-going -b html docs docs/_build``."""

import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

import pages  # noqa: E402

import iga_membrane  # noqa: E402

project = "iga_membrane"
author = "The iga_membrane developers"
release = iga_membrane.__version__

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
]
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
exclude_patterns = ["_build", "notebooks"]
templates_path = ["_templates"]
html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_title = f"iga_membrane {release}"

autosummary_generate = True
autodoc_typehints = "none"  # arguments are described in words
numpydoc_show_class_members = False
numpydoc_attributes_as_param_list = True

pages.write_gallery(HERE / "gallery")
pages.write_tutorials(HERE / "tutorials")
pages.write_reference(HERE / "api", iga_membrane._HOME)

SECTION = re.compile(r"^(Parameters|Attributes)$")
ENTRY = re.compile(r"^(\S[^:]*?) : (.*)$")


def describe(app, what, name, obj, options, lines):
    """Our entries are "name : what it is", in one line; numpydoc expects a type there, so the words
    move below the name."""
    inside, made = False, []
    for k, line in enumerate(lines):
        underlined = k + 1 < len(lines) and re.fullmatch(r"-{3,}", lines[k + 1])
        if underlined:
            inside = bool(SECTION.match(line))
        entry = ENTRY.match(line) if inside else None
        if entry is None:
            made.append(line)
            continue
        # "one, two : ...; three : ..." are entries of one line
        for part in re.split(r"; (?=[a-z_0-9]+(?:, [a-z_0-9]+)* : )", line):
            names, _, words = part.partition(" : ")
            made += [names, f"    {words}"]
    lines[:] = made


def setup(app):
    app.connect("autodoc-process-docstring", describe, priority=400)
