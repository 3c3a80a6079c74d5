"""The definitions of messages: their fields and constants, as their texts have them or as rosidl adds them."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass

from thymio_sim_ros.portable_ros.messages.definition_text import Constant, Field, FieldType, Section, Shape, parsed
from thymio_sim_ros.portable_ros.messages.interface_files import (
    ACTION_PARTS,
    ACTION_SERVICES,
    FEEDBACK_MESSAGE,
    SERVICE_PARTS,
    is_action,
    is_service,
    sections,
    snake_case,
)

__all__ = ["Constant", "Definition", "Field", "FieldType", "Shape", "definition", "structure"]


@dataclass(frozen=True, slots=True)
class Definition:
    """A message; `name` is full, such as `std_msgs/msg/Bool`."""

    name: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...] = ()


@functools.cache
def definition(name: str) -> Definition:
    """The definition of a message by its full name.

    Raises KeyError if there is none, DefinitionError if it is wrong.
    """
    if "" in sections(name):
        return _parsed(name, sections(name)[""])
    owner, _, part = name.rpartition("_")
    if part in sections(owner):
        return _parsed(name, sections(owner)[part])
    if part == "Event" and is_service(owner):
        event = (Field(one.lower(), FieldType(f"{owner}_{one}", Shape.SEQUENCE, 1)) for one in SERVICE_PARTS[:2])
        return Definition(name, (Field("info", FieldType("service_msgs/msg/ServiceEventInfo")), *event))
    for added, fields in _ADDED.items():
        action = name.removesuffix(f"_{added}")
        if action != name and is_action(action):
            return _composed(name, {field: base.format(action=action) for field, base in fields.items()})
    raise KeyError(name)


_GOAL_ID = {"goal_id": "unique_identifier_msgs/msg/UUID"}
_ADDED = {
    "SendGoal_Request": {**_GOAL_ID, "goal": "{action}_Goal"},
    "SendGoal_Response": {"accepted": "bool", "stamp": "builtin_interfaces/msg/Time"},
    "GetResult_Request": _GOAL_ID,
    "GetResult_Response": {"status": "int8", "result": "{action}_Result"},
    FEEDBACK_MESSAGE: {**_GOAL_ID, "feedback": "{action}_Feedback"},
}
"""The messages that rosidl adds to an action: the types of their fields by their names."""


def structure(name: str) -> Definition:
    """What stands for an interface in descriptions and hashes of types: a service or an action has its parts as fields.

    Raises KeyError if there is no such interface.
    """
    if is_service(name):
        return _composed(name, {f"{part.lower()}_message": f"{name}_{part}" for part in SERVICE_PARTS})
    if is_action(name):
        services = {f"{snake_case(one)}_service": f"{name}_{one}" for one in ACTION_SERVICES}
        parts = {part.lower(): f"{name}_{part}" for part in ACTION_PARTS}
        return _composed(name, {**parts, **services, snake_case(FEEDBACK_MESSAGE): f"{name}_{FEEDBACK_MESSAGE}"})
    return definition(name)


def _composed(name: str, fields: Mapping[str, str]) -> Definition:
    return Definition(name, tuple(Field(field, FieldType(base)) for field, base in fields.items()))


def _parsed(name: str, section: Section) -> Definition:
    fields, constants = parsed(section, name.partition("/")[0], lambda base: base != name and "" in sections(base))
    return Definition(name, tuple(fields), tuple(constants))
