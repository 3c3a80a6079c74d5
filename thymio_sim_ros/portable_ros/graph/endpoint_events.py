"""Events of publishers and subscriptions: matches, and profiles that do not fit."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.graph.event_queue import EventQueue
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
from thymio_sim_ros.portable_ros.rclpy.event_handler import IncompatibleQoSInfo, MatchedInfo
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind

__all__ = ["EndpointEvents"]


class EndpointEvents(Entity):
    """Calls the callbacks of an endpoint for events, in the executor of its node."""

    def __init__(
        self,
        callback_group: CallbackGroup | None,
        matched: Callable[[MatchedInfo], Any] | None,
        incompatible: Callable[[IncompatibleQoSInfo], Any] | None,
    ) -> None:
        super().__init__(callback_group)
        self._matched, self._incompatible = matched, incompatible
        self._queue: EventQueue[tuple[Callable[..., Any], Any]] = EventQueue(None)
        self._total = self._current = self._misfits = 0

    def report_match(self, change: int) -> None:
        """Report a match (1) or its end (-1)."""
        self._current += change
        self._total += max(0, change)
        if self._matched is not None:
            self._put(self._matched, MatchedInfo(self._total, max(0, change), self._current, change))

    def report_incompatible(self, policy: QoSPolicyKind) -> None:
        """Report an endpoint that does not fit because of a policy."""
        self._misfits += 1
        if self._incompatible is not None:
            self._put(self._incompatible, IncompatibleQoSInfo(self._misfits, 1, policy))

    def pending(self) -> int:
        """The number of events."""
        return len(self._queue)

    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take an event."""
        found = self._queue.get()
        return None if found is None else (found[0], (found[1],))

    def _put(self, callback: Callable[..., Any], info: Any) -> None:
        self._queue.put((callback, info))
        self.notify()
