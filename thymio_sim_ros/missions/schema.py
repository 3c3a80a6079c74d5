"""The JSON schema of mission files, for editors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thymio_sim_ros.missions.conditions import MAX_PARTS, MAX_SECONDS, MAX_TIMES
from thymio_sim_ros.missions.facts import FACTS
from thymio_sim_ros.missions.file_fields import (
    FORMAT,
    MAX_HAPPENINGS,
    MAX_HINTS,
    MAX_STARS,
    MAX_TOOLS,
    FactHead,
    HappeningFields,
    Head,
    StarFields,
    TextFields,
)
from thymio_sim_ros.missions.mission import PROGRAM_LANGUAGES
from thymio_sim_ros.missions.zones import ZONES
from thymio_sim_ros.sim.model.fields import json_schema

__all__ = ["schema"]


def schema() -> dict[str, Any]:
    """The JSON schema of mission files, for editors; `description` states units."""
    name = {"type": "string"}
    condition = {"$ref": "#/$defs/condition"}
    texts = {"type": "array", "items": name, "maxItems": MAX_HINTS}
    texts_of_stars = {"type": "array", "items": name, "maxItems": MAX_STARS}
    by_language = {
        "type": "object",
        "properties": dict.fromkeys(PROGRAM_LANGUAGES, name),
        "additionalProperties": False,
    }
    tools = {"type": "array", "items": name, "maxItems": MAX_TOOLS}
    times = {"type": "integer", "minimum": 0, "maximum": MAX_TIMES}
    seconds = {"type": "number", "exclusiveMinimum": 0, "maximum": MAX_SECONDS}
    parts = {"type": "array", "items": condition, "minItems": 1, "maxItems": MAX_PARTS}
    star = json_schema(StarFields)
    star["properties"]["when"] = condition
    translation = json_schema(TextFields)
    named_texts = {"type": "object", "additionalProperties": name}
    translation["properties"] |= {"hints": texts, "stars": texts_of_stars, "facts": named_texts, "missing": named_texts}
    head = json_schema(Head)
    head["properties"] |= {
        "format": {"const": FORMAT},
        "$schema": name,
        "languages": {"type": "array", "items": {"enum": list(PROGRAM_LANGUAGES)}, "minItems": 1},
        "programs": by_language,
        "solutions": by_language,
        "robots": {"type": "object", "additionalProperties": name},
        "toolbox": {"type": "object", "properties": {"hide": tools, "modes": tools}, "additionalProperties": False},
        "zones": _choices(ZONES, {}),
        "facts": _choices(FACTS, json_schema(FactHead)["properties"]),
        "happens": {"type": "array", "items": json_schema(HappeningFields), "maxItems": MAX_HAPPENINGS},
        "success": condition,
        "failure": condition,
        "stars": {"type": "array", "items": star, "maxItems": MAX_STARS},
        "hints": texts,
        "translations": {"type": "object", "additionalProperties": translation},
    }
    head["required"] = ["format", *head["required"], "facts", "success"]
    words: list[dict[str, object]] = [
        {"all": parts},
        {"any": parts},
        {"then": parts},
        {"not": condition},
        {"once": condition},
        {"hold": condition, "for_s": seconds},
        {"at_most": times, "of": condition},
    ]
    objects = [
        {"type": "object", "properties": each, "required": list(each), "additionalProperties": False} for each in words
    ]
    draft = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Mission of Thymio Sim ROS"}
    return draft | head | {"$defs": {"condition": {"anyOf": [name, *objects]}}}


def _choices(kinds: Mapping[str, type[Any]], common: Mapping[str, Any]) -> dict[str, Any]:
    """An object of values, each of one of these kinds, with further members."""
    forms = []
    for word, kind in kinds.items():
        form = json_schema(kind, extra={"kind": {"const": word}})
        forms.append(form | {"properties": dict(common) | form["properties"]})
    return {"type": "object", "additionalProperties": {"anyOf": forms}}
