"""The rclpy context of one test, and its end."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import get_default_context, try_shutdown

from thymio_sim_ros import course_packages
from thymio_sim_ros.ros.rclpy_ext import log_directory

__all__ = ["PrivateContext"]

THREADS_S = 2.0
"""Last resort: time for threads of nodes under test to notice that ROS is shut down and to end, in s of real time."""


class PrivateContext:
    """An initialized context in the domain of a test, and the threads that were started since."""

    def __init__(self, domain: int) -> None:
        self._threads = set(threading.enumerate())
        # Code under test may use the default context (`rclpy.ok()`). If it is in use already, it is left alone.
        self.context = get_default_context()
        if self.context.ok():
            self.context = Context()
        log_directory.ensure()
        course_packages.add_to_path()
        rclpy.init(args=[], context=self.context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)

    @contextlib.contextmanager
    def alive(self) -> Iterator[None]:
        """Fail the test with an explanation if the context is shut down before or inside the block."""
        try:
            if not self.context.ok():
                raise ExternalShutdownException
            yield
        except ExternalShutdownException:
            pytest.fail("a node under test shut ROS down: rclpy.shutdown() belongs to main()")

    def end_threads(self) -> None:
        """Shut ROS down before the nodes are destroyed if they run threads, whose loops check `rclpy.ok()`."""
        running = set(threading.enumerate()) - self._threads
        if running:
            self.close()
        deadline = time.monotonic() + THREADS_S
        for thread in running:
            thread.join(max(0.0, deadline - time.monotonic()))

    def close(self) -> None:
        """Shut the context down, unless it is already."""
        if self.context is get_default_context():
            try_shutdown()
        else:
            self.context.try_shutdown()
