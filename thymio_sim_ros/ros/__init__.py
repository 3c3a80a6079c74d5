"""The only folder that imports rclpy: thin nodes around the pure packages (docs/architecture.md)."""
