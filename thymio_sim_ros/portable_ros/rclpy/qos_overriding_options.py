"""Quality of service that users override by parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.duration import Duration
from thymio_sim_ros.portable_ros.rclpy.exceptions import ParameterAlreadyDeclaredException
from thymio_sim_ros.portable_ros.rclpy.publisher import Publisher
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind, QoSProfile
from thymio_sim_ros.portable_ros.rclpy.subscription import Subscription

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy_parts.node_parameters import NodeParameters

__all__ = ["InvalidQosOverridesError", "QoSOverridingOptions", "QosCallbackResult", "QosCallbackType"]

QosCallbackResult = ros_types.SetParametersResult
QosCallbackType = Callable[[QoSProfile], ros_types.SetParametersResult]


class InvalidQosOverridesError(Exception):
    """A callback rejected the profile."""


class QoSOverridingOptions:
    """Which policies of an endpoint are parameters of its node."""

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: QosCallbackType | None = None,
        entity_id: str | None = None,
    ) -> None:
        """`callback` checks the profile, `entity_id` distinguishes endpoints of one topic."""
        self._policy_kinds, self._callback, self._entity_id = policy_kinds, callback, entity_id

    @property
    def policy_kinds(self) -> Iterable[QoSPolicyKind]:
        """The policies."""
        return self._policy_kinds

    @property
    def callback(self) -> QosCallbackType | None:
        """The check of the profile."""
        return self._callback

    @property
    def entity_id(self) -> str | None:
        """The part of the parameters' names that distinguishes endpoints of one topic."""
        return self._entity_id

    @classmethod
    def with_default_policies(
        cls, *, callback: QosCallbackType | None = None, entity_id: str | None = None
    ) -> QoSOverridingOptions:
        """History, depth and reliability."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback=callback, entity_id=entity_id)


def _declare_qos_parameters(
    entity_type: type[Publisher[Any] | Subscription],
    node: NodeParameters,
    topic_name: str,
    qos: QoSProfile,
    options: QoSOverridingOptions,
) -> None:
    """Declare the parameters of an endpoint, and change the profile as they say.

    Raises RuntimeError for a wrong value and InvalidQosOverridesError.
    """
    kind = "publisher" if issubclass(entity_type, Publisher) else "subscription"
    suffix = "" if options.entity_id is None else f"_{options.entity_id}"
    about = f"for {kind} `{topic_name}` with id `{options.entity_id}`"
    for policy in options.policy_kinds:
        if kind == "subscription" and policy == QoSPolicyKind.LIFESPAN:
            continue
        field = policy.name.lower()
        name = f"qos_overrides.{topic_name}.{kind}{suffix}.{field}"
        descriptor = ros_types.ParameterDescriptor(description=f"{field} {about}", read_only=True)
        try:
            value = node.declare_parameter(name, _get_qos_policy_parameter(qos, policy), descriptor).value
        except ParameterAlreadyDeclaredException:
            value = node.get_parameter(name).value
        setattr(qos, field, _policy(field, value, getattr(qos, field)))
    if options.callback is not None:
        result = options.callback(qos)
        if not result.successful:
            raise InvalidQosOverridesError(f"Provided QoS overrides {about}, are not valid: {result.reason}")


def _get_qos_policy_parameter(qos: QoSProfile, policy: QoSPolicyKind) -> str | int | bool:
    """The value of the parameter that stands for a policy. Raises ValueError for an unknown policy."""
    value: Duration | IntEnum | int | bool = getattr(qos, policy.name.lower())
    if isinstance(value, Duration):
        return value.nanoseconds
    if isinstance(value, IntEnum):
        if value.name == "UNKNOWN":
            raise ValueError("User provided QoS profile is invalid")
        return value.name.lower()
    return value  # a depth or a switch


def _policy(field: str, value: Any, like: Any) -> Any:
    """The value of a policy of a parameter; `like` is another one."""
    if isinstance(like, Duration):
        return Duration(nanoseconds=value)
    if isinstance(like, IntEnum):
        if value.upper() not in type(like).__members__:
            raise RuntimeError(f"Unexpected QoS override for policy `{field}`: `{value}`")
        return type(like)[value.upper()]
    return value
