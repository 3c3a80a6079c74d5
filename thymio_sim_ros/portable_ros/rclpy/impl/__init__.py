"""Parts of rclpy that programs import although they are not documented."""
