"""Reads folders and zips that pupils handed in, into memory and within limits."""

from __future__ import annotations

import io
import os
import stat
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["Content", "RejectedError", "read_folder", "read_zip", "unpack"]

Content = Mapping[str, bytes]
"""Relative paths with slashes → bytes."""

MAX_BYTES = 8_000_000
"""Size of all files of a submission, unpacked."""
MAX_FILES = 300
CLASS_BYTES = 1_000_000_000
CLASS_FILES = 20_000
"""Limits of a zip of the whole class."""


class RejectedError(ThymioSimError):
    """Files that are not accepted; the text is one line for the teacher's table."""


def read_folder(path: Path) -> dict[str, bytes]:
    """Read a file, or all files below a folder. Raises RejectedError for links, devices and too many bytes; OSError."""
    files: dict[str, bytes] = {}
    size = 0
    for file in [path] if not path.is_dir() else _walk(path):
        name = file.name if file == path else file.relative_to(path).as_posix()
        with _opened(file, name) as opened:
            content = opened.read(MAX_BYTES + 1)
        size += len(content)
        _check_size(size, len(files) + 1, MAX_BYTES, MAX_FILES)
        files[name] = content
    return files


def _walk(folder: Path) -> list[Path]:
    found = []
    for parent, folders, names in os.walk(folder):
        folders.sort()
        for name in (*folders, *names):
            if os.path.islink(os.path.join(parent, name)):
                shown = Path(parent, name).relative_to(folder).as_posix()
                raise RejectedError(f"{shown} is a symbolic link; expected a file or folder")
        found += [Path(parent, name) for name in sorted(names)]
        _check_size(0, len(found), MAX_BYTES, MAX_FILES)
    return found


def _opened(path: Path, name: str) -> io.BufferedReader:
    """Open a file without following a link and without waiting for a pipe."""
    opened = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    if not stat.S_ISREG(os.fstat(opened).st_mode):
        os.close(opened)
        raise RejectedError(f"{name} is neither a file nor a folder")
    return os.fdopen(opened, "rb")


def read_zip(data: bytes, *, whole_class: bool = False) -> dict[str, bytes]:
    """Read a zip. Raises RejectedError if it is damaged, encrypted or too large, or has a link or a path out of it."""
    max_bytes, max_files = (CLASS_BYTES, CLASS_FILES) if whole_class else (MAX_BYTES, MAX_FILES)
    files: dict[str, bytes] = {}
    size = 0
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = [entry for entry in archive.infolist() if not entry.is_dir()]
            _check_size(sum(entry.file_size for entry in entries), len(entries), max_bytes, max_files)
            for entry in entries:
                name = _checked_name(entry, files)
                with archive.open(entry) as opened:  # declared sizes may be false: never read more than is allowed
                    files[name] = opened.read(max_bytes - size + 1)
                size += len(files[name])
                _check_size(size, len(files), max_bytes, max_files)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError) as error:
        raise RejectedError(f"a zip that cannot be read: {error}") from error
    return files


def unpack(files: Content) -> dict[str, bytes]:
    """Replace zips by their files, if a submission is nothing but zips; zips in zips stay as they are."""
    if not files or not all(name.lower().endswith(".zip") for name in files):
        _check_size(sum(map(len, files.values())), len(files), MAX_BYTES, MAX_FILES)
        return dict(files)
    content: dict[str, bytes] = {}
    for data in files.values():
        content |= read_zip(data)
        _check_size(sum(map(len, content.values())), len(content), MAX_BYTES, MAX_FILES)
    return content


def _checked_name(entry: zipfile.ZipInfo, taken: Content) -> str:
    name = entry.filename.replace("\\", "/")
    if stat.S_ISLNK(entry.external_attr >> 16):
        raise RejectedError(f"{name} is a symbolic link; expected a file or folder")
    if name.startswith("/") or ".." in name.split("/") or ":" in name.split("/")[0] or "\0" in name or len(name) > 200:
        raise RejectedError(f"the zip has the path {name[:60]!r}; expected paths inside of it")
    if name in taken:
        raise RejectedError(f"the zip has {name} twice")
    return name


def _check_size(size: int, files: int, max_bytes: int, max_files: int) -> None:
    if size > max_bytes:
        raise RejectedError(f"more than {max_bytes // 1_000_000} MB, unpacked")
    if files > max_files:
        raise RejectedError(f"more than {max_files} files")
