"""Values of parameters as text: on the command line and in files, typed as rcl types them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["TextValueError", "file_values", "text_value"]

_TRUE = frozenset({"y", "Y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"})
_FALSE = frozenset({"n", "N", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"})
_NOTHING = frozenset({"", "~", "null", "Null", "NULL"})
_FLOAT = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_SPECIAL = {
    **dict.fromkeys((".nan", ".NaN", ".NAN"), math.nan),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), math.inf),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), -math.inf),
}
_LIMIT = 2**63
_KEY = "ros__parameters"


class TextValueError(ThymioSimError, ValueError):
    """A text is no value; the text says why."""


def text_value(text: str) -> Any:
    """The value of a text of YAML; None for nothing and for an empty list."""
    return _value(_composed(text))


def file_values(path: str) -> Iterator[tuple[str, str, Any]]:
    """Pattern of nodes, name of the parameter and value of each entry of a file of parameters, in order."""
    try:
        content = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise TextValueError("Error opening YAML file") from error
    root = _composed(content)
    if root is None:
        return
    if not isinstance(root, yaml.MappingNode):
        raise TextValueError("found no mapping, expected names of nodes")
    yield from _of_nodes(root, "")


def _composed(text: str) -> yaml.Node | None:
    try:
        return yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        raise TextValueError(f"Error parsing an event: {' '.join(str(error).split())}") from error


def _of_nodes(mapping: yaml.MappingNode, prefix: str) -> Iterator[tuple[str, str, Any]]:
    for key, inner in mapping.value:
        if not isinstance(inner, yaml.MappingNode):
            raise TextValueError(f"Cannot have a value before {_KEY} at line {inner.start_mark.line + 1}")
        if key.value == _KEY:
            yield from ((prefix, name, value) for name, value in _of_parameters(inner, ""))
        else:
            yield from _of_nodes(inner, f"{prefix}/{key.value.strip('/')}")


def _of_parameters(mapping: yaml.MappingNode, prefix: str) -> Iterator[tuple[str, Any]]:
    for key, inner in mapping.value:
        name = f"{prefix}{key.value}"
        if isinstance(inner, yaml.MappingNode):
            yield from _of_parameters(inner, f"{name}.")
        else:
            yield name, _value(inner)


def _value(node: yaml.Node | None) -> Any:
    if node is None:
        return None
    if isinstance(node, yaml.SequenceNode):
        return _list(node)
    if isinstance(node, yaml.ScalarNode):
        return _scalar(node)
    raise TextValueError("found a mapping, expected a value")


def _list(node: yaml.SequenceNode) -> list[Any] | None:
    values = [_value(one) for one in node.value]
    kinds = {type(value) for value in values}
    if len(kinds) > 1 or kinds & {list, type(None)}:
        names = {int: "integer", float: "double", bool: "bool", str: "string"}
        other = next((one for one in values if type(one) is not type(values[0])), None)
        raise TextValueError(
            f"Sequence should be of same type. Value type '{names.get(type(other), 'other')}' do not belong at"
            f" line_num {node.start_mark.line + 1}"
        )
    return values or None


def _scalar(node: yaml.ScalarNode) -> Any:
    text = str(node.value)
    if node.style in ("'", '"', "|", ">"):
        return text
    if text in _TRUE | _FALSE:
        return text in _TRUE
    if text in _NOTHING:
        return None
    if (number := _integer(text)) is not None:
        return number
    if text in _SPECIAL:
        return _SPECIAL[text]
    return float(text) if _FLOAT.fullmatch(text) else text


def _integer(text: str) -> int | None:
    """A number in the notation of C, if 64 bits can hold it."""
    for pattern, base in ((r"[+-]?0[xX][0-9a-fA-F]+", 16), (r"[+-]?0[0-7]+", 8), (r"[+-]?\d+", 10)):
        if re.fullmatch(pattern, text):
            number = int(text, base)
            return number if -_LIMIT <= number < _LIMIT else None
    return None
