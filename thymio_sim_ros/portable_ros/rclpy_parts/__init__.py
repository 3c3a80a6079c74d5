"""What the modules of `rclpy/` are made of: no program imports it, and rclpy has no such modules."""

# The modules of both folders import each other in the order that `rclpy` begins.
import thymio_sim_ros.portable_ros.rclpy  # noqa: F401 - imported for the order
