"""What the graph knows about a publisher or a subscription."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import Any, ClassVar

from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile, qos_profile_unknown
from thymio_sim_ros.portable_ros.rclpy.type_hash import TypeHash
from thymio_sim_ros.portable_ros.rclpy_parts.checked_field import checked_field

__all__ = ["TopicEndpointInfo", "TopicEndpointTypeEnum"]


class TopicEndpointTypeEnum(IntEnum):
    """Kinds of endpoints."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


def _record(kind: type[Any]) -> Callable[[Any], Any]:
    """The conversion of the arguments of a record to the record."""
    return lambda value: kind(**value) if isinstance(value, dict) else value


class TopicEndpointInfo:
    """An endpoint of a topic. Raises AssertionError for unknown arguments and for values of other types."""

    __slots__: ClassVar[list[str]] = [  # noqa: RUF023  # in the order in which they are shown
        "_node_name",
        "_node_namespace",
        "_topic_type",
        "_topic_type_hash",
        "_endpoint_type",
        "_endpoint_gid",
        "_qos_profile",
    ]

    node_name = checked_field("node_name", str)
    node_namespace = checked_field("node_namespace", str)
    topic_type = checked_field("topic_type", str)
    topic_type_hash = checked_field("topic_type_hash", TypeHash, _record(TypeHash))
    endpoint_type = checked_field(
        "endpoint_type",
        TopicEndpointTypeEnum,
        lambda value: TopicEndpointTypeEnum(value) if isinstance(value, int) else value,
    )
    endpoint_gid = checked_field(
        "endpoint_gid", list, lambda value: value if all(isinstance(one, int) for one in value) else None
    )
    qos_profile = checked_field("qos_profile", QoSProfile, _record(QoSProfile))

    def __init__(self, **kwargs: Any) -> None:
        if unknown := [name for name in kwargs if f"_{name}" not in self.__slots__]:
            raise AssertionError(f"Invalid arguments passed to constructor: {unknown!r}")
        self.node_name = kwargs.get("node_name", "")
        self.node_namespace = kwargs.get("node_namespace", "")
        self.topic_type = kwargs.get("topic_type", "")
        self.topic_type_hash = kwargs.get("topic_type_hash", TypeHash())
        self.endpoint_type = kwargs.get("endpoint_type", TopicEndpointTypeEnum.INVALID)
        self.endpoint_gid = kwargs.get("endpoint_gid", [])
        self.qos_profile = kwargs.get("qos_profile", qos_profile_unknown)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TopicEndpointInfo) and all(
            getattr(self, one) == getattr(other, one) for one in self.__slots__
        )

    __hash__ = None  # type: ignore[assignment]  # as rclpy's

    def __str__(self) -> str:
        gid = ".".join(f"{one:02x}" for one in self.endpoint_gid)
        profile = self.qos_profile
        history = profile.history.name
        if history == "KEEP_LAST":
            history = f"{history} ({profile.depth})"
        return "\n".join(
            (
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Topic type: {self.topic_type}",
                f"Topic type hash: {self.topic_type_hash}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"GID: {gid}",
                "QoS profile:",
                f"  Reliability: {profile.reliability.name}",
                f"  History (Depth): {history}",
                f"  Durability: {profile.durability.name}",
                f"  Lifespan: {profile.lifespan}",
                f"  Deadline: {profile.deadline}",
                f"  Liveliness: {profile.liveliness.name}",
                f"  Liveliness lease duration: {profile.liveliness_lease_duration}",
            )
        )
