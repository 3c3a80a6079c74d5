"""Reads folders and zips that pupils handed in, into memory and within limits."""

from __future__ import annotations

import contextlib
import io
import lzma
import os
import stat
import unicodedata
import zipfile
import zlib
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path, PurePosixPath

from thymio_sim_ros.errors import ThymioSimError

__all__ = [
    "Content",
    "RejectedError",
    "check_paths",
    "is_clutter",
    "is_link",
    "is_zip",
    "read_class_zip",
    "read_folder",
    "read_zip",
    "unpack",
]

Content = Mapping[str, bytes]
"""Relative paths with slashes → bytes. Paths are in Unicode's composed form, as programs write and import them."""

MAX_BYTES = 8_000_000
"""Size of all files of a submission, unpacked."""
MAX_FILES = 300
CLASS_BYTES = 1_000_000_000
CLASS_FILES = 20_000
"""Limits of a zip of the whole class."""
MAX_PATH, MAX_NAME_BYTES = 1000, 255
"""Characters of a path; bytes of each of its parts, as Linux has it."""

_CLUTTER = ("__MACOSX", "__pycache__", "desktop.ini", "Thumbs.db")
_ENCRYPTED, _IS_UTF8 = 0x1, 0x800
"""Flags of an entry of a zip."""

_CANNOT_UNPACK = (
    zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, IndexError, OSError, RuntimeError, ValueError,
)  # fmt: skip
"""Exceptions for a damaged, encrypted or unusual archive; IndexError: an entry without a name."""


_ONLY_NEEDED = "hand in only what the task asks for"


class RejectedError(ThymioSimError):
    """Files that are not accepted; the text is one line for the teacher's table."""


def is_link(name: str) -> str:
    """The reason why a link is rejected."""
    return f"{name} is a link (symbolic link) to something else: hand in the file or folder itself"


def is_clutter(path: str) -> bool:
    """Whether a path leads to files that systems and tools add: `.git`, `.DS_Store`, `__MACOSX`, …"""
    return any((part.startswith(".") and part not in (".", "..")) or part in _CLUTTER for part in path.split("/"))


def read_folder(path: Path) -> dict[str, bytes]:
    """Read a file, or all files below a folder without clutter. Raises RejectedError for links, devices and too many
    bytes; OSError.
    """
    files: dict[str, bytes] = {}
    size = 0
    for file in [path] if not path.is_dir() else _walk(path):
        name = file.name if file == path else file.relative_to(path).as_posix()
        with _opened(file, name) as opened:
            content = opened.read(MAX_BYTES + 1)
        size += len(content)
        _check_size(size, len(files) + 1, MAX_BYTES, MAX_FILES)
        files[_composed(name)] = content
    return files


def _walk(folder: Path) -> list[Path]:
    found: list[Path] = []
    for parent, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not is_clutter(name))
        names = sorted(name for name in names if not is_clutter(name))
        for name in (*folders, *names):
            if os.path.islink(os.path.join(parent, name)):
                shown = Path(parent, name).relative_to(folder).as_posix()
                raise RejectedError(is_link(shown))
        found += [Path(parent, name) for name in names]
        _check_size(0, len(found), MAX_BYTES, MAX_FILES)
    return found


def _opened(path: Path, name: str) -> io.BufferedReader:
    """Open a file without following a link and without waiting for a pipe."""
    opened = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    if not stat.S_ISREG(os.fstat(opened).st_mode):
        os.close(opened)
        raise RejectedError(f"{name} is neither a file nor a folder: hand in a file, a folder or a zip")
    return os.fdopen(opened, "rb")


def read_zip(data: bytes) -> dict[str, bytes]:
    """Read a zip without clutter.

    Raises RejectedError if it is damaged, encrypted or too large, or has a link or a path out of it.
    """
    files: dict[str, bytes] = {}
    size = 0
    with _opened_zip(data) as archive:
        entries = _entries(archive)
        _check_size(sum(entry.file_size for _, entry in entries), len(entries), MAX_BYTES, MAX_FILES)
        for name, entry in entries:
            if name in files:
                raise _twice(name)
            _check_inside(name)
            files[name] = _read_entry(archive, name, entry, MAX_BYTES - size)
            size += len(files[name])
            _check_size(size, len(files), MAX_BYTES, MAX_FILES)
    return files


def read_class_zip(data: bytes) -> dict[str, bytes | RejectedError | None]:
    """Read a zip of the whole class.

    A rejected file is replaced by the reason, so that the other submissions are graded. Clutter and folders are None;
    the path of a folder ends in "/.", so that a pupil without files is listed, too. Raises RejectedError if the zip as
    a whole is damaged or too large, or has a path out of it.
    """
    files: dict[str, bytes | RejectedError | None] = {}
    with _opened_zip(data) as archive:
        entries = archive.infolist()
        declared = [entry.file_size for entry in entries if entry.file_size <= MAX_BYTES]
        _check_size(sum(declared), len(entries), CLASS_BYTES, CLASS_FILES)
        for entry in entries:
            name = _name(entry)
            _check_inside(name.partition("/")[0])
            if entry.is_dir() or is_clutter(name):
                files[f"{name}." if entry.is_dir() else name] = None
                continue
            try:
                _check_inside(name)
                _check_size(entry.file_size, 1, MAX_BYTES, 1)
                content = _read_entry(archive, name, entry, entry.file_size)
                files[name] = _twice(name) if name in files else content
            except RejectedError as error:
                files[name] = error
    return files


@contextlib.contextmanager
def _opened_zip(data: bytes) -> Iterator[zipfile.ZipFile]:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            yield archive
    except _CANNOT_UNPACK as error:
        raise _unreadable(error) from error


def _entries(archive: zipfile.ZipFile) -> list[tuple[str, zipfile.ZipInfo]]:
    """The files of a zip and their names, without clutter."""
    entries = [(_name(entry), entry) for entry in archive.infolist() if not entry.is_dir()]
    return [(name, entry) for name, entry in entries if not is_clutter(name)]


def _name(entry: zipfile.ZipInfo) -> str:
    """The path of an entry. Some systems, such as macOS, write UTF-8 without the flag that says so."""
    name = entry.filename.replace("\\", "/")
    if not entry.flag_bits & _IS_UTF8:
        with contextlib.suppress(UnicodeError):
            name = name.encode("cp437").decode("utf-8")
    return _composed(name)


def _composed(name: str) -> str:
    return unicodedata.normalize("NFC", name)


def _read_entry(archive: zipfile.ZipFile, name: str, entry: zipfile.ZipInfo, limit: int) -> bytes:
    """Read an entry, at most one byte more than the limit: declared sizes may be false."""
    if stat.S_ISLNK(entry.external_attr >> 16):
        raise RejectedError(is_link(name))
    if entry.flag_bits & _ENCRYPTED:
        raise RejectedError(f"{name} has a password: pack a zip without a password")
    try:
        with archive.open(entry) as opened:
            return opened.read(limit + 1)
    except _CANNOT_UNPACK as error:
        raise _unreadable(error) from error


def _unreadable(error: Exception) -> RejectedError:
    return RejectedError(f"the zip cannot be read: pack the files again ({error})")


def _twice(name: str) -> RejectedError:
    return RejectedError(f"the zip has {name} twice: pack it with one of them")


def unpack(files: Content) -> dict[str, bytes]:
    """Replace zips by their files, if a submission has only zips; zips in zips stay as they are.

    Raises RejectedError.
    """
    content = dict(files)
    if files and all(map(is_zip, files)):
        content = {}
        for data in files.values():
            content |= read_zip(data)
    _check_size(sum(map(len, content.values())), len(content), MAX_BYTES, MAX_FILES)
    return content


def is_zip(name: str) -> bool:
    """Whether a file is a zip by its name."""
    return name.lower().endswith(".zip")


def check_paths(names: Collection[str]) -> None:
    """Check that a folder can have these paths. Raises RejectedError."""
    folders = {str(parent) for name in names for parent in PurePosixPath(name).parents}
    for name in names:
        if len(name) > MAX_PATH or any(
            len(part.encode("utf-8", "replace")) > MAX_NAME_BYTES for part in name.split("/")
        ):
            raise RejectedError(f"the name of a file or folder is too long: give {name[:60]!r}… a shorter one")
        if name in folders:
            raise RejectedError(f"{name} is both a file and a folder: give one of them another name")


def _check_inside(name: str) -> None:
    if name.startswith("/") or ".." in name.split("/") or ":" in name.split("/")[0] or "\0" in name:
        raise RejectedError(f"{name[:60]!r} leads out of the zip: pack the folder of your work again")


def _check_size(size: int, files: int, max_bytes: int, max_files: int) -> None:
    if size > max_bytes:
        raise RejectedError(f"more than {max_bytes // 1_000_000} MB, unpacked: {_ONLY_NEEDED}")
    if files > max_files:
        raise RejectedError(f"more than {max_files} files: {_ONLY_NEEDED}")
