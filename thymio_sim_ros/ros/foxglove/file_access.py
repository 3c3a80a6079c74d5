"""What clients may not ask for: files of this computer by their path.

A client of the bridge gives a playground or a program by the name of a shipped one, or as its text. Paths are for those
who are on this computer: `ros2 param set`, the command line. All clients are treated alike, since a page on this
computer may be anyone's. Other nodes than ours are left alone.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from thymio_sim_ros import resources
from thymio_sim_ros.loading import NO_PROGRAM, is_playground_text

__all__ = ["call_refusal", "parameter_refusal"]

_BY_PATH = "by `ros2 param set` on the computer of the simulator"


def _playground_refusal(value: str) -> str:
    if is_playground_text(value) or value in resources.playgrounds():
        return ""
    return f"expected the name of a shipped playground, or the text of one; files are loaded {_BY_PATH}"


def _program_refusal(value: str) -> str:
    if value in ("", NO_PROGRAM) or value in resources.behaviours():
        return ""
    return f"expected the name of a built-in program; texts go to script.source, files are loaded {_BY_PATH}"


_PARAMETERS: tuple[tuple[re.Pattern[str], Callable[[str], str]], ...] = (
    (re.compile(r"playground"), _playground_refusal),
    (re.compile(r"(robots\..+\.)?script\.path"), _program_refusal),
)
"""Parameters of ours that open files while a node runs; `card`, `settings` and `log` are fixed at its start."""


def parameter_refusal(name: str, value: object) -> str:
    """Why a client may not give a parameter this value, or nothing; `name` is without its node."""
    if not isinstance(value, str):
        return ""
    return next((refusal(value) for pattern, refusal in _PARAMETERS if pattern.fullmatch(name)), "")


def call_refusal(type_name: str, request: Any) -> str:
    """Why a client may not call a service of this type so, or nothing."""
    check = _CALLS.get(type_name)
    return "" if check is None else check(request)


def _set_parameters(request: Any) -> str:
    given = ((item.name, item.value.string_value) for item in request.parameters if item.value.string_value)
    refusals = ((name, parameter_refusal(name, value)) for name, value in given)
    return next((f"{name}: {reason}" for name, reason in refusals if reason), "")


def _load_world(request: Any) -> str:
    uri = getattr(request, "world_resource", request).uri  # in a field of its own from version 2 on
    return _playground_refusal(uri) if uri else ""


_CALLS: dict[str, Callable[[Any], str]] = {
    "rcl_interfaces/srv/SetParameters": _set_parameters,
    "rcl_interfaces/srv/SetParametersAtomically": _set_parameters,
    "simulation_interfaces/srv/LoadWorld": _load_world,
}
"""Services by which the same can be reached; those that every node has are offered with `include_hidden` only."""
