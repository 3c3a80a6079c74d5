"""The service that returns the tree of frames."""

from __future__ import annotations

from thymio_sim_ros.ros.compat.absent_types import AbsentType, absent

__all__ = ["FrameGraph"]

FrameGraph: AbsentType = absent("tf2_msgs.srv", "FrameGraph")
