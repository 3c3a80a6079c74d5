"""The error of a sweep that cannot be run as described."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["SweepError"]


class SweepError(ThymioSimError, ValueError):
    """A description, a table or a parameter that is rejected: where, what was found, what was expected."""
