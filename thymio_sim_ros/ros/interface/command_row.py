"""The description of a topic that carries commands."""

from __future__ import annotations

import builtins
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

from rclpy.qos import QoSProfile

from thymio_sim_ros.ros.interface import qos, saturation
from thymio_sim_ros.ros.interface.saturation import LimitCheck
from thymio_sim_ros.sim.commands import Command

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["CommandRow"]

M = TypeVar("M", bound="Message")


@dataclass(frozen=True, slots=True)
class CommandRow:
    """One topic: `decode` returns the command of a message or raises CommandError.

    `encode` returns the message of a command that programs may give, or is None. `about` describes content and units
    for docs/ros.md. `limit_check` describes the part of a message that will be clamped. `is_retained`: the command
    stays in force until the next one, so late subscribers need it.
    """

    topic: str
    type: type[Message]
    decode: Callable[[Any], Command]
    encode: Callable[[Any], Message] | None = None
    profile: QoSProfile = field(default_factory=lambda: qos.COMMAND)
    about: str = ""
    limit_check: LimitCheck = saturation.nothing
    is_retained: bool = False

    if TYPE_CHECKING:  # the parts fit each other; a generic class would not be checked within a tuple of rows

        def __init__(
            self,
            topic: str,
            type: builtins.type[M],  # noqa: A002  # the name of the field
            decode: Callable[[M], Command],
            encode: Callable[[Any], M] | None = None,
            profile: QoSProfile = ...,
            about: str = "",
            limit_check: Callable[[M], str] = ...,
            is_retained: bool = False,
        ) -> None: ...
