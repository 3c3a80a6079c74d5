"""Declarations of mission files for the page's creator: kinds of facts with their fields and limits, as JSON.

`python -m thymio_sim_ros.missions.declarations` prints the content of `web_ui/playground/mission_declarations.json`.
"""

from __future__ import annotations

import json
import sys
from typing import Any

from thymio_sim_ros.missions.conditions import MAX_SECONDS
from thymio_sim_ros.missions.facts import FACTS
from thymio_sim_ros.missions.file_fields import (
    FORMAT,
    MAX_FACTS,
    MAX_HAPPENINGS,
    MAX_HINTS,
    MAX_STARS,
    FactHead,
    HappeningFields,
    Head,
    StarFields,
)
from thymio_sim_ros.missions.mission import PROGRAM_LANGUAGES
from thymio_sim_ros.missions.schema import schema
from thymio_sim_ros.sim.model.field_declarations import field_declarations

__all__ = ["declarations"]


def declarations() -> dict[str, Any]:
    """The declarations of mission files.

    Keys: `format`, `words` (the members of a file), `languages`, `limits` (numbers of items, and `hold_s`: the longest
    time of a condition), `head`, `star`, `happening`, `fact` (fields of all facts) and `facts` (kind → its fields).
    """
    limits = {"facts": MAX_FACTS, "hints": MAX_HINTS, "happens": MAX_HAPPENINGS, "stars": MAX_STARS}
    return {
        "format": FORMAT,
        "words": [word for word in schema()["properties"] if not word.startswith("$")],
        "languages": list(PROGRAM_LANGUAGES),
        "limits": limits | {"hold_s": MAX_SECONDS},
        "head": field_declarations(Head),
        "star": field_declarations(StarFields),
        "happening": field_declarations(HappeningFields),
        "fact": field_declarations(FactHead),
        "facts": {kind: field_declarations(fact) for kind, fact in FACTS.items()},
    }


if __name__ == "__main__":
    sys.stdout.write(json.dumps(declarations(), indent=2, ensure_ascii=False, allow_nan=False) + "\n")
