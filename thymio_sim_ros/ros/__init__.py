"""ROS nodes: the only package that imports rclpy, with thin nodes around the pure packages (docs/architecture.md)."""
