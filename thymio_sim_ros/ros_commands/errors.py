"""Errors of commands."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["CommandError"]


class CommandError(ThymioSimError):
    """A command cannot do what it was asked for; the text is one line."""
