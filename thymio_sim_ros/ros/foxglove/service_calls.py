"""Service calls that do not block: clients are created on demand, readiness and time-outs are polled.

Each service has a queue of calls, which serves its senders in turn: a sender with many calls does not delay the others.
The cost of a call does not depend on the number of open ones. Callbacks run one after the other, never nested, also if
they make calls themselves.
"""

from __future__ import annotations

import heapq
import itertools
import time
import traceback
from collections import deque
from collections.abc import Callable, Container
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future

from thymio_sim_ros.bridge.fair_queue import FairQueue

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message, Service

__all__ = ["CALL_TIMEOUT_S", "SET_TIMEOUT_S", "ServiceCalls"]

CALL_TIMEOUT_S = 5.0

SET_TIMEOUT_S = 60.0
"""Time-out of calls that set parameters: a node may have to load a file, behind those of others, before it answers."""

_IN_FLIGHT = 5
"""Calls of one service at a time: the middleware of a server keeps ten requests and silently drops more."""

_IN_FLIGHT_EACH = 2
"""Calls of one service at a time by one sender, so that one sender cannot occupy a slow service."""

_RESULTS = "/_action/get_result"
"""End of the names of services that answer when a goal has ended."""

Request = TypeVar("Request", bound="Message")
Response = TypeVar("Response", bound="Message")

Done = Callable[[Response | None, str], None]
"""Callback of a call, called once: with the response and "", or with None and the reason of the failure."""


@dataclass(slots=True, eq=False)
class _Queue:
    """Calls of one service."""

    name: str
    client: Client[Any, Any]
    waiting: FairQueue[int, _Call] = field(default_factory=FairQueue)
    in_flight: dict[_Call, Future[Any]] = field(default_factory=dict)

    @property
    def has_room(self) -> bool:
        """Whether another call may be sent. Results of actions have no limit: servers take their requests at once."""
        return len(self.in_flight) < _IN_FLIGHT or self.name.endswith(_RESULTS)

    def is_free(self, sender: int) -> bool:
        """Whether a call of this sender may be sent."""
        in_flight = sum(call.sender == sender for call in self.in_flight)
        return in_flight < _IN_FLIGHT_EACH or self.name.endswith(_RESULTS)


@dataclass(slots=True, eq=False)
class _Call:
    queue: _Queue
    sender: int
    request: Message
    done: Done[Any]
    timeout_s: float
    deadline_s: float = 0.0


class ServiceCalls:
    """All calls of the bridge. Belongs to the executor's thread; `poll` must be called while it returns True."""

    def __init__(
        self, node: Node, *, wake: Callable[[], None] = lambda: None, timeout_s: float = CALL_TIMEOUT_S
    ) -> None:
        self._node = node
        self._wake = wake
        self._timeout_s = timeout_s
        self._queues: dict[tuple[str, type[Service[Any, Any]]], _Queue] = {}
        self._open: set[_Call] = set()
        """Calls without an answer."""
        self._deadlines: list[tuple[float, int, _Call]] = []
        """Heap of deadlines; an entry of a call that has another deadline by now, or is not open, is ignored."""
        self._numbers = itertools.count()
        self._finished: deque[tuple[_Call, Message | None, str]] = deque()
        self._is_finishing = False

    def call(
        self,
        service_type: type[Service[Request, Response]],
        name: str,
        request: Request,
        done: Done[Response],
        *,
        sender: int = 0,
        timeout_s: float | None = None,
    ) -> None:
        """Call a service; the request is sent as soon as the service is found and it is the sender's turn.

        `timeout_s`: longest wait for the service, and then for its answer; default: that of this object.
        """
        key = (name, service_type)
        queue = self._queues.get(key)
        if queue is None:
            queue = self._queues[key] = _Queue(name, self._node.create_client(service_type, name))
        call = _Call(queue, sender, request, done, self._timeout_s if timeout_s is None else timeout_s)
        self._open.add(call)
        self._set_deadline(call)
        queue.waiting.put(sender, call)
        self._send(queue)
        self._finish_all()
        if self._open:
            self._wake()

    def poll(self) -> bool:
        """Send waiting calls and end those that timed out; return whether calls are open."""
        now_s = time.monotonic()
        while self._deadlines and self._deadlines[0][0] <= now_s:
            deadline_s, _, call = heapq.heappop(self._deadlines)
            if call in self._open and call.deadline_s == deadline_s:
                self._time_out(call)
        for queue in list(self._queues.values()):
            self._send(queue)
        self._finish_all()
        return bool(self._open)

    def forget(self, name: str) -> None:
        """Remove a service that no longer exists: its open calls fail."""
        for key in [key for key in self._queues if key[0] == name]:
            queue = self._queues.pop(key)
            for call in [*queue.in_flight, *queue.waiting]:
                self._finish(call, None, f"service {name} no longer exists")
            self._node.destroy_client(queue.client)
        self._finish_all()

    def cancel(self, sender: int) -> None:
        """End all open calls of a sender, which fail."""
        for call in [call for call in self._open if call.sender == sender]:
            future = call.queue.in_flight.get(call)
            if future is not None:
                call.queue.client.remove_pending_request(future)
            self._finish(call, None, f"call of {call.queue.name} canceled")
        self._finish_all()

    def forget_gone(self, names: Container[str]) -> None:
        """Remove services that are not among `names` and have no open calls."""
        gone = {queue.name for queue in self._queues.values() if queue.name not in names}
        for name in gone - {call.queue.name for call in self._open}:
            self.forget(name)

    def _send(self, queue: _Queue) -> None:
        """Send waiting calls within the limits."""
        if not queue.waiting or not queue.client.service_is_ready():
            return
        while queue.waiting and queue.has_room:
            try:
                call = queue.waiting.pop(queue.is_free)
            except IndexError:
                return
            try:
                future = queue.client.call_async(call.request)
            except Exception as error:  # the request has a value that rclpy cannot convert
                self._finish(call, None, f"{queue.name}: cannot send the request: {error}")
                continue
            queue.in_flight[call] = future
            self._set_deadline(call)
            future.add_done_callback(partial(self._answered, call))

    def _answered(self, call: _Call, future: Future[Any]) -> None:
        """Finish an answered call. Must not raise: an exception would end rclpy's events executor and the process."""
        if future.cancelled() or call not in self._open:
            return
        error = future.exception()
        self._finish(call, None if error else future.result(), f"service {call.queue.name} failed: {error}")
        self._send(call.queue)
        self._finish_all()

    def _time_out(self, call: _Call) -> None:
        future = call.queue.in_flight.get(call)
        if future is not None:
            call.queue.client.remove_pending_request(future)
        self._finish(call, None, f"no answer from {call.queue.name} within {call.timeout_s:g} s")

    def _set_deadline(self, call: _Call) -> None:
        call.deadline_s = time.monotonic() + call.timeout_s
        heapq.heappush(self._deadlines, (call.deadline_s, next(self._numbers), call))

    def _finish(self, call: _Call, response: Message | None, reason: str) -> None:
        """Remove an open call; `_finish_all` calls its callback."""
        self._open.remove(call)
        if not self._open:
            self._deadlines.clear()
        if call.queue.in_flight.pop(call, None) is None:
            call.queue.waiting.remove(call.sender, call)
        self._finished.append((call, response, "" if response is not None else reason))

    def _finish_all(self) -> None:
        """Call the callbacks of finished calls. The outermost `_finish_all` also handles calls that these finish."""
        if self._is_finishing:
            return
        self._is_finishing = True
        try:
            while self._finished:
                call, response, reason = self._finished.popleft()
                try:
                    call.done(response, reason)
                except Exception:
                    self._node.get_logger().error(
                        f"internal error (please report): the callback for an answer of {call.queue.name} failed:\n"
                        f"{traceback.format_exc()}"
                    )
        finally:
            self._is_finishing = False
