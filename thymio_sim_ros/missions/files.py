"""The files of a mission: those beside it, or those of a zip that holds all of them."""

from __future__ import annotations

import atexit
import io
import lzma
import shutil
import tempfile
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from thymio_sim_ros.sim.model.fields import FieldError, describe

__all__ = ["MAX_ARCHIVE_BYTES", "MAX_PICTURE_BYTES", "Files", "is_archive", "located", "unpack"]

MAX_ARCHIVE_BYTES = 10_000_000
"""Of all files of a zip, unpacked."""
MAX_ARCHIVE_FILES = 200
MAX_PICTURE_BYTES = 1_000_000
_ZIP = b"PK\x03\x04"
_DAMAGED = (
    zipfile.BadZipFile, zipfile.LargeZipFile, zlib.error, lzma.LZMAError, OSError, EOFError, RuntimeError, ValueError,
)  # fmt: skip
"""Exceptions for a damaged, encrypted or unusual archive."""


@dataclass(frozen=True, slots=True)
class Files:
    """The folder of a mission. Names of files in a zip must stay inside of it."""

    folder: Path
    is_closed: bool = False

    def find(self, key: str, name: str, *, longest: int | None = None) -> str:
        """The path of a file beside the mission, which need not be there: an assignment has no start programs.

        Raises FieldError for a file outside of the zip, or one that has more than `longest` bytes.
        """
        path = self.folder / name
        if self.is_closed and not path.resolve().is_relative_to(self.folder.resolve()):
            raise FieldError(key, f"'{name}'", "a file of the zip")
        try:
            size = path.stat().st_size if longest is not None and path.is_file() else 0
        except (OSError, ValueError):  # a name that is too long, or that no file has
            size = 0
        if longest is not None and size > longest:
            raise FieldError(key, f"{size} bytes in '{name}'", f"at most {longest} bytes; make it smaller")
        return str(path)

    def find_or_name(self, key: str, name: str) -> str:
        """The same for what may also be shipped: a name without an ending."""
        if PurePosixPath(name).suffix:
            return self.find(key, name)
        if self.is_closed and not name.replace("-", "_").isidentifier():
            raise FieldError(key, describe(name), "a file of the zip, or a shipped name")
        return name


def is_archive(data: bytes) -> bool:
    """Whether a file is a zip."""
    return data.startswith(_ZIP)


def located(path: Path) -> Path:
    """The file of a mission: the same, or that of a zip, which is unpacked. Raises FieldError, OSError."""
    with path.open("rb") as file:
        head = file.read(len(_ZIP))
    return unpack(path.read_bytes()) if is_archive(head) else path


def unpack(data: bytes, folder: Path | None = None) -> Path:
    """Unpack a zip into a folder, or into one that is removed when the process ends; return the path of its mission.

    The mission is the file `mission.json`, or the only JSON file with "success" in it. Raises FieldError.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = [each for each in archive.infolist() if not each.is_dir() and "__MACOSX" not in each.filename]
            _check(entries)
            contents = {each.filename: archive.read(each) for each in entries}
    except _DAMAGED as error:
        raise FieldError("", "a damaged zip", "a complete zip with mission.json") from error
    mission = _mission_of(contents)
    if folder is None:
        folder = Path(tempfile.mkdtemp(prefix="thymio_mission_"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for name, content in contents.items():
        path = folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        except (OSError, ValueError) as error:  # a name that is too long, or both of a file and of a folder
            raise FieldError("", f"the name {describe(name)} in the zip", "one that a file can have") from error
    return folder / mission


def _check(entries: list[zipfile.ZipInfo]) -> None:
    if len(entries) > MAX_ARCHIVE_FILES:
        raise FieldError("", f"{len(entries)} files in the zip", f"at most {MAX_ARCHIVE_FILES}")
    for entry in entries:
        path = PurePosixPath(entry.filename)
        if path.is_absolute() or ".." in path.parts or "\\" in entry.filename or ":" in entry.filename:
            raise FieldError("", f"the name {describe(entry.filename)} in the zip", "names inside of the zip")
    total = sum(entry.file_size for entry in entries)
    if total > MAX_ARCHIVE_BYTES:
        largest = max(entries, key=lambda entry: entry.file_size)
        found = (
            f"{total / 1e6:.1f} MB in the zip, {largest.file_size / 1e6:.1f} MB of it in {describe(largest.filename)}"
        )
        raise FieldError("", found, f"at most {MAX_ARCHIVE_BYTES / 1e6:g} MB; make the pictures smaller")


def _mission_of(contents: dict[str, bytes]) -> str:
    named = [name for name in contents if PurePosixPath(name).name == "mission.json"]
    found = named or [name for name in contents if name.endswith(".json") and b'"success"' in contents[name]]
    if len(found) != 1:
        raise FieldError("", f"{len(found)} missions in the zip ({', '.join(found)})", "one mission.json")
    return found[0]
