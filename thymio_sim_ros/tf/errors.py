"""What can go wrong with transforms, by the names that tf2 gives it."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = [
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
    "TypeException",
]


class TransformException(ThymioSimError):  # noqa: N818  # as tf2 has it
    """Any of them."""


class LookupException(TransformException):
    """A frame that nobody has sent."""


class ConnectivityException(TransformException):
    """Two frames that no chain of transforms connects."""


class ExtrapolationException(TransformException):
    """A time before the first or after the last transform that is kept."""


class InvalidArgumentException(TransformException):
    """A name that no frame can have."""


class TimeoutException(TransformException):
    """Nothing came in time."""


class TypeException(ThymioSimError):  # noqa: N818  # as tf2 has it
    """A message that cannot be transformed."""
