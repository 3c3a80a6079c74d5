"""C structures of rosidl 4.6 and its Fast DDS type support 3.6 (ROS 2 Jazzy), declared with ctypes.

They follow the headers of rosidl_runtime_c, rosidl_typesupport_fastrtps_cpp and rosidl_typesupport_introspection_c in
the releases `KNOWN`; another order or size of a field would crash the process. `typesupport` fills them.
"""

from __future__ import annotations

import ctypes

__all__ = [
    "INTROSPECTION_MESSAGE",
    "KNOWN",
    "NESTED_UNBOUNDED_SEQUENCE",
    "Callbacks",
    "ConvertFromPython",
    "ConvertToPython",
    "Create",
    "Deserialize",
    "Destroy",
    "Dispatch",
    "Field",
    "FieldType",
    "Getter",
    "IndividualTypeDescription",
    "Member",
    "Members",
    "Sequence",
    "Serialize",
    "SerializedSize",
    "String",
    "TypeDescription",
    "TypeHash",
    "TypeSource",
    "TypeSupport",
]

KNOWN = {"rosidl_runtime_c": (4, 6), "rosidl_typesupport_fastrtps_c": (3, 6)}
INTROSPECTION_MESSAGE = 18  # rosidl_typesupport_introspection_c: field_types.h
NESTED_UNBOUNDED_SEQUENCE = 145  # type_description_interfaces/msg/FieldType


class String(ctypes.Structure):
    """rosidl_runtime_c__String; `size` does not count the final NUL."""

    _fields_ = (("data", ctypes.c_void_p), ("size", ctypes.c_size_t), ("capacity", ctypes.c_size_t))


class Sequence(ctypes.Structure):
    """Any rosidl sequence: address of the elements, their number, allocated number."""

    _fields_ = (("data", ctypes.c_void_p), ("size", ctypes.c_size_t), ("capacity", ctypes.c_size_t))


class FieldType(ctypes.Structure):
    _fields_ = (
        ("type_id", ctypes.c_uint8),
        ("capacity", ctypes.c_uint64),
        ("string_capacity", ctypes.c_uint64),
        ("nested_type_name", String),
    )


class Field(ctypes.Structure):
    _fields_ = (("name", String), ("type", FieldType), ("default_value", String))


class IndividualTypeDescription(ctypes.Structure):
    _fields_ = (("type_name", String), ("fields", Sequence))


class TypeDescription(ctypes.Structure):
    _fields_ = (("type_description", IndividualTypeDescription), ("referenced_type_descriptions", Sequence))


class TypeSource(ctypes.Structure):
    _fields_ = (("type_name", String), ("encoding", String), ("raw_file_contents", String))


class TypeHash(ctypes.Structure):
    _fields_ = (("version", ctypes.c_uint8), ("value", ctypes.c_uint8 * 32))


class Callbacks(ctypes.Structure):
    """message_type_support_callbacks_t of rosidl_typesupport_fastrtps_cpp; also used by the C type support."""

    _fields_ = (
        ("message_namespace", ctypes.c_char_p),
        ("message_name", ctypes.c_char_p),
        ("cdr_serialize", ctypes.c_void_p),
        ("cdr_deserialize", ctypes.c_void_p),
        ("get_serialized_size", ctypes.c_void_p),
        ("max_serialized_size", ctypes.c_void_p),
        ("key_callbacks", ctypes.c_void_p),
    )


class Member(ctypes.Structure):
    """rosidl_typesupport_introspection_c__MessageMember."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("type_id", ctypes.c_uint8),
        ("string_upper_bound", ctypes.c_size_t),
        ("members", ctypes.c_void_p),
        ("is_key", ctypes.c_bool),
        ("is_array", ctypes.c_bool),
        ("array_size", ctypes.c_size_t),
        ("is_upper_bound", ctypes.c_bool),
        ("offset", ctypes.c_uint32),
        ("default_value", ctypes.c_void_p),
        ("size_function", ctypes.c_void_p),
        ("get_const_function", ctypes.c_void_p),
        ("get_function", ctypes.c_void_p),
        ("fetch_function", ctypes.c_void_p),
        ("assign_function", ctypes.c_void_p),
        ("resize_function", ctypes.c_void_p),
    )


class Members(ctypes.Structure):
    """rosidl_typesupport_introspection_c__MessageMembers."""

    _fields_ = (
        ("message_namespace", ctypes.c_char_p),
        ("message_name", ctypes.c_char_p),
        ("member_count", ctypes.c_uint32),
        ("size_of", ctypes.c_size_t),
        ("has_any_key_member", ctypes.c_bool),
        ("members", ctypes.c_void_p),
        ("init_function", ctypes.c_void_p),
        ("fini_function", ctypes.c_void_p),
    )


Serialize = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_void_p)  # message, Cdr
Deserialize = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_void_p)  # Cdr, message
SerializedSize = ctypes.CFUNCTYPE(ctypes.c_uint32, ctypes.c_void_p)
# What rclpy finds in a message class (rosidl_generator_py); they are called with the lock of the interpreter.
Create = ctypes.PYFUNCTYPE(ctypes.c_void_p)
ConvertFromPython = ctypes.PYFUNCTYPE(ctypes.c_bool, ctypes.py_object, ctypes.c_void_p)
ConvertToPython = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.POINTER(ctypes.py_object))
Destroy = ctypes.PYFUNCTYPE(None, ctypes.c_void_p)

Dispatch = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p)
Getter = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p)


class TypeSupport(ctypes.Structure):
    """rosidl_message_type_support_t."""

    _fields_ = (
        ("identifier", ctypes.c_char_p),
        ("data", ctypes.c_void_p),
        ("dispatch", Dispatch),
        ("get_type_hash", Getter),
        ("get_type_description", Getter),
        ("get_sources", Getter),
    )
