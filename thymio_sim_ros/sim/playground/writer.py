"""Writes a playground as JSON, for converters and run logs."""

from __future__ import annotations

import json
from typing import Any

from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.playground.reader import FORMAT, Playground

__all__ = ["dumps"]


def dumps(playground: Playground) -> str:
    """JSON that loads as the same playground: it contains the images, and omits defaults."""
    head: dict[str, object] = {"format": FORMAT, "title": playground.title, "description": playground.description}
    translations = {language: fields.write(text) for language, text in playground.translations}
    if translations:
        head["translations"] = translations
    shapes = [{"kind": named.kind, "name": named.name} | fields.write(named.shape) for named in playground.shapes]
    robots = [fields.write(robot) for robot in playground.robots]
    members = [f"  {_line(key)}: {_line(value)}" for key, value in head.items()]
    members += [f"  {_line(key)}: {_list(items)}" for key, items in (("shapes", shapes), ("robots", robots))]
    return "{\n" + ",\n".join(members) + "\n}\n"


def _list(items: list[dict[str, Any]]) -> str:
    """A list with one item per line."""
    return "[\n    " + ",\n    ".join(map(_line, items)) + "\n  ]" if items else "[]"


def _line(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)
