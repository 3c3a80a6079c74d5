"""Type support at run time for a ROS message type `T[] name`, from the compiled type support of `T`.

rmw_fastrtps needs four things of a type: Fast DDS callbacks (for serialized messages it only uses the name in them), an
introspection table, from which it creates the DDS type object, the type hash, and the description of the type with its
sources. For a message whose only field is an unbounded sequence of an installed type, all four follow from that type.
ctypes structures can therefore replace the generated library (docs/spec/ros-packaging.md section 1.3).

Without a codec such a type only supports serialized messages: `publisher.publish(bytes)` and subscriptions with
`raw=True`. With a codec it also supports message objects. The C message that rclpy passes to the middleware is then
one reference to a Python object: the bytes that the codec made of a message that is published, or the message that it
made of received bytes. The Fast DDS callbacks copy these bytes to and from the buffer of Fast CDR by three of its
functions that raise no C++ exceptions, since an exception could not pass through Python.

Python handles Ctrl-C between two instructions of any Python function, also of one that C calls; the KeyboardInterrupt
is then lost and C gets 0. Therefore a pointer that C uses without a check (of a table, of a new message, of a message
for Python) comes from a callable that is implemented in C, such as a filled `functools.cache`, which has no such
instructions.

The middleware does not report when it stops using a structure; therefore everything that is built here is kept until
the process ends. The alternative, compiling tf2_msgs on the user's computer, would take a minute and one ABI for each
Python version.
"""

from __future__ import annotations

import ctypes
import functools
import logging
import operator
import os
import struct
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.compat import rosidl_structs

__all__ = [
    "Codec",
    "Conversions",
    "SequenceType",
    "TypeSupportError",
    "build",
    "check_layouts",
    "conversions",
    "release_of",
    "type_hash_of",
]

_LOG = logging.getLogger(__name__)

_C = b"rosidl_typesupport_c"
_FASTRTPS = b"rosidl_typesupport_fastrtps_c"
_INTROSPECTION = b"rosidl_typesupport_introspection_c"
_HASH_PREFIX = "RIHS01_"

_KNOWN_RMW = "rmw_fastrtps_cpp"

_FAST_CDR = "libfastcdr.so.2"
_FAST_CDR_FUNCTIONS = {
    "buffer": ("_ZN8eprosima7fastcdr3Cdr18get_buffer_pointerEv", ctypes.c_void_p, []),
    "position": ("_ZN8eprosima7fastcdr3Cdr20get_current_positionEv", ctypes.c_void_p, []),
    "jump": ("_ZN8eprosima7fastcdr3Cdr4jumpEm", ctypes.c_bool, [ctypes.c_size_t]),
}
_ENCAPSULATION = 4
"""Bytes before the content of a serialized message."""

_LARGEST_STEP = 30
"""Binary logarithm of the longest step with which the end of a buffer is searched."""


class TypeSupportError(ThymioSimError, RuntimeError):
    """The structures of the installed ROS are not known; the text says what differs."""


@dataclass(frozen=True, slots=True)
class SequenceType:
    """A message type with one field, an unbounded sequence of messages of another package."""

    package: str
    name: str
    field: str
    element: str  # "geometry_msgs/msg/TransformStamped"
    type_hash: str  # "RIHS01_" and 64 hexadecimal digits

    @property
    def full_name(self) -> str:
        """Name in the ROS graph, `package/msg/Name`."""
        return f"{self.package}/msg/{self.name}"

    @property
    def definition(self) -> str:
        """Text of the .msg file."""
        package, _, element = self.element.split("/")
        return f"{package}/{element}[] {self.field}\n"


@dataclass(frozen=True, slots=True)
class Codec:
    """Conversion of messages to serialized messages (CDR with its encapsulation) and back.

    `decode` raises ValueError for bytes that are not such a message.
    """

    encode: Callable[[Any], bytes]
    decode: Callable[[bytes], Any]


class Conversions(NamedTuple):
    """The four functions of a message class that rclpy calls for message objects, as capsules."""

    create: object
    convert_from_py: object
    convert_to_py: object
    destroy: object


# Own prototypes: `ctypes.pythonapi` is shared with other modules, so its argtypes must not be changed.
_capsule_new = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)(
    ("PyCapsule_New", ctypes.pythonapi)
)
_capsule_name = ctypes.PYFUNCTYPE(ctypes.c_char_p, ctypes.py_object)(("PyCapsule_GetName", ctypes.pythonapi))
_capsule_pointer = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.py_object, ctypes.c_char_p)(
    ("PyCapsule_GetPointer", ctypes.pythonapi)
)
_keep_for_ever = ctypes.PYFUNCTYPE(None, ctypes.py_object)(("Py_IncRef", ctypes.pythonapi))


_release = ctypes.PYFUNCTYPE(None, ctypes.py_object)(("Py_DecRef", ctypes.pythonapi))


def release_of(package: str) -> tuple[int, int] | None:
    """Major and minor version of an installed ROS package from its package.xml; None if it is not installed."""
    prefixes = [*filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)), sys.prefix]
    for prefix in prefixes:
        manifest = Path(prefix, "share", package, "package.xml")
        if manifest.is_file():
            major, minor, *_ = ElementTree.parse(manifest).getroot().findtext("version", "0.0").split(".")
            return int(major), int(minor)
    return None


def check_layouts(rmw: str) -> None:
    """Raise TypeSupportError unless the running middleware `rmw` and the installed rosidl are the known ones."""
    if rmw != _KNOWN_RMW:
        raise TypeSupportError(f"found middleware {rmw}, expected {_KNOWN_RMW}")
    for package, known in rosidl_structs.KNOWN.items():
        found = release_of(package)
        if found != known:
            text = "none" if found is None else "{}.{}".format(*found)
            raise TypeSupportError(f"{package}: found release {text}, expected {'{}.{}'.format(*known)}")


def type_hash_of(message_type: type) -> str:
    """Type hash of a message class as text. Raises TypeSupportError if its type support is not loaded."""
    support = _support_of(message_type)
    found = rosidl_structs.TypeHash.from_address(support.get_type_hash(ctypes.addressof(support)))
    return f"RIHS{found.version:02d}_{bytes(found.value).hex()}"


def build(message: SequenceType, element_type: type, codec: Codec | None = None) -> object:
    """Return a capsule with the type support of `message`; `element_type` is the compiled class of its elements.

    `check_layouts` must have been called. Message objects need a `codec` and `conversions`. Raises TypeSupportError if
    the type support of the element or Fast CDR lacks a part.

    The result has the structure of generated code: a top handle whose `dispatch` function returns the handle of the
    requested implementation (Fast DDS or introspection) by its identifier.
    """
    element = _support_of(element_type)
    keep: list[object] = []
    handles = {
        _FASTRTPS: _handle(_FASTRTPS, _callbacks(message, element, codec, keep), keep),
        _INTROSPECTION: _handle(_INTROSPECTION, _members(message, element, keep), keep),
    }
    addresses = {identifier: ctypes.addressof(handle) for identifier, handle in handles.items()}
    type_hash = _hash(message)
    description, sources = _description(message, element, keep), _sources(message, element, keep)
    getters = [_getter(part, keep) for part in (type_hash, description, sources)]
    # Called only during the creation of a publisher or subscription, in the thread that creates it.
    dispatch = rosidl_structs.Dispatch(functools.cache(lambda _handle, identifier: addresses.get(identifier)))
    top = rosidl_structs.TypeSupport(_C)
    for handle in (top, *handles.values()):
        handle.dispatch = dispatch
        handle.get_type_hash, handle.get_type_description, handle.get_sources = getters
        for getter in getters:  # fills the caches
            getter(ctypes.addressof(handle))
        for identifier in handles:
            dispatch(ctypes.addressof(handle), identifier)
    keep += [top, dispatch, handles]
    _keep_for_ever(keep)
    return _capsule_new(ctypes.addressof(top), None, None)


def _support_of(message_type: type) -> rosidl_structs.TypeSupport:
    capsule = message_type.__class__._TYPE_SUPPORT  # type: ignore[attr-defined]  # set by rosidl's metaclass
    if capsule is None:
        raise TypeSupportError(f"the type support of {message_type.__name__} is not loaded")
    return rosidl_structs.TypeSupport.from_address(_capsule_pointer(capsule, _capsule_name(capsule)))


def _part(element: rosidl_structs.TypeSupport, identifier: bytes) -> rosidl_structs.TypeSupport:
    address = element.dispatch(ctypes.addressof(element), identifier)
    if not address:
        raise TypeSupportError(f"the type of the elements has no {identifier.decode()}")
    return rosidl_structs.TypeSupport.from_address(address)


def _handle(identifier: bytes, data: ctypes.Structure, keep: list[object]) -> rosidl_structs.TypeSupport:
    keep.append(data)
    return rosidl_structs.TypeSupport(identifier, ctypes.addressof(data))


def _getter(part: ctypes.Structure, keep: list[object]) -> Any:
    address = ctypes.addressof(part)
    function = rosidl_structs.Getter(functools.cache(lambda _handle: address))
    keep += [part, function]
    return function


def _callbacks(
    message: SequenceType, element: rosidl_structs.TypeSupport, codec: Codec | None, keep: list[object]
) -> rosidl_structs.Callbacks:
    """A copy of the element's callbacks under the name of the message; both types are unbounded in size."""
    data = _part(element, _FASTRTPS).data
    callbacks = rosidl_structs.Callbacks.from_buffer_copy(
        ctypes.string_at(data, ctypes.sizeof(rosidl_structs.Callbacks))
    )
    callbacks.message_namespace = f"{message.package}::msg".encode()
    callbacks.message_name = message.name.encode()
    if codec is not None:
        serialize, deserialize, size = _serializers(codec)
        callbacks.cdr_serialize, callbacks.cdr_deserialize, callbacks.get_serialized_size = (
            ctypes.cast(function, ctypes.c_void_p) for function in (serialize, deserialize, size)
        )
        keep += [serialize, deserialize, size]
    return callbacks


def _serializers(codec: Codec) -> tuple[Any, Any, Any]:
    """The Fast DDS callbacks for C messages that refer to a Python object."""
    fast_cdr = _fast_cdr()

    def serialize(message: int, cdr: int) -> bool:
        content = _held(message)[_ENCAPSULATION:]
        begin = fast_cdr["position"](cdr)
        if not content or not fast_cdr["jump"](cdr, len(content)):
            return False
        ctypes.memmove(begin, content, len(content))
        return True

    def deserialize(cdr: int, message: int) -> bool:
        begin = fast_cdr["buffer"](cdr)
        for step in range(_LARGEST_STEP, -1, -1):  # the size of the buffer has no function of its own
            fast_cdr["jump"](cdr, 1 << step)
        try:
            received = codec.decode(ctypes.string_at(begin, fast_cdr["position"](cdr) - begin))
        except ValueError:
            return False  # the middleware reports that the message cannot be taken
        _hold(message, received)
        return True

    return (
        rosidl_structs.Serialize(serialize),
        rosidl_structs.Deserialize(deserialize),
        rosidl_structs.SerializedSize(lambda message: len(_held(message)[_ENCAPSULATION:])),
    )


def _fast_cdr() -> dict[str, Any]:
    try:
        library = ctypes.CDLL(_FAST_CDR)
        functions = {}
        for name, (symbol, result, arguments) in _FAST_CDR_FUNCTIONS.items():
            functions[name] = library[symbol]
            functions[name].restype, functions[name].argtypes = result, [ctypes.c_void_p, *arguments]
    except (OSError, AttributeError) as error:
        raise TypeSupportError(f"{_FAST_CDR}: {error}") from error
    return functions


def conversions(codec: Codec) -> Conversions:
    """The functions with which rclpy converts message objects of a type that was built with this codec."""
    library = ctypes.CDLL(None)
    allocate, free = library.calloc, library.free
    allocate.restype, allocate.argtypes = ctypes.c_void_p, [ctypes.c_size_t, ctypes.c_size_t]
    free.restype, free.argtypes = None, [ctypes.c_void_p]

    def convert_from_py(message: Any, place: int) -> bool:
        try:
            data = codec.encode(message)
        except (AttributeError, TypeError, ValueError, struct.error) as error:  # it cannot pass through C
            _LOG.error("a message cannot be sent: %s: %s: found %r", type(error).__name__, error, message)
            data = b""
        _hold(place, data)
        return bool(data)

    def destroy(place: int) -> None:
        _hold(place, None)
        free(place)

    functions = (
        rosidl_structs.Create(functools.partial(allocate, 1, ctypes.sizeof(rosidl_structs.Sequence))),
        rosidl_structs.ConvertFromPython(convert_from_py),
        rosidl_structs.ConvertToPython(operator.itemgetter(0)),
        rosidl_structs.Destroy(destroy),
    )
    _keep_for_ever(functions)
    return Conversions(
        *(_capsule_new(ctypes.cast(function, ctypes.c_void_p).value, None, None) for function in functions)
    )


def _hold(place: int, value: object) -> None:
    """Make the C message at `place` refer to a Python object, None: to nothing; its former object is released."""
    reference = ctypes.c_void_p.from_address(place)
    former = None if not reference.value else ctypes.cast(reference.value, ctypes.py_object).value
    if value is None:
        reference.value = None
    else:
        _keep_for_ever(value)
        reference.value = id(value)
    if former is not None:
        _release(former)


def _held(place: int) -> Any:
    return ctypes.cast(ctypes.c_void_p.from_address(place), ctypes.py_object).value


def _members(message: SequenceType, element: rosidl_structs.TypeSupport, keep: list[object]) -> rosidl_structs.Members:
    nested = _part(element, _INTROSPECTION)
    member = rosidl_structs.Member(
        name=message.field.encode(),
        type_id=rosidl_structs.INTROSPECTION_MESSAGE,
        members=ctypes.addressof(nested),
        is_array=True,
    )
    keep.append(member)
    return rosidl_structs.Members(
        message_namespace=f"{message.package}__msg".encode(),
        message_name=message.name.encode(),
        member_count=1,
        size_of=ctypes.sizeof(rosidl_structs.Sequence),
        members=ctypes.addressof(member),
    )


def _hash(message: SequenceType) -> rosidl_structs.TypeHash:
    digits = bytes.fromhex(message.type_hash.removeprefix(_HASH_PREFIX))
    return rosidl_structs.TypeHash(1, (ctypes.c_uint8 * 32)(*digits))


def _description(
    message: SequenceType, element: rosidl_structs.TypeSupport, keep: list[object]
) -> rosidl_structs.TypeDescription:
    """The description of the message, then all types that it refers to in the order of their names, as rosidl does."""
    address = element.get_type_description(ctypes.addressof(element))
    nested = rosidl_structs.TypeDescription.from_address(address)
    field = rosidl_structs.Field(
        _string(message.field, keep),
        rosidl_structs.FieldType(rosidl_structs.NESTED_UNBOUNDED_SEQUENCE, 0, 0, _string(message.element, keep)),
        _string("", keep),
    )
    referenced = [
        nested.type_description,
        *_items(nested.referenced_type_descriptions, rosidl_structs.IndividualTypeDescription),
    ]
    referenced.sort(key=lambda description: _text(description.type_name))
    ours = rosidl_structs.IndividualTypeDescription(
        _string(message.full_name, keep), _sequence(rosidl_structs.Field, [field], keep)
    )
    return rosidl_structs.TypeDescription(ours, _sequence(rosidl_structs.IndividualTypeDescription, referenced, keep))


def _sources(message: SequenceType, element: rosidl_structs.TypeSupport, keep: list[object]) -> rosidl_structs.Sequence:
    nested = rosidl_structs.Sequence.from_address(element.get_sources(ctypes.addressof(element)))
    ours = rosidl_structs.TypeSource(
        _string(message.full_name, keep), _string("msg", keep), _string(message.definition, keep)
    )
    others = sorted(_items(nested, rosidl_structs.TypeSource), key=lambda source: _text(source.type_name))
    return _sequence(rosidl_structs.TypeSource, [ours, *others], keep)


def _string(text: str, keep: list[object]) -> rosidl_structs.String:
    data = ctypes.create_string_buffer(text.encode())
    keep.append(data)
    return rosidl_structs.String(ctypes.addressof(data), len(data) - 1, len(data))


def _text(string: rosidl_structs.String) -> bytes:
    return ctypes.string_at(string.data, string.size)


def _items(sequence: rosidl_structs.Sequence, kind: type[ctypes.Structure]) -> Iterable[Any]:
    return (kind * sequence.size).from_address(sequence.data) if sequence.size else ()


def _sequence(kind: type[ctypes.Structure], items: Sequence[Any], keep: list[object]) -> rosidl_structs.Sequence:
    data = (kind * len(items))(*items)
    keep.append(data)
    return rosidl_structs.Sequence(ctypes.addressof(data), len(items), len(items))
