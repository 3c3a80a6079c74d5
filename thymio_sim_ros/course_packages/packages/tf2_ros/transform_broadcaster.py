"""The broadcaster of `tf2_ros`."""

from __future__ import annotations

from thymio_sim_ros.tf.broadcasters import TransformBroadcaster

__all__ = ["TransformBroadcaster"]
