"""The error of an environment that cannot be made as asked."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["TaskError"]


class TaskError(ThymioSimError, ValueError):
    """A task, or a playground that does not fit it: what was found, and what was expected."""
