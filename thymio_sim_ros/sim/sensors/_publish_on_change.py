"""Values that change rarely are reported on change, and once per second for programs that were reset meanwhile."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.plugin_api.view import BatchSensorView, SensorView

__all__ = ["REFRESH_NS", "should_publish", "should_publish_all"]

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


def should_publish_all(batch: BatchSensorView, values: npt.NDArray[np.int64]) -> npt.NDArray[np.bool_]:
    """`should_publish` for each robot: `values` has shape (robots,) or (robots, words); returns shape (robots,)."""
    now_ns, column_state = batch.now_ns, batch.column_state
    reported = column_state.column("reported", tuple(values[0].tolist()) if values.ndim > 1 else 0)
    refresh_ns = column_state.column("refresh_ns", 0)
    differ = reported != values
    is_due: npt.NDArray[np.bool_] = (differ.any(axis=1) if values.ndim > 1 else differ) | (now_ns >= refresh_ns)
    reported[is_due], refresh_ns[is_due] = values[is_due], now_ns + REFRESH_NS
    return is_due
