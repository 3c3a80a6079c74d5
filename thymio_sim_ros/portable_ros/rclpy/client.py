"""Clients of services."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, Generic, NamedTuple, TypeVar

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.graph import waits
from thymio_sim_ros.portable_ros.graph.event_queue import EventQueue
from thymio_sim_ros.portable_ros.graph.time_base import note_query
from thymio_sim_ros.portable_ros.messages import cdr
from thymio_sim_ros.portable_ros.messages.message_class import SrvRequestT, SrvResponseT
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.task import Future
from thymio_sim_ros.portable_ros.rclpy_parts.service_entity import ServiceDescription, ServiceEntity

__all__ = ["Client"]

T = TypeVar("T")


class _Request(NamedTuple, Generic[SrvResponseT]):
    """A request without a response: its future, and what makes the result of the future of the response."""

    future: Future[Any]
    convert: Callable[[SrvResponseT], Any]


class Client(ServiceEntity[SrvRequestT, SrvResponseT]):
    """Calls a service."""

    def __init__(self, of: ServiceDescription[SrvRequestT, SrvResponseT]) -> None:
        super().__init__(of)
        self.lets_pass = True
        self._pending_requests: dict[int, _Request[SrvResponseT]] = {}
        self._numbers = itertools.count(1)
        self._lock = threading.Lock()
        self._queue: EventQueue[tuple[int, bytes]] = EventQueue(of.qos_profile.kept)

    def call(self, request: SrvRequestT, timeout_sec: float | None = None) -> SrvResponseT | None:
        """Call and wait for the response, None when time is over; another thread must spin the node."""
        answered = threading.Event()
        future = self.call_async(request)
        future.add_done_callback(lambda _: answered.set())
        with self.named_wait(timeout_sec):
            if not answered.wait(None if timeout_sec is None or timeout_sec < 0 else timeout_sec):
                self.remove_pending_request(future)
        return future.result()

    def named_wait(self, timeout_s: float | None = None) -> AbstractContextManager[None]:
        """Name the wait inside the block, which is one for a response."""
        return waits.named(f"the response of {self._full_name}", timeout_s, is_deadlock=self.is_blocked())

    def call_async(self, request: SrvRequestT) -> Future[SrvResponseT]:
        """Call; the future gets the response. Raises TypeError for a request of another type."""
        return self.send(request, lambda response: response)

    def send(self, request: SrvRequestT, convert: Callable[[SrvResponseT], T]) -> Future[T]:
        """Call; the future gets what `convert` makes of the response. Raises TypeError for a wrong request."""
        note_query()
        with self._handle:
            if not isinstance(request, self.srv_type.Request):
                raise TypeError
            data = cdr.serialize(request)
            future: Future[T] = Future()
            with self._lock:
                sequence = next(self._numbers)
                self._pending_requests[sequence] = _Request(future, convert)
            future.add_done_callback(self.remove_pending_request)
            self._report(ros_types.ServiceEventInfo.REQUEST_SENT, self, sequence, request=request)
            for service in self.context.graph.services_for(self):
                service.receive(self, sequence, data)
            return future

    def get_pending_request(self, sequence_number: int) -> Future[SrvResponseT]:
        """The future of a request. Raises KeyError if it is answered."""
        with self._lock:
            return self._pending_requests[sequence_number].future

    def remove_pending_request(self, future: Future[Any]) -> None:
        """Ignore the response to a request."""
        with self._lock:
            self._pending_requests = {
                number: one for number, one in self._pending_requests.items() if one.future is not future
            }

    def service_is_ready(self) -> bool:
        """Whether there is a service. Raises RCLError after a shutdown of the context."""
        note_query()
        with self._handle:
            if not self.context.ok():
                raise RCLError("failed to check service availability: rcl node's context is invalid")
            return bool(self.context.graph.services_for(self))

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait for a service; return whether there is one."""
        self.context.wait_for(self.service_is_ready, timeout_sec, f"service {self.service_name}")
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
            request = self._pending_requests.pop(found[0], None)
        if request is None:
            self._report_unexpected()
            return None
        if not request.future._pending():
            return None
        request.future._set_executor(None if self.node is None else self.node.executor)
        response = cdr.deserialize(found[1], self.srv_type.Response)
        self._report(ros_types.ServiceEventInfo.RESPONSE_RECEIVED, self, found[0], response=response)
        return self._finish, (request, response)

    def _finish(self, request: _Request[SrvResponseT], response: SrvResponseT) -> None:
        request.future.set_result(request.convert(response))

    def _report_unexpected(self) -> None:
        """Ignore a response without a request: the future was canceled, or another service has answered."""
