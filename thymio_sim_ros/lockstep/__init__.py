"""Runs a student's program in a process of its own against simulated time (docs/grading.md, "Grade a program").

The test gives the program a turn in each tick (`thymio_sim_ros.testing.ros.program`). In a turn one thread of the
program runs at a time, until all of them wait for time, messages or input. What waits is replaced before the program is
loaded, so that only simulated time ends a wait:

- `turns`: the threads, simulated time, and whose turn it is
- `threads`, `clocks`, `keyboard`: locks and threads, `time` and `select`, standard input
- `ros_waits`, `ros_graph`: clocks, timers and executors of rclpy; discovery and the barrier between processes
- `barrier`, `matching`, `channel`: what both processes use
- `main`: the process
"""
