"""The error of a command, and its exit code."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["USAGE_ERROR", "UsageError"]

USAGE_ERROR = 2
"""Exit code for rejected input, as of `argparse`."""


class UsageError(ThymioSimError):
    """A request that cannot be executed; the text is one line."""
