"""The executor that runs callbacks in the order of their events, as all executors here do."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros.rclpy.executors import SingleThreadedExecutor

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.task import Task

__all__ = ["EventsExecutor"]


class EventsExecutor(SingleThreadedExecutor):
    """Executes callbacks on the thread that spins, and tasks in their order with them."""

    def _add_created(self, task: Task) -> None:
        self._queue.append(task)

    def _require_context(self, timeout_sec: float | None, condition: Callable[[], bool]) -> None:
        """Need nothing: a wait after a shutdown of the context raises ExternalShutdownException, too."""
