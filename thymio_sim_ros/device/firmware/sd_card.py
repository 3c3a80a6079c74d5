"""The memory card, represented by a folder (docs/spec/thymio-robot.md sections 6.3, 9 and 10).

Programs refer to files by number only: data `uN.dat`; sounds `pN.wav` to play, `rN.wav` recorded, `sN.wav` instead of
missing system sounds. Upper and lower case are the same, as in the card's file system. Nothing outside the folder is
read or written, even if a link in it points there. `MAX_FILES` and `MAX_BYTES` limit the whole folder, so that an
endless program cannot fill a disk; beyond them calls fail as on the robot.

The folder is listed again only after its modification time shows that another program has added or removed files. No
file is open between calls.
"""

from __future__ import annotations

import array
import os
import stat
import sys
from collections.abc import Sequence
from pathlib import Path

from aseba_vm.cli.output import replacing
from thymio_sim_ros.device.firmware import wav
from thymio_sim_ros.errors import ThymioSimError

__all__ = ["SdCard", "SdCardError", "SoundFile"]

MAX_BYTES = 64_000_000
"""Limit of bytes of all files on the card."""
MAX_FILES = 256
"""Limit of files on the card."""
MAX_SAMPLES = 10 * 60 * 7813
"""Length limit for reading a sound: ten minutes."""

SoundFile = tuple[bytes, str]
"""Unsigned 8-bit samples, and a message about the format of the file, or an empty one."""


class SdCardError(ThymioSimError):
    """A folder that cannot be used as a card; the text is one line."""


class SdCard:
    """A card with at most one selected data file. Invariant: no file is open between calls."""

    def __init__(self, folder: Path) -> None:
        """Create the folder if necessary. Raises SdCardError if that fails or the path is not a folder."""
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self.folder = folder.resolve(strict=True)
        except OSError as error:
            raise SdCardError(f"card {folder}: {error.strerror}; expected a folder, or a place for one") from error
        self.refusal = ""
        """Message if the last `open`, `write` or `write_sound` failed because of the card or its disk, else empty."""
        self._file: Path | None = None
        self._at = 0
        self._names: dict[str, str] = {}
        """Name of each file by its name in lower case."""
        self._bytes = 0
        self._listed_ns: int | None = None
        """Modification time of the folder when it was last listed."""

    def open(self, number: int) -> bool:
        """Close the open data file; open or create data file `number` at its beginning; return whether that worked."""
        self.close()
        self.refusal = ""
        path = self._path(f"u{number}.dat") if number >= 0 else None
        if path is None or not self._has_room(path):
            return False
        try:
            with path.open("ab"):
                self._file = path
        except OSError as error:
            self._refuse(path, error)
            return False
        self._register(path)
        return True

    def close(self) -> None:
        """Close the data file, if one is open."""
        self._file, self._at = None, 0

    def write(self, words: Sequence[int]) -> int:
        """Write words (int16, little-endian) at the current position; return how many were written."""
        self.refusal = ""
        if self._file is None:
            return 0
        try:
            with self._file.open("r+b") as file:
                size = os.fstat(file.fileno()).st_size
                room = max(0, size + MAX_BYTES - self._bytes - self._at) // 2
                if room < len(words):
                    self.refusal = f"the card is full: it holds {MAX_BYTES} bytes"
                file.seek(self._at)
                written = file.write(_as_bytes(words[:room]))
        except OSError as error:  # some of the words may have been written
            self._refuse(self._file, error)
            return 0
        self._at += written
        self._bytes += max(0, self._at - size) if written else 0
        return written // 2

    def read(self, count: int) -> list[int]:
        """Read up to `count` words at the current position; return none at the end or without a file."""
        if self._file is None:
            return []
        try:
            with self._file.open("rb") as file:
                file.seek(self._at)
                data = file.read(2 * count)
        except OSError:
            return []
        whole = data[: len(data) // 2 * 2]
        self._at += len(whole)
        return _as_words(whole)

    def seek(self, position: int) -> bool:
        """Move to a word, 0 is the first; return False without a file. Writing beyond the end fills the gap with 0."""
        if self._file is None or position < 0:
            return False
        self._at = 2 * position
        return True

    def read_sound(self, name: str) -> SoundFile | None:
        """Read the sound of a name such as p1; None if there is none."""
        path = self._path(f"{name}.wav")
        try:
            if path is None or not path.is_file():
                return None
            with path.open("rb") as file:
                data = file.read(wav.HEADER_BYTES + MAX_SAMPLES)
        except OSError:
            return None
        return data[wav.HEADER_BYTES :], wav.format_problem(path)

    def sound_bytes(self, name: str) -> int:
        """Number of samples of the sound of a name such as r1; 0 if there is none."""
        path = self._path(f"{name}.wav")
        size = 0 if path is None else _size(path)
        return min(MAX_SAMPLES, max(0, size - wav.HEADER_BYTES))

    def write_sound(self, name: str, samples: bytes) -> bool:
        """Store unsigned 8-bit samples under a name such as r1; return whether that worked."""
        self.refusal = ""
        path = self._path(f"{name}.wav")
        if path is None or not self._has_room(path):
            return False
        grown = wav.HEADER_BYTES + len(samples) - _size(path)
        if self._bytes + grown > MAX_BYTES:
            self.refusal = f"the card is full: it holds {MAX_BYTES} bytes"
            return False
        try:
            with replacing(str(path)) as file:
                wav.write(file, [samples])
        except OSError as error:
            self._refuse(path, error)
            return False
        self._bytes += grown
        self._register(path)
        return True

    def _refuse(self, path: Path, error: OSError) -> None:
        self.refusal = f"{path}: {error.strerror}"
        self._listed_ns = None  # the sizes of the files are not known any more

    def _has_room(self, path: Path) -> bool:
        """Whether a file exists or may be created."""
        if path.name.lower() in self._names or len(self._names) < MAX_FILES:
            return True
        self.refusal = f"the card is full: it holds {MAX_FILES} files"
        return False

    def _register(self, path: Path) -> None:
        """Add a file that may be new to the listing."""
        if path.name.lower() not in self._names:
            self._names[path.name.lower()] = path.name
            self._listed_ns = _modified_ns(self.folder)

    def _list(self) -> None:
        """List the folder if another program has added or removed files. Raises OSError."""
        changed_ns = self.folder.stat().st_mtime_ns
        if changed_ns == self._listed_ns:
            return
        with os.scandir(self.folder) as entries:
            found = sorted(entries, key=lambda entry: entry.name)
        self._names = {}
        for entry in found:
            if entry.name == entry.name.lower():
                self._names[entry.name] = entry.name
            else:
                self._names.setdefault(entry.name.lower(), entry.name)
        self._bytes = sum(_size(Path(entry.path)) for entry in found)
        self._listed_ns = changed_ns

    def _path(self, name: str) -> Path | None:
        """Path of an existing or new file of this name; None if it is not a file in the folder."""
        try:
            self._list()
            path = self.folder / self._names.get(name, name)
            is_free = path.is_file() or not path.exists()
            return path if is_free and path.resolve().parent == self.folder else None
        except (OSError, RuntimeError):  # the folder was removed, or links form a circle
            return None


def _size(path: Path) -> int:
    """Size of a regular file in bytes; 0 for anything else."""
    try:
        found = path.lstat()
    except OSError:
        return 0
    return found.st_size if stat.S_ISREG(found.st_mode) else 0


def _modified_ns(folder: Path) -> int | None:
    try:
        return folder.stat().st_mtime_ns
    except OSError:
        return None


def _as_bytes(words: Sequence[int]) -> bytes:
    values = array.array("h", words)
    if sys.byteorder == "big":
        values.byteswap()
    return values.tobytes()


def _as_words(data: bytes) -> list[int]:
    values = array.array("h", data)
    if sys.byteorder == "big":
        values.byteswap()
    return values.tolist()
