"""Events of publishers and subscriptions: matches, and endpoints that do not fit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from thymio_sim_ros.portable_ros.rclpy.event_handler import (
    CountInfo,
    EventHandler,
    IncompatibleQoSInfo,
    IncompatibleTypeInfo,
    MatchedInfo,
)
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind

__all__ = ["DeadlineTimer", "EndpointEvents"]


class DeadlineTimer(Protocol):
    """A timer, as the events of an endpoint need it."""

    def reset(self) -> None:
        """Start a period."""

    def destroy(self) -> None:
        """End it."""


class EndpointEvents:
    """Counts the events of an endpoint, and passes them to its handlers."""

    def __init__(self, handlers: Mapping[str, EventHandler]) -> None:
        """`handlers`: by the names of their callbacks, such as `matched`."""
        self._handlers = handlers
        self._total = self._current = self._misfits = self._other_types = self._missed = 0
        self.deadline: DeadlineTimer | None = None
        """Runs out if no message comes in time; None if nothing asks for that."""

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

    def watch(self, deadline: DeadlineTimer) -> None:
        """Restart a timer with each message; its callback is `report_missed`."""
        self.deadline = deadline

    def note_message(self) -> None:
        """Note a message that is published or received."""
        if self.deadline is not None:
            self.deadline.reset()

    def report_missed(self) -> None:
        """Report a message that did not come within the deadline."""
        self._missed += 1
        self._put("deadline", CountInfo(self._missed, 1))

    @property
    def asks_for_deadlines(self) -> bool:
        """Whether there is a handler for missed deadlines."""
        return "deadline" in self._handlers

    def destroy(self) -> None:
        """Destroy the handlers and the timer of the deadline."""
        for handler in self._handlers.values():
            handler.destroy()
        if self.deadline is not None:
            self.deadline.destroy()

    def _put(self, name: str, info: Any) -> None:
        if name in self._handlers:
            self._handlers[name].put(info)
