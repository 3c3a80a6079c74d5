"""All topics of the simulator: those of the world, of the robots and of transforms, and which have subscribers."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from rclpy.node import Node

from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand
from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode
from thymio_sim_ros.ros.simulator.clock_publisher import ClockPublisher
from thymio_sim_ros.ros.simulator.parameters import SimulatorParams
from thymio_sim_ros.ros.simulator.robot_endpoint_set import RobotEndpointSet
from thymio_sim_ros.ros.simulator.robot_endpoints import RobotEndpoints
from thymio_sim_ros.ros.simulator.visualization.transforms import POSE_SENSOR, Transforms
from thymio_sim_ros.ros.simulator.world_endpoints import WorldEndpoints
from thymio_sim_ros.sim.plugin_api.reading_table import select_rows
from thymio_sim_ros.sim.world import StepResult, World

__all__ = ["SimulatorEndpoints"]

POLL_PERIOD_NS = SECOND_NS // 20
"""Shortest wall time between two polls for subscribers; longer with many topics, so that polling uses at most 1 % of a
core."""

POLL_COST_NS = 1_000
"""Cost of polling one topic (docs/spec/ros-packaging.md section 9)."""


class SimulatorEndpoints:
    """Owns the publishers of the simulator. Readings are converted only for topics with subscribers."""

    def __init__(
        self,
        node: Node,
        control: Node | LocalNode,
        params: SimulatorParams,
        make: Callable[[str, RobotNames], RobotEndpoints],
        *,
        is_localized: bool = True,
        frames: Sequence[str] = (),
    ) -> None:
        """`control` publishes the topics of the world; `make` creates the endpoints of a robot from its name in the
        world and its ROS names. `is_localized`, `frames`: see `TransformOptions`.
        """
        self.clock = ClockPublisher(node, is_on=params.publish_clock, rate_hz=params.clock_rate)
        self.world = WorldEndpoints(node, control, publish_map=params.publish_map, map_frame=params.map_frame)
        self.demand = SubscriberDemand(params.published_periods_ns)
        self.robots = RobotEndpointSet(make, params.naming)
        options = replace(params.transform_options, is_localized=is_localized, frames=tuple(frames))
        self._transforms = Transforms(node, self.demand, options)
        self._polled_ns = self._poll_period_ns = 0

    def poll_if_due(self, wall_ns: int) -> None:
        """Call `poll` if the last one is long enough ago; `wall_ns` is of `time.monotonic_ns`."""
        if wall_ns - self._polled_ns >= self._poll_period_ns:
            self.poll()

    def poll(self) -> None:
        """Find out which topics have subscribers."""
        self._polled_ns = time.monotonic_ns()
        self._poll_period_ns = max(POLL_PERIOD_NS, 100 * POLL_COST_NS * self.robots.topics)
        self.robots.poll()
        self._transforms.poll()
        self.clock.poll()

    def reset_robots(self, robots: Iterable[str]) -> None:
        """Serve the robots of a new or reset world; retained messages and static frames are published again."""
        self.robots.reset(robots)
        self._transforms.restart()
        self._set_frames()

    def update_robots(self, robots: Iterable[str]) -> bool:
        """Create or destroy topics and frames if robots were added or removed; return whether there was a change."""
        if not self.robots.update(robots):
            return False
        self._set_frames()
        return True

    def publish_readings(self, world: World, result: StepResult) -> None:
        """Publish the readings of one tick on the topics that have subscribers."""
        for robot, sensor, reading in select_rows(result.readings, self.demand.sensors):
            endpoints = self.robots[robot]
            endpoints.publish(sensor, reading)
            if sensor == POSE_SENSOR:
                self._transforms.add_reading(endpoints.names, reading, world.robots[robot].wheels.angles_rad)
        self._transforms.flush()

    def publish_poses(self, world: World) -> None:
        """Publish the true poses of all robots of a paused world for late subscribers."""
        for name, robot in world.robots.items():
            self.robots[name].publish_pose(world.now_ns, robot.pose, robot.tilt, robot.height_m)

    def _set_frames(self) -> None:
        self._transforms.set_robots(tuple(self.robots.names.values()))
