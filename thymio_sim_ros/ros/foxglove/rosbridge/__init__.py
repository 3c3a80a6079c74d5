"""Clients of rosbridge on the ROS graph (docs/rosbridge.md). Everything here belongs to the executor's thread."""
