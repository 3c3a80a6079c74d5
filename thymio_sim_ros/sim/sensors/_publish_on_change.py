"""Values that change rarely are reported on change, and once per second for programs that were reset meanwhile."""

from __future__ import annotations

from thymio_sim_ros.sim.plugin_api.view import SensorView

__all__ = ["REFRESH_NS", "should_publish"]

REFRESH_NS = 1_000_000_000


def should_publish(view: SensorView, value: object) -> bool:
    """Return whether a value differs from the last one published, or that was a second ago; then store it as published.

    `memory["refresh_ns"]` is when it is reported again without a change.
    """
    memory, now_ns = view.memory, view.now_ns
    if value == memory.get("reported") and now_ns < memory["refresh_ns"]:
        return False
    memory["reported"], memory["refresh_ns"] = value, now_ns + REFRESH_NS
    return True
