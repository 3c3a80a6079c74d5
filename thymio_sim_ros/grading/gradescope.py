"""The pupils in an export of Gradescope, whose folders have numbers.

The export has a folder `submission_123` for each submission and one `submission_metadata.yml`:

    submission_123:
      :submitters:
      - :name: Anna Smith
        :sid: '4711'
        :email: anna@school.example

A pupil who hands in again gets another number, so the number does not identify the pupil.
"""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["METADATA", "Pupil", "pupils"]

METADATA = "submission_metadata.yml"


class Pupil(NamedTuple):
    """Name and key of a pupil or a group. The key stays when they hand in again; empty if there is none."""

    name: str
    key: str


def pupils(metadata: object) -> dict[str, Pupil]:
    """Pupils by folder, the names of a group joined by " and "; none where the metadata, as bytes, does not say."""
    import yaml

    if not isinstance(metadata, bytes):
        return {}
    try:
        table = yaml.load(metadata, Loader=yaml.BaseLoader)  # makes texts, lists and dictionaries only
    except (yaml.YAMLError, ValueError, RecursionError):
        return {}
    if not isinstance(table, dict):
        return {}
    return {folder: pupil for folder, entry in table.items() if (pupil := _pupil(entry)).name}


def _pupil(entry: object) -> Pupil:
    listed = entry.get(":submitters") if isinstance(entry, dict) else None
    people = [person for person in listed if isinstance(person, dict)] if isinstance(listed, list) else []
    names = [name for person in people if (name := _text(person, ":name"))]
    keys = [_text(person, ":sid") or _text(person, ":email") for person in people]
    return Pupil(" and ".join(names), "\0".join(sorted(keys)) if all(keys) else "")


def _text(person: dict[object, object], field: str) -> str:
    value = person.get(field)
    return value if isinstance(value, str) else ""
