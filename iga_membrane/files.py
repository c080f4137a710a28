"""Files that are whole or not there: written beside, flushed, renamed, and checked when read.

A state file is a plain ``.npz`` (stored, not compressed, no pickle) whose zip comment holds the
SHA-256 of everything before it, so that any flipped bit is noticed.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import math
import os
import stat
import tempfile
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .arrays import Array
from .errors import OutputError, StateError

SCHEMA = 1
"""Version of the state file."""
LARGEST_STATE = 1_000_000_000
"""Bytes of a state file at most."""
_MAGIC = b"iga_membrane state "
_DIGITS = 64
_TAIL = len(_MAGIC) + 4 + _DIGITS
_DTYPES = ("<f8", "<i8", "|b1", "|u1")


def write_whole(path: Path, write: Callable[[str], object]) -> None:
    """Write to a temporary file beside ``path``, flush it to the disk, then rename it.

    Raises
    ------
    OutputError
        Nothing half-written is left behind, and what was there before stays.
    """
    try:
        # hidden: what a killed process leaves behind is not taken for a result
        handle, name = tempfile.mkstemp(path.suffix, f".{path.stem}-", path.parent)
        os.close(handle)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error})") from error
    try:
        write(name)
        with open(name, "rb+") as file:
            os.fsync(file.fileno())
        os.chmod(name, 0o644)
        os.replace(name, path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error})") from error
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(name)


def check_folder(folder: Path) -> None:
    """Make a folder and prove that files can be written in it, before any work.

    Raises
    ------
    OutputError
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except (OSError, ValueError) as error:
        raise OutputError(f"{folder}: cannot be written ({error})") from error


def size_of(path: Path, most: int, wrong: type[Exception]) -> int:
    """Bytes of a file that may be read, seen before it is opened: a pipe would keep its reader
    waiting, a device never ends.

    Parameters
    ----------
    path : links are followed.
    most : bytes at most.
    wrong : what to raise.
    """
    try:
        found = path.stat()
    except (OSError, ValueError) as error:
        raise wrong(f"{path}: cannot be read ({error})") from error
    if not stat.S_ISREG(found.st_mode):
        kinds = (stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe")
        kind = next((name for is_kind, name in kinds if is_kind(found.st_mode)), "a device")
        raise wrong(f"{path}: cannot be read: it is {kind}, name a regular file")
    if found.st_size > most:
        raise wrong(f"{path}: larger than {most} bytes; no such file is")
    return found.st_size


def read_file(path: Path, most: int, wrong: type[Exception]) -> bytes:
    """All of a file that a user names; only regular ones are read (:func:`size_of`).

    Parameters
    ----------
    most : bytes at most.
    wrong : what to raise.
    """
    size = size_of(path, most, wrong)
    try:
        with open(path, "rb") as file:
            data = file.read(size + 1)
    except OSError as error:
        raise wrong(f"{path}: cannot be read ({error})") from error
    if len(data) > size:
        raise wrong(f"{path}: cannot be read: it is larger than it says, or grows")
    return data


def previous(path: Path) -> Path:
    """Where the generation before a state file is kept: ``state.previous.npz``."""
    return path.with_suffix(f".previous{path.suffix}")


def write_arrays(
    path: Path, header: Mapping[str, Any], arrays: Mapping[str, Array], *, keep: bool = False
) -> None:
    """Write a state file.

    Parameters
    ----------
    header : what JSON can hold.
    arrays : by name; any but "header".
    keep : whether to keep the file that was there before as :func:`previous`.

    Raises
    ------
    OutputError
    """
    text = json.dumps({"schema": SCHEMA, **header})
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, array in {"header": np.frombuffer(text.encode(), np.uint8), **arrays}.items():
            member = io.BytesIO()
            np.lib.format.write_array(member, array, (1, 0), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), member.getvalue())
        archive.comment = _MAGIC + f"{SCHEMA:3d} ".encode() + b"0" * _DIGITS
    body = memoryview(buffer.getbuffer())[:-_DIGITS]
    digest = hashlib.sha256(body).hexdigest().encode()

    def write(name: str) -> None:
        with open(name, "wb") as file:
            file.write(body)
            file.write(digest)

    if keep and path.exists():
        write_whole(previous(path), lambda name: Path(name).write_bytes(path.read_bytes()))
    write_whole(path, write)


def read_arrays(path: Path) -> tuple[dict[str, Any], dict[str, Array]]:
    """Header and arrays of a state file.

    Raises
    ------
    StateError
        Not readable, too large, not a state file, of a newer version, or not as it was written.
    """
    size = size_of(path, LARGEST_STATE, StateError)
    if not _is_state(path, size):
        raise StateError(
            f"{path}: not a state file of iga_membrane, or cut off: its end has no checksum"
        )
    data = read_file(path, LARGEST_STATE, StateError)
    schema = data[-_DIGITS - 4 : -_DIGITS].strip()
    if schema != str(SCHEMA).encode():
        raise StateError(
            f"{path}: schema {schema.decode(errors='replace')}, this version reads schema "
            f"{SCHEMA}: read the file with the version that wrote it"
        )
    body = memoryview(data)[:-_DIGITS]
    if hashlib.sha256(body).hexdigest().encode() != data[-_DIGITS:]:
        raise StateError(f"{path}: corrupt: its content does not have the checksum written in it")
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            arrays = {
                member.filename.removesuffix(".npy"): _array(archive, member)
                for member in archive.infolist()
            }
        header = json.loads(arrays.pop("header").tobytes())
    except (ValueError, KeyError, RecursionError, OSError, EOFError, NotImplementedError,
            zipfile.BadZipFile) as error:  # fmt: skip
        raise StateError(f"{path}: not a state file of iga_membrane ({error})") from error
    if not isinstance(header, dict) or header.get("schema") != SCHEMA:
        raise StateError(f"{path}: not a state file of iga_membrane: it has no header")
    return header, arrays


def _is_state(path: Path, size: int) -> bool:
    """Whether a file ends like a state file; nothing else of it is read."""
    if size < _TAIL:
        return False
    try:
        with open(path, "rb") as file:
            file.seek(size - _TAIL)
            return file.read(len(_MAGIC)) == _MAGIC
    except OSError as error:
        raise StateError(f"{path}: cannot be read ({error})") from error


def _array(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> Array:
    """An array whose size in the file is what its header claims; no objects, no compression."""
    if member.compress_type != zipfile.ZIP_STORED:
        raise ValueError(f"{member.filename} is compressed")
    data = archive.read(member)
    stream = io.BytesIO(data)
    version = np.lib.format.read_magic(stream)
    if version != (1, 0):
        raise ValueError(f"{member.filename} has npy version {version}")
    shape, fortran, dtype = np.lib.format.read_array_header_1_0(stream)
    left = len(data) - stream.tell()
    if dtype.str not in _DTYPES or left != math.prod(shape) * dtype.itemsize:
        raise ValueError(f"{member.filename} claims {shape} of {dtype} in {left} bytes")
    flat = np.frombuffer(data, dtype, offset=stream.tell())
    return flat.reshape(shape, order="F" if fortran else "C").copy()
