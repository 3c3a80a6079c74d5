"""The exception of `tf2_ros.buffer_interface`."""

from __future__ import annotations

from thymio_sim_ros.tf.errors import TypeException

__all__ = ["TypeException"]
