"""The classes of messages and services that the room itself uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros.messages.message_class import message_type, service_type

if TYPE_CHECKING:
    from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
    from action_msgs.srv import CancelGoal
    from builtin_interfaces.msg import Duration as DurationMessage
    from builtin_interfaces.msg import Time as TimeMessage
    from lifecycle_msgs.msg import State, Transition, TransitionDescription, TransitionEvent
    from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState
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
    from service_msgs.msg import ServiceEventInfo
    from type_description_interfaces.srv import GetTypeDescription
    from unique_identifier_msgs.msg import UUID
else:
    Clock = message_type("rosgraph_msgs/msg/Clock")
    DurationMessage = message_type("builtin_interfaces/msg/Duration")
    FloatingPointRange = message_type("rcl_interfaces/msg/FloatingPointRange")
    GoalInfo = message_type("action_msgs/msg/GoalInfo")
    GoalStatus = message_type("action_msgs/msg/GoalStatus")
    GoalStatusArray = message_type("action_msgs/msg/GoalStatusArray")
    IntegerRange = message_type("rcl_interfaces/msg/IntegerRange")
    ListParametersResult = message_type("rcl_interfaces/msg/ListParametersResult")
    Log = message_type("rcl_interfaces/msg/Log")
    LoggerLevel = message_type("rcl_interfaces/msg/LoggerLevel")
    ParameterDescriptor = message_type("rcl_interfaces/msg/ParameterDescriptor")
    ParameterEvent = message_type("rcl_interfaces/msg/ParameterEvent")
    ParameterMessage = message_type("rcl_interfaces/msg/Parameter")
    ParameterType = message_type("rcl_interfaces/msg/ParameterType")
    ParameterValue = message_type("rcl_interfaces/msg/ParameterValue")
    ServiceEventInfo = message_type("service_msgs/msg/ServiceEventInfo")
    SetLoggerLevelsResult = message_type("rcl_interfaces/msg/SetLoggerLevelsResult")
    SetParametersResult = message_type("rcl_interfaces/msg/SetParametersResult")
    State = message_type("lifecycle_msgs/msg/State")
    TimeMessage = message_type("builtin_interfaces/msg/Time")
    Transition = message_type("lifecycle_msgs/msg/Transition")
    TransitionDescription = message_type("lifecycle_msgs/msg/TransitionDescription")
    TransitionEvent = message_type("lifecycle_msgs/msg/TransitionEvent")
    UUID = message_type("unique_identifier_msgs/msg/UUID")

    CancelGoal = service_type("action_msgs/srv/CancelGoal")
    ChangeState = service_type("lifecycle_msgs/srv/ChangeState")
    DescribeParameters = service_type("rcl_interfaces/srv/DescribeParameters")
    GetAvailableStates = service_type("lifecycle_msgs/srv/GetAvailableStates")
    GetAvailableTransitions = service_type("lifecycle_msgs/srv/GetAvailableTransitions")
    GetLoggerLevels = service_type("rcl_interfaces/srv/GetLoggerLevels")
    GetParameterTypes = service_type("rcl_interfaces/srv/GetParameterTypes")
    GetParameters = service_type("rcl_interfaces/srv/GetParameters")
    GetState = service_type("lifecycle_msgs/srv/GetState")
    GetTypeDescription = service_type("type_description_interfaces/srv/GetTypeDescription")
    ListParameters = service_type("rcl_interfaces/srv/ListParameters")
    SetLoggerLevels = service_type("rcl_interfaces/srv/SetLoggerLevels")
    SetParameters = service_type("rcl_interfaces/srv/SetParameters")
    SetParametersAtomically = service_type("rcl_interfaces/srv/SetParametersAtomically")

__all__ = [
    "UUID",
    "CancelGoal",
    "ChangeState",
    "Clock",
    "DescribeParameters",
    "DurationMessage",
    "FloatingPointRange",
    "GetAvailableStates",
    "GetAvailableTransitions",
    "GetLoggerLevels",
    "GetParameterTypes",
    "GetParameters",
    "GetState",
    "GetTypeDescription",
    "GoalInfo",
    "GoalStatus",
    "GoalStatusArray",
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
    "ServiceEventInfo",
    "SetLoggerLevels",
    "SetLoggerLevelsResult",
    "SetParameters",
    "SetParametersAtomically",
    "SetParametersResult",
    "State",
    "TimeMessage",
    "Transition",
    "TransitionDescription",
    "TransitionEvent",
]
