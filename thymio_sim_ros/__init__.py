"""A simulated Thymio II for ROS 2, Aseba and the browser."""

__version__ = "0.1.0"
