"""Quality of service that users override by parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import IntEnum
from typing import Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.duration import Duration
from thymio_sim_ros.portable_ros.rclpy.exceptions import ParameterAlreadyDeclaredException
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind, QoSProfile

__all__ = ["InvalidQosOverridesError", "QoSOverridingOptions"]


class InvalidQosOverridesError(Exception):
    """A callback rejected the profile."""


class QoSOverridingOptions:
    """Which policies of an endpoint are parameters of its node."""

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: Callable[[QoSProfile], Any] | None = None,
        entity_id: str | None = None,
    ) -> None:
        """`callback` checks the profile, `entity_id` distinguishes endpoints of one topic."""
        self.policy_kinds, self.callback, self.entity_id = tuple(policy_kinds), callback, entity_id

    @classmethod
    def with_default_policies(
        cls, *, callback: Callable[[QoSProfile], Any] | None = None, entity_id: str | None = None
    ) -> QoSOverridingOptions:
        """History, depth and reliability."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback=callback, entity_id=entity_id)


def override(kind: str, node: Any, topic: str, profile: QoSProfile, options: QoSOverridingOptions) -> None:
    """Declare the parameters of an endpoint, and change the profile as they say.

    `kind` is `publisher` or `subscription`. Raises RuntimeError for a wrong value and InvalidQosOverridesError.
    """
    suffix = "" if options.entity_id is None else f"_{options.entity_id}"
    about = f"for {kind} `{topic}` with id `{options.entity_id}`"
    for policy in options.policy_kinds:
        if kind == "subscription" and policy == QoSPolicyKind.LIFESPAN:
            continue
        field = policy.name.lower()
        name = f"qos_overrides.{topic}.{kind}{suffix}.{field}"
        descriptor = ros_types.ParameterDescriptor(description=f"{field} {about}", read_only=True)
        present = getattr(profile, field)
        try:
            value = node.declare_parameter(name, _plain(present), descriptor).value
        except ParameterAlreadyDeclaredException:
            value = node.get_parameter(name).value
        setattr(profile, field, _policy(field, value, present))
    if options.callback is not None:
        result = options.callback(profile)
        if not result.successful:
            raise InvalidQosOverridesError(f"Provided QoS overrides {about}, are not valid: {result.reason}")


def _plain(value: Any) -> Any:
    if isinstance(value, Duration):
        return value.nanoseconds
    if isinstance(value, IntEnum):
        if value.name == "UNKNOWN":
            raise ValueError("User provided QoS profile is invalid")
        return value.name.lower()
    return value


def _policy(field: str, value: Any, like: Any) -> Any:
    """The value of a policy of a parameter; `like` is another one."""
    if isinstance(like, Duration):
        return Duration(nanoseconds=value)
    if isinstance(like, IntEnum):
        if value.upper() not in type(like).__members__:
            raise RuntimeError(f"Unexpected QoS override for policy `{field}`: `{value}`")
        return type(like)[value.upper()]
    return value
