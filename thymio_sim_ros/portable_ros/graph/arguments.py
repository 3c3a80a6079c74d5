"""The arguments behind `--ros-args`: names, parameters and levels of logs."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from thymio_sim_ros.portable_ros.graph import log_levels
from thymio_sim_ros.portable_ros.graph.names import expanded, namespace_problem, node_problem
from thymio_sim_ros.portable_ros.graph.yaml_values import TextValueError, file_values, text_value
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLInvalidROSArgsError, UnknownROSArgsError

__all__ = ["Arguments", "parse", "without_ros_arguments"]

_BEGIN, _END = "--ros-args", "--"
_FLAGS = {"-r": "remap", "--remap": "remap", "-p": "param", "--param": "param", "--params-file": "file"}
_FLAGS |= {"--log-level": "level", "-e": "enclave", "--enclave": "enclave", "--log-config-file": "ignored"}
_SWITCHES = frozenset({"rosout-logs", "stdout-logs", "external-lib-logs"})
_WHAT = {
    "remap": "remap rule",
    "param": "parameter override rule",
    "file": "params file",
    "level": "log level",
    "enclave": "enclave",
    "ignored": "log config file",
}
_OF_TOPICS, _OF_SERVICES = "rostopic://", "rosservice://"
_EVERY_NODE = "/**"
_WILDCARD = re.compile(r"\*\*?")


@dataclass(frozen=True, slots=True)
class _Remap:
    """`node`: the only node that the rule is for, empty for all; `scheme`: whether it is for topics or services."""

    node: str
    old: str
    new: str
    scheme: str = ""


@dataclass(slots=True)
class Arguments:
    """Arguments of a process or of a node."""

    remaps: list[_Remap] = field(default_factory=list)
    parameters: list[tuple[str, str, Any]] = field(default_factory=list)
    """Pattern of nodes, name and value."""
    log_levels: list[tuple[str, int]] = field(default_factory=list)
    has_rosout: bool = True
    has_stdout: bool = True

    def node_name(self, name: str) -> str:
        """The name of a node after the rules."""
        return next((one.new for one in self.remaps if one.old == "__node" and one.node in ("", name)), name)

    def namespace(self, name: str, namespace: str) -> str:
        """The namespace of a node after the rules."""
        return next((one.new for one in self.remaps if one.old == "__ns" and one.node in ("", name)), namespace)

    def remapped(self, full: str, node: str, namespace: str, *, is_service: bool) -> str | None:
        """The new full name of a topic or a service of a node; None if no rule is for it."""
        schemes = ("", _OF_SERVICES if is_service else _OF_TOPICS)
        for one in self.remaps:
            is_for_node = one.node in ("", node) and one.scheme in schemes and not one.old.startswith("__")
            if is_for_node and expanded(one.old, node, namespace) == full:
                return expanded(one.new, node, namespace)
        return None

    def values(self, full_node: str) -> dict[str, Any]:
        """The values of the parameters of a node by its full name; later ones replace earlier ones."""
        return {name: value for pattern, name, value in self.parameters if _matches(pattern, full_node)}

    def apply_log_levels(self) -> None:
        """Set the levels of all logs that the arguments name, and whether logs are printed."""
        for name, level in self.log_levels:
            log_levels.set_level(name, level)
        log_levels.is_printed = self.has_stdout


def _matches(pattern: str, full_node: str) -> bool:
    if not _WILDCARD.search(pattern):
        return pattern == full_node
    parts = re.split(r"(\*\*|\*)", pattern)
    text = "".join({"**": ".*", "*": "[^/]*"}.get(part, re.escape(part)) for part in parts)
    return re.fullmatch(text.replace("/.*/", "(/.*)?/"), full_node) is not None


def without_ros_arguments(words: Sequence[str]) -> list[str]:
    """The words outside `--ros-args … --`."""
    kept, is_of_ros = [], False
    for word in words:
        if word == _BEGIN or (is_of_ros and word == _END):
            is_of_ros = word == _BEGIN
        elif not is_of_ros:
            kept.append(word)
    return kept


def parse(words: Sequence[str] | None) -> Arguments:
    """Parse arguments, None: those of the process.

    Raises UnknownROSArgsError for words that are no arguments of ROS, RCLInvalidROSArgsError for wrong values, and
    UnicodeEncodeError for words that are no text.
    """
    made, unknown = Arguments(), []
    words = sys.argv[1:] if words is None else words
    for word in words:
        word.encode()
    remaining = _ros_words(words)
    for word in remaining:
        switch = re.fullmatch(r"--(enable|disable)-(.*)", word)
        if word in _FLAGS:
            kind = _FLAGS[word]
            value = next(remaining, None)
            if value is None:
                raise RCLInvalidROSArgsError(f"Couldn't parse trailing {word} flag. No {_WHAT[kind]} found.")
            try:
                _add(made, kind, value)
            except ValueError as error:
                raise RCLInvalidROSArgsError(
                    f"Couldn't parse {_WHAT[kind]}: '{word} {value}'. Error: {error}"
                ) from error
        elif switch and switch[2] in _SWITCHES:
            if switch[2] == "rosout-logs":
                made.has_rosout = switch[1] == "enable"
            elif switch[2] == "stdout-logs":
                made.has_stdout = switch[1] == "enable"
        else:
            unknown.append(word)
    if unknown:
        raise UnknownROSArgsError(str(unknown))
    return made


def _ros_words(words: Sequence[str]) -> Iterator[str]:
    is_of_ros = False
    for word in words:
        if word == _BEGIN or (is_of_ros and word == _END):
            is_of_ros = word == _BEGIN
        elif is_of_ros:
            yield word


def _add(made: Arguments, kind: str, value: str) -> None:
    """Add the value of a flag. Raises ValueError for a wrong one."""
    if kind == "remap":
        made.remaps.append(_remap(value))
    elif kind == "param":
        node, name, text = _rule(value)
        made.parameters.append((_pattern(node), name, text_value(text)))
    elif kind == "file":
        made.parameters.extend(file_values(value))
    elif kind == "level":
        name, _, level = value.rpartition(":=")
        made.log_levels.append((name, log_levels.number(level)))


def _rule(text: str) -> tuple[str, str, str]:
    """Node, left side and right side of `node:left:=right`."""
    left, assign, right = text.partition(":=")
    if not assign or not left:
        raise TextValueError("found no ':=', expected NAME:=VALUE")
    node, colon, name = left.partition(":")
    return (node, name, right) if colon and not name.startswith("//") else ("", left, right)


def _pattern(node: str) -> str:
    if not node:
        return _EVERY_NODE
    return node if node.startswith("/") else f"/{node}"


def _remap(text: str) -> _Remap:
    node, old, new = _rule(text)
    scheme = next((one for one in (_OF_TOPICS, _OF_SERVICES) if old.startswith(one)), "")
    old, new = old.removeprefix(scheme), new.removeprefix(scheme)
    old = {"__name": "__node"}.get(old, old)
    problem = {"__node": node_problem, "__ns": namespace_problem}.get(old, lambda _: None)(new)
    if problem is not None:
        raise TextValueError(problem[0])
    if old not in ("__node", "__ns") and not re.fullmatch(r"[~/A-Za-z_{}][\w/{}]*", new):
        raise TextValueError(f"found {new!r}, expected a name")
    return _Remap(node, old, new, scheme)
