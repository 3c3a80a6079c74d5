"""Events of publishers and subscriptions: matches, endpoints that do not fit, missed deadlines, liveliness."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from thymio_sim_ros.portable_ros.graph.liveliness import Lease
from thymio_sim_ros.portable_ros.rclpy.event_handler import (
    CountInfo,
    EventHandler,
    IncompatibleQoSInfo,
    IncompatibleTypeInfo,
    MatchedInfo,
    QoSLivelinessChangedInfo,
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
        self._alive = self._not_alive = self._lost = 0
        self.deadline: DeadlineTimer | None = None
        """Runs out if no message comes in time; None if nothing asks for that."""
        self.lease: Lease | None = None
        """The liveliness of a publisher that asserts it itself, None without it."""

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

    def report_liveliness(self, alive: int, not_alive: int) -> None:
        """Report changes of the numbers of publishers that are alive and that are not, to a subscription."""
        self._alive += alive
        self._not_alive += not_alive
        self._put("liveliness", QoSLivelinessChangedInfo(self._alive, self._not_alive, alive, not_alive))

    def report_lost(self) -> None:
        """Report to a publisher that it has not asserted its liveliness in time."""
        if self.lease is not None:
            self.lease.end()
        self._lost += 1
        self._put("liveliness", CountInfo(self._lost, 1))

    def report_missed(self) -> None:
        """Report a message that did not come within the deadline."""
        self._missed += 1
        self._put("deadline", CountInfo(self._missed, 1))

    @property
    def asks_for_deadlines(self) -> bool:
        """Whether there is a handler for missed deadlines."""
        return "deadline" in self._handlers

    @property
    def timers(self) -> list[DeadlineTimer]:
        """The timers of deadline and lease, if there are such."""
        found = (self.deadline, None if self.lease is None else self.lease.timer)
        return [one for one in found if one is not None]

    def destroy(self) -> None:
        """Destroy the handlers and the timers of deadline and lease."""
        for handler in self._handlers.values():
            handler.destroy()
        if self.deadline is not None:
            self.deadline.destroy()
        if self.lease is not None:
            self.lease.destroy()

    def _put(self, name: str, info: Any) -> None:
        if name in self._handlers:
            self._handlers[name].put(info)
