"""The help of one language."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["HelpTable"]


@dataclass(frozen=True, slots=True)
class HelpTable:
    """Name → one line, for each kind of name."""

    variables: Mapping[str, str]
    natives: Mapping[str, str]
    events: Mapping[str, str]
