"""Parts of tests of ROS nodes: a private graph, nodes under test, recorded topics, a stepped simulator.

All nodes live in the test's own process and thread: ours on one executor, each node under test on its own. Waiting
is always for a condition with a deadline, and simulated time is stepped, so that a slow machine changes nothing
(docs/spec/ros-packaging.md section 7).
"""

from __future__ import annotations

from thymio_sim_ros.testing.ros.graph import DEADLINE_S, Ros
from thymio_sim_ros.testing.ros.recorder import Recorder
from thymio_sim_ros.testing.ros.simulation import Simulation

__all__ = ["DEADLINE_S", "Recorder", "Ros", "Simulation"]
