"""Responses of simulation_interfaces services: a result code, and a message where it is not OK.

The package is optional (docs/spec/ros-interface.md sections 5 and 7), so its types are looked up by name; a service
whose type is missing in an older version is not offered.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.interface.names import MAP_FRAME

__all__ = [
    "FAILED",
    "INCORRECT_STATE",
    "NOT_FOUND",
    "OK",
    "UNSUPPORTED",
    "Offer",
    "RefusedError",
    "answering",
    "resource",
]

UNSUPPORTED, OK, NOT_FOUND, INCORRECT_STATE, FAILED = range(5)
"""Result codes of all services (docs/spec/ros-interface.md section 7); codes of individual services begin at 101."""

WORLD_FRAMES = ("", "world", MAP_FRAME)
"""Names of the world frame that are accepted in addition to the configured one."""

Act = Callable[[Any, Any], None]


@dataclass(frozen=True, slots=True)
class Offer:
    """One service below `~/`: name, type, features that it provides, description."""

    name: str
    type: str
    features: tuple[str, ...]
    about: str


class RefusedError(ThymioSimError):
    """A rejected request, with result code and reason."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code


def answering(act: Act) -> Callable[[Any, Any], Any]:
    """Return a service callback; `act` fills the response or raises RefusedError."""

    def answer(request: Any, response: Any) -> Any:
        response.result.result = OK
        try:
            act(request, response)
        except RefusedError as refusal:
            response.result.result, response.result.error_message = refusal.code, str(refusal)
        return response

    return answer


def resource(request: Any, field: str) -> tuple[str, str]:
    """Return URI and text of a request; from version 2 on they are in a separate field."""
    holder = getattr(request, field, request)
    return holder.uri, holder.resource_string
