"""Recordings of topics in bags, which `ros2 bag`, Foxglove and rosbags read, and their playback; nodes on any graph."""
