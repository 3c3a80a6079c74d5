"""Replaces the package `tf_transformations` where it is not installed (docs/tf.md)."""

from __future__ import annotations

from thymio_sim_ros.tf import transformations
from thymio_sim_ros.tf.transformations import *  # noqa: F403

__all__ = transformations.__all__
