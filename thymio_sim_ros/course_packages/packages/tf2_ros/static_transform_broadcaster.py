"""The broadcaster of static transforms of `tf2_ros`."""

from __future__ import annotations

from thymio_sim_ros.tf.broadcasters import StaticTransformBroadcaster

__all__ = ["StaticTransformBroadcaster"]
