"""Names that browsers, operating systems and drives give to a copy of a file.

Examples: `f (1).aesl`, `f - Kopie.aesl`, `f.aesl.txt`.
"""

from __future__ import annotations

import re
import unicodedata
from pathlib import PurePosixPath

__all__ = ["is_copy"]

_APPENDED = re.compile(r"\.(?:txt|download|xml|html?|crdownload|part|bak|bin)$", re.IGNORECASE)
"""Suffixes behind the right one, which programs and operating systems add and often hide."""
_BEFORE = re.compile(
    r"^(?:copy(?: \(\d+\))? of|kopie(?: \(\d+\))? von|copie(?: \(\d+\))? de|copia(?: \(\d+\))? d[ie]) ", re.IGNORECASE
)
_BEHIND = re.compile(
    r"(?: ?\(\d+\)|(?: ?[-_–])? ?\b(?:copy|kopie|copie|copia)\b(?: \d+)?|(?<=\D)[-_ ]\d)$", re.IGNORECASE
)
"""The marks of copies: of browsers and Windows, of Windows and macOS in four languages, of Firefox and macOS."""


def is_copy(name: str, wanted: str) -> bool:
    """Return whether a file of any folder has the name `wanted`, in another case or with marks of copies.

    A name that has such a mark itself, as `level_2.aesl`, is no copy of another one that has, as `level_1.aesl`.
    """
    suffix = PurePosixPath(wanted).suffix.casefold()
    found, target = (unicodedata.normalize("NFC", PurePosixPath(path).name).casefold() for path in (name, wanted))
    while suffix in found.removesuffix(suffix) and (shorter := _APPENDED.sub("", found)) != found:
        found = shorter
    stem = found.removesuffix(suffix).rstrip()
    while stem + suffix != target:
        shorter = _BEFORE.sub("", _BEHIND.sub("", stem.removesuffix(suffix))).strip()
        if shorter in (stem, ""):
            return False
        stem = shorter
    return True
