"""The error of a cluster that cannot be used."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["EngineError"]


class EngineError(ThymioSimError):
    """A cluster that cannot be reached, was lost, or has other versions of the packages; the text is one line."""
