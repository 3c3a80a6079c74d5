"""Events of publishers and subscriptions: matches, and endpoints that do not fit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thymio_sim_ros.portable_ros.rclpy.event_handler import (
    EventHandler,
    IncompatibleQoSInfo,
    IncompatibleTypeInfo,
    MatchedInfo,
)
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind

__all__ = ["EndpointEvents"]


class EndpointEvents:
    """Counts the events of an endpoint, and passes them to its handlers."""

    def __init__(self, handlers: Mapping[str, EventHandler]) -> None:
        """`handlers`: by the names of their callbacks, such as `matched`."""
        self._handlers = handlers
        self._total = self._current = self._misfits = self._other_types = 0

    @property
    def handlers(self) -> list[EventHandler]:
        """All handlers."""
        return list(self._handlers.values())

    def report_match(self, change: int) -> None:
        """Report a match (1) or its end (-1)."""
        self._current += change
        self._total += max(0, change)
        self._put("matched", MatchedInfo(self._total, max(0, change), self._current, change))

    def report_incompatible(self, policy: QoSPolicyKind) -> None:
        """Report an endpoint that does not fit because of a policy."""
        self._misfits += 1
        self._put("incompatible_qos", IncompatibleQoSInfo(self._misfits, 1, policy))

    def report_other_type(self) -> None:
        """Report an endpoint that has another type."""
        self._other_types += 1
        self._put("incompatible_type", IncompatibleTypeInfo(self._other_types, 1))

    def _put(self, name: str, info: Any) -> None:
        if name in self._handlers:
            self._handlers[name].put(info)
