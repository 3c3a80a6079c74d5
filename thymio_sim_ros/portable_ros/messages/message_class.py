"""The classes of messages and services, made from their definitions with the attributes that rosidl's classes have."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from thymio_sim_ros.portable_ros.messages.definitions import Field, FieldType, Shape, definition
from thymio_sim_ros.portable_ros.messages.field_checks import Check, check_of
from thymio_sim_ros.portable_ros.messages.field_values import FieldValues, values_of
from thymio_sim_ros.portable_ros.messages.interface_files import SERVICE_PARTS, is_service, module_of
from thymio_sim_ros.portable_ros.messages.primitives import PRIMITIVES
from thymio_sim_ros.portable_ros.rosidl_parser.definition import (
    AbstractNestableType,
    AbstractType,
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    BoundedWString,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
    UnboundedWString,
)

__all__ = [
    "EMPTY_FIELD",
    "Member",
    "Message",
    "MsgT",
    "Service",
    "SrvRequestT",
    "SrvResponseT",
    "message_type",
    "service_type",
]

EMPTY_FIELD = "structure_needs_at_least_one_member"
"""The field of a serialized message without fields."""

MsgT = TypeVar("MsgT", bound="Message")
SrvRequestT = TypeVar("SrvRequestT", bound="Message")
SrvResponseT = TypeVar("SrvResponseT", bound="Message")

_CHECKED = os.environ.get("ROS_PYTHON_CHECK_FIELDS") == "1"


@dataclass(frozen=True, slots=True)
class Member:
    """A field of a class: `slot` has its value, `wire` is the attribute that is serialized."""

    field: Field
    values: FieldValues
    check: Check
    slot: str

    @property
    def wire(self) -> str:
        """The slot itself unless its value is converted."""
        return self.slot if self.values.to_wire is None else f"_wire{self.slot}"


class Message:
    """Base of all classes of messages."""

    __slots__: ClassVar[Any] = ("_check_fields",)
    SLOT_TYPES: ClassVar[tuple[AbstractType, ...]] = ()
    TYPE_NAME: ClassVar[str] = ""
    """The full name, such as `std_msgs/msg/Bool`."""
    members: ClassVar[tuple[Member, ...]] = ()
    _fields_and_field_types: ClassVar[dict[str, str]] = {}
    _check_fields: bool
    structure_needs_at_least_one_member = 0

    def __init__(self, **kwargs: Any) -> None:
        self._check_fields = is_checked = kwargs.pop("check_fields", _CHECKED)
        if is_checked and not kwargs.keys() <= self._fields_and_field_types.keys():
            unknown = ", ".join(sorted(kwargs.keys() - self._fields_and_field_types.keys()))
            raise AssertionError(f"Invalid arguments passed to constructor: {unknown}")
        for member in self.members:
            name = member.field.name
            if name in kwargs:
                value, given = kwargs[name], member.values.given
                setattr(self, name, value if given is None else given(value))
            else:
                setattr(self, member.slot, member.values.default())

    def __repr__(self) -> str:
        *package, _ = type(self).__module__.split(".")
        texts = (f"{name}={_shown(getattr(self, name))}" for name in self._fields_and_field_types)
        return f"{'.'.join([*package, type(self).__name__])}({', '.join(texts)})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, type(self)):
            return False
        return all(_are_equal(getattr(self, one.slot), getattr(other, one.slot)) for one in self.members)

    __hash__ = None  # type: ignore[assignment]  # messages can be changed

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """The names of the fields and their types in IDL."""
        return dict(cls._fields_and_field_types)


class Service(Generic[SrvRequestT, SrvResponseT]):
    """Base of all classes of services."""

    TYPE_NAME: ClassVar[str] = ""
    Request: type[SrvRequestT]
    Response: type[SrvResponseT]
    Event: type[Message]

    def __init__(self) -> None:
        raise NotImplementedError("Service classes can not be instantiated")


def _shown(value: Any) -> str:
    """A value as a message shows it: arrays by their elements."""
    if isinstance(value, np.ndarray) or not hasattr(value, "typecode"):
        return repr(value)
    return repr(value.tolist())


def _are_equal(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return bool(np.array_equal(one, other))
    return bool(one == other)


@functools.cache
def message_type(name: str) -> Any:
    """The class of a message by its full name, such as `std_msgs/msg/Bool`. Raises KeyError if there is none."""
    of, short = definition(name), name.rpartition("/")[2]
    members = tuple(
        Member(field, values_of(field, message_type), check_of(field, message_type), f"_{field.name}")
        for field in of.fields
    )
    constants = {one.name: one.value for one in of.constants}
    for member in members:
        if member.field.default is not None:
            constants[f"{member.field.name.upper()}__DEFAULT"] = member.values.default()
    namespace: dict[str, Any] = {
        "__slots__": [member.slot for member in members],
        "__module__": module_of(name),
        "__doc__": f"Message class '{short}'.",
        "SLOT_TYPES": tuple(_slot_type(field.type) for field in of.fields),
        "TYPE_NAME": name,
        "members": members,
        "_fields_and_field_types": {field.name: _idl(field.type) for field in of.fields},
        **constants,
    }
    for member in members:
        namespace[member.field.name] = _property(member)
        if member.values.to_wire is not None:
            namespace[member.wire] = _wire_property(member, member.values.to_wire)
    # As rosidl's: constants are properties of the class of the class, so that they cannot be assigned.
    metaclass = type(f"Metaclass_{short}", (type,), {one: _constant(value) for one, value in constants.items()})
    made = metaclass(short, (Message,), namespace)
    made.__slots__ = [*made.__slots__, "_check_fields"]  # as rosidl's; the base has this one
    return made


@functools.cache
def service_type(name: str) -> Any:
    """The class of a service by its full name, such as `std_srvs/srv/Empty`. Raises KeyError if there is none."""
    if not is_service(name):
        raise KeyError(name)
    parts = {part: message_type(f"{name}_{part}") for part in SERVICE_PARTS}
    return type(name.rpartition("/")[2], (Service,), {"__module__": module_of(name), "TYPE_NAME": name, **parts})


def _constant(value: Any) -> property:
    return property(lambda _: value)


def _property(member: Member) -> property:
    slot, check, kept = member.slot, member.check, member.values.kept

    def get(self: Message) -> Any:
        return getattr(self, slot)

    def assign(self: Message, value: Any) -> None:
        is_ready = self._check_fields and check(value)
        setattr(self, slot, value if kept is None or is_ready else kept(value))

    return property(get, assign, doc=f"Message field '{member.field.name}'.")


def _wire_property(member: Member, convert: Callable[[Any], Any]) -> property:
    slot = member.slot
    return property(lambda self: convert(getattr(self, slot)))


def _nestable(of: FieldType) -> AbstractNestableType:
    if not of.is_primitive:
        package, form, short = of.base.split("/")
        return NamespacedType([package, form], short)
    if of.base == "string":
        return BoundedString(of.text_bound) if of.text_bound else UnboundedString()
    if of.base == "wstring":
        return BoundedWString(of.text_bound) if of.text_bound else UnboundedWString()
    return BasicType(PRIMITIVES[of.base].idl)


def _slot_type(of: FieldType) -> AbstractType:
    inner = _nestable(of)
    if of.shape is Shape.SCALAR:
        return inner
    if of.shape is Shape.ARRAY:
        return Array(inner, of.size)
    return BoundedSequence(inner, of.size) if of.size else UnboundedSequence(inner)


def _idl(of: FieldType) -> str:
    """The name of a type in IDL, as `get_fields_and_field_types` has it."""
    if of.is_primitive:
        inner = f"{of.base}<{of.text_bound}>" if of.text_bound else PRIMITIVES[of.base].idl
    else:
        package, _, short = of.base.split("/")
        inner = f"{package}/{short}"
    if of.shape is Shape.ARRAY:
        return f"{inner}[{of.size}]"
    if of.shape is Shape.SEQUENCE:
        return f"sequence<{inner}, {of.size}>" if of.size else f"sequence<{inner}>"
    return inner


def is_message_type(kind: object) -> bool:
    """Whether an object is a class of messages."""
    return isinstance(kind, type) and issubclass(kind, Message) and kind is not Message


def is_service_type(kind: object) -> bool:
    """Whether an object is a class of services."""
    return isinstance(kind, type) and issubclass(kind, Service) and kind is not Service
