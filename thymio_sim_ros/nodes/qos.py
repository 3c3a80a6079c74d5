"""QoS profiles by kind of topic (ros-interface.md section 9)."""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy


def _reliable(depth: int, durability: DurabilityPolicy = DurabilityPolicy.VOLATILE) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=durability
    )


SENSOR = _reliable(10)
"""Sensors and state: reliable, since driver code subscribes reliable."""

LATCHED = _reliable(1, DurabilityPolicy.TRANSIENT_LOCAL)
"""Latched: a late joiner gets the last message."""

TRANSFORMS = _reliable(100)
CLOCK = _reliable(1)
COMMAND = _reliable(1)
LEDS = _reliable(10)
EVENTS = _reliable(100)
"""Aseba events: nothing lost in bursts."""
