"""Keeps clients from opening files of this computer by their path.

A client of the bridge may set a playground or a program by the name of a shipped one, or as text. Paths are accepted
only from users of this computer: by `ros2 param set` and on the command line. The rule is the same for all clients,
also on this computer, since a web page may come from anywhere. It concerns only nodes of this project.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rcl_interfaces.srv import SetParameters, SetParametersAtomically

from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import NO_PROGRAM, is_playground_text

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

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
"""Parameters of this project that open files while a node runs; `card`, `settings` and `log` are fixed at its start."""


def parameter_refusal(name: str, value: object) -> str:
    """The reason why a client may not set a parameter to this value, or an empty string; `name` is without its node."""
    if not isinstance(value, str):
        return ""
    return next((refusal(value) for pattern, refusal in _PARAMETERS if pattern.fullmatch(name)), "")


def call_refusal(type_name: str, request: Message) -> str:
    """The reason why a client may not call a service of this type with this request, or an empty string."""
    check = _CALLS.get(type_name)
    return "" if check is None else check(request)


def _set_parameters(request: SetParameters.Request | SetParametersAtomically.Request) -> str:
    given = ((item.name, item.value.string_value) for item in request.parameters if item.value.string_value)
    refusals = ((name, parameter_refusal(name, value)) for name, value in given)
    return next((f"{name}: {reason}" for name, reason in refusals if reason), "")


def _load_world(request: Any) -> str:  # the package may not be installed
    uri = getattr(request, "world_resource", request).uri  # version 2 has it in a separate field
    return _playground_refusal(uri) if uri else ""


_CALLS: dict[str, Callable[[Any], str]] = {
    "rcl_interfaces/srv/SetParameters": _set_parameters,
    "rcl_interfaces/srv/SetParametersAtomically": _set_parameters,
    "simulation_interfaces/srv/LoadWorld": _load_world,
}
"""Services that can open files, too. The parameter services of nodes are offered with `include_hidden` only."""
