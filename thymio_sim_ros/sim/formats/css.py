"""CSS as far as a check of a picture needs it: declarations and references, from style attributes and style sheets.

One tokenizer pass after CSS Syntax Level 3, section 4: comments separate tokens, escapes are decoded, and neither
strings nor comments hold declarations. Selectors and nesting are not interpreted: a declaration counts wherever it is.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass

__all__ = ["Declaration", "Style", "parse"]

_ESCAPE = r"\\(?:[0-9A-Fa-f]{1,6}(?:\r\n|[ \t\r\n\f])?|[^\r\n\f0-9A-Fa-f]|\Z)"
_LETTER = rf"(?:[A-Za-z_\u0080-\U0010ffff]|{_ESCAPE})"
_REST = rf"(?:[A-Za-z0-9_\u0080-\U0010ffff-]|{_ESCAPE})"
_NAME = rf"(?:--|-?{_LETTER}){_REST}*+"
_TOKEN = re.compile(
    rf"""
    (?P<space> (?:[ \t\r\n\f]|/\*(?s:.*?)(?:\*/|\Z)|<!--|-->)++ )
  | (?P<string> "(?:[^"\\\r\n\f]|\\(?s:.)|\\\Z)*+"? | '(?:[^'\\\r\n\f]|\\(?s:.)|\\\Z)*+'? )
  | (?P<at> @{_NAME} )
  | (?P<function> {_NAME}\( )
  | (?P<name> {_NAME} )
  | (?P<number> [0-9.]++(?:{_NAME})?+ )
  | (?P<hash> \#{_REST}++ )
  | (?P<other> (?s:.) )
    """,
    re.VERBOSE,
)
_BARE_URL = re.compile(r"[ \t\r\n\f]*([^\"'() \t\r\n\f](?:[^)\\]|\\(?s:.))*)(?:\)|\Z)")
"""The content of `url(…)` without quotes."""
_ESCAPED = re.compile(r"\\(?:([0-9A-Fa-f]{1,6})(?:\r\n|[ \t\r\n\f])?|(\r\n|[\n\r\f])|((?s:.)))|\\\Z")
_VENDOR = re.compile(r"-(?:webkit|moz|ms|o|khtml)-")
_COLON = ("other", ":")


@dataclass(frozen=True, slots=True)
class Declaration:
    """`name: value`: the name in lower case, the first words of the value in lower case without `!important`."""

    name: str
    value: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Style:
    """What a style says: declarations, names of at-rules in lower case, targets of `url(…)`."""

    declarations: tuple[Declaration, ...]
    rules: tuple[str, ...]
    urls: tuple[str, ...]


def parse(text: str, properties: Container[str]) -> Style:
    """Return the declarations of some properties, the at-rules and the references of a style attribute or style sheet.

    `properties` are in lower case and without a vendor's prefix; that of a declaration is left out.
    """
    tokens = list(_tokens(text))
    declarations = []
    for place, (token, following) in enumerate(itertools.pairwise(tokens)):
        if token[0] == "name" and following == _COLON:
            name = _VENDOR.sub("", token[1].lower())
            if name in properties:
                declarations.append(Declaration(name, _value(tokens, place + 2)))
    rules = tuple(value.lower() for kind, value in tokens if kind == "at")
    return Style(tuple(declarations), rules, tuple(value for kind, value in tokens if kind == "url"))


def _value(tokens: Sequence[tuple[str, str]], begin: int) -> tuple[str, ...]:
    """Return the first words of the value of a declaration; a few are enough, as only short values are compared."""
    words = []
    for kind, value in tokens[begin : begin + 6]:
        if kind == "other" and value in ";{}":
            break
        words.append(value.lower())
    if words[-2:] == ["!", "important"]:
        del words[-2:]
    return tuple(words)


def _tokens(text: str) -> Iterator[tuple[str, str]]:
    """Iterate over kind and content of each token except space; `url(…)`, quoted or not, is one token of kind url."""
    place = 0
    while match := _TOKEN.match(text, place):
        place = match.end()
        kind, value = match.lastgroup or "", match.group()
        if kind == "space":
            continue
        if kind == "string":
            value = value[1:].removesuffix(value[0])
        elif kind == "at":
            value = value[1:]
        elif kind == "function":
            value = value[:-1]
        value = _unescaped(value)
        if kind == "function" and value.lower() == "url":
            bare = _BARE_URL.match(text, place)
            if bare is not None:
                place = bare.end()
                yield "url", _unescaped(bare[1]).rstrip()
                continue
            quoted = _TOKEN.match(text, place)
            while quoted is not None and quoted.lastgroup == "space":
                quoted = _TOKEN.match(text, quoted.end())
            if quoted is not None and quoted.lastgroup == "string":
                place = quoted.end()
                yield "url", _unescaped(quoted.group()[1:].removesuffix(quoted.group()[0])).strip()
                continue
        yield kind, value


def _unescaped(text: str) -> str:
    if "\\" not in text:
        return text

    def character(match: re.Match[str]) -> str:
        code, line_end, other = match.groups()
        if code is not None:
            number = int(code, 16)
            return chr(number) if 0 < number <= 0x10FFFF and not 0xD800 <= number <= 0xDFFF else "\ufffd"
        return "" if line_end is not None else other or ""

    return _ESCAPED.sub(character, text)
