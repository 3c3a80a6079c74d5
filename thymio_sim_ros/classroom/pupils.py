"""Names of pupils from a CSV file, with or without a header. Pure."""

from __future__ import annotations

import csv
import re
import unicodedata
from collections.abc import Sequence

from thymio_sim_ros.classroom.errors import ClassError

__all__ = ["MAX_PUPILS", "archive_name", "folder_name", "read_pupils"]

MAX_PUPILS = 100
"""Pupils of a class; each needs a ROS domain below 233, and memory."""
MAX_NAME = 60
"""Characters of a name."""

_SINGLE = frozenset({"name", "names", "pupil", "student", "full name", "schüler", "schülerin", "élève", "nome"})
_FIRST = frozenset({"first name", "firstname", "given name", "vorname", "prénom", "prenom"})
_LAST = frozenset({"last name", "lastname", "surname", "family name", "nachname", "nom", "cognome"})


def read_pupils(data: bytes, where: str) -> list[str]:
    """The names in the order of a file: UTF-8, or Windows-1252 as old spreadsheets write it.

    Columns are separated by comma, semicolon or tab. A header may name a column for the name, or two for first and last
    name; without a header the first column is the name. Empty lines are skipped. `where` begins the messages of errors.
    Raises ClassError for names that occur twice, that are too long, or too many.
    """
    try:
        rows = _rows(_text(data))
    except csv.Error as error:
        raise ClassError(f"{where}: {error}; expected a table with one name per line") from error
    if not rows:
        raise ClassError(f"{where}: found no names; expected one per line")
    columns = _columns(rows[0][1])
    if columns is not None:
        rows = rows[1:]
    lines: dict[str, int] = {}
    names = []
    for line, cells in rows:
        name = " ".join(" ".join(cells[at] for at in columns or (0,) if at < len(cells)).split())
        if not name:
            raise ClassError(f"{where}: line {line}: found no name; expected one in each line")
        if len(name) > MAX_NAME or not name.isprintable():
            raise ClassError(f"{where}: line {line}: expected a name of at most {MAX_NAME} printable characters")
        first = lines.setdefault(_key(name), line)
        if first != line:
            raise ClassError(
                f"{where}: line {line}: found '{name}' again, as in line {first}; expected different names: add an "
                "initial or a number"
            )
        names.append(name)
    if not names:
        raise ClassError(f"{where}: found a header and no names; expected one per line")
    if len(names) > MAX_PUPILS:
        raise ClassError(f"{where}: found {len(names)} names; expected at most {MAX_PUPILS}")
    return names


def folder_name(name: str, taken: Sequence[str] = ()) -> str:
    """A name for files and addresses: lower-case ASCII letters, digits and hyphens, different from `taken`."""
    plain = unicodedata.normalize("NFKD", name.casefold().replace("ß", "ss")).encode("ascii", "ignore").decode()
    base = re.sub(r"[^a-z0-9]+", "-", plain).strip("-") or "pupil"
    unused, number = base, 1
    while unused in taken:
        number += 1
        unused = f"{base}-{number}"
    return unused


def archive_name(name: str, taken: Sequence[str] = ()) -> str:
    """A name for a folder in a zip that a person reads: the pupil's, without characters that a system does not allow.

    It differs from `taken` also where upper and lower case are the same.
    """
    base = re.sub(r'[<>:"/\\|?*\x00-\x1f\x7f]', "_", unicodedata.normalize("NFC", name)).strip(" .") or "pupil"
    unused, number = base, 1
    while unused.casefold() in {one.casefold() for one in taken}:
        number += 1
        unused = f"{base} {number}"
    return unused


def _text(data: bytes) -> str:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("cp1252", "replace")
    return unicodedata.normalize("NFC", text)


def _rows(text: str) -> list[tuple[int, list[str]]]:
    """The rows that are not empty, with their lines from 1."""
    first = next((line for line in text.splitlines() if line.strip()), "")
    delimiter = max(";\t,", key=first.count)
    reader = csv.reader(text.splitlines(), delimiter=delimiter, skipinitialspace=True)
    rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    return [(line, cells) for line, cells in rows if any(cells)]


def _columns(header: Sequence[str]) -> tuple[int, ...] | None:
    """The columns that together are the name; None if this row is no header."""
    words = [cell.casefold() for cell in header]
    parts = [next((at for at, word in enumerate(words) if word in known), None) for known in (_FIRST, _LAST)]
    given = tuple(at for at in parts if at is not None)
    whole = next((at for at, word in enumerate(words) if word in _SINGLE), None)
    if whole is not None and len(given) < 2:
        return (whole,)
    return given or None


def _key(name: str) -> str:
    return name.casefold()
