"""Clients of services."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable
from typing import Any

from thymio_sim_ros.portable_ros.graph.event_queue import EventQueue
from thymio_sim_ros.portable_ros.messages import cdr
from thymio_sim_ros.portable_ros.messages.message_class import SrvRequestT, SrvResponseT
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.service_entity import ServiceDescription, ServiceEntity
from thymio_sim_ros.portable_ros.rclpy.task import Future

__all__ = ["Client"]


class Client(ServiceEntity[SrvRequestT, SrvResponseT]):
    """Calls a service."""

    def __init__(self, of: ServiceDescription[SrvRequestT, SrvResponseT]) -> None:
        super().__init__(of)
        self._pending_requests: dict[int, Future[SrvResponseT]] = {}
        self._numbers = itertools.count(1)
        self._lock = threading.Lock()
        self._queue: EventQueue[tuple[int, bytes]] = EventQueue(of.qos_profile.kept)

    def call(self, request: SrvRequestT, timeout_sec: float | None = None) -> SrvResponseT | None:
        """Call and wait for the response, None when time is over; another thread must spin the node."""
        answered = threading.Event()
        future = self.call_async(request)
        future.add_done_callback(lambda _: answered.set())
        if not answered.wait(None if timeout_sec is None or timeout_sec < 0 else timeout_sec):
            self.remove_pending_request(future)
        return future.result()

    def call_async(self, request: SrvRequestT) -> Future[SrvResponseT]:
        """Call; the future gets the response. Raises TypeError for a request of another type."""
        with self._handle:
            if not isinstance(request, self.srv_type.Request):
                raise TypeError
            data = cdr.serialize(request)
            future: Future[SrvResponseT] = Future()
            with self._lock:
                sequence = next(self._numbers)
                self._pending_requests[sequence] = future
            future.add_done_callback(self.remove_pending_request)
            for service in self.context.graph.services_for(self):
                service.receive(self, sequence, data)
            return future

    def get_pending_request(self, sequence_number: int) -> Future[SrvResponseT]:
        """The future of a request. Raises KeyError if it is answered."""
        with self._lock:
            return self._pending_requests[sequence_number]

    def remove_pending_request(self, future: Future[SrvResponseT]) -> None:
        """Ignore the response to a request."""
        with self._lock:
            self._pending_requests = {
                number: one for number, one in self._pending_requests.items() if one is not future
            }

    def service_is_ready(self) -> bool:
        """Whether there is a service. Raises RCLError after a shutdown of the context."""
        with self._handle:
            if not self.context.ok():
                raise RCLError("failed to check service availability: rcl node's context is invalid")
            return bool(self.context.graph.services_for(self))

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait for a service; return whether there is one."""
        self.context.on_shutdown(self.context.graph.notify)
        self.context.graph.wait_for(lambda: not self.context.ok() or self.service_is_ready(), timeout_sec)
        return self.service_is_ready()

    def receive(self, sequence: int, response: bytes) -> None:
        """Queue a serialized response."""
        if self._queue.put((sequence, response)):
            self.notify()

    def pending(self) -> int:
        """The number of waiting responses."""
        return len(self._queue)

    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take a response."""
        found = self._queue.get()
        if found is None:
            return None
        with self._lock:
            future = self._pending_requests.get(found[0])
        if future is None or not future._pending():
            return None
        future._set_executor(None if self.node is None else self.node.executor)
        return future.set_result, (cdr.deserialize(found[1], self.srv_type.Response),)
