"""The names of the pupils in an export of Gradescope, whose folders have numbers.

The export has a folder `submission_123` for each submission and one `submission_metadata.yml`:

    submission_123:
      :submitters:
      - :name: Anna Smith
        :sid: '4711'
"""

from __future__ import annotations

__all__ = ["METADATA", "names"]

METADATA = "submission_metadata.yml"


def names(metadata: object) -> dict[str, str]:
    """Names by folder, those of a group joined by " and "; none where the metadata, as bytes, does not say."""
    import yaml

    if not isinstance(metadata, bytes):
        return {}
    try:
        table = yaml.load(metadata, Loader=yaml.BaseLoader)  # makes texts, lists and dictionaries only
    except (yaml.YAMLError, ValueError, RecursionError):
        return {}
    if not isinstance(table, dict):
        return {}
    return {folder: joined for folder, entry in table.items() if (joined := " and ".join(_submitters(entry)))}


def _submitters(entry: object) -> list[str]:
    listed = entry.get(":submitters") if isinstance(entry, dict) else None
    people = [one for one in listed if isinstance(one, dict)] if isinstance(listed, list) else []
    return [name for one in people if isinstance(name := one.get(":name"), str) and name]
