"""CSS as far as a check of a picture needs it: declarations and references, from style attributes and style sheets.

One tokenizer pass after CSS Syntax Level 3, section 4: comments separate tokens, escapes are decoded, and neither
strings nor comments hold declarations. A rule of a style sheet applies to at least the elements that its selector
selects: types, classes, ids, attributes with a value, and the combinators for descendants and children are interpreted,
everything else selects all. A nested rule and a rule within an at-rule count wherever they are.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

__all__ = ["Declaration", "Path", "Rule", "Selector", "Sheet", "Style", "parse", "rules"]

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
_SPACE = ("space", " ")
_VENDOR = re.compile(r"-(?:webkit|moz|ms|o|khtml)-")
_COLON = ("other", ":")


@dataclass(frozen=True, slots=True)
class Declaration:
    """`name: value`: the name in lower case, the first words of the value in lower case without `!important`."""

    name: str
    value: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Style:
    """The content of a style: declarations, names of at-rules in lower case, targets of `url(…)`."""

    declarations: tuple[Declaration, ...]
    rules: tuple[str, ...]
    urls: tuple[str, ...]


Path = Sequence[tuple[str, Mapping[str, str]]]
"""Type and attributes of each element from the root to one element."""


@dataclass(slots=True)
class _Compound:
    """The conditions on one element: its type, id, classes and attributes; None and nothing fit every element."""

    tag: str | None = None
    id: str | None = None
    classes: list[str] = field(default_factory=list)
    attributes: list[tuple[str, str | None]] = field(default_factory=list)
    """Name and value; None for any value."""

    def selects(self, tag: str, attributes: Mapping[str, str]) -> bool:
        return (
            (self.tag is None or self.tag.lower() == tag.lower())
            and self.id in (None, attributes.get("id"))
            and set(self.classes) <= set(attributes.get("class", "").split())
            and all(name in attributes and value in (None, attributes[name]) for name, value in self.attributes)
        )


@dataclass(frozen=True, slots=True)
class Selector:
    """The parts of a selector from the left, and whether each part but the last is the parent of the next one."""

    parts: tuple[_Compound, ...]
    is_parent: tuple[bool, ...]

    def selects(self, path: Path) -> bool:
        """Whether an element may be selected. From the right, the places that each part can have are kept."""
        places = [len(path) - 1] if self.parts[-1].selects(*path[-1]) else []
        for part, is_parent in zip(self.parts[-2::-1], self.is_parent[::-1], strict=True):
            if not places:
                break
            above = {place - 1 for place in places if place > 0} if is_parent else range(max(places))
            places = [place for place in above if part.selects(*path[place])]
        return bool(places)


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule of a style sheet."""

    selectors: tuple[Selector, ...]
    style: Style


class Sheet:
    """The rules of style sheets, found by what the last part of their selectors names.

    Attributes:
        checks: number of selectors that were compared with an element so far.
    """

    def __init__(self) -> None:
        self._rules: dict[tuple[str, str], list[tuple[Selector, Style]]] = {}
        self.checks = 0

    def add(self, text: str, properties: Container[str]) -> None:
        """Add the rules of a text that have one of the properties or a reference; see `parse`."""
        for rule in rules(text, properties):
            for selector in rule.selectors:
                last = selector.parts[-1]
                key = ("", "") if last.tag is None else ("tag", last.tag.lower())
                key = ("id", last.id) if last.id is not None else key
                key = ("class", last.classes[0]) if last.classes else key
                self._rules.setdefault(key, []).append((selector, rule.style))

    def styles(self, path: Path) -> list[Style]:
        """The styles of the rules that may apply to an element."""
        tag, attributes = path[-1]
        classes = set(attributes.get("class", "").split())
        keys = [
            ("", ""),
            ("tag", tag.lower()),
            ("id", attributes.get("id", "")),
            *(("class", name) for name in classes),
        ]
        candidates = [rule for key in keys for rule in self._rules.get(key, ())]
        self.checks += len(candidates)
        return [style for selector, style in candidates if selector.selects(path)]


def rules(text: str, properties: Container[str]) -> tuple[Rule, ...]:
    """The rules of a style sheet that have one of the properties or a reference; see `parse`.

    The references of at-rules such as @font-face are those of no element.
    """
    found: list[Rule] = []
    _read_rules(list(_all_tokens(text)), 0, properties, found)
    return tuple(found)


def _read_rules(tokens: Sequence[tuple[str, str]], place: int, properties: Container[str], found: list[Rule]) -> None:
    """Read rules until the end. A block whose prelude is an at-rule is transparent, except that of a font."""
    open_: list[tuple[Selector, ...]] = []
    """Selectors of each open block."""
    begin = place
    while place < len(tokens):
        token = tokens[place]
        if token == ("other", "{"):
            prelude = tokens[begin:place]
            at = next((value.lower() for kind, value in prelude if kind == "at"), None)
            open_.append(open_[-1] if at and open_ else () if at else _selectors(prelude))
        elif token in (("other", ";"), ("other", "}")) or place == len(tokens) - 1:
            ends = token in (("other", ";"), ("other", "}"))
            words = [word for word in tokens[begin : place if ends else place + 1] if word != _SPACE]
            style = _style(words, properties)
            if open_ and open_[-1] and (style.declarations or style.urls):
                found.append(Rule(open_[-1], style))
            if token == ("other", "}") and open_:
                open_.pop()
        else:
            place += 1
            continue
        place += 1
        begin = place


def _selectors(prelude: Sequence[tuple[str, str]]) -> tuple[Selector, ...]:
    """The selectors of a rule; in parentheses, commas separate nothing."""
    lists: list[list[tuple[str, str]]] = [[]]
    depth = 0
    for token in prelude:
        depth += (token[0] == "function" or token[1] in ("(", "[")) - (token[0] == "other" and token[1] in (")", "]"))
        if token == ("other", ",") and depth == 0:
            lists.append([])
        else:
            lists[-1].append(token)
    return tuple(_selector(tokens) for tokens in lists)


def _selector(tokens: Sequence[tuple[str, str]]) -> Selector:
    parts = [_Compound()]
    is_parent: list[bool] = []
    pending: bool | None = None
    """The combinator before the next part: True for the parent, False for any ancestor, None for none."""
    depth = 0
    skips = False
    """Whether the next name belongs to a pseudo-class."""
    bracket: list[tuple[str, str]] | None = None
    """Tokens inside the open brackets of an attribute."""
    for kind, value in tokens:
        opens = kind == "function" or value in ("(", "[")
        if opens or depth > 0:
            if value == "[" and depth == 0:
                _begin_part(parts, is_parent, pending)
                pending = None
                bracket = []
            elif bracket is not None and value == "]":
                parts[-1].attributes += _attribute(bracket)
                bracket = None
            elif bracket is not None:
                bracket.append((kind, value))
            depth += opens - (kind == "other" and value in (")", "]"))
            skips = False
        elif kind == "space":
            pending = False if pending is None else pending
        elif (kind, value) == ("other", ">"):
            pending = True
        elif kind == "other" and value in "+~|&":
            # a sibling, a namespace or the rule around: what is before it is not interpreted
            parts, is_parent, pending = [_Compound()], [], None
        elif (kind, value) == ("other", ":"):
            skips = True
        elif skips and kind == "name":
            skips = False
        else:
            _begin_part(parts, is_parent, pending)
            pending = None
            if kind == "hash":
                parts[-1].id = value[1:]
            elif kind == "number" and value.startswith("."):
                parts[-1].classes.append(value[1:])
            elif kind == "name":
                parts[-1].tag = value
    return Selector(tuple(parts), tuple(is_parent))


def _begin_part(parts: list[_Compound], is_parent: list[bool], pending: bool | None) -> None:
    """Begin the next part of a selector if there is a combinator before it."""
    if pending is not None and (parts != [_Compound()] or is_parent):
        parts.append(_Compound())
        is_parent.append(pending)


def _attribute(tokens: Sequence[tuple[str, str]]) -> list[tuple[str, str | None]]:
    """The condition of `[name]` or `[name=value]`; other operators and namespaces set none here."""
    words = [token for token in tokens if token != _SPACE]
    match words:
        case [("name", name)]:
            return [(name, None)]
        case [("name", name), ("other", "="), ("name" | "string", value)]:
            return [(name, value)]
    return []


def parse(text: str, properties: Container[str]) -> Style:
    """The declarations of some properties, the at-rules and the references of a style attribute or style sheet.

    `properties` are in lower case and without a vendor's prefix; that of a declaration is left out.
    """
    return _style(list(_tokens(text)), properties)


def _style(tokens: Sequence[tuple[str, str]], properties: Container[str]) -> Style:
    declarations = []
    for place, (token, following) in enumerate(itertools.pairwise(tokens)):
        if token[0] == "name" and following == _COLON:
            name = _VENDOR.sub("", token[1].lower())
            if name in properties:
                declarations.append(Declaration(name, _value(tokens, place + 2)))
    at_rules = tuple(value.lower() for kind, value in tokens if kind == "at")
    return Style(tuple(declarations), at_rules, tuple(value for kind, value in tokens if kind == "url"))


def _value(tokens: Sequence[tuple[str, str]], begin: int) -> tuple[str, ...]:
    """The first words of the value of a declaration; a few are enough, as only short values are compared."""
    words = []
    for kind, value in tokens[begin : begin + 6]:
        if kind == "other" and value in ";{}":
            break
        words.append(value.lower())
    if words[-2:] == ["!", "important"]:
        del words[-2:]
    return tuple(words)


def _tokens(text: str) -> Iterator[tuple[str, str]]:
    """Kind and content of each token except space."""
    return (token for token in _all_tokens(text) if token != _SPACE)


def _all_tokens(text: str) -> Iterator[tuple[str, str]]:
    """Kind and content of each token; `url(…)`, quoted or not, is one token of kind url."""
    place = 0
    while match := _TOKEN.match(text, place):
        place = match.end()
        kind, value = match.lastgroup or "", match.group()
        if kind == "space":
            yield _SPACE
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
