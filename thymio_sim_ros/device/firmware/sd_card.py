"""The memory card, represented by a folder (docs/spec/thymio-robot.md sections 6.3, 9 and 10).

Programs name files by number only: data `uN.dat`; sounds `pN.wav` to play, `rN.wav` recorded, `sN.wav` in place of
missing system sounds. Names are found in any case, as on the card's file system. Nothing outside the folder is
read or written, not even where a link in it points. What a program may store is limited, so that an
endless program cannot fill a disk: beyond `MAX_FILES` and `MAX_BYTES` of the whole folder calls fail as on the robot.

The folder is listed when something but this card has added or removed files (its modification time tells), not for
every name. No file is open between calls.
"""

from __future__ import annotations

import array
import os
import stat
import sys
from collections.abc import Sequence
from pathlib import Path

from thymio_sim_ros.device.firmware import wav
from thymio_sim_ros.errors import ThymioSimError

__all__ = ["SdCard", "SdCardError", "SoundFile"]

MAX_BYTES = 64_000_000
"""Limit of bytes of all files on the card."""
MAX_FILES = 256
"""Limit of files on the card."""
MAX_SAMPLES = 10 * 60 * 7813
"""Longest sound that is read: ten minutes."""

SoundFile = tuple[bytes, str]
"""Unsigned 8 bit samples, and what is wrong with the file's format, if anything."""


class SdCardError(ThymioSimError):
    """A folder that cannot be used as a card; the text is one line."""


class SdCard:
    """A card in its slot: at most one data file is selected; no file is open between calls."""

    def __init__(self, folder: Path) -> None:
        """SdCardError when the folder cannot be made or is none."""
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self.folder = folder.resolve(strict=True)
        except OSError as error:
            raise SdCardError(f"card {folder}: {error.strerror}; expected a folder, or a place for one") from error
        self.refusal = ""
        """Why the last `open`, `write` or `write_sound` was refused, if the card was full."""
        self._file: Path | None = None
        self._at = 0
        self._names: dict[str, str] = {}
        """Names in the folder by the same in lower case."""
        self._bytes = 0
        self._listed_ns: int | None = None
        """Modification time of the folder as it was listed."""

    def open(self, number: int) -> bool:
        """Open data file `number`, made when there is none, at its beginning; one that is open is closed first."""
        self.close()
        self.refusal = ""
        path = self._path(f"u{number}.dat") if number >= 0 else None
        if path is None or not self._has_room(path):
            return False
        try:
            with path.open("ab"):
                self._file = path
        except OSError:
            return False
        self._register(path)
        return True

    def close(self) -> None:
        """Close the data file, if one is open."""
        self._file, self._at = None, 0

    def write(self, words: Sequence[int]) -> int:
        """Write words (int16, little-endian) from the position on; how many fitted."""
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
        except OSError:
            return 0
        self._at += written
        self._bytes += max(0, self._at - size) if written else 0
        return written // 2

    def read(self, count: int) -> list[int]:
        """Up to so many words from the position on; none at the end or without a file."""
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
        """Go to a word (0 is the first); a later write fills what lies between with zeros."""
        if self._file is None or position < 0:
            return False
        self._at = 2 * position
        return True

    def read_sound(self, name: str) -> SoundFile | None:
        """The sound of a name such as p1, or None when it is not there."""
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
        """Samples in the sound of a name such as r1; 0 when it is not there."""
        path = self._path(f"{name}.wav")
        size = 0 if path is None else _size(path)
        return min(MAX_SAMPLES, max(0, size - wav.HEADER_BYTES))

    def write_sound(self, name: str, samples: bytes) -> bool:
        """Store unsigned 8 bit samples under a name such as r1; whether that worked."""
        self.refusal = ""
        path = self._path(f"{name}.wav")
        if path is None or not self._has_room(path):
            return False
        grown = wav.HEADER_BYTES + len(samples) - _size(path)
        if self._bytes + grown > MAX_BYTES:
            self.refusal = f"the card is full: it holds {MAX_BYTES} bytes"
            return False
        try:
            wav.write(path, [samples])
        except OSError:
            self._listed_ns = None
            return False
        self._bytes += grown
        self._register(path)
        return True

    def _has_room(self, path: Path) -> bool:
        """Whether a file is there, or may be made."""
        if path.name.lower() in self._names or len(self._names) < MAX_FILES:
            return True
        self.refusal = f"the card is full: it holds {MAX_FILES} files"
        return False

    def _register(self, path: Path) -> None:
        """Remember a file that may be new."""
        if path.name.lower() not in self._names:
            self._names[path.name.lower()] = path.name
            self._listed_ns = _modified_ns(self.folder)

    def _list(self) -> None:
        """List the folder if something else has added or removed files; OSError."""
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
        """Where a file of this name is or would be; None when that is no file in the folder."""
        try:
            self._list()
            path = self.folder / self._names.get(name, name)
            is_free = path.is_file() or not path.exists()
            return path if is_free and path.resolve().parent == self.folder else None
        except (OSError, RuntimeError):  # the folder is gone, or links lead round in a circle
            return None


def _size(path: Path) -> int:
    """Bytes of a file; 0 when it is none."""
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
