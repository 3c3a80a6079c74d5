"""QoS profiles by kind of topic (docs/spec/ros-interface.md section 9)."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError


def _reliable(depth: int, durability: DurabilityPolicy = DurabilityPolicy.VOLATILE) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=durability
    )


SENSOR = _reliable(10)
"""Sensors and state: reliable, since driver code subscribes reliable."""

TRANSIENT_LOCAL = _reliable(1, DurabilityPolicy.TRANSIENT_LOCAL)
"""Latched: a late joiner gets the last message."""

TRANSFORMS = _reliable(100)
CLOCK = _reliable(1)
COMMAND = _reliable(1)
LEDS = _reliable(10)
EVENTS = _reliable(100)
"""Aseba events: nothing lost in bursts."""


KINDS: dict[str, tuple[QoSProfile, str]] = {
    "sensor": (SENSOR, "sensors and state; volatile"),
    "latched": (TRANSIENT_LOCAL, "a late joiner gets the last message; transient local"),
    "transforms": (TRANSFORMS, "as tf2 has it; volatile"),
    "clock": (CLOCK, "the newest counts; volatile"),
    "command": (COMMAND, "the newest wins; volatile"),
    "lights": (LEDS, "volatile"),
    "event": (EVENTS, "nothing lost in bursts; volatile"),
}
"""Every profile by the name that the reference gives it, and what it is for; all are reliable, keep last."""


def kind_of(profile: QoSProfile) -> str:
    """The name of one of our profiles; some that differ in purpose alone share the first name."""
    return next(kind for kind, (known, _) in KINDS.items() if known is profile)


_POLICIES: Mapping[str, type[HistoryPolicy] | type[ReliabilityPolicy] | type[DurabilityPolicy]] = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
}
_MAX_DEPTH = 2**31 - 1


def check_overrides(node: Node) -> None:
    """StartError for a `qos_overrides.<topic>.publisher.…` that the node was started with and no publisher can have."""
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
            raise StartError(f"parameter {name}: {value!r} found, expected {expected}")


def overridable(node: Node, topic: str, profile: QoSProfile) -> dict[str, Any]:
    """Arguments of `create_publisher`: its profile, and the parameters `qos_overrides.<topic>.publisher.…`.

    They are declared only where the node was started with one of them: for every topic of a hundred robots they would
    be ten thousand.
    """
    # rclpy tells nobody what a node was started with but the node itself.
    started_with = [name for name in node._parameter_overrides if name.startswith("qos_overrides.")]
    if started_with and any(
        name.startswith(f"qos_overrides.{node.resolve_topic_name(topic)}.publisher.") for name in started_with
    ):
        # rclpy writes the overrides into the profile that it is given.
        own = copy.copy(profile)
        return {"qos_profile": own, "qos_overriding_options": QoSOverridingOptions.with_default_policies()}
    return {"qos_profile": profile}
