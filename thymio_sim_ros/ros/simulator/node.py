"""The simulator as a ROS node: creates its parts, connects them and runs their loop.

One thread does everything: between ticks the executor delivers messages, whose callbacks only convert and post. The
world is paced by absolute deadlines, never by a ROS timer (docs/architecture.md, "Threads"). Topics, services and
parameters: docs/spec/ros-interface.md sections 4, 5 and 10.
"""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from rclpy.context import Context
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.parameter_service import ParameterService

from thymio_sim_ros.engine.replay import last_run
from thymio_sim_ros.engine.run_log import RunLogError
from thymio_sim_ros.names.domain import describe_domain
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.interface import driver_topics, qos
from thymio_sim_ros.ros.interface.extra_topics import ExtraTopics
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.names import RobotNames, full_name
from thymio_sim_ros.ros.profiles import Profile
from thymio_sim_ros.ros.profiles._actions import PLAIN
from thymio_sim_ros.ros.rclpy_ext import parameters as params
from thymio_sim_ros.ros.rclpy_ext.connections import Connections
from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports
from thymio_sim_ros.ros.rclpy_ext.node_runner import AnnouncedNode, StartError, announce, run_main
from thymio_sim_ros.ros.rclpy_ext.parameter_node import parameter_node
from thymio_sim_ros.ros.simulator.diagnostics import Diagnostics
from thymio_sim_ros.ros.simulator.endpoints import SimulatorEndpoints
from thymio_sim_ros.ros.simulator.mission_endpoints import MissionEndpoints
from thymio_sim_ros.ros.simulator.parameter_callbacks import ParameterCallbacks, reject_sim_time
from thymio_sim_ros.ros.simulator.parameters import CurrentParams, LidarParams, SimulatorParams
from thymio_sim_ros.ros.simulator.prepared_playground import LOAD_ERRORS, PreparedPlayground, new_engine
from thymio_sim_ros.ros.simulator.profile.host import ProfileHost
from thymio_sim_ros.ros.simulator.recording import Recording
from thymio_sim_ros.ros.simulator.robot_access import RobotAccess
from thymio_sim_ros.ros.simulator.robot_endpoints import RobotEndpoints
from thymio_sim_ros.ros.simulator.simulation_interfaces import services
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.ros.simulator.world_services import WorldServices

__all__ = ["Simulator", "SimulatorParams", "main"]

HEARTBEAT_NS = SECOND_NS
"""Wall time between heartbeats. While paused, each repeats the clock for late subscribers."""


class Simulator:
    """The simulator node. `runner` owns the engine, `endpoints` the publishers, `params` the current parameters.
    Invariant: only `run_once` and callbacks of `node` use them.
    """

    def __init__(
        self,
        context: Context,
        defaults: SimulatorParams | None = None,
        *,
        is_closed: bool = False,
        is_localized: bool = True,
        profile: Profile | None = None,
    ) -> None:
        """`profile`: the robot whose names and types there are besides.
        `is_closed`: only this process reaches services, parameters and topics of the world, by `control`.
        `is_localized`: whether transforms have the true pose on the map, or that of the odometry.

        Raises StartError for a playground, a parameter, a profile or a log file that cannot be used.
        """
        self.node = parameter_node(
            "simulator",
            context=context,
            is_set_again=lambda name: name == "playground",
            repeat=self._repeat,
            has_acted=self._has_loaded,
            start_parameter_services=not is_closed,
        )
        self.control: Node | LocalNode = LocalNode(self.node) if is_closed else self.node
        """Has the endpoints of the world, and those by which an operator acts on a robot."""
        try:
            reject_sim_time(self.node)
            self.params = CurrentParams(params.declare(self.node, defaults or SimulatorParams()))
            values = self.params.values
            params.warn_of_unknown(self.node, "ros.md")
            qos.check_overrides(self.node)
            logged = last_run(Path(values.replay)) if values.replay else None
            if logged is not None:
                values = replace(values, lidar=LidarParams.of(logged.start.world.lidar))
                self.params.values = values
            if logged is None:
                prepared = PreparedPlayground.load(values.playground, values)
            else:
                prepared = PreparedPlayground.of(logged.name, logged.start.playground, values)
            self._recording = Recording(self.node, values.log)
        except (*LOAD_ERRORS, RunLogError) as error:
            self.node.destroy_node()
            raise StartError(str(error)) from error
        self._profile = self._host(context, profile)
        self._last_heartbeat_ns = 0
        self.attached: Sequence[AnnouncedNode] = ()
        """Nodes that the thread of this one runs as well, since they use the engine."""
        self._messages = MessageReports(self.node)
        self.endpoints = SimulatorEndpoints(
            self.node,
            self.control,
            values,
            self._new_robot,
            is_localized=is_localized,
            frames=self._profile.profile.frames,
        )
        extra = driver_topics.found(self.node) if values.driver_topics else ExtraTopics()
        own = values.endpoint_options
        self._robot_options = replace(own, extra=extra, left_out=own.left_out | self._profile.profile.replaces)
        if logged is None:
            engine = new_engine(prepared.playground, values, prepared.ground)
        else:
            engine = logged.new_engine(prepared.ground)
        self._connections = Connections(
            self.node,
            values.switched_off,
            beside=self._profile.nodes,
            missing=self._profile.profile.missing_name,
            actions=self._profile.actions,
        )
        self.runner = WorldRunner(
            self.node,
            self.params,
            self.endpoints,
            self._connections,
            self._messages,
            self._recording,
            prepared,
            engine,
            logged,
        )
        self._profile.attach(self.runner, self._messages)
        self.runner.start()
        if logged is not None:
            self.runner.step(logged.tick_at(values.replay_from))
        self.parameter_callbacks = ParameterCallbacks(self.node, self.params, self.runner)
        robots = self.endpoints.robots
        self.missions = MissionEndpoints(self.control, self.runner, robots, self.parameter_callbacks)
        self._services = WorldServices(self.control, self.runner, robots, self._messages, self.missions)
        self._diagnostics = Diagnostics(self.node, self._messages, self._connections, self.endpoints.clock.conflict)
        self._interfaces: services.SimInterfaces | None = None
        if isinstance(self.control, LocalNode):
            self._parameter_services = ParameterService(self.control)
        else:
            self._interfaces = services.offered(self.node, self.runner, self.params, self.parameter_callbacks)

    @property
    def startup_message(self) -> str:
        """Playground, robots and domain, for the user."""
        names = self.endpoints.robots.names.values()
        robots = ", ".join(full_name(self.node, one.name).rstrip("/") or "/" for one in names)
        where = describe_domain(os.environ, self.node.context.get_domain_id())
        name = self._profile.profile.name
        like = f"like {name}, " if name else ""
        return f"Playground {self.runner.prepared.name}, {like}robots in {robots or 'none'}; {where}"

    @property
    def peers(self) -> Sequence[Node]:
        """The ROS nodes that the executor of this one spins as well."""
        return [*self._profile.nodes, *(attached.node for attached in self.attached)]

    def run_once(self, executor: Executor) -> None:
        """Execute the ticks that are due, then handle messages until the next tick with a visible result."""
        now_ns = time.monotonic_ns()
        self.endpoints.poll_if_due(now_ns)
        self.runner.run_due_ticks(now_ns)
        if now_ns - self._last_heartbeat_ns >= HEARTBEAT_NS:
            self._publish_heartbeat(now_ns)
        self.endpoints.world.publish_overview_if_due(self.runner.world, now_ns)
        self.runner.spin(executor)

    def interrupt(self) -> None:
        """Give up a playground that is being loaded."""
        self.runner.is_ending = True

    def stop(self) -> None:
        """Stop the attached nodes, and close the run log."""
        for attached in self.attached:
            attached.stop()
        self._recording.close()

    def close(self) -> None:
        """Close the log and destroy the node."""
        self.stop()
        for attached in self.attached:
            attached.close()
        if self._interfaces is not None:
            self._interfaces.close()
        self._profile.close()
        self.node.destroy_node()

    def _repeat(self, parameter: str) -> str:
        """Return how the world restarts, for a parameter whose change restarts it."""
        is_of_world = parameter in ("playground", "seed")
        return f"the service {self.node.get_fully_qualified_name()}/reset restarts the world" if is_of_world else ""

    def _has_loaded(self) -> bool:
        return self.parameter_callbacks.has_loaded

    def _new_robot(self, robot: str, names: RobotNames) -> RobotEndpoints:
        owner = RobotAccess(robot, names, self.runner, self.params, self._messages)
        options, demand = self._robot_options, self.endpoints.demand
        other = self._profile.open(robot, names)
        return RobotEndpoints(
            self.node, names, owner, options=options, demand=demand, control=self.control, other=other
        )

    def _host(self, context: Context, profile: Profile | None) -> ProfileHost:
        """Create the endpoints of a profile. Raises StartError."""
        try:
            return ProfileHost(context, self.node, PLAIN if profile is None else profile)
        except StartError:
            self.node.destroy_node()
            raise

    def _publish_heartbeat(self, now_ns: int) -> None:
        self._last_heartbeat_ns = now_ns
        if self.runner.paused:
            self.endpoints.clock.publish(self.runner.world.now_ns, last=True)
            self.runner.update_robots()
            self.endpoints.publish_poses(self.runner.world)
        self._connections.poll()
        self.runner.publish_state()
        self._diagnostics.publish(self.runner.state(), self.runner.scheduler)


def main(args: Sequence[str] | None = None) -> int:
    """Run the executable `simulator`."""
    with dds_profile.used(dds_profile.ALONE):
        return run_main(lambda context: announce([Simulator(context)]), args)


if __name__ == "__main__":
    raise SystemExit(main())
