"""Fields of a dataclass as JSON, from which the page builds its forms and checks; and values of a new item.

A field is declared by an object with its `type`:

- `number`: `unit`, `low`, `high` (inclusive)
- `text`: `pattern` (the whole text matches), `longest` in characters, and `format` (`line`, `name` or `color`) for a
  rule of `fields.py` or `meaning` in words for any other pattern
- `points`: `fewest`, `most` points [x, y] in m
- `image`: `longest` in characters of the data URI
- `flag`: true or false
- `object`: `fields`

Each has either `required: true` or a `default`; `nullable: true` allows null.
"""

from __future__ import annotations

import dataclasses
import re
import typing
from collections.abc import Mapping
from typing import Any

from thymio_sim_ros.sim.model.fields import File, Name, Number, Path, Pattern, Shade, Text, hinted_rule

__all__ = ["field_declarations", "number_declaration", "sample_values"]

_FORMATS: dict[Any, str] = {hinted_rule(Text)[0]: "line", hinted_rule(Name)[0]: "name", hinted_rule(Shade)[0]: "color"}
_SAMPLE_NUMBER = 0.1
_SAMPLE_TEXTS = ("", "name", "#9fa3bd")


def field_declarations(form: type[Any]) -> dict[str, dict[str, Any]]:
    """Field name → its declaration, in the order of the dataclass. Raises TypeError for a type without a rule."""
    found = {}
    for field, rule, nullable in _fields(form):
        declared = _rule_declaration(rule)
        declared |= {"required": True} if field.default is dataclasses.MISSING else {"default": field.default}
        found[field.name] = declared | ({"nullable": True} if nullable else {})
    return found


def sample_values(form: type[Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a new item: those given, and one within the limits for each other required field.

    Required images are left out, since there is no image to start with. Raises TypeError for a given value whose field
    does not exist.
    """
    names = [field.name for field in dataclasses.fields(form)]
    for name in given:
        if name not in names:
            raise TypeError(f"sample of {form.__name__}: found '{name}', expected one of {', '.join(names)}")
    values = {}
    for field, rule, _nullable in _fields(form):
        if field.name in given:
            values[field.name] = given[field.name]
        elif field.default is dataclasses.MISSING and not isinstance(rule, File):
            values[field.name] = _sample(rule)
    return values


def number_declaration(rule: Number) -> dict[str, Any]:
    """The declaration of a number, without `required` or `default`."""
    return {"type": "number", "unit": rule.unit, "low": rule.low, "high": rule.high}


def _fields(form: type[Any]) -> list[tuple[dataclasses.Field[Any], Any, bool]]:
    """(field, its rule, bool or dataclass, whether null is allowed) of each field."""
    hints = typing.get_type_hints(form, include_extras=True)
    return [(field, *hinted_rule(hints[field.name])) for field in dataclasses.fields(form)]


def _rule_declaration(rule: Any) -> dict[str, Any]:
    match rule:
        case Number():
            return number_declaration(rule)
        case Pattern(expression, meaning, longest):
            words = {"format": _FORMATS[rule]} if rule in _FORMATS else {"meaning": meaning}
            return {"type": "text", **words, "pattern": expression, "longest": longest}
        case File(_, longest):
            return {"type": "image", "longest": longest}
        case Path(fewest, most):
            return {"type": "points", "fewest": fewest, "most": most}
    if rule is bool:
        return {"type": "flag"}
    if not dataclasses.is_dataclass(rule):
        raise TypeError(f"field of type {rule!r}, expected bool or a rule of sim/model/fields.py such as Coordinate")
    return {"type": "object", "fields": field_declarations(typing.cast("type[Any]", rule))}


def _sample(rule: Any) -> Any:
    match rule:
        case Number(_, low, high):
            return 0.0 if low < 0 else max(low, min(high, _SAMPLE_NUMBER))
        case Pattern(expression, _, _):
            return next((text for text in _SAMPLE_TEXTS if re.fullmatch(expression, text)), "")
        case Path(fewest, _):  # on a parabola, so that no three of them are on a line
            return tuple((index * _SAMPLE_NUMBER, index * index * _SAMPLE_NUMBER) for index in range(fewest))
    return False if rule is bool else sample_values(rule, {})
