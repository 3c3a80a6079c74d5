"""The errors of the grader."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["DestroyedError", "GradingError"]


class GradingError(ThymioSimError):
    """A class cannot be graded at all; the text says where, what was found, what was expected."""


class DestroyedError(GradingError):
    """A sandbox was ended from outside, perhaps by the submission in it."""
