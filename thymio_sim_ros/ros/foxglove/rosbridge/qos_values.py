"""QoS profiles as values of operations (docs/rosbridge.md, section QoS)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from thymio_sim_ros.ros.foxglove.rosbridge.host import RefusedError

__all__ = ["from_profile", "to_profile"]

_POLICIES = {"reliability": ReliabilityPolicy, "durability": DurabilityPolicy, "history": HistoryPolicy}
_DEFAULTS = {"reliability": "reliable", "durability": "volatile", "history": "keep_last"}

MAX_DEPTH = 1000


def to_profile(value: Mapping[str, Any], where: str) -> QoSProfile:
    """The profile that a client asks for. Raises RefusedError, with the place `where`."""
    policies = {key: _policy(key, value.get(key) or default, where) for key, default in _DEFAULTS.items()}
    depth = value.get("depth", 10)
    if not isinstance(depth, int) or isinstance(depth, bool) or not 0 <= depth <= MAX_DEPTH:
        raise RefusedError(f"{where}.depth: expected an integer in 0…{MAX_DEPTH}, found {depth!r:.40}")
    return QoSProfile(depth=max(depth, 1), **policies)


def _policy(key: str, value: object, where: str) -> Any:
    for policy in _POLICIES[key]:
        if value in (policy.name.lower(), policy.value) and not isinstance(value, bool):
            return policy
    known = ", ".join(policy.name.lower() for policy in _POLICIES[key])
    raise RefusedError(f"{where}.{key}: expected one of {known}, found {value!r:.40}")


def from_profile(profile: QoSProfile) -> dict[str, str | int]:
    """A profile for a client."""
    return {key: getattr(profile, key).name.lower() for key in _POLICIES} | {"depth": profile.depth}
