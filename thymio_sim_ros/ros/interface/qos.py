"""QoS profiles by kind of topic (docs/spec/ros-interface.md section 9)."""

from __future__ import annotations

import copy
from collections.abc import Mapping

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError


def _reliable(depth: int, durability: DurabilityPolicy = DurabilityPolicy.VOLATILE) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=durability
    )


SENSOR = _reliable(10)
"""Sensors and state: reliable, because code for the driver subscribes reliably."""

TRANSIENT_LOCAL = _reliable(1, DurabilityPolicy.TRANSIENT_LOCAL)
"""Late subscribers get the last message."""

TRANSFORMS = _reliable(100)
CLOCK = _reliable(1)
COMMAND = _reliable(1)
LEDS = _reliable(10)
EVENTS = _reliable(100)
"""Aseba events: no loss in bursts."""


KINDS: dict[str, tuple[QoSProfile, str]] = {
    "sensor": (SENSOR, "sensors and state; volatile"),
    "transient local": (TRANSIENT_LOCAL, "retained state: late subscribers get the last message"),
    "transforms": (TRANSFORMS, "as in tf2; volatile"),
    "clock": (CLOCK, "newest message only; volatile"),
    "command": (COMMAND, "newest message only; volatile"),
    "lights": (LEDS, "volatile"),
    "event": (EVENTS, "no loss in bursts; volatile"),
}
"""Profiles by their name in docs/ros.md, with their purpose; all are reliable, keep last."""


def best_effort(profile: QoSProfile) -> QoSProfile:
    """Return a profile without reliability, for a subscription that publishers of either reliability reach."""
    changed = copy.copy(profile)
    changed.reliability = ReliabilityPolicy.BEST_EFFORT
    return changed


def kind_of(profile: QoSProfile) -> str:
    """Return the name of a profile."""
    return next(kind for kind, (known, _) in KINDS.items() if known is profile)


_POLICIES: Mapping[str, type[HistoryPolicy] | type[ReliabilityPolicy] | type[DurabilityPolicy]] = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
}
_MAX_DEPTH = 2**31 - 1


def check_overrides(node: Node) -> None:
    """Raise StartError for an invalid value of `qos_overrides.<topic>.publisher.…` given at the start."""
    for name, parameter in node._parameter_overrides.items():
        head, _, policy = name.rpartition(".")
        if not (name.startswith("qos_overrides.") and head.endswith(".publisher")):
            continue
        value, expected = parameter.value, ""
        if policy in _POLICIES:
            words = [word for word in map(str.lower, _POLICIES[policy].__members__) if word != "unknown"]
            expected = "" if value in words else ", ".join(words)
        elif policy == "depth" and (type(value) is not int or not 0 <= value <= _MAX_DEPTH):
            expected = f"0 to {_MAX_DEPTH}"
        if expected:
            raise StartError(f"parameter {name}: found {value!r}, expected {expected}")


def overridable(node: Node, topic: str, profile: QoSProfile) -> tuple[QoSProfile, QoSOverridingOptions | None]:
    """Return the profile and the QoS overrides for `create_publisher`, None if none were given for the topic.

    Override parameters are declared only if the node was started with one of them; for all topics of a hundred robots
    there would be ten thousand.
    """
    # rclpy has no public accessor for start parameters.
    started_with = [name for name in node._parameter_overrides if name.startswith("qos_overrides.")]
    if started_with and any(
        name.startswith(f"qos_overrides.{node.resolve_topic_name(topic)}.publisher.") for name in started_with
    ):
        # rclpy writes the overrides into the given profile.
        own = copy.copy(profile)
        return own, QoSOverridingOptions.with_default_policies()
    return profile, None
