"""The classes of messages and services that the room itself uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros.messages.message_class import message_type, service_type

if TYPE_CHECKING:
    from builtin_interfaces.msg import Duration as DurationMessage
    from builtin_interfaces.msg import Time as TimeMessage
    from rcl_interfaces.msg import (
        FloatingPointRange,
        IntegerRange,
        ListParametersResult,
        Log,
        LoggerLevel,
        ParameterDescriptor,
        ParameterEvent,
        ParameterType,
        ParameterValue,
        SetLoggerLevelsResult,
        SetParametersResult,
    )
    from rcl_interfaces.msg import Parameter as ParameterMessage
    from rcl_interfaces.srv import (
        DescribeParameters,
        GetLoggerLevels,
        GetParameters,
        GetParameterTypes,
        ListParameters,
        SetLoggerLevels,
        SetParameters,
        SetParametersAtomically,
    )
    from rosgraph_msgs.msg import Clock
else:
    Clock = message_type("rosgraph_msgs/msg/Clock")
    DurationMessage = message_type("builtin_interfaces/msg/Duration")
    FloatingPointRange = message_type("rcl_interfaces/msg/FloatingPointRange")
    IntegerRange = message_type("rcl_interfaces/msg/IntegerRange")
    ListParametersResult = message_type("rcl_interfaces/msg/ListParametersResult")
    Log = message_type("rcl_interfaces/msg/Log")
    LoggerLevel = message_type("rcl_interfaces/msg/LoggerLevel")
    ParameterDescriptor = message_type("rcl_interfaces/msg/ParameterDescriptor")
    ParameterEvent = message_type("rcl_interfaces/msg/ParameterEvent")
    ParameterMessage = message_type("rcl_interfaces/msg/Parameter")
    ParameterType = message_type("rcl_interfaces/msg/ParameterType")
    ParameterValue = message_type("rcl_interfaces/msg/ParameterValue")
    SetLoggerLevelsResult = message_type("rcl_interfaces/msg/SetLoggerLevelsResult")
    SetParametersResult = message_type("rcl_interfaces/msg/SetParametersResult")
    TimeMessage = message_type("builtin_interfaces/msg/Time")

    DescribeParameters = service_type("rcl_interfaces/srv/DescribeParameters")
    GetLoggerLevels = service_type("rcl_interfaces/srv/GetLoggerLevels")
    GetParameterTypes = service_type("rcl_interfaces/srv/GetParameterTypes")
    GetParameters = service_type("rcl_interfaces/srv/GetParameters")
    ListParameters = service_type("rcl_interfaces/srv/ListParameters")
    SetLoggerLevels = service_type("rcl_interfaces/srv/SetLoggerLevels")
    SetParameters = service_type("rcl_interfaces/srv/SetParameters")
    SetParametersAtomically = service_type("rcl_interfaces/srv/SetParametersAtomically")

__all__ = [
    "Clock",
    "DescribeParameters",
    "DurationMessage",
    "FloatingPointRange",
    "GetLoggerLevels",
    "GetParameterTypes",
    "GetParameters",
    "IntegerRange",
    "ListParameters",
    "ListParametersResult",
    "Log",
    "LoggerLevel",
    "ParameterDescriptor",
    "ParameterEvent",
    "ParameterMessage",
    "ParameterType",
    "ParameterValue",
    "SetLoggerLevels",
    "SetLoggerLevelsResult",
    "SetParameters",
    "SetParametersAtomically",
    "SetParametersResult",
    "TimeMessage",
]
