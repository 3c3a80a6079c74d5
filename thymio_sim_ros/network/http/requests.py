"""Requests of the HTTP interface as values: path and body in, an action out (docs/spec/aseba-protocol.md section 3).

A path is decoded before it is split, and empty parts are ignored, as in the reference: `%2F` separates too.
"""

from __future__ import annotations

import json
import re
import urllib.parse
from collections.abc import Sequence
from dataclasses import dataclass

from thymio_sim_ros.access import RefusedError

__all__ = [
    "METHODS",
    "Action",
    "DescribeNode",
    "ListNodes",
    "LoadProgram",
    "ReadOrSend",
    "ResetAll",
    "Send",
    "StreamEvents",
    "is_path",
    "parse_request",
]

METHODS = ("GET", "POST", "PUT")
"""Methods with an action; the server answers OPTIONS itself."""

MAX_WORDS = 258
"""Words of an event or a variable in one request."""
_MAX_PATH = 4096
_MAX_VALUES = 40_000
"""Bytes of a body with values; the reference cuts bodies there. A megabyte of JSON takes a third of a second."""
_RESETS = ("reset", "reset_all")
_NUMBER = re.compile(r"[+-]?[0-9]{1,9}(?:\.[0-9]*)?")
_XML_FORM = b"file="
"""Begin of a body for `asebahttp2`, which other programs send as well."""


@dataclass(frozen=True, slots=True)
class ListNodes:
    """All nodes."""


@dataclass(frozen=True, slots=True)
class DescribeNode:
    """One node, by id, by the name of its type or robot, or the begin of that name."""

    node: str


@dataclass(frozen=True, slots=True)
class ReadOrSend:
    """Send the event of this name, without values; if the program has none, read the variable of this name."""

    node: str
    name: str


@dataclass(frozen=True, slots=True)
class Send:
    """Send the event of this name; if the program has none, set the variable of this name, from its beginning."""

    node: str
    name: str
    values: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class LoadProgram:
    """Load the text of a file on a node, None: on all."""

    node: str | None
    text: bytes


@dataclass(frozen=True, slots=True)
class ResetAll:
    """Restart all programs and stop the motors."""


@dataclass(frozen=True, slots=True)
class StreamEvents:
    """Events as they happen: of a node (None: of all), with a name (None: all), at most `limit` (None: no limit)."""

    node: str | None
    name: str | None
    limit: int | None


Action = ListNodes | DescribeNode | ReadOrSend | Send | LoadProgram | ResetAll | StreamEvents


def is_path(path: str) -> bool:
    """Whether a path, which still has its escapes, is one of the interface."""
    first = next((part for part in urllib.parse.unquote(path).split("/") if part), "")
    return first in ("events", "nodes", *_RESETS)


def parse_request(method: str, target: str, body: bytes) -> Action:
    """The action of a request; `target` is its path with query. Raises RefusedError."""
    if len(target) > _MAX_PATH:
        raise RefusedError(414, f"path of {len(target)} characters, expected at most {_MAX_PATH}")
    path, _, query = target.partition("?")
    parts = [part for part in urllib.parse.unquote(path).split("/") if part]
    match parts:
        case [word] if word in _RESETS:
            return _only(method, ("GET", "POST"), ResetAll())
        case ["events", *names] if len(names) <= 1:
            return _only(method, ("GET",), StreamEvents(None, _first(names), _limit(query)))
        case ["nodes"]:
            if method == "PUT":
                return LoadProgram(None, _program(body))
            return _only(method, ("GET",), ListNodes(), also=("PUT",))
        case ["nodes", node]:
            if method == "PUT":
                return LoadProgram(node, _program(body))
            return _only(method, ("GET",), DescribeNode(node), also=("PUT",))
        case ["nodes", node, "events", *names] if len(names) <= 1:
            return _only(method, ("GET",), StreamEvents(node, _first(names), _limit(query)))
        case ["nodes", node, name, *words]:
            return _of_name(method, node, name, words, body)
    raise RefusedError(404, "no such path; expected /nodes, /events or /reset")


def _of_name(method: str, node: str, name: str, words: Sequence[str], body: bytes) -> Action:
    """Read a variable, set it, or send an event. Values in the path have precedence over those in the body."""
    if words:
        return _only(method, ("GET", "POST"), Send(node, name, _checked([_word(word) for word in words])))
    if method == "GET":
        return ReadOrSend(node, name)
    return _only(method, ("POST",), Send(node, name, _values(body)), also=("GET",))


def _only(method: str, allowed: tuple[str, ...], action: Action, also: tuple[str, ...] = ()) -> Action:
    if method not in allowed:
        raise RefusedError(405, f"{method} is not possible here; expected {' or '.join((*allowed, *also))}")
    return action


def _first(names: Sequence[str]) -> str | None:
    return names[0] if names else None


def _limit(query: str) -> int | None:
    """The value of `?todo=`; None without one, and for 0, as in the reference."""
    given = urllib.parse.parse_qs(query, errors="replace").get("todo")
    if given is None:
        return None
    if not re.fullmatch(r"[0-9]{1,9}", given[-1]):
        raise RefusedError(400, "todo: expected a number of events, as in ?todo=5")
    return int(given[-1]) or None


def _program(body: bytes) -> bytes:
    """The text of the file in a body."""
    rest = body.removeprefix(_XML_FORM)
    return rest if rest.lstrip().startswith(b"<") else body


def _values(body: bytes) -> tuple[int, ...]:
    """The values of a body: a JSON array of numbers, or nothing."""
    if not body.strip():
        return ()
    if len(body) > _MAX_VALUES:
        raise RefusedError(413, f"found {len(body)} bytes of values, expected at most {_MAX_VALUES}")
    try:
        found = json.loads(body)
    except (ValueError, RecursionError) as error:
        raise RefusedError(400, "the body is not JSON; expected an array of numbers, as in [100, -100]") from error
    if not isinstance(found, list):
        raise RefusedError(400, "expected an array of numbers, as in [100, -100]")
    return _checked([_json_word(value) for value in found])


def _json_word(value: object) -> int:
    if isinstance(value, str):
        return _word(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise RefusedError(400, f"found {json.dumps(value):.40} among the values, expected numbers")
    if isinstance(value, float) and not abs(value) < 1e9:
        raise RefusedError(400, f"found {value}, expected numbers of 16 bits")
    return int(value)


def _word(text: str) -> int:
    """A number of a path. Decimals are cut off, as in the reference: programs compute speeds with them."""
    if not _NUMBER.fullmatch(text):
        raise RefusedError(400, f"found {text[:40]!r} among the values, expected numbers")
    return int(text.partition(".")[0])


def _checked(values: Sequence[int]) -> tuple[int, ...]:
    """Values of 16 bits, with or without sign, as int16."""
    if len(values) > MAX_WORDS:
        raise RefusedError(400, f"found {len(values)} values, expected at most {MAX_WORDS}")
    for value in values:
        if not -0x8000 <= value <= 0xFFFF:
            raise RefusedError(400, f"found {value}, expected a number of 16 bits, -32768..32767")
    return tuple(value - 0x10000 if value >= 0x8000 else value for value in values)
