"""Errors of a class."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["ClassError"]


class ClassError(ThymioSimError):
    """A list of names or a folder that cannot be used; the text says where, what was found and what was expected."""
