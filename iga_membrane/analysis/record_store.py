"""One file per finished point, whole or not there: what a sweep resumes from."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import socket
import sys
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ..errors import OutputError, StateError
from ..files import check_folder, read_file, write_whole
from ..records import digest

Record = dict[str, Any]
LARGEST_RECORD = 50_000_000
"""Bytes of a record at most."""
LARGEST_CLAIM = 1_000
"""Bytes of a claim at most; it holds a host name of at most 255 characters and a number."""
LAPSE = 300.0
"""Seconds after which a claim that nobody has renewed counts for nothing."""


class RecordStore:
    """A folder of records, shared by any number of processes.

    A point is claimed by a file that names host and process, made exclusively. The claim of a
    process of this host that is gone counts for nothing, nor does one, of any host, that was not
    renewed for ``LAPSE``. A record is written beside and renamed, so that it is whole or not there,
    and has a checksum.

    Parameters
    ----------
    folder : made if it is not there.

    Raises
    ------
    OutputError
        If it cannot be written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        check_folder(folder)

    @staticmethod
    def key(parameters: Mapping[str, Any]) -> str:
        """Name of a point by its parameters, whatever their order."""
        return digest(dict(sorted(parameters.items())))[:24]

    def read(self, key: str) -> Record | None:
        """The record of a point, or None where there is none that can be trusted."""
        try:
            text = read_file(self._path(key), LARGEST_RECORD, StateError).decode("utf-8")
            mark, text = text.split("\n", 1)
            record = json.loads(text) if mark == _checksum(text) else None
        except (ValueError, RecursionError):
            return None
        return record if isinstance(record, dict) else None

    def write(self, key: str, record: Record) -> None:
        """Keep a record; its claim ends."""
        text = json.dumps(record, indent=1) + "\n"
        whole = f"{_checksum(text)}\n{text}"
        write_whole(self._path(key), lambda name: Path(name).write_text(whole, encoding="utf-8"))
        self.release(key)

    def claim(self, key: str) -> bool:
        """Whether this process may compute a point.

        Raises
        ------
        OutputError
            If the claim cannot be written.
        """
        path = self._claim(key)
        if _made(path):
            return True
        now = self._now()
        if not _abandoned(path, now):
            return False
        # of those that see a dead claim one renames it away
        dead = self.folder / f".{key}.{os.getpid()}.dead"
        try:
            os.rename(path, dead)
        except FileNotFoundError:
            return False
        if not _abandoned(dead, now):  # another one has made it anew meanwhile
            os.rename(dead, path)
            return False
        dead.unlink()
        return _made(path)

    def _now(self) -> float:
        """By the clock of the folder, which may be another machine's."""
        try:
            with tempfile.NamedTemporaryFile(dir=self.folder, prefix=".now-") as file:
                return os.fstat(file.fileno()).st_mtime
        except OSError as error:
            raise OutputError(f"{self.folder}: cannot be written ({error})") from error

    def renew(self, keys: Iterable[str]) -> None:
        """Say that this process still computes its points."""
        for key in keys:
            with contextlib.suppress(FileNotFoundError):
                os.utime(self._claim(key))

    def release(self, key: str) -> None:
        """Let others compute a point."""
        self._claim(key).unlink(missing_ok=True)

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}.json"

    def _claim(self, key: str) -> Path:
        return self.folder / f".{key}.claim"


def _checksum(text: str) -> str:
    return "sha256 " + hashlib.sha256(text.encode()).hexdigest()


def this_process() -> str:
    """Its host and number."""
    return f"{socket.gethostname()} {os.getpid()}"


def _made(path: Path) -> bool:
    """Whether this process has made a claim, which nobody had.

    Raises
    ------
    OutputError
    """
    try:
        with open(path, "x", encoding="utf-8") as file:
            file.write(this_process())
    except FileExistsError:
        return False
    except OSError as error:
        path.unlink(missing_ok=True)
        raise OutputError(f"{path}: cannot be written ({error})") from error
    return True


def _abandoned(path: Path, now: float) -> bool:
    """Whether the process that made a claim is gone, now by the clock of the folder."""
    try:
        lapsed = now - path.stat().st_mtime > LAPSE
    except FileNotFoundError:
        return False
    try:
        text = read_file(path, LARGEST_CLAIM, StateError).decode("utf-8", "replace")
    except StateError:  # taken away meanwhile, or no claim
        return lapsed
    host, _, pid = text.partition(" ")
    return lapsed or (host == socket.gethostname() and pid.isdecimal() and _gone(int(pid)))


def _gone(pid: int) -> bool:
    """Whether a process of this host has ended, also if its parent has not taken notice yet."""
    if sys.platform == "win32" or pid <= 0:
        return False  # there a signal 0 is Ctrl-C; a claim then lapses
    try:
        os.kill(pid, 0)
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except ProcessLookupError:
        return True
    except (OSError, OverflowError):
        return False  # another user's, or a system without /proc
