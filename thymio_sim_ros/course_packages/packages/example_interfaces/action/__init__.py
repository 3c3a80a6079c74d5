"""The action."""

from __future__ import annotations

from thymio_sim_ros.ros.compat.absent_types import AbsentType, absent

__all__ = ["Fibonacci"]

Fibonacci: AbsentType = absent("example_interfaces.action", "Fibonacci")
