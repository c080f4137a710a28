"""One file per finished point, whole or not there: what a sweep resumes from."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import socket
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ..errors import OutputError
from ..files import check_folder, write_whole
from ..records import digest

Record = dict[str, Any]
LARGEST_RECORD = 50_000_000
"""Bytes of a record at most."""
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
        path = self._path(key)
        try:
            if path.stat().st_size > LARGEST_RECORD:
                return None
            mark, text = path.read_text(encoding="utf-8").split("\n", 1)
            record = json.loads(text) if mark == _checksum(text) else None
        except (OSError, ValueError, RecursionError):
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
        path, mine = self._claim(key), self.folder / f".{key}.{os.getpid()}"
        try:
            mine.write_text(this_process(), encoding="utf-8")
        except OSError as error:
            mine.unlink(missing_ok=True)
            raise OutputError(f"{mine}: cannot be written ({error})") from error
        try:
            if _abandoned(path, mine.stat().st_mtime):
                # of those that see a dead claim one renames it away
                os.rename(path, mine.with_suffix(".dead"))
                mine.with_suffix(".dead").unlink()
            os.link(mine, path)
        except (FileExistsError, FileNotFoundError):
            return False
        finally:
            mine.unlink()
        return True

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


def _abandoned(path: Path, now: float) -> bool:
    """Whether the process that made a claim is gone, now by the clock of the folder."""
    try:
        host, _, pid = path.read_text(encoding="utf-8").partition(" ")
        lapsed = now - path.stat().st_mtime > LAPSE
    except FileNotFoundError:
        return False
    return lapsed or (host == socket.gethostname() and _gone(int(pid)))


def _gone(pid: int) -> bool:
    """Whether a process has ended, also if its parent has not taken notice yet."""
    try:
        os.kill(pid, 0)
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except ProcessLookupError:
        return True
    except OSError:
        return False  # another user's, or a system without /proc
