"""The words of the command line: commands, their options and examples."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Mapping
from typing import Any, NoReturn

from . import __version__
from .checks import suggestion

PROGRAM = "python -m iga_membrane"


class Parser(argparse.ArgumentParser):
    """A parser that suggests the word that was meant."""

    def error(self, message: str) -> NoReturn:
        """Exit with code 2 and one line."""
        choices = re.search(r"invalid choice: '?([^' ]*)'? \(choose from (.*)\)", message)
        unknown = re.search(r"unrecognized arguments: (--?[\w-]+)", message)
        if choices:
            message += suggestion(choices[1], re.findall(r"[\w-]+", choices[2]))
        elif unknown:
            message += suggestion(unknown[1], self.known_options())
        super().error(message)

    def known_options(self) -> list[str]:
        """Options of this parser and of its commands."""
        inside = [p for action in self._actions if isinstance(action, argparse._SubParsersAction)
                  for p in action.choices.values()]  # fmt: skip
        own = [word for action in self._actions for word in action.option_strings]
        return own + [word for each in inside for word in each.known_options()]


def parser(run: Mapping[str, Callable[[argparse.Namespace], int]]) -> argparse.ArgumentParser:
    """The parser, with what runs each command."""
    made = Parser(
        prog="iga_membrane",
        description="Static wetting with C1 spline membranes.",
        epilog=f"Start with: {PROGRAM} init scene.toml",
    )
    made.add_argument("--version", action="version", version=__version__)
    made.add_argument("--progress", action="store_true",
                      help="lines of progress on stderr where it is no terminal")  # fmt: skip
    commands = made.add_subparsers(dest="command", required=True, parser_class=Parser)
    for name, (text, example, arguments) in COMMANDS.items():
        command = commands.add_parser(
            name,
            help=text,
            description=text[0].upper() + text[1:] + ".",
            epilog="examples:\n" + "\n".join(f"  {PROGRAM} {name} {line}" for line in example),
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        for words, options in arguments:
            command.add_argument(*words, **options)
        command.set_defaults(run=run[name])
    return made


Argument = tuple[tuple[str, ...], dict[str, Any]]


def _argument(*words: str, **options: Any) -> Argument:
    return words, options


def _flag(word: str, text: str) -> Argument:
    return _argument(word, action="store_true", help=text)


_OUT = "folder for result.json and state.npz"
COMMANDS: dict[str, tuple[str, tuple[str, ...], tuple[Argument, ...]]] = {
    "init": (
        "write a commented scene file to begin with",
        ("scene.toml", "sheet.toml --kind liquid_sheet"),
        (
            _argument("scene", help="scene file to write, .toml"),
            _argument("--kind", default="sessile_droplet",
                      help="sessile_droplet, liquid_sheet, asperity_cell, capillary_bridge or "
                      "film_between_rings"),
        ),
    ),
    "solve": (
        "solve one scene file",
        ("scene.toml --out out", "scene.toml --out out --png --vtu"),
        (
            _argument("scene", help="scene file, .toml or .json"),
            _argument("--out", required=True, help=_OUT),
            _flag("--vtu", "also write the surface (surface.vtu)"),
            _flag("--png", "also write a picture (picture.png)"),
        ),
    ),
    "sweep": (
        "solve a grid of scenes; again: what is missing",
        ("sweep.toml --out points --workers 4", "sweep.toml --out points --retry-failed"),
        (
            _argument("sweep", help="scene file with [[over]] tables, .toml or .json"),
            _argument("--out", required=True, help="folder for points/, table.csv, table.npz"),
            _argument("--workers", type=int, help="processes (default: the processors)"),
            _argument("--timeout", type=float, help="seconds per point"),
            _flag("--allow-mixed", "keep points of other options or versions"),
            _flag("--retry-failed", "compute again what is recorded, but not as a success"),
        ),
    ),
    "fit": (
        "measure the droplet in a photograph against the light",
        ('drop.png --scale "8 um" --out fit',
         'hanging.png --scale "8 um" --out fit --fit surface_tension volume'),
        (
            _argument("image", help="photograph, .png, .jpg, .tif"),
            _argument("--scale", required=True, help='length of a pixel, "8 um"'),
            _argument("--out", required=True,
                      help="folder for fit.json, points.csv, profile.csv, overlay.png"),
            _argument("--tension", default="72.8 mN/m", help="surface tension (water)"),
            _argument("--density", default="998 kg/m^3", help="over that of the surroundings"),
            _argument("--gravity", default="9.81 m/s^2", help="acceleration, down in the picture"),
            _argument("--fit", nargs="+", default=["contact_angle", "volume"],
                      help="what is sought: contact_angle volume surface_tension base"),
        ),
    ),
    "info": (
        "print the summary of a result",
        ("out", "out/result.json"),
        (_argument("result", help="output folder, state.npz or result.json"),),
    ),
    "plot": (
        "draw a result",
        ("out --color pressure", "out --kind section --out section.pdf"),
        (
            _argument("result", help="output folder or state.npz"),
            _argument("--out", help="picture (.png, .html; section and goniometer .png, .pdf, "
                      ".svg); by default picture.png"),
            _argument("--kind", choices=("space", "goniometer", "section"), default="space",
                      help="in space; the shadow from the side; the section"),
            _argument("--color", choices=("none", "mean_curvature", "pressure", "gap", "residual")),
            _argument("--view", choices=("oblique", "foot", "side", "top")),
            _argument("--focus", choices=("asperity",), help="zoom on a wet asperity"),
            _flag("--traction", "arrows along contact lines"),
            _flag("--forces", "arrows of forces on particles"),
        ),
    ),
    "export": (
        "write other files of a result",
        ("out drop.vtu drop.stl", "out line.lines.csv"),
        (
            _argument("result", help="output folder or state.npz"),
            _argument("files", nargs="+", metavar="FILE",
                      help="by its ending .vtu, .linear.vtu, .stl, .obj, .ply, .geomdl.json, "
                      ".lines.csv, .forces.csv, .json, .npz, .png or .html"),
        ),
    ),
    "schema": ("print the JSON schema of scene files", ("> scene.schema.json",), ()),
}  # fmt: skip
"""Command to what it does, examples of its arguments, and its arguments."""
