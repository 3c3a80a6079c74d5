"""The message of `/tf`."""

from __future__ import annotations

from thymio_sim_ros.ros.compat.tf2_messages import TFMessage

__all__ = ["TFMessage"]
