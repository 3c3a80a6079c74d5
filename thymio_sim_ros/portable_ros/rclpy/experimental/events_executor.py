"""The executor that runs callbacks in the order of their events, as all executors here do."""

from __future__ import annotations

from collections.abc import Callable

from thymio_sim_ros.portable_ros.rclpy.executors import SingleThreadedExecutor

__all__ = ["EventsExecutor"]


class EventsExecutor(SingleThreadedExecutor):
    """Executes callbacks on the thread that spins."""

    def _require_context(self, timeout_sec: float | None, condition: Callable[[], bool]) -> None:
        """Need nothing: a wait after a shutdown of the context raises ExternalShutdownException, too."""
