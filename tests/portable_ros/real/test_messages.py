"""The classes of messages that the room makes, compared with those of the ROS wheels."""

from __future__ import annotations

import array
import importlib
import json
from collections.abc import Iterator
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message

from thymio_sim_ros.portable_ros.messages import cdr, interface_files
from thymio_sim_ros.portable_ros.messages.action_class import action_type
from thymio_sim_ros.portable_ros.messages.definitions import Field, FieldType, Shape, definition
from thymio_sim_ros.portable_ros.messages.interface_files import (
    ACTION_PARTS,
    ACTION_SERVICES,
    FEEDBACK_MESSAGE,
    FORMS,
    SERVICE_PARTS,
)
from thymio_sim_ros.portable_ros.messages.message_class import message_type, service_type
from thymio_sim_ros.portable_ros.messages.primitives import PRIMITIVES
from thymio_sim_ros.portable_ros.messages.type_descriptions import type_hash
from thymio_sim_ros.ros.foxglove.schemas import share_folders

NOT_IN_WHEELS = {
    "action_tutorials_interfaces",
    "composition_interfaces",
    "example_interfaces",
    "irobot_create_msgs",
    "tf2_msgs",
    "turtlebot3_msgs",
    "turtlesim",
}
OPTIONAL = {one for one in ("test_msgs",) if PathFinder.find_spec(one) is None}  # not what our hook serves
PACKAGES = sorted(interface_files.PACKAGES - NOT_IN_WHEELS - OPTIONAL)


def _messages() -> Iterator[str]:
    for package in PACKAGES:
        for name in interface_files.interfaces(package):
            yield from interface_files.messages(f"{package}/{name}")


def _names(form: str) -> list[str]:
    return [f"{package}/{form}/{short}" for package in PACKAGES for short in interface_files.names(package, form)]


MESSAGES = tuple(_messages())


def _real(name: str) -> Any:
    package, form, short = name.split("/")
    module = importlib.import_module(f"{package}.{form}")
    # The module of a package does not have all parts of an action.
    return getattr(module if hasattr(module, short) else importlib.import_module(message_type(name).__module__), short)


def _share(package: str) -> Path:
    return next(folder / package for folder in share_folders() if (folder / package).is_dir())


@pytest.mark.parametrize("package", PACKAGES)
def test_the_definitions_are_all_those_of_the_package(package: str) -> None:
    share = _share(package)
    for form in FORMS:
        files = share.glob(f"{form}/*.{form}")
        assert sorted(interface_files.names(package, form)) == sorted(one.stem for one in files)


@pytest.mark.parametrize("package", PACKAGES)
def test_hashes_of_all_types_are_those_of_the_package(package: str) -> None:
    share = _share(package)
    for name in interface_files.interfaces(package):
        found = json.loads((share / f"{name}.json").read_text())["type_hashes"]
        for one in found:
            assert type_hash(one["type_name"]) == one["hash_string"], one["type_name"]


@pytest.mark.parametrize("name", MESSAGES)
def test_a_class_has_the_attributes_of_the_real_one(name: str) -> None:
    ours, real = message_type(name), _real(name)
    assert ours.__module__ == real.__module__
    assert ours.__name__ == real.__name__
    assert ours.get_fields_and_field_types() == real.get_fields_and_field_types()
    assert list(map(_type_text, ours.SLOT_TYPES)) == list(map(_type_text, real.SLOT_TYPES))
    assert list(ours.__slots__) == list(real.__slots__)
    assert repr(ours()) == repr(real())
    for constant in definition(name).constants:
        value = getattr(real, constant.name)
        assert getattr(ours, constant.name) == value
        assert type(getattr(ours, constant.name)) is type(value)
    defaults = [one for one in vars(real) if one.endswith("__DEFAULT")]
    assert [one for one in vars(ours) if one.endswith("__DEFAULT")] == defaults
    for default in defaults:
        assert repr(getattr(ours, default)) == repr(getattr(real, default))


def _type_text(kind: Any) -> str:
    """A type of a field as text, by the attributes that the classes of rosidl_parser have."""
    names = ("typename", "namespaces", "name", "value_type", "size", "maximum_size")
    values = {name: getattr(kind, name) for name in names if hasattr(kind, name)}
    inner = {name: _type_text(value) if name == "value_type" else value for name, value in values.items()}
    return f"{type(kind).__name__}{inner}"


@pytest.mark.parametrize("name", _names("srv"))
def test_a_service_has_the_messages_of_the_real_one(name: str) -> None:
    ours, real = service_type(name), _real(name)
    assert (ours.__name__, ours.__module__) == (real.__name__, real.__module__)
    for part in SERVICE_PARTS:
        assert getattr(ours, part) is message_type(f"{name}_{part}")
        assert getattr(real, part).__name__ == getattr(ours, part).__name__
    with pytest.raises(NotImplementedError, match=_refusal_to_make(real)):
        ours()


@pytest.mark.parametrize("name", _names("action"))
def test_an_action_has_the_messages_and_services_of_the_real_one(name: str) -> None:
    ours, real = action_type(name), _real(name)
    assert (ours.__name__, ours.__module__) == (real.__name__, real.__module__)
    for part in ACTION_PARTS:
        assert getattr(ours, part) is message_type(f"{name}_{part}")
        assert getattr(real, part).__name__ == getattr(ours, part).__name__
    ends = [one for one in vars(real.Impl) if not one.startswith("_")]
    assert [one for one in vars(ours.Impl) if not one.startswith("_")] == ends
    for end in ends:
        one, other = getattr(ours.Impl, end), getattr(real.Impl, end)
        assert (one.__name__, one.__module__) == (other.__name__, other.__module__)
    assert ours.Impl.FeedbackMessage is message_type(f"{name}_{FEEDBACK_MESSAGE}")
    assert ours.Impl.SendGoalService is service_type(f"{name}_{ACTION_SERVICES[0]}")
    with pytest.raises(NotImplementedError, match=_refusal_to_make(real)):
        ours()


def _refusal_to_make(kind: Any) -> str:
    with pytest.raises(NotImplementedError) as caught:
        kind()
    return str(caught.value)


def _values(of: FieldType, depth: int = 0) -> st.SearchStrategy[Any]:
    """Values of a field, as `_made` makes messages of them; sequences of messages in messages are short."""
    if of.shape is Shape.ARRAY:
        return st.lists(_values(FieldType(of.base), depth), min_size=of.size, max_size=of.size)
    if of.shape is Shape.SEQUENCE:
        longest = 3 if of.is_primitive else max(0, 2 - depth)
        inner = _values(FieldType(of.base, text_bound=of.text_bound), depth + 1)
        return st.lists(inner, max_size=min(of.size or longest, longest))
    if not of.is_primitive:
        return st.tuples(*(_values(field.type, depth) for field in definition(of.base).fields))
    primitive = PRIMITIVES[of.base]
    if primitive.limits is not None:
        return st.integers(*primitive.limits)
    if primitive.python is float:
        bound = 2.0**127 if primitive.idl == "float" else None  # the check of rosidl refuses the largest floats
        width: Literal[32, 64] = 64 if bound is None else 32
        return st.floats(None if bound is None else -bound, bound, allow_nan=False, width=width)
    if primitive.python is bytes:
        return st.binary(min_size=1, max_size=1)
    if primitive.python is bool:
        return st.booleans()
    letters = st.characters(exclude_characters="\0", exclude_categories=["Cs"])
    return st.text(letters, max_size=8)


def _made(name: str, values: tuple[Any, ...], class_of: Any) -> Any:
    """A message of the values of its fields; `class_of` returns our class or the real one."""

    def value_of(field: Field, value: Any) -> Any:
        if field.type.is_primitive:
            return value
        if field.type.shape is Shape.SCALAR:
            return _made(field.type.base, value, class_of)
        return [_made(field.type.base, one, class_of) for one in value]

    pairs = zip(definition(name).fields, values, strict=True)
    return class_of(name)(**{field.name: value_of(field, value) for field, value in pairs})


@pytest.mark.parametrize("name", MESSAGES)
@settings(max_examples=5, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_messages_have_the_bytes_and_the_text_of_the_real_ones(name: str, data: st.DataObject) -> None:
    values = data.draw(_values(FieldType(name)))
    ours, real = _made(name, values, message_type), _made(name, values, _real)
    assert repr(ours) == repr(real)
    our_bytes, real_bytes = cdr.serialize(ours), serialize_message(real)
    assert len(our_bytes) <= len(real_bytes)  # rmw_fastrtps estimates the size and appends what it does not use
    # Fast CDR does not write the gaps between fields; ours are zero.
    differing = [at for at, (one, other) in enumerate(zip(our_bytes, real_bytes, strict=False)) if one != other]
    assert not any(our_bytes[at] for at in differing)
    assert cdr.serialize(cdr.deserialize(real_bytes, message_type(name))) == our_bytes
    assert deserialize_message(our_bytes, _real(name)) == deserialize_message(real_bytes, _real(name))
    assert cdr.deserialize(our_bytes, message_type(name)) == ours


WRONG = [
    True,
    1,
    2**70,
    -(2**70),
    1.5,
    1e300,
    "text",
    b"x",
    b"xyz",
    None,
    [],
    [1],
    [1.5],
    ["a"],
    [b"a"],
    [2**70],
    {"a"},
]


@pytest.mark.parametrize("name", MESSAGES)
def test_checked_fields_refuse_the_same_values_with_the_same_sentences(name: str) -> None:
    ours, real = message_type(name)(check_fields=True), _real(name)(check_fields=True)
    for field in definition(name).fields:
        for value in WRONG:
            assert _refusal(ours, field.name, value) == _refusal(real, field.name, value), (field, value)


def _refusal(message: Any, name: str, value: Any) -> str:
    try:
        setattr(message, name, value)
    except (AssertionError, OverflowError, TypeError, ValueError) as error:
        return f"{type(error).__name__}: {error}".partition("\n")[0]  # pytest adds lines in files named *_test.py
    return ""


def test_arrays_are_checked_as_the_real_ones() -> None:
    for name, field, values in (
        ("sensor_msgs/msg/Imu", "orientation_covariance", (np.zeros(9, np.float32), np.zeros(8), np.zeros(9))),
        ("sensor_msgs/msg/JointState", "position", (array.array("f", [1]), array.array("d", [1]))),
        ("shape_msgs/msg/SolidPrimitive", "dimensions", (array.array("d", [1] * 4), array.array("d", [1] * 3))),
    ):
        ours, real = message_type(name)(check_fields=True), _real(name)(check_fields=True)
        for value in values:
            assert _refusal(ours, field, value) == _refusal(real, field, value)
            assert (getattr(ours, field) is value) == (getattr(real, field) is value)


def test_unknown_arguments_are_refused_where_fields_are_checked() -> None:
    for kind in (message_type("std_msgs/msg/Bool"), _real("std_msgs/msg/Bool")):
        assert kind(nonsense=1, check_fields=False) == kind()
        with pytest.raises(AssertionError, match="Invalid arguments passed to constructor: nonsense"):
            kind(nonsense=1, check_fields=True)
