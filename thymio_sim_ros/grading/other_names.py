"""Names that browsers, operating systems and drives give to a copy of a file.

Examples: `f (1).aesl`, `f - Kopie.aesl`, `f.aesl.txt`.
"""

from __future__ import annotations

import re
import unicodedata
from pathlib import PurePosixPath

__all__ = ["original_name"]

_APPENDED = re.compile(r"\.(?:txt|download|xml|html?|crdownload|part|bak|bin)$", re.IGNORECASE)
"""Suffixes behind the right one, which programs and operating systems add and often hide."""
_BEFORE = re.compile(
    r"^(?:copy(?: \(\d+\))? of|kopie(?: \(\d+\))? von|copie(?: \(\d+\))? de|copia(?: \(\d+\))? d[ie]) ", re.IGNORECASE
)
_BEHIND = re.compile(
    r"(?: ?\(\d+\)|(?: ?[-_–])? ?\b(?:copy|kopie|copie|copia)\b(?: \d+)?|(?<=\D)[-_ ]\d)$", re.IGNORECASE
)
"""The marks of copies: of browsers and Windows, of Windows and macOS in four languages, of Firefox and macOS."""


def original_name(name: str, suffix: str) -> str:
    """Return the name of the file of which one with this name and without a folder is a copy, in lower case.

    `suffix` is the one that is expected, as in `.aesl`.
    """
    found = unicodedata.normalize("NFC", PurePosixPath(name).name).casefold()
    suffix = suffix.casefold()
    while suffix in found.removesuffix(suffix) and (shorter := _APPENDED.sub("", found)) != found:
        found = shorter
    stem = found.removesuffix(suffix).rstrip()
    while (shorter := _BEFORE.sub("", _BEHIND.sub("", stem.removesuffix(suffix)))) not in (stem, ""):
        stem = shorter.strip()
    return stem + suffix
