"""Callbacks for changes of parameters of any node."""

from __future__ import annotations

import threading
from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import chain
from typing import Any, TypeVar

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
from thymio_sim_ros.portable_ros.rclpy.event_handler import SubscriptionEventCallbacks
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile, qos_profile_parameter_events
from thymio_sim_ros.portable_ros.rclpy.qos_overriding_options import QoSOverridingOptions

__all__ = ["ParameterCallbackHandle", "ParameterEventCallbackHandle", "ParameterEventHandler"]

T = TypeVar("T")


@dataclass(frozen=True, slots=True, eq=False)
class ParameterCallbackHandle:
    """The registration of a callback for a parameter of a node; `callback` gets its message."""

    parameter_name: str
    node_name: str
    callback: Callable[[ros_types.ParameterMessage], object]


@dataclass(frozen=True, slots=True, eq=False)
class ParameterEventCallbackHandle:
    """The registration of a callback for all messages of `/parameter_events`."""

    callback: Callable[[ros_types.ParameterEvent], object]


class _Callbacks:
    """The callbacks of a handler; the last one that was added is called first."""

    def __init__(self) -> None:
        self.parameter_callbacks: defaultdict[tuple[str, str], list[ParameterCallbackHandle]] = defaultdict(list)
        self.event_callbacks: list[ParameterEventCallbackHandle] = []
        self._lock = threading.Lock()

    def event_callback(self, event: Any) -> None:
        """Call all callbacks that an event concerns."""
        with self._lock:
            of_parameters = [(key, list(handles)) for key, handles in self.parameter_callbacks.items()]
            of_events = list(self.event_callbacks)
        for (parameter_name, node_name), handles in of_parameters:
            parameter = ParameterEventHandler.get_parameter_from_event(event, parameter_name, node_name)
            if parameter is not None:
                for one in handles:
                    one.callback(parameter)
        for other in of_events:
            other.callback(event)

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[ros_types.ParameterMessage], object]
    ) -> ParameterCallbackHandle:
        """Call back for a parameter of a node with this full name."""
        handle = ParameterCallbackHandle(parameter_name, node_name, callback)
        with self._lock:
            self.parameter_callbacks[parameter_name, node_name].insert(0, handle)
        return handle

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Undo `add_parameter_callback`. Raises RuntimeError for an unknown handle."""
        key = handle.parameter_name, handle.node_name
        with self._lock:
            _remove(self.parameter_callbacks[key], handle)
            if not self.parameter_callbacks[key]:
                del self.parameter_callbacks[key]

    def add_parameter_event_callback(
        self, callback: Callable[[ros_types.ParameterEvent], object]
    ) -> ParameterEventCallbackHandle:
        """Call back for all events."""
        handle = ParameterEventCallbackHandle(callback)
        with self._lock:
            self.event_callbacks.insert(0, handle)
        return handle

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Undo `add_parameter_event_callback`. Raises RuntimeError for an unknown handle."""
        with self._lock:
            _remove(self.event_callbacks, handle)


def _remove(handles: list[T], handle: T) -> None:
    if handle not in handles:
        raise RuntimeError("Callback doesn't exist")
    handles.remove(handle)


class ParameterEventHandler:
    """Calls callbacks for new and changed parameters."""

    Callbacks = _Callbacks

    def __init__(
        self,
        node: Node,
        qos_profile: QoSProfile = qos_profile_parameter_events,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> None:
        self.node, self.qos_profile = node, qos_profile
        self._callbacks = ParameterEventHandler.Callbacks()
        self.parameter_event_subscription = node.create_subscription(
            ros_types.ParameterEvent,
            "/parameter_events",
            self._callbacks.event_callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )

    def destroy(self) -> None:
        """Call back no more."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    @staticmethod
    def get_parameter_from_event(
        event: ros_types.ParameterEvent, parameter_name: str, node_name: str
    ) -> ros_types.ParameterMessage | None:
        """The message of a parameter of a node, None if the event is not about it."""
        if event.node != node_name:
            return None
        parameters = ParameterEventHandler.get_parameters_from_event(event)
        return next((one for one in parameters if one.name == parameter_name), None)

    @staticmethod
    def get_parameters_from_event(event: ros_types.ParameterEvent) -> Iterable[ros_types.ParameterMessage]:
        """The messages of all new and changed parameters."""
        yield from chain(event.new_parameters, event.changed_parameters)

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[ros_types.ParameterMessage], object]
    ) -> ParameterCallbackHandle:
        """Call back for a parameter of a node, whose name may be relative to the namespace of this one."""
        return self._callbacks.add_parameter_callback(parameter_name, self._resolve_path(node_name), callback)

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Undo `add_parameter_callback`. Raises RuntimeError for an unknown handle."""
        self._callbacks.remove_parameter_callback(handle)

    def add_parameter_event_callback(
        self, callback: Callable[[ros_types.ParameterEvent], object]
    ) -> ParameterEventCallbackHandle:
        """Call back for all events."""
        return self._callbacks.add_parameter_event_callback(callback)

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Undo `add_parameter_event_callback`. Raises RuntimeError for an unknown handle."""
        self._callbacks.remove_parameter_event_callback(handle)

    def _resolve_path(self, node_path: str | None = None) -> str:
        """The full name of a node, by default of this one."""
        if not node_path:
            return self.node.get_fully_qualified_name()
        return node_path if node_path.startswith("/") else f"{self.node.get_namespace().rstrip('/')}/{node_path}"
