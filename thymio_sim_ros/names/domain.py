"""The ROS domain and discovery range of a process, as text."""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["describe_domain", "describe_range"]

_RANGES = {
    "": "this network",
    "SYSTEM_DEFAULT": "as DDS is configured",
    "SUBNET": "this network",
    "LOCALHOST": "this computer only",
    "OFF": "this process only",
}


def describe_domain(environment: Mapping[str, str], number: int | None = None) -> str:
    """Describe domain and discovery range in one line, from the variables of ROS; `number` is the domain, if known."""
    domain = environment.get("ROS_DOMAIN_ID") or "0"
    return f"ROS_DOMAIN_ID {domain if number is None else number}, {describe_range(environment)}"


def describe_range(environment: Mapping[str, str]) -> str:
    """Describe from where programs of the same domain are found."""
    given = environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").upper()
    if environment.get("ROS_LOCALHOST_ONLY") == "1":  # older, and has priority
        given = "LOCALHOST"
    return _RANGES.get(given, _RANGES[""])
