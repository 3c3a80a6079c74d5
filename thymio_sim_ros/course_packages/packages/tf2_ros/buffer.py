"""The buffer of `tf2_ros`."""

from __future__ import annotations

from thymio_sim_ros.tf.buffer import Buffer

__all__ = ["Buffer"]
