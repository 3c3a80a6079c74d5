"""Guard conditions: callbacks that a program triggers."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros.graph.entity import Entity

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
    from thymio_sim_ros.portable_ros.rclpy.context import Context

__all__ = ["GuardCondition"]


class GuardCondition(Entity):
    """Calls its callback in the executor after `trigger`, once for all triggers until then."""

    def __init__(
        self, callback: Callable[[], Any] | None, callback_group: CallbackGroup | None, context: Context | None = None
    ) -> None:
        super().__init__(callback_group)
        self.callback = callback
        self._is_triggered = False
        self._lock = threading.Lock()

    def trigger(self) -> None:
        """Make the executor call the callback."""
        with self._handle, self._lock:
            is_new, self._is_triggered = not self._is_triggered, True
        if is_new:
            self.notify()

    def pending(self) -> int:
        """1 after a trigger."""
        return int(self._is_triggered)

    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take the trigger."""
        with self._lock:
            was_triggered, self._is_triggered = self._is_triggered, False
        return (self.callback, ()) if was_triggered and self.callback is not None else None
