"""Reads the JSON of untrusted files: what Python reads in addition, or silently leaves out, is refused."""

from __future__ import annotations

import json
import re
from typing import NoReturn

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim.model.fields import FieldError, describe

__all__ = ["parse_json"]

_WORDS = re.compile(r'"(?:[^"\\]++|\\.)*+"|NaN|-?Infinity')
"""Strings of JSON, and words that Python takes for numbers outside them."""
_PARTS = re.compile(r'"(?:[^"\\]++|\\.)*+"|[{}]')
_COLON = re.compile(r"\s*:")
"""Follows a string that is a key."""
_HALVES = re.compile(r"[\ud800-\udfff]")
"""Surrogates: JSON escapes may contain them, UTF-8 may not, and keys are quoted in errors and notes."""
_SHOWN = 12
"""Number of characters that an error quotes."""


def parse_json(data: bytes) -> object:
    """The value of a file in UTF-8. Numbers are finite, and keys are unique. Raises FieldError with the place."""
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise FieldError("", f"an invalid byte at offset {error.start}", "UTF-8 text") from error
    return _parsed(text)


def _parsed(text: str) -> object:
    def refuse(word: str) -> NoReturn:
        place = next(token.start() for token in _WORDS.finditer(text) if token.group() == word)
        raise FieldError(_line_and_column(text, place), word, "finite numbers")

    def unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
        members = dict(pairs)
        if len(members) < len(pairs):
            raise _TwiceError
        half = next(filter(_HALVES.search, members), None)
        if half is not None:
            raise FieldError("", f"an unpaired surrogate in the key {describe(half)}", "valid Unicode")
        return members

    try:
        return json.loads(text, parse_constant=refuse, object_pairs_hook=unique)
    except json.JSONDecodeError as error:
        found = repr(text[error.pos : error.pos + _SHOWN]) if error.pos < len(text) else "the end of the text"
        raise FieldError(_line_and_column(text, error.pos), found, f"JSON ({error.msg})") from error
    except (RecursionError, ValueError) as error:
        raise FieldError(
            "", "numbers that are too long or values nested too deeply", "shorter or flatter data"
        ) from error
    except _TwiceError as error:
        place, key = _second(text)
        raise FieldError(_line_and_column(text, place), f"the duplicate key {describe(key)}", "unique keys") from error


class _TwiceError(ThymioSimError):
    """A JSON object has a duplicate key."""


def _second(text: str) -> tuple[int, str]:
    """Offset and name of the first duplicate key; there is one."""
    keys: list[set[str]] = []
    for token in _PARTS.finditer(text):
        match token.group():
            case "{":
                keys.append(set())
            case "}":
                keys.pop()
            case word if _COLON.match(text, token.end()):
                key = json.loads(word)
                if key in keys[-1]:
                    return token.start(), key
                keys[-1].add(key)
    raise AssertionError("there is one")


def _line_and_column(text: str, place: int) -> str:
    return f"line {text.count(chr(10), 0, place) + 1}, column {place - text.rfind(chr(10), 0, place)}"
