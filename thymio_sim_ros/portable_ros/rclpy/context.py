"""Contexts: arguments, domain and lifetime of the nodes that belong to one."""

from __future__ import annotations

import os
import threading
import weakref
from collections.abc import Callable, Sequence
from types import MethodType, TracebackType
from typing import Any

from thymio_sim_ros.portable_ros.graph.arguments import Arguments, parse
from thymio_sim_ros.portable_ros.graph.entity import Handle
from thymio_sim_ros.portable_ros.graph.graph import Graph, graph_of
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError, RCLInvalidROSArgsError
from thymio_sim_ros.portable_ros.rclpy.exceptions import NotInitializedException

__all__ = ["Context", "default_domain"]

_DOMAIN_VARIABLE = "ROS_DOMAIN_ID"


class Context:
    """What several nodes share. `init` and `shutdown` start and end it; a `with` block does both."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._callbacks: list[Callable[[], Any]] = []
        self._handle: Handle | None = None
        self._is_ok = False
        self._graph: Graph | None = None
        self.arguments = Arguments()
        """The arguments of the process."""

    @property
    def handle(self) -> Handle | None:
        """The handle, None before `init`."""
        return self._handle

    @property
    def graph(self) -> Graph:
        """The graph of the domain. Raises NotInitializedException before `init`."""
        if self._graph is None:
            raise NotInitializedException("cannot create node")
        return self._graph

    def init(
        self, args: Sequence[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        """Initialize. Raises RuntimeError the second time, UnknownROSArgsError and RCLError for wrong arguments."""
        with self._lock:
            if self._handle is not None:
                raise RuntimeError("Context.init() must only be called once")
            if domain_id is not None and domain_id < 0:
                raise RuntimeError(f"Domain id ({domain_id}) should not be lower than zero.")
            try:
                self.arguments = parse(args)
            except RCLInvalidROSArgsError as error:
                raise RCLError(f"failed to initialize rcl: {error}") from error
            self._graph = graph_of(default_domain() if domain_id is None else domain_id)
            self._handle, self._is_ok = Handle("Context"), True
            if initialize_logging:
                self.arguments.apply_log_levels()

    def ok(self) -> bool:
        """Whether the context is initialized and not shut down."""
        return self._is_ok

    def require_ok(self, failure: str) -> None:
        """Raise RCLError if the context is not usable; `failure` says what cannot be done."""
        if not self.ok():
            reason = "either rcl_init() was not called or rcl_shutdown() was called."
            raise RCLError(f"{failure}: the given context is not valid, {reason}")

    def destroy(self) -> None:
        """Shut down."""
        self.try_shutdown()

    def shutdown(self) -> None:
        """Shut down and call all callbacks. Raises RuntimeError if it is not initialized or has been shut down."""
        with self._lock:
            if self._handle is None:
                raise RuntimeError("Context must be initialized before it can be shutdown")
            if not self._is_ok:
                raise RCLError("failed to shutdown: rcl_shutdown already called on the given context")
            self._is_ok = False
            callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            callback()

    def try_shutdown(self) -> None:
        """Shut down unless that has been done."""
        with self._lock:
            if self._is_ok:
                self.shutdown()

    def on_shutdown(self, callback: Callable[[], Any]) -> None:
        """Call back at the shutdown; the objects of methods are not kept alive. At once after the shutdown."""
        if not callable(callback):
            raise TypeError(f"callback should be a callable, got {type(callback)}")
        with self._lock:
            if self._handle is None or self._is_ok:
                self._callbacks = [one for one in self._callbacks if not isinstance(one, _Method) or one.is_alive]
                self._callbacks.append(_Method(callback) if isinstance(callback, MethodType) else callback)
                return
        callback()

    def wait_for(self, condition: Callable[[], bool], timeout_s: float | None, what: str) -> None:
        """Wait until a condition of the graph is true, for a shutdown, or until the time is over.

        None and negative times stand for a wait without end; `what` names what is waited for.
        """
        self.on_shutdown(self.graph.notify)
        self.graph.wait_for(lambda: not self._is_ok or condition(), timeout_s, what)

    def get_domain_id(self) -> int:
        """The ROS domain. Raises RuntimeError before `init`."""
        if self._graph is None:
            raise RuntimeError("Context must be initialized before it can have a domain id")
        return self._graph.domain_id

    def __enter__(self) -> Context:
        self.init()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.try_shutdown()


class _Method:
    """A method whose object may be deleted."""

    def __init__(self, method: MethodType) -> None:
        self._method = weakref.WeakMethod(method)

    @property
    def is_alive(self) -> bool:
        """Whether the object exists."""
        return self._method() is not None

    def __call__(self) -> None:
        method = self._method()
        if method is not None:
            method()


def default_domain() -> int:
    """The domain of contexts that choose none."""
    return int(os.environ.get(_DOMAIN_VARIABLE) or 0)
