"""Runs a student's program in a process of its own against simulated time (docs/grading.md, "Grade a program").

The test gives the program a turn in each tick (`thymio_sim_ros.testing.ros.program`). In a turn one thread of the
program runs at a time, until all of them wait for time, messages or input. What waits is replaced before the program is
loaded, so that only simulated time ends a wait:

- `turns`: the threads, simulated time, and whose turn it is
- `threads`, `clocks`, `keyboard`: locks and threads, `time` and `select`, standard input
- `program_graph`, `graph_link`: the embedded graph, and how it is one with that of the test
- `installed_ros`, `matching`: the same with an installed ROS: waits of rclpy, discovery, marks behind messages
- `channel`, `real_time`: the pipe between both processes, and waits for the other one
- `main`: the process
"""
