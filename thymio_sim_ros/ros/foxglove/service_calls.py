"""Service calls without a blocking wait: clients created on demand, readiness and time-outs by polling.

Every call belongs to the queue of its service, which serves its senders in turn. A call costs the same however many are
open. Callbacks run one after the other, never inside one another, whatever they call.
"""

from __future__ import annotations

import time
import traceback
from collections import OrderedDict, deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future

from thymio_sim_ros.ros.rclpy_ext.fair_queue import FairQueue

__all__ = ["CALL_TIMEOUT_S", "ServiceCalls"]

CALL_TIMEOUT_S = 5.0
_IN_FLIGHT = 5
"""Calls of one service at a time: its middleware keeps ten requests and drops the rest without a word."""

_IN_FLIGHT_EACH = 2
"""Of these at most so many of one sender, so that a slow service is not busy with one sender alone."""

Done = Callable[[Any, str], None]
"""Called once: with the response and "", or with None and the reason."""


@dataclass(slots=True, eq=False)
class _Queue:
    """Calls of one service."""

    name: str
    client: Client
    waiting: FairQueue[int, _Call] = field(default_factory=FairQueue)
    in_flight: dict[_Call, Future] = field(default_factory=dict)

    def is_free(self, sender: int) -> bool:
        """Whether a call of this sender may be sent."""
        return sum(call.sender == sender for call in self.in_flight) < _IN_FLIGHT_EACH


@dataclass(slots=True, eq=False)
class _Call:
    queue: _Queue
    sender: int
    request: Any
    done: Done
    deadline_s: float


class ServiceCalls:
    """All calls of the bridge. Belongs to the executor's thread; `poll` must be called while it returns True."""

    def __init__(
        self, node: Node, *, wake: Callable[[], None] = lambda: None, timeout_s: float = CALL_TIMEOUT_S
    ) -> None:
        self._node = node
        self._wake = wake
        self._timeout_s = timeout_s
        self._queues: dict[tuple[str, Any], _Queue] = {}
        self._open: OrderedDict[_Call, None] = OrderedDict()
        """In the order of their deadlines."""
        self._finished: deque[tuple[_Call, Any, str]] = deque()
        self._is_finishing = False

    def call(self, service_type: Any, name: str, request: Any, done: Done, *, sender: int = 0) -> None:
        """Call a service; the request leaves as soon as the service is found and the senders before it were served."""
        key = (name, service_type)
        queue = self._queues.get(key)
        if queue is None:
            queue = self._queues[key] = _Queue(name, self._node.create_client(service_type, name))
        call = _Call(queue, sender, request, done, time.monotonic() + self._timeout_s)
        self._open[call] = None
        queue.waiting.put(sender, call)
        self._send(queue)
        self._finish_all()
        if self._open:
            self._wake()

    def poll(self) -> bool:
        """Send what can be sent, give up what is too old; whether calls are open still."""
        now_s = time.monotonic()
        while self._open and (call := next(iter(self._open))).deadline_s <= now_s:
            self._time_out(call)
        for queue in list(self._queues.values()):
            self._send(queue)
        self._finish_all()
        return bool(self._open)

    def forget(self, name: str) -> None:
        """The service is gone: its open calls fail, its client ends."""
        for key in [key for key in self._queues if key[0] == name]:
            queue = self._queues.pop(key)
            for call in [*queue.in_flight, *queue.waiting]:
                self._finish(call, None, f"service {name} is gone")
            self._node.destroy_client(queue.client)
        self._finish_all()

    def _send(self, queue: _Queue) -> None:
        """Send waiting calls as far as the service takes them."""
        if not queue.waiting or not queue.client.service_is_ready():
            return
        while queue.waiting and len(queue.in_flight) < _IN_FLIGHT:
            try:
                call = queue.waiting.pop(queue.is_free)
            except IndexError:
                return
            try:
                future = queue.client.call_async(call.request)
            except Exception as error:  # of a request that ROS cannot carry
                self._finish(call, None, f"{queue.name} cannot be asked this: {error}")
                continue
            queue.in_flight[call] = future
            call.deadline_s = time.monotonic() + self._timeout_s
            self._open.move_to_end(call)
            future.add_done_callback(lambda future, call=call: self._answered(call, future))

    def _answered(self, call: _Call, future: Future) -> None:
        """Nothing may be raised here: rclpy's events executor dies of it, with all that share its process."""
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
        self._finish(call, None, f"no answer from {call.queue.name} within {self._timeout_s:g} s")

    def _finish(self, call: _Call, response: Any, reason: str) -> None:
        """Take an open call out; its callback is left to `_finish_all`."""
        del self._open[call]
        if call.queue.in_flight.pop(call, None) is None:
            call.queue.waiting.remove(call.sender, call)
        self._finished.append((call, response, "" if response is not None else reason))

    def _finish_all(self) -> None:
        """Call back for finished calls. A callback may call and finish others: the outermost of us does it for them."""
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
                        f"internal error (please report): the answer of {call.queue.name} is lost:\n"
                        f"{traceback.format_exc()}"
                    )
        finally:
            self._is_finishing = False
