"""Sound files of the robot: unsigned 8-bit samples, one channel, 7800 to 8000 Hz, after a header of 44 bytes.

Source: docs/spec/thymio-robot.md section 9.
"""

from __future__ import annotations

import wave
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

__all__ = ["HEADER_BYTES", "format_problem", "write"]

HEADER_BYTES = 44
"""Length of the header, which the robot skips without reading it."""
RATES_HZ = (7800, 8000)
"""Lowest and highest sample rate that the robot plays at the right pitch."""
WRITTEN_RATE_HZ = 7812
_EXPECTED = "expected 8 bit, 1 channel, 7800 to 8000 Hz"


def write(output: BinaryIO, parts: Iterable[bytes]) -> None:
    """Write unsigned 8-bit samples, part after part, to a file that was opened for it. Raises OSError."""
    with wave.open(output, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(1)
        file.setframerate(WRITTEN_RATE_HZ)
        for part in parts:
            file.writeframes(part)


def format_problem(path: Path) -> str:
    """Message if a file has another format, else empty. The robot plays the bytes of any file as samples."""
    try:
        with wave.open(str(path), "rb") as file:
            bits, channels, rate = 8 * file.getsampwidth(), file.getnchannels(), file.getframerate()
    except (wave.Error, EOFError, OSError, RuntimeError):  # RuntimeError: a chunk that ends behind the file
        return f"{path.name}: no WAV file found, {_EXPECTED}"
    low, high = RATES_HZ
    if (bits, channels) == (8, 1) and low <= rate <= high:
        return ""
    return f"{path.name}: {bits} bit, {channels} channels, {rate} Hz found, {_EXPECTED}"
