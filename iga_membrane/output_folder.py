"""The folder that a command writes to: never the results of two scenes in one.

What a command is to write is here by name, so that an older result can be removed, and nothing
else. What a sweep resumes from, its folder of points, is not a result.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable
from pathlib import Path

from .errors import OutputError

RESULT, STATE, SURFACE, PICTURE = "result.json", "state.npz", "surface.vtu", "picture.png"
STATE_BEFORE = "state.previous.npz"
FRAME = "frame_{}.png"
TABLES = ("table.csv", "table.npz")
OWN = (RESULT, STATE, STATE_BEFORE, SURFACE, PICTURE, *TABLES)
"""All that ``solve``, ``sweep`` and ``plot`` write into a folder by themselves."""


def output_folder(field: str, given: str | Path) -> Path:
    """A folder to write to, which need not exist yet.

    Raises
    ------
    OutputError
        No name, or the name of something else.
    """
    if not isinstance(given, (str, Path)) or not str(given).strip():
        raise OutputError(f'{field} = {given!r}: name a folder; "." is the current one')
    try:
        is_folder = stat.S_ISDIR(os.stat(given).st_mode)
    except FileNotFoundError:
        is_folder = True  # to be made
    except (OSError, ValueError) as error:
        raise OutputError(f"{field} = {str(given)!r}: cannot be a folder ({error})") from error
    if not is_folder:
        raise OutputError(f"{field} = {str(given)!r}: is there and no folder; name another one")
    return Path(given)


def remove_results(folder: Path, keep: Iterable[str] = ()) -> None:
    """Remove the results of an older scene.

    Parameters
    ----------
    folder : which need not exist.
    keep : names that stay.

    Raises
    ------
    OutputError
        If one cannot be removed.
    """
    for name in OWN:
        if name not in keep:
            remove(folder / name)


def remove(path: Path) -> None:
    """Remove a file, or a link but not what it leads to, if it is there.

    Raises
    ------
    OutputError
        If it cannot be removed.
    """
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"{path}: of an older result, cannot be removed ({error})") from error
