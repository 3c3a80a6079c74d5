"""Declarations of playground files for the page: the fields of shapes and robots with their limits, as JSON.

`python -m thymio_sim_ros.sim.playground.declarations` prints the declarations of this package's shapes: the content of
`web_ui/playground/declarations.json`, which the page uses without a server. The page's server hands out those of all
installed shapes as `/shapes.json`.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from typing import Any

from thymio_sim_ros.sim.model.field_declarations import field_declarations, number_declaration
from thymio_sim_ros.sim.model.fields import LANGUAGE, Coordinate, hinted_rule
from thymio_sim_ros.sim.playground.model import RobotStart, Translation
from thymio_sim_ros.sim.playground.reader import FORMAT, MAX_ROBOTS, MAX_SHAPES, MAX_TRANSLATIONS
from thymio_sim_ros.sim.shapes import ShapeKind, declaration, own_shapes

__all__ = ["as_json", "declarations"]


def declarations(kinds: Iterable[ShapeKind]) -> dict[str, Any]:
    """The declarations of playground files with these kinds of shapes.

    Keys: `format`, `limits` (numbers of items), `language` (pattern of a language code), `coordinate` (the rule of a
    coordinate in lists of points), `titles`, `robot` (fields) and `shapes` (kind → its declaration).
    """
    return {
        "format": FORMAT,
        "limits": {
            "shapes": MAX_SHAPES,
            "robots": MAX_ROBOTS,
            "translations": MAX_TRANSLATIONS,
        },
        "language": LANGUAGE,
        "coordinate": number_declaration(hinted_rule(Coordinate)[0]),
        "titles": field_declarations(Translation),
        "robot": field_declarations(RobotStart),
        "shapes": {kind.name: declaration(kind) for kind in kinds},
    }


def as_json(kinds: Iterable[ShapeKind], *, indent: int | None = None) -> str:
    """`declarations` as JSON text."""
    return json.dumps(declarations(kinds), indent=indent, ensure_ascii=False, allow_nan=False)


if __name__ == "__main__":
    sys.stdout.write(as_json(own_shapes(), indent=2) + "\n")
