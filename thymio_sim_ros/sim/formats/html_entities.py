"""Named characters of HTML in XML that declares none, as descriptions of playgrounds have them (``&ndash;``)."""

from __future__ import annotations

import re
from html.entities import html5

__all__ = ["without_html_entities"]

_OWN = frozenset(("lt", "gt", "amp", "quot", "apos"))
"""Names that XML itself knows."""
_REFERENCE = re.compile(r"<!--.*?(?:-->|\Z)|<!\[CDATA\[.*?(?:\]\]>|\Z)|&([A-Za-z][A-Za-z0-9]{1,31});", re.DOTALL)


def without_html_entities(text: str) -> str:
    """XML with each named character of HTML by its number; comments and CDATA stay as they are.

    Nothing is declared and nothing expanded more than once, so the text grows by a small factor at most.
    """
    return _REFERENCE.sub(_numbered, text)


def _numbered(match: re.Match[str]) -> str:
    name = match[1]
    characters = None if name is None or name in _OWN else html5.get(f"{name};")
    return match[0] if characters is None else "".join(f"&#{ord(character)};" for character in characters)
