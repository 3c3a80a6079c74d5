"""Service calls that wait for nobody: lazy clients, readiness and time-outs by polling."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future

__all__ = ["CALL_TIMEOUT_S", "Calls"]

CALL_TIMEOUT_S = 5.0
_IN_FLIGHT = 5
"""Calls of one service at a time: its middleware keeps ten requests and drops the rest without a word."""

Done = Callable[[Any, str], None]
"""Called once: with the response and "", or with None and the reason."""


@dataclass(slots=True)
class _Call:
    client: Client
    name: str
    request: Any
    done: Done
    deadline_s: float
    future: Future | None = None


class Calls:
    """All calls of the bridge. Belongs to the executor's thread; `poll` must be called while it returns True."""

    def __init__(
        self, node: Node, *, wake: Callable[[], None] = lambda: None, timeout_s: float = CALL_TIMEOUT_S
    ) -> None:
        self._node = node
        self._wake = wake
        self._timeout_s = timeout_s
        self._clients: dict[tuple[str, Any], Client] = {}
        self._open: list[_Call] = []

    def call(self, service_type: Any, name: str, request: Any, done: Done) -> None:
        """Call a service; the request leaves as soon as the service is found."""
        key = (name, service_type)
        client = self._clients.get(key)
        if client is None:
            client = self._clients[key] = self._node.create_client(service_type, name)
        self._open.append(_Call(client, name, request, done, time.monotonic() + self._timeout_s))
        self.poll()
        self._wake()

    def poll(self) -> bool:
        """Send what can be sent, give up what is too old; whether calls are open still."""
        now_s = time.monotonic()
        for call in list(self._open):
            if now_s >= call.deadline_s:
                self._give_up(call)
            elif call.future is None and self._may_leave(call):
                call.deadline_s = now_s + self._timeout_s
                try:
                    call.future = call.client.call_async(call.request)
                except Exception as error:  # of a request that ROS cannot carry
                    self._finish(call, None, f"{call.name} cannot be asked this: {error}")
                    continue
                call.future.add_done_callback(lambda future, call=call: self._answered(call, future))
        return bool(self._open)

    def _may_leave(self, call: _Call) -> bool:
        in_flight = sum(1 for other in self._open if other.client is call.client and other.future is not None)
        return in_flight < _IN_FLIGHT and bool(call.client.service_is_ready())

    def forget(self, name: str) -> None:
        """The service is gone: its open calls fail, its client ends."""
        for call in [call for call in self._open if call.name == name]:
            self._finish(call, None, f"service {name} is gone")
        for key in [key for key in self._clients if key[0] == name]:
            self._node.destroy_client(self._clients.pop(key))

    def _answered(self, call: _Call, future: Future) -> None:
        """Nothing may be raised here: rclpy's events executor dies of it, with all that share its process."""
        if future.cancelled():
            return
        error = future.exception()
        reason = f"service {call.name} failed: {error}" if error else ""
        try:
            self._finish(call, None if error else future.result(), reason)
            self.poll()
        except Exception:
            self._node.get_logger().error(f"the answer of {call.name} is lost:\n{traceback.format_exc()}")

    def _give_up(self, call: _Call) -> None:
        if call.future is not None:
            call.client.remove_pending_request(call.future)
        self._finish(call, None, f"no answer from {call.name} within {self._timeout_s:g} s")

    def _finish(self, call: _Call, response: Any, reason: str) -> None:
        if call in self._open:
            self._open.remove(call)
            call.done(response, reason)
