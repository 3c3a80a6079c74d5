"""Transforms as serialized tf2_msgs/msg/TFMessage, also if tf2_msgs is not installed (the ROS wheels lack it).

`TFMessage` is the class for `create_publisher` and `create_subscription`: that of tf2_msgs if it is installed,
otherwise a replacement of the same name and hash, built by `typesupport`. This package publishes bytes of `encode` and
subscribes with `raw=True`, because message objects cost more.
If neither works, `available()` is False and logs the reason once; /tf is then left out.
"""

from __future__ import annotations

import functools
import logging
import struct
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from geometry_msgs.msg import TransformStamped
from rclpy.time import Time
from rosidl_parser.definition import NamespacedType, UnboundedSequence

from thymio_sim_ros import course_packages
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.compat import typesupport

__all__ = [
    "TF_DEFINITION",
    "TF_TYPE_NAME",
    "TFMessage",
    "Transform",
    "TransformDataError",
    "available",
    "decode",
    "encode",
    "from_message",
    "to_message",
]

_DESCRIPTION = typesupport.SequenceType(
    package="tf2_msgs",
    name="TFMessage",
    field="transforms",
    element="geometry_msgs/msg/TransformStamped",
    type_hash="RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
)
TF_TYPE_NAME = _DESCRIPTION.full_name
TF_DEFINITION = _DESCRIPTION.definition

_SECOND_NS = 1_000_000_000
_LITTLE_ENDIAN_CDR = b"\x00\x01\x00\x00"
_HEADER = struct.Struct("<4sI")  # encapsulation, number of transforms


class Transform(NamedTuple):
    """Pose of frame `child` in `frame` at `stamp_ns`: translation in m and a unit quaternion x, y, z, w."""

    stamp_ns: int
    frame: str
    child: str
    translation: tuple[float, float, float]
    rotation: tuple[float, float, float, float]


class TransformDataError(ThymioSimError, ValueError):
    """Bytes are not a TFMessage; the text has the offset."""


class _Metaclass(type):
    """The attributes that rclpy expects of a message class: type support and four conversions, built on first use."""

    _TYPE_SUPPORT: object = None
    _CREATE_ROS_MESSAGE: object = None
    _CONVERT_FROM_PY: object = None
    _CONVERT_TO_PY: object = None
    _DESTROY_ROS_MESSAGE: object = None

    @classmethod
    def __import_type_support__(cls) -> None:
        """Build the type support. Raises TypeSupportError if the installed ROS is not supported."""
        from rclpy.type_support import check_for_type_support
        from rclpy.utilities import get_rmw_implementation_identifier

        typesupport.check_layouts(get_rmw_implementation_identifier())
        check_for_type_support(TransformStamped)
        codec = typesupport.Codec(
            lambda message: encode(map(from_message, message.transforms)),
            lambda data: _TFMessage(transforms=list(map(to_message, decode(data)))),
        )
        support = typesupport.build(_DESCRIPTION, TransformStamped, codec)
        cls._CREATE_ROS_MESSAGE, cls._CONVERT_FROM_PY, cls._CONVERT_TO_PY, cls._DESTROY_ROS_MESSAGE = (
            typesupport.conversions(codec)
        )
        cls._TYPE_SUPPORT = support


class _TFMessage(metaclass=_Metaclass):
    """Replaces tf2_msgs.msg.TFMessage."""

    __slots__ = ("_transforms",)
    SLOT_TYPES = (UnboundedSequence(NamespacedType(["geometry_msgs", "msg"], "TransformStamped")),)

    def __init__(self, *, transforms: Iterable[TransformStamped] = ()) -> None:
        self.transforms = transforms

    @property
    def transforms(self) -> list[TransformStamped]:
        """The transforms."""
        return self._transforms

    @transforms.setter
    def transforms(self, value: Iterable[TransformStamped]) -> None:
        found = list(value)
        for transform in found:
            if not isinstance(transform, TransformStamped):
                raise TypeError(
                    f"transforms: found {type(transform).__name__}, expected geometry_msgs.msg.TransformStamped"
                )
        self._transforms = value if isinstance(value, list) else found

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Names and types of the fields, as all message classes have it."""
        return {"transforms": "sequence<geometry_msgs/TransformStamped>"}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _TFMessage) and self.transforms == other.transforms

    __hash__ = None  # type: ignore[assignment]  # as all messages, which can be changed

    def __repr__(self) -> str:
        return f"tf2_msgs.msg.TFMessage(transforms={self.transforms!r})"


_TFMessage.__name__ = _TFMessage.__qualname__ = "TFMessage"
_TFMessage.__module__ = "tf2_msgs.msg._tf_message"  # the name of the type in tools of ROS is made of these


if TYPE_CHECKING or course_packages.is_installed("tf2_msgs"):
    from tf2_msgs.msg import TFMessage
else:
    TFMessage = _TFMessage


def from_message(message: TransformStamped) -> Transform:
    """The values of a message. Its stamp may be a time of rclpy, which tf2 reads, too."""
    stamp, t, q = message.header.stamp, message.transform.translation, message.transform.rotation
    stamp_ns = stamp.nanoseconds if isinstance(stamp, Time) else stamp.sec * _SECOND_NS + stamp.nanosec
    return Transform(stamp_ns, message.header.frame_id, message.child_frame_id, (t.x, t.y, t.z), (q.x, q.y, q.z, q.w))


def to_message(transform: Transform) -> TransformStamped:
    """A message of these values."""
    message = TransformStamped(child_frame_id=transform.child)
    message.header.frame_id = transform.frame
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(transform.stamp_ns, _SECOND_NS)
    translation, rotation = message.transform.translation, message.transform.rotation
    translation.x, translation.y, translation.z = transform.translation
    rotation.x, rotation.y, rotation.z, rotation.w = transform.rotation
    return message


@functools.cache
def available() -> bool:
    """Whether TFMessage can be published and subscribed to; logs the reason once if not."""
    try:
        from rclpy.type_support import check_for_type_support

        check_for_type_support(TFMessage)
    except (ImportError, AttributeError, typesupport.TypeSupportError) as error:
        logging.getLogger(__name__).warning("no /tf: tf2_msgs is not installed and cannot be replaced: %s", error)
        return False
    return True


def encode(transforms: Iterable[Transform]) -> bytes:
    """Serialize a TFMessage as little-endian CDR. Stamps must be in 0…2³¹ s.

    Layout: 4 bytes of encapsulation, the number of transforms as uint32, then the transforms. CDR aligns each item to
    its size, counted from the end of the encapsulation, therefore the layout of a transform depends on its offset.
    """
    parts = [b""]
    offset = 4
    for stamp_ns, frame, child, translation, rotation in transforms:
        layout, *named = _named(offset % 8, frame, child)
        parts.append(layout.pack(*divmod(stamp_ns, _SECOND_NS), *named, *translation, *rotation))
        offset += layout.size
    parts[0] = _HEADER.pack(_LITTLE_ENDIAN_CDR, len(parts) - 1)
    return b"".join(parts)


@functools.lru_cache(maxsize=8192)
def _named(alignment: int, frame: str, child: str) -> tuple[struct.Struct, int, bytes, int, bytes]:
    """The layout of a transform between these frames, and the sizes and bytes of their names."""
    frame_bytes, child_bytes = frame.encode(), child.encode()
    frame_size, child_size = len(frame_bytes) + 1, len(child_bytes) + 1
    return _layout(alignment, frame_size, child_size), frame_size, frame_bytes, child_size, child_bytes


def decode(data: bytes) -> tuple[Transform, ...]:
    """Deserialize a TFMessage, little-endian as all known implementations send it. Raises TransformDataError."""
    try:
        encapsulation, count = _HEADER.unpack_from(data)
        if encapsulation[:2] != _LITTLE_ENDIAN_CDR[:2]:
            raise TransformDataError(f"offset 0: found encapsulation {encapsulation.hex()}, expected little-endian CDR")
        transforms = []
        start = _HEADER.size
        for _ in range(count):
            transform, start = _decode_one(data, start)
            transforms.append(transform)
    except (struct.error, UnicodeDecodeError) as error:
        raise TransformDataError(f"too short or damaged, {len(data)} bytes: {error}") from error
    return tuple(transforms)


def _decode_one(data: bytes, start: int) -> tuple[Transform, int]:
    """Decode the transform at `start`; return it and the start of the next one.

    The sizes of both strings are read first, because they determine the layout of everything after them. Raises
    TransformDataError or struct.error.
    """
    aligned = start + -(start - 4) % 4
    (frame_size,) = struct.unpack_from("<8xI", data, aligned)
    child_at = aligned + 12 + frame_size
    child_at += -(child_at - 4) % 4
    (child_size,) = struct.unpack_from("<I", data, child_at)
    if not frame_size or not child_size or child_at + 4 + child_size > len(data):
        raise TransformDataError(
            f"offset {start}: found strings of {frame_size} and {child_size} bytes, which do not fit"
        )
    layout = _layout((start - 4) % 8, frame_size, child_size)
    sec, nanosec, _, frame, _, child, *numbers = layout.unpack_from(data, start)
    translation = (numbers[0], numbers[1], numbers[2])
    rotation = (numbers[3], numbers[4], numbers[5], numbers[6])
    stamp_ns = sec * _SECOND_NS + nanosec
    return Transform(stamp_ns, frame[:-1].decode(), child[:-1].decode(), translation, rotation), start + layout.size


@functools.lru_cache(maxsize=1024)
def _layout(alignment: int, frame_size: int, child_size: int) -> struct.Struct:
    """The layout of a TransformStamped that begins `alignment` bytes after a multiple of eight; sizes include the NUL.

    Items: sec, nanosec, frame, child, three doubles of the translation and four of the rotation, each aligned to its
    size. `struct` fills gaps and final NULs with zeros.
    """
    text = "<"
    size = alignment
    for item, item_size, item_alignment in (
        ("iI", 8, 4),
        (f"I{frame_size}s", 4 + frame_size, 4),
        (f"I{child_size}s", 4 + child_size, 4),
        ("7d", 56, 8),
    ):
        gap = -size % item_alignment
        text += f"{gap}x{item}"
        size += gap + item_size
    return struct.Struct(text)
