"""The listener of `tf2_ros`."""

from __future__ import annotations

from thymio_sim_ros.tf.transform_listener import TransformListener

__all__ = ["TransformListener"]
