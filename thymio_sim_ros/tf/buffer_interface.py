"""The interface of a buffer of transforms for messages of any type, and the registers of such types, as in `tf2_ros`.

A package that has messages of its own registers a function that transforms each of them (`TransformRegistration`), and
functions that convert them from and to messages of ROS (`ConvertRegistration`). The registers belong to the process.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar

from builtin_interfaces.msg import Time as TimeMessage
from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.time import Time
from std_msgs.msg import Header

from thymio_sim_ros.tf.errors import NotImplementedException, TypeException
from thymio_sim_ros.tf.geometry import TRANSFORMERS

__all__ = ["NO_WAIT", "BufferInterface", "ConvertRegistration", "Stamped", "TransformRegistration", "convert"]

NO_WAIT = Duration()

Key = TypeVar("Key")
S = TypeVar("S")
N = TypeVar("N")
T = TypeVar("T", bound="_WithHeader")


class _WithHeader(Protocol):
    header: Header


_transformers: dict[type, Callable[[Any, TransformStamped], Any]] = dict(TRANSFORMERS)
_to_message: dict[type, Callable[[Any], Any]] = {kind: lambda message: message for kind in TRANSFORMERS}
_from_message: dict[type, Callable[[Any], Any]] = {kind: lambda message: message for kind in TRANSFORMERS}
_direct: dict[tuple[type, type], Callable[[Any], Any]] = {}


class TransformRegistration:
    """The functions that transform messages, by type; all objects of this class share them."""

    def add(self, key: type[S], callback: Callable[[S, TransformStamped], S]) -> None:
        """Register a function of a message and a transform that returns the transformed message."""
        _transformers[key] = callback

    def get(self, key: type[S]) -> Callable[[S, TransformStamped], S]:
        """The function of a type. Raises TypeException without one."""
        return _registered(_transformers, key, "TransformRegistration().add")

    def print_me(self) -> None:
        """Print the types and their functions."""
        print(_transformers)  # the purpose of the method


class ConvertRegistration:
    """The functions that convert objects from and to messages; all objects of this class share them."""

    def add_to_msg(self, key: type[S], callback: Callable[[S], object]) -> None:
        """Register a function that makes a message of an object of type `key`."""
        _to_message[key] = callback

    def add_from_msg(self, key: type[S], callback: Callable[[Any], S]) -> None:
        """Register a function that makes an object of type `key` of a message."""
        _from_message[key] = callback

    def add_convert(self, key: tuple[type[S], type[N]], callback: Callable[[S], N]) -> None:
        """Register a function that converts directly; `key` is the type that it takes and the type that it returns."""
        _direct[key] = callback

    def get_to_msg(self, key: type[S]) -> Callable[[S], Any]:
        """The function of `add_to_msg`. Raises TypeException without one."""
        return _registered(_to_message, key, "ConvertRegistration().add_to_msg")

    def get_from_msg(self, key: type[S]) -> Callable[[Any], S]:
        """The function of `add_from_msg`. Raises TypeException without one."""
        return _registered(_from_message, key, "ConvertRegistration().add_from_msg")

    def get_convert(self, key: tuple[type[S], type[N]]) -> Callable[[S], N]:
        """The function of `add_convert`. Raises TypeException without one."""
        return _registered(_direct, key, "ConvertRegistration().add_convert")


def convert(a: object, b_type: type[N]) -> N:
    """Convert an object to a type: directly if such a function is registered, otherwise by way of a message.

    Raises TypeException if the types have no functions.
    """
    direct = _direct.get((type(a), b_type))
    if direct is not None:
        converted: N = direct(a)
        return converted
    if type(a) is b_type:
        return a
    registration = ConvertRegistration()
    from_message = registration.get_from_msg(b_type)
    return from_message(registration.get_to_msg(type(a))(a))


def Stamped(obj: T, stamp: TimeMessage, frame_id: str) -> T:  # noqa: N802  # as tf2's
    """Give an object a header with a time and a frame, and return it."""
    obj.header = Header(stamp=stamp, frame_id=frame_id)
    return obj


class BufferInterface:
    """Transforms messages of all registered types by the lookups of a derived class."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self, object_stamped: _WithHeader, target_frame: str, timeout: Duration = NO_WAIT, new_type: type | None = None
    ) -> Any:
        """Transform a message to another frame at the time of its header; with `new_type`, convert the result.

        Raises TypeException for a type without a function, and the exceptions of `lookup_transform`.
        """
        act = self.registration.get(type(object_stamped))
        header = object_stamped.header
        transformed = act(object_stamped, self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout))
        return transformed if new_type is None else convert(transformed, new_type)

    def transform_full(
        self,
        object_stamped: _WithHeader,
        target_frame: str,
        target_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
        new_type: type | None = None,
    ) -> Any:
        """Transform a message to another frame at another time; see `transform` and `lookup_transform_full`."""
        act = self.registration.get(type(object_stamped))
        header = object_stamped.header
        known = (target_frame, target_time, header.frame_id, header.stamp, fixed_frame, timeout)
        transformed = act(object_stamped, self.lookup_transform_full(*known))
        return transformed if new_type is None else convert(transformed, new_type)

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage, timeout: Duration = NO_WAIT
    ) -> TransformStamped:
        """The pose of `source_frame` in `target_frame`. Raises NotImplementedException in this class."""
        raise _missing(self, "lookup_transform")

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> TransformStamped:
        """The pose of a frame at another time. Raises NotImplementedException in this class."""
        raise _missing(self, "lookup_transform_full")

    def can_transform(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage, timeout: Duration = NO_WAIT
    ) -> Any:
        """Whether a transform is known. Raises NotImplementedException in this class."""
        raise _missing(self, "can_transform")

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> Any:
        """Whether a transform between two times is known. Raises NotImplementedException in this class."""
        raise _missing(self, "can_transform_full")


def _registered(register: dict[Key, Callable[..., Any]], key: Key, adds: str) -> Callable[..., Any]:
    if key in register:
        return register[key]
    known = ", ".join(map(_name, register)) or "none"
    raise TypeException(f"found {_name(key)}, expected one of {known}; {adds} registers a function for it")


def _name(key: object) -> str:
    return " to ".join(one.__name__ for one in (key if isinstance(key, tuple) else (key,)))


def _missing(buffer: BufferInterface, method: str) -> NotImplementedException:
    return NotImplementedException(f"{type(buffer).__name__} has no method {method}: a derived class must have it")
