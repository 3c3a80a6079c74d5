"""The action of a server of transforms."""

from __future__ import annotations

from thymio_sim_ros.ros.compat.absent_types import AbsentType, absent

__all__ = ["LookupTransform"]

LookupTransform: AbsentType = absent("tf2_msgs.action", "LookupTransform")
