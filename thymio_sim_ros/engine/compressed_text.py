"""A text in memory, compressed with gzip while it is written."""

from __future__ import annotations

import errno
import io
import zlib

__all__ = ["CompressedText"]

_GZIP_BITS = 31
"""Window of zlib with the head and end of a gzip file."""


class CompressedText(io.TextIOBase):
    """A file for writing. Raises OSError when it would be larger than `limit`, in bytes when compressed."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._compressor = zlib.compressobj(wbits=_GZIP_BITS)
        self._content = bytearray()

    def write(self, text: str) -> int:
        """Append text; returns its length."""
        self._content += self._compressor.compress(text.encode())
        if len(self._content) > self._limit:
            raise OSError(errno.EFBIG, f"larger than {self._limit / 1e6:g} MB")
        return len(text)

    def content(self, end: str = "") -> bytes:
        """Return what has been written so far, and `end` after it, as a gzip file."""
        compressor = self._compressor.copy()
        return bytes(self._content) + compressor.compress(end.encode()) + compressor.flush()
