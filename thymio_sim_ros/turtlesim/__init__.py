"""The programs of turtlesim that its courses start: `thymio-sim node -m thymio_sim_ros.turtlesim.turtle_teleop_key`."""
