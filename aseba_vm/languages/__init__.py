"""Texts in the languages of the users: one folder per language, one JSON file per part of the program.

A folder with a `language.json`, which holds the name of the language in itself, is a language; there is no other list.
A file maps keys to texts; `{name}` and `{0}` in a text are replaced by values. English is the reference: a language
may lack files and keys, and then English is used. The web page reads the same files (`web_ui/i18n/`).
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path

__all__ = ["ENGLISH", "LANGUAGES", "texts"]

ENGLISH = "en"
"""Code of the reference language."""

_FOLDER = Path(__file__).parent


def _languages() -> tuple[str, ...]:
    codes = {path.parent.name for path in _FOLDER.glob("*/language.json")}
    return (ENGLISH, *sorted(codes - {ENGLISH}))


LANGUAGES: tuple[str, ...] = _languages()
"""Codes of all languages (two letters of ISO 639-1), English first."""


@cache
def texts(file: str, language: str = ENGLISH) -> Mapping[str, str]:
    """The texts of a file, such as "compiler", in a language, with English for what the language lacks.

    An unknown language is English. Raises FileNotFoundError if English has no such file.
    """
    english = _read(file, ENGLISH)
    if language == ENGLISH or language not in LANGUAGES:
        return english
    try:
        return english | _read(file, language)
    except FileNotFoundError:
        return english


def _read(file: str, language: str) -> dict[str, str]:
    table: dict[str, str] = json.loads((_FOLDER / language / f"{file}.json").read_text(encoding="utf-8"))
    return table
