"""What changes rarely is told when it changes, and once a second for programs that were reset meanwhile."""

from __future__ import annotations

from thymio_sim_ros.sim.view import SensorView

__all__ = ["REFRESH_NS", "is_news"]

REFRESH_NS = 1_000_000_000


def is_news(view: SensorView, value: object) -> bool:
    """Whether a value differs from the one told last, or that was told a second ago; it then counts as told.

    `memory["refresh_ns"]` is when it will be told again anyway.
    """
    memory, now_ns = view.memory, view.now_ns
    if value == memory.get("told") and now_ns < memory["refresh_ns"]:
        return False
    memory["told"], memory["refresh_ns"] = value, now_ns + REFRESH_NS
    return True
