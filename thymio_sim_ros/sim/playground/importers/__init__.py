"""Converters of playgrounds of other simulators (docs/spec/playground-formats.md).

A converter takes what was parsed and gives a `Conversion`; `sim/playground/format_detection.py` chooses it,
`sim/playground/reader.py` checks the result as if a person had written it, and names the place in the original when
something is wrong.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

__all__ = ["Conversion"]


@dataclass(slots=True)
class Conversion:
    """Shapes and robots of our format so far, what could not be expressed, and where each item stood."""

    title: str
    description: str = ""
    translations: dict[str, dict[str, str]] = field(default_factory=dict)
    shapes: list[dict[str, Any]] = field(default_factory=list)
    robots: list[dict[str, Any]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    places: dict[str, str] = field(default_factory=dict)
    """Key of an item here (such as "shapes[3]") → its place in the original."""

    def add_shape(self, place: str, members: dict[str, Any]) -> None:
        """Add a shape, found at `place` in the original; members whose value is None are omitted."""
        self.places[f"shapes[{len(self.shapes)}]"] = place
        self.shapes.append({key: value for key, value in members.items() if value is not None})

    def add_robot(self, place: str, members: dict[str, Any]) -> None:
        """Add a robot, found at `place` in the original."""
        self.places[f"robots[{len(self.robots)}]"] = place
        self.robots.append(members)

    def data(self) -> dict[str, Any]:
        """The playground as data of a JSON file."""
        return {
            "format": 1,
            "title": self.title,
            "description": self.description,
            "translations": self.translations,
            "shapes": self.shapes,
            "robots": self.robots,
        }
