"""The few verbs of `ros2 topic`, `node`, `service`, `param`, `action` and `interface` that tutorials need.

`arguments.py` reads the words and imports no rclpy; `commands.py` runs a verb as a hidden node. The output is that of
ros2cli for the same verb.
"""
