"""Exceptions of transforms, with the names of tf2."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = [
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "TimeoutException",
    "TransformException",
    "TypeException",
]


class TransformException(ThymioSimError):  # noqa: N818  # as tf2 has it
    """Base of the errors of transforms."""


class LookupException(TransformException):
    """A frame is not known."""


class ConnectivityException(TransformException):
    """Two frames are not connected by transforms."""


class ExtrapolationException(TransformException):
    """A time is before the first or after the last transform in the buffer."""


class InvalidArgumentException(TransformException):
    """A frame name or a transform is invalid."""


class TimeoutException(TransformException):
    """A time-out elapsed."""


class TypeException(ThymioSimError):  # noqa: N818  # as tf2 has it
    """A message type cannot be transformed."""


class NotImplementedException(ThymioSimError):  # noqa: N818  # as tf2 has it
    """A class derived from BufferInterface lacks a method."""
