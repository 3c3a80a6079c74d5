"""The executor that runs callbacks in the order of their events, as all executors here do."""

from __future__ import annotations

from thymio_sim_ros.portable_ros.rclpy.executors import SingleThreadedExecutor

__all__ = ["EventsExecutor"]


class EventsExecutor(SingleThreadedExecutor):
    """Executes callbacks on the thread that spins."""
