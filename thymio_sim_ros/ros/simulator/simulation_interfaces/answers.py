"""How services of the package simulation_interfaces answer: a code, and a sentence where it is not OK.

The package is optional (docs/spec/ros-interface.md sections 5 and 7), so its types are asked for by name: one that an
older version lacks is not offered.
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
"""Result codes of all services (docs/spec/ros-interface.md section 7); those of single services begin at 101."""

WORLD_FRAMES = ("", "world", MAP_FRAME)
"""What a pose in the world's frame may call it, besides the name that the user gave it."""

Act = Callable[[Any, Any], None]


@dataclass(frozen=True, slots=True)
class Offer:
    """One service below `~/`: its type's name, the features that it is, what it does and how."""

    name: str
    type: str
    features: tuple[str, ...]
    about: str


class RefusedError(ThymioSimError):
    """A request that is not done: the code and the reason."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code


def answering(act: Act) -> Callable[[Any, Any], Any]:
    """A service's callback: `act` fills the response or raises RefusedError."""

    def answer(request: Any, response: Any) -> Any:
        response.result.result = OK
        try:
            act(request, response)
        except RefusedError as refusal:
            response.result.result, response.result.error_message = refusal.code, str(refusal)
        return response

    return answer


def resource(request: Any, field: str) -> tuple[str, str]:
    """URI and text of a request; from version 2 on they are in a field of their own."""
    holder = getattr(request, field, request)
    return holder.uri, holder.resource_string
