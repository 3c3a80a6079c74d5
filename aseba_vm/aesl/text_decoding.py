"""Decoding of text files: UTF-8 unless a byte order mark or an XML declaration says otherwise."""

from __future__ import annotations

import codecs
import re
from dataclasses import dataclass

from aseba_vm.aesl.foreign_files import refuse_foreign_bytes
from aseba_vm.errors import TextError

_MARKS = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))
_UNMARKED = ((rb"[^\0]\0[^\0]\0", "utf-16-le"), (rb"\0[^\0]\0[^\0]", "utf-16-be"))
"""First bytes of a text in UTF-16 without a byte order mark, if it begins with two letters of ASCII."""
_DECLARED = re.compile(rb"\s*<\?xml\s[^>]*?encoding\s*=\s*[\"']([A-Za-z0-9._-]+)[\"']")

_NOT_OF_FILES = frozenset({"idna", "punycode", "raw-unicode-escape", "undefined", "unicode-escape"})
"""Codecs of Python that are no encodings of files; some of them cannot report the position of an error."""


@dataclass(frozen=True, slots=True)
class TextFile:
    """A text without byte order mark, and the codec that reproduces its bytes."""

    text: str
    encoding: str

    def encoded(self, text: str) -> bytes:
        """Another text in the same encoding."""
        return text.encode(self.encoding)


def decode(data: bytes) -> TextFile:
    """The text of a file.

    Raises TextError with the position of the first invalid byte, or for a file of another program that is no text.
    """
    refuse_foreign_bytes(data)
    encoding = next((name for mark, name in _MARKS if data.startswith(mark)), None)
    encoding = encoding or next((name for pattern, name in _UNMARKED if re.match(pattern, data)), None)
    if encoding is None:
        declared = _DECLARED.match(data)
        encoding = declared[1].decode("ascii") if declared else "utf-8"
        if encoding.lower().startswith("utf-16"):  # impossible: the declaration was readable as ASCII
            encoding = "utf-8"
    try:
        if codecs.lookup(encoding).name in _NOT_OF_FILES:
            raise LookupError(encoding)
        return TextFile(data.decode(encoding), encoding)
    except UnicodeDecodeError as error:
        before = data[: error.start].decode(encoding, "replace")
        place = before.count("\n") + 1, len(before) - before.rfind("\n")
        raise TextError("text-undecodable", (f"{data[error.start]:02x}", encoding.upper()), *place) from error
    except (LookupError, UnicodeError) as error:
        raise TextError("text-unknown-encoding", (encoding,), 1, 1) from error
