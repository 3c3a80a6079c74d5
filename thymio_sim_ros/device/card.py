"""The memory card: a folder that stands for it (thymio-robot.md sections 6.3, 9 and 10).

Programs name files by number only: data `uN.dat`; sounds `pN.wav` to play, `rN.wav` recorded, `sN.wav` in place of
missing system sounds. Names are found in any case, as on the card's file system. Nothing outside the folder is
read or written, not even where a link in it points.
"""

from __future__ import annotations

import array
import sys
from collections.abc import Sequence
from pathlib import Path

from thymio_sim_ros.device import wav

__all__ = ["Card", "CardError", "SoundFile"]

MOST_BYTES = 64_000_000
"""A program's data file grows no longer."""
MOST_SAMPLES = 10 * 60 * 7813
"""Longest sound that is read: ten minutes."""

SoundFile = tuple[bytes, str]
"""Unsigned 8 bit samples, and what is wrong with the file's format, if anything."""


class CardError(Exception):
    """A folder that cannot stand for a card; the text is one line."""


class Card:
    """A card in its slot: at most one data file is open, as a place in the folder; nothing is held between calls."""

    def __init__(self, folder: Path) -> None:
        """CardError when the folder cannot be made or is none."""
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self.folder = folder.resolve(strict=True)
        except OSError as error:
            raise CardError(f"card {folder}: {error.strerror}; expected a folder, or a place for one") from error
        self._file: Path | None = None
        self._at = 0

    def open(self, number: int) -> bool:
        """Open data file `number`, made when there is none, at its beginning; one that is open is closed first."""
        self.close()
        path = self._path(f"u{number}.dat")
        if number < 0 or path is None:
            return False
        try:
            with path.open("ab"):
                self._file = path
        except OSError:
            return False
        return True

    def close(self) -> None:
        """Close the data file, if one is open."""
        self._file, self._at = None, 0

    def write(self, words: Sequence[int]) -> int:
        """Write words (int16, little-endian) from the position on; how many fitted."""
        if self._file is None:
            return 0
        room = max(0, MOST_BYTES - self._at) // 2
        try:
            with self._file.open("r+b") as file:
                file.seek(self._at)
                written = file.write(_as_bytes(words[:room]))
        except OSError:
            return 0
        self._at += written
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
                data = file.read(wav.HEADER_BYTES + MOST_SAMPLES)
        except OSError:
            return None
        return data[wav.HEADER_BYTES :], wav.complaint(path)

    def write_sound(self, name: str, samples: bytes) -> bool:
        """Store unsigned 8 bit samples under a name such as r1; whether that worked."""
        path = self._path(f"{name}.wav")
        if path is None:
            return False
        try:
            wav.write(path, [samples])
        except OSError:
            return False
        return True

    def _path(self, name: str) -> Path | None:
        """Where a file of this name is or would be; None when that is no file in the folder."""
        path = self.folder / name
        try:
            if not path.exists():
                found = sorted(other for other in self.folder.iterdir() if other.name.lower() == name)
                path = found[0] if found else path
            is_free = path.is_file() or not path.exists()
            return path if is_free and path.resolve().parent == self.folder else None
        except (OSError, RuntimeError):  # the folder is gone, or links lead round in a circle
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
