"""Loads slow values of a parameter on a separate thread while the node continues.

rclpy sets parameters inside a service callback, and the events executor has no asynchronous callbacks. So the callbacks
of the two services are replaced: a request that sets the parameter is answered later, once its value has been loaded.
rclpy's own callback then runs as usual on the executor's thread and uses the loaded value.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from queue import SimpleQueue
from typing import Any, Generic, TypeVar

from rcl_interfaces.msg import ParameterType, SetParametersResult
from rclpy.node import Node
from rclpy.service import Service

from thymio_sim_ros.ros.rclpy_ext.mailbox import Mailbox

__all__ = ["MAX_WAITING", "DeferredLoad"]

T = TypeVar("T")

MAX_WAITING = 4
"""Pending requests, including the one that is being loaded; each may contain 32 MB of text."""
_SERVICES = ("/set_parameters", "/set_parameters_atomically")


@dataclass(slots=True)
class _Request(Generic[T]):
    """A pending request, returned by the service callback in place of a response."""

    value: str
    answer: Callable[[Any], None]
    header: Any = None
    loaded: T | Exception | None = None


class DeferredLoad(Generic[T]):
    """Loads the values of one string parameter. Invariant: only the executor's thread uses loaded values."""

    def __init__(self, node: Node, parameter: str, load: Callable[[str], T]) -> None:
        """`load` is also called on another thread; it must not change state of the node's thread."""
        self._parameter, self._load = parameter, load
        self._queue: SimpleQueue[_Request[T] | None] = SimpleQueue()
        self._thread: threading.Thread | None = None
        self._mailbox: Mailbox[_Request[T]] = Mailbox(node, self._finish)
        self._waiting = 0
        self._is_closed = False
        self._ready: _Request[T] | None = None
        for service in node.services:
            if service.srv_name.endswith(_SERVICES):
                self._defer(service)

    def load(self, value: str) -> T:
        """Return the loaded value, from the pending request that is being answered or by loading it now.

        Raises what the `load` function raises.
        """
        if self._ready is None or self._ready.value != value or self._ready.loaded is None:
            return self._load(value)
        if isinstance(self._ready.loaded, Exception):
            raise self._ready.loaded
        return self._ready.loaded

    def close(self) -> None:
        """Stop loading and answering; a value that is being loaded is dropped."""
        self._is_closed = True
        self._queue.put(None)  # ends the thread
        self._mailbox.close()

    def _defer(self, service: Service) -> None:
        """Make a service of rclpy answer later if a request sets the parameter."""
        set_now, send_now = service.callback, service.send_response

        def on_request(request: Any, response: Any) -> Any:
            values = [
                one.value.string_value
                for one in request.parameters
                if one.name == self._parameter and one.value.type == ParameterType.PARAMETER_STRING
            ]
            if not values:
                return set_now(request, response)
            if len(values) > 1:
                return _refused(request, response, f"{self._parameter} is set {len(values)} times, expected once")
            if self._waiting >= MAX_WAITING:
                return _refused(request, response, f"{self._waiting} other values of {self._parameter} are loading")
            self._waiting += 1
            return _Request(values[0], lambda header: send_now(set_now(request, response), header))

        def send(response: Any, header: Any) -> None:
            if isinstance(response, _Request):
                response.header = header
                self._begin(response)
            else:
                send_now(response, header)

        service.callback = on_request
        service.send_response = send  # type: ignore[method-assign]  # executors look it up for each response

    def _begin(self, waiting: _Request[T]) -> None:
        self._queue.put(waiting)
        if self._thread is None:
            # A daemon thread: Ctrl-C does not wait until a playground is loaded.
            self._thread = threading.Thread(target=self._run, name=f"load {self._parameter}", daemon=True)
            self._thread.start()

    def _run(self) -> None:
        while (waiting := self._queue.get()) is not None and not self._is_closed:
            try:
                waiting.loaded = self._load(waiting.value)
            except Exception as error:
                waiting.loaded = error
            self._mailbox.post(waiting)
            del waiting

    def _finish(self, waiting: _Request[T]) -> None:
        self._waiting -= 1
        self._ready = waiting
        try:
            waiting.answer(waiting.header)
        finally:
            self._ready = None


def _refused(request: Any, response: Any, reason: str) -> Any:
    """Return the response with a rejection for every parameter."""
    refusal = SetParametersResult(successful=False, reason=reason)
    if hasattr(response, "results"):
        response.results = [refusal] * len(request.parameters)
    else:
        response.result = refusal
    return response
