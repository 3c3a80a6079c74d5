"""The compiled part of rclpy, as far as it is here."""

from thymio_sim_ros.portable_ros.rclpy import _rclpy_pybind11 as rclpy_implementation

__all__ = ["rclpy_implementation"]
