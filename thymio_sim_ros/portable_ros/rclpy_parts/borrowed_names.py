"""Names that modules of rclpy have from other modules, and that programs import from there.

`from rclpy.node import Node, Publisher` works with rclpy, since its module `node` imports the class `Publisher`, and
editors write such imports. The import hook serves these names, and stubs have them; the modules of the room do not need
them.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

__all__ = ["BORROWED", "lookup", "sources"]

MsgType = TypeVar("MsgType")
SrvType = TypeVar("SrvType")
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")

_TYPES = "rclpy_parts.borrowed_names"
_OF_SERVICES = "SrvType SrvTypeRequest SrvTypeResponse"
BORROWED: Mapping[str, Mapping[str, str]] = {
    "rclpy": {
        "typing": "List Optional",
        "rclpy.signals": "install_signal_handlers uninstall_signal_handlers",
    },
    "rclpy.action.client": {
        "action_msgs.msg": "GoalStatus",
        "action_msgs.srv": "CancelGoal",
        "rclpy.waitable": "NumberOfEntities Waitable",
        "unique_identifier_msgs.msg": "UUID",
    },
    "rclpy.action.server": {
        "action_msgs.msg": "GoalInfo GoalStatus",
        "rclpy.waitable": "NumberOfEntities Waitable",
    },
    "rclpy.client": {
        "typing": "Dict Optional",
        "rclpy.callback_groups": "CallbackGroup",
        "rclpy.clock": "Clock",
        "rclpy.context": "Context",
        "rclpy.qos": "QoSProfile",
        _TYPES: _OF_SERVICES,
    },
    "rclpy.clock": {"typing": "Optional", "rclpy.context": "Context"},
    "rclpy.event_handler": {
        "typing": "List Optional",
        "rclpy.callback_groups": "CallbackGroup",
        "rclpy.waitable": "Waitable",
    },
    "rclpy.executors": {
        "typing": "Any Coroutine Generator List Optional Set Tuple Type TypeVar Union",
        "rclpy.client": "Client",
        "rclpy.clock": "Clock",
        "rclpy.clock_type": "ClockType",
        "rclpy.context": "Context",
        "rclpy.exceptions": "InvalidHandle",
        "rclpy.guard_condition": "GuardCondition",
        "rclpy.service": "Service",
        "rclpy.subscription": "Subscription",
        "rclpy.task": "Future Task",
        "rclpy.timer": "Timer",
        "rclpy.utilities": "get_default_context timeout_sec_to_nsec",
        "rclpy.waitable": "NumberOfEntities Waitable",
    },
    "rclpy.experimental": {"rclpy.experimental.events_executor": "EventsExecutor"},
    "rclpy.lifecycle.node": {"typing": "Callable Dict NamedTuple Optional Set", "rclpy.service": "Service"},
    "rclpy.lifecycle.publisher": {"typing": "Union", _TYPES: "MsgType"},
    "rclpy.node": {
        "typing": "Any Callable Dict Iterator List Optional Tuple Type TypeVar Union",
        "rcl_interfaces.msg": "FloatingPointRange IntegerRange ListParametersResult ParameterDescriptor ParameterEvent"
        " ParameterType ParameterValue SetParametersResult",
        "rcl_interfaces.srv": "ListParameters",
        "rclpy.callback_groups": "CallbackGroup MutuallyExclusiveCallbackGroup ReentrantCallbackGroup",
        "rclpy.client": "Client",
        "rclpy.clock": "Clock ROSClock",
        "rclpy.constants": "S_TO_NS",
        "rclpy.context": "Context",
        "rclpy.event_handler": "PublisherEventCallbacks SubscriptionEventCallbacks",
        "rclpy.exceptions": "InvalidHandle InvalidParameterTypeException InvalidParameterValueException"
        " InvalidTopicNameException NotInitializedException ParameterAlreadyDeclaredException"
        " ParameterImmutableException ParameterNotDeclaredException ParameterUninitializedException",
        "rclpy.executors": "Executor",
        "rclpy.expand_topic_name": "expand_topic_name",
        "rclpy.guard_condition": "GuardCondition",
        "rclpy.logging": "get_logger",
        "rclpy.parameter": "PARAMETER_SEPARATOR_STRING",
        "rclpy.publisher": "Publisher",
        "rclpy.qos": "QoSProfile qos_profile_services_default",
        "rclpy.qos_overriding_options": "QoSOverridingOptions",
        "rclpy.service": "Service",
        "rclpy.subscription": "Subscription",
        "rclpy.timer": "Rate Timer",
        "rclpy.topic_endpoint_info": "TopicEndpointInfo",
        "rclpy.type_support": "check_is_valid_msg_type check_is_valid_srv_type",
        "rclpy.utilities": "get_default_context",
        "rclpy.waitable": "Waitable",
        _TYPES: f"MsgType {_OF_SERVICES}",
    },
    "rclpy.parameter": {"typing": "Dict List Optional Tuple Union"},
    "rclpy.parameter_client": {
        "typing": "List Optional Union",
        "rcl_interfaces.msg": "ParameterEvent",
        "rcl_interfaces.srv": "DescribeParameters GetParameters GetParameterTypes ListParameters SetParameters"
        " SetParametersAtomically",
    },
    "rclpy.parameter_event_handler": {
        "typing": "Dict List Optional Tuple",
        "rcl_interfaces.msg": "ParameterEvent",
        "rclpy.parameter": "Parameter",
    },
    "rclpy.publisher": {
        "typing": "TypeVar Union",
        "rclpy.callback_groups": "CallbackGroup",
        "rclpy.event_handler": "EventHandler PublisherEventCallbacks",
        _TYPES: "MsgType",
    },
    "rclpy.qos": {"typing": "Union"},
    "rclpy.service": {
        "typing": "TypeVar",
        "rclpy.callback_groups": "CallbackGroup",
        "rclpy.clock": "Clock",
        "rclpy.qos": "QoSProfile",
        _TYPES: _OF_SERVICES,
    },
    "rclpy.subscription": {
        "typing": "TypeVar",
        "rclpy.event_handler": "EventHandler SubscriptionEventCallbacks",
        _TYPES: "MsgType",
    },
    "rclpy.timer": {
        "typing": "Optional",
        "rclpy.callback_groups": "CallbackGroup",
        "rclpy.clock": "Clock",
        "rclpy.context": "Context",
    },
}
"""Names by the module of rclpy that has them and the module that they are from."""

_ROOM = __package__.rpartition(".")[0]


def sources(module: str) -> dict[str, str]:
    """The modules of the names that a module of rclpy has from others, by these names."""
    return {
        name: f"{_ROOM}.{place}" if place.startswith("rclpy") else place
        for place, names in BORROWED.get(module, {}).items()
        for name in names.split()
    }


def lookup(module: str, before: Callable[[str], Any] | None) -> Callable[[str], Any]:
    """The `__getattr__` of a module of rclpy, which may have had one before."""
    places = sources(module)

    def get(name: str) -> Any:
        if name in places:
            return getattr(importlib.import_module(places[name]), name)
        if before is not None:
            return before(name)
        raise AttributeError(f"module {module!r} has no attribute {name!r}")

    return get
