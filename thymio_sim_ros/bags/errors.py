"""Errors of bags."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["BagError"]


class BagError(ThymioSimError):
    """A bag cannot be written or read; the text is one line with its path."""
