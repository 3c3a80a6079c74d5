"""The simulator as a ROS node: owns the world, steps it, publishes readings and posts commands.

One thread does everything: between ticks the executor delivers messages, whose callbacks only convert and post. The
world is paced by absolute deadlines, never by a ROS timer (docs/architecture.md, "Threads"). Ticks without a result
that any subscriber would see are deferred and executed together, at the latest when a message arrives; the command in
it takes effect in the next tick, as if no tick had been deferred. Topics, services and parameters:
docs/spec/ros-interface.md sections 4, 5 and 10.
"""

from __future__ import annotations

import os
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from rcl_interfaces.msg import SetParametersResult
from rclpy.context import Context
from rclpy.executors import Executor
from rclpy.parameter import Parameter

from thymio_sim_ros import resources
from thymio_sim_ros.domain import describe_domain
from thymio_sim_ros.loading import load_playground
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.interface import driver_topics, qos
from thymio_sim_ros.ros.interface.driver_topics import DriverTopics
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.names import RobotNames, full_name
from thymio_sim_ros.ros.interface.raw_topic import RawTopic
from thymio_sim_ros.ros.interface.robot_inputs import InputContext
from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand
from thymio_sim_ros.ros.rclpy_ext import parameters as params
from thymio_sim_ros.ros.rclpy_ext.node_runner import SPIN_SLICE_S, StartError, announce, deliver, run_main
from thymio_sim_ros.ros.rclpy_ext.parameter_node import parameter_node
from thymio_sim_ros.ros.rclpy_ext.type_mismatch import TypeMismatches
from thymio_sim_ros.ros.simulator import robot_endpoints
from thymio_sim_ros.ros.simulator.deferred_load import DeferredLoad
from thymio_sim_ros.ros.simulator.parameters import SimulatorParams
from thymio_sim_ros.ros.simulator.robot_endpoint_set import RobotEndpointSet
from thymio_sim_ros.ros.simulator.robot_endpoints import RobotEndpoints
from thymio_sim_ros.ros.simulator.simulation_interfaces import services
from thymio_sim_ros.ros.simulator.transforms import POSE_SENSOR, Transforms, frames_of
from thymio_sim_ros.ros.simulator.world_endpoints import PaceCounters, SceneMessages, WorldEndpoints, WorldState
from thymio_sim_ros.ros.simulator.world_services import WorldServices
from thymio_sim_ros.runlog.run_log import RunLog
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model.clock import TICK_NS, Pacer
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError, RobotStart
from thymio_sim_ros.sim.plugin_api.reading_table import select_rows
from thymio_sim_ros.sim.world import World

__all__ = ["Simulator", "SimulatorParams", "main"]

USE_SIM_TIME = "use_sim_time"
SIM_TIME_REASON = "the simulator is the source of simulated time, it cannot follow /clock"

MAX_NOTES = 20
"""Number of notes about a playground in the state; the log has all of them."""

HEARTBEAT_NS = SECOND_NS
"""Period of heartbeats. While paused, each repeats the clock for late subscribers."""


MAX_DEFERRED_TICKS = 10
"""Largest number of deferred ticks: changes are published at most this much later (0.1 s of wall time)."""

POLL_PERIOD_NS = SECOND_NS // 20
"""Shortest wall time between two polls for subscribers; longer with many topics, so that polling uses at most 1 % of a
core."""
POLL_COST_NS = 1_000
"""Cost of polling one topic (docs/spec/ros-packaging.md section 9)."""

MAX_CATCH_UP_TICKS = 2 * MAX_DEFERRED_TICKS
"""Largest number of ticks executed at once after the machine was busy; further late ticks are dropped."""


@dataclass(frozen=True, slots=True)
class _Prepared:
    """A playground with renamed robots, and the slow results derived from it, ready for a world."""

    name: str
    playground: Playground
    ground: Ground
    scene: SceneMessages


class Simulator:
    """The simulator node and its world.

    Invariant: only `run_once`, `advance` and callbacks of `node` touch the world.
    """

    def __init__(self, context: Context, defaults: SimulatorParams | None = None) -> None:
        self.node = parameter_node("simulator", context=context, names_file=lambda name: name == "playground")
        try:
            self._reject_sim_time()
            self.params = params.declare(self.node, defaults or SimulatorParams())
            params.warn_of_unknown(self.node, "ros.md")
            qos.check_overrides(self.node)
            self._loader = DeferredLoad(self.node, "playground", self._prepare)
            prepared = self._prepare(self.params.playground)
            self._log = self._open_log(self.params.log)
        except (PlaygroundError, resources.ResourceError, StartError, OSError) as error:
            self.node.destroy_node()
            raise StartError(str(error)) from error
        self.paused = self.params.start_paused
        self._is_spinning = False
        self._polled_ns = self._poll_period_ns = 0
        self._prompt_until_ns = 0
        """Simulated time until which no tick is deferred, since a message has arrived."""
        self._set_pace()
        self._refused = self._limited = self._last_heartbeat_ns = 0
        self._published_fallen: frozenset[str] = frozenset()
        self._content = self.params.convert_options
        self._world_endpoints = WorldEndpoints(
            self.node,
            publish_clock=self.params.publish_clock,
            clock_rate_hz=self.params.clock_rate,
            publish_map=self.params.publish_map,
            map_frame=self.params.map_frame,
        )
        self._demand = SubscriberDemand(self.params.periods_ns)
        self._raw = RawTopic(self._world_endpoints.raw, self._demand)
        self._transforms = Transforms(self.node, self._demand, self.params.transform_options)
        self._endpoint_options = replace(self.params.endpoint_options, extra=self._driver_topics())
        self._robot_endpoints = RobotEndpointSet(self._new_endpoints, self.params.naming)
        self.playground_name, self._scene = prepared.name, prepared.scene
        self._set_world(self._new_world(prepared.playground, self.params, prepared.ground))
        self._services = WorldServices(self.node, self)
        self._type_mismatches = TypeMismatches(self.node)
        self._interfaces = services.offered(self.node, self)
        self._accepted: tuple[_Prepared, World] | None = None
        self.node.add_on_set_parameters_callback(self._check_parameters)
        self.node.add_post_set_parameters_callback(self._apply_parameters)

    @property
    def names(self) -> Mapping[str, RobotNames]:
        """ROS names of the robots by their name in the world."""
        return self._robot_endpoints.by_robot

    @property
    def map_frame(self) -> str:
        """Name of the world frame."""
        return self.params.map_frame

    @property
    def playground(self) -> str:
        """The playground as given: name, path or text."""
        return self.params.playground

    @property
    def startup_message(self) -> str:
        """Playground, robots and domain, for the user."""
        robots = ", ".join(full_name(self.node, names.name).rstrip("/") or "/" for names in self.names.values())
        where = describe_domain(os.environ, self.node.context.get_domain_id())
        return f"Playground {self.playground_name}, robots in {robots or 'none'}; {where}"

    def run_once(self, executor: Executor) -> None:
        """Execute the ticks that are due, then handle messages until the next tick with a visible result."""
        now = time.monotonic_ns()
        if now - self._polled_ns >= self._poll_period_ns:
            self._poll_subscribers()
        if self.paused:
            if now - self._last_heartbeat_ns >= HEARTBEAT_NS:
                self._publish_heartbeat(now)
            executor.spin_once(timeout_sec=SPIN_SLICE_S)
            return
        if not self._pacer.wait_ns(now, self._wanted_ticks()):
            self._run_guarded(self._run_owed)
        if now - self._last_heartbeat_ns >= HEARTBEAT_NS:
            self._publish_heartbeat(now)
        wait_s = self._pacer.wait_ns(time.monotonic_ns(), self._wanted_ticks()) / SECOND_NS
        if wait_s > 0.0:
            self._is_spinning = True
            executor.spin_once(timeout_sec=min(wait_s, SPIN_SLICE_S))
            self._is_spinning = False
        else:
            deliver(executor)

    def advance(self, ticks: int) -> None:
        """Step the world by ticks of 10 ms, also while paused, and publish their results."""
        self._poll_subscribers()
        self._advance(ticks)

    def catch_up(self) -> None:
        """Execute the deferred ticks: a request or a command has arrived, which must see the present world."""
        if self._is_spinning and not self.paused:
            self._run_guarded(self._run_owed)
        self._prompt_until_ns = self.world.now_ns + TICK_NS

    def update_robots(self) -> None:
        """Create or destroy topics and frames if robots were added or removed."""
        if self._robot_endpoints.update(self.world.robots):
            self._transforms.set_robots(self._robot_endpoints.names)
            self._publish_state()

    def pause(self, paused: bool) -> None:
        """Pause or resume the simulation."""
        self.paused = paused
        self._set_pace()
        self._world_endpoints.publish_clock(self.world.now_ns, last=True)
        self._publish_state()

    def step(self, ticks: int | None = None) -> bool:
        """Execute `ticks`, by default those of one `~/step`; False if the world stopped with an internal error."""
        is_done = self._run_guarded(lambda: self.advance(self.params.step_ticks if ticks is None else ticks))
        self._world_endpoints.publish_clock(self.world.now_ns, last=True)
        self._publish_state()
        return is_done

    def spawn(self, start: RobotStart) -> None:
        """Add a robot.

        Raises ValueError as `World.spawn` does, and for a name that is the first word of a nameless robot's topics.
        """
        has_nameless = any(not names.name for names in self.names.values())
        if has_nameless and start.name in robot_endpoints.first_words():
            raise ValueError(f"the name '{start.name}' is taken by topics of the robot that has no name")
        self.world.spawn(start)

    def reset(self) -> None:
        """Reset world, time and noise to the start."""
        self.world.reset()
        self._publish_start()

    def load(self, playground: str) -> str:
        """Load a playground (name, path or text) or reload the current one; return the reason if it is rejected."""
        before = self.world
        result = self.node.set_parameters_atomically([Parameter("playground", value=playground)])
        if result.successful and self.world is before:
            self.reset()
        return "" if result.successful else str(result.reason)

    def count_refusal(self) -> None:
        """Count a rejected message for the diagnostics."""
        self._refused += 1

    def count_limited(self) -> None:
        """Count a clamped message for the diagnostics."""
        self._limited += 1

    def stop(self) -> None:
        """Close the run log."""
        if self._log is not None:
            self._log.close()
            self._log = None

    def close(self) -> None:
        """Close the log and destroy the node."""
        self.stop()
        self._loader.close()
        if self._interfaces is not None:
            self._interfaces.close()
        self.node.destroy_node()

    def _poll_subscribers(self) -> None:
        """Find out which topics have subscribers."""
        self._polled_ns = time.monotonic_ns()
        self._poll_period_ns = max(POLL_PERIOD_NS, 100 * POLL_COST_NS * self._robot_endpoints.topics)
        self._robot_endpoints.poll()
        self._raw.poll()
        self._transforms.poll()
        self._world_endpoints.poll()

    def _advance(self, ticks: int) -> None:
        self.update_robots()
        for _ in range(ticks):
            result = self.world.step()
            for robot, sensor, reading in select_rows(result.readings, self._demand.sensors):
                endpoints = self._robot_endpoints[robot]
                endpoints.publish(sensor, reading)
                self._raw.add(endpoints.names.name, sensor, reading)
                if sensor == POSE_SENSOR:
                    self._transforms.add_reading(endpoints.names, reading, self.world.robots[robot].wheels.angles_rad)
            self._raw.flush()
            self._transforms.flush()
            if self.paused:
                self._world_endpoints.publish_clock(result.now_ns, last=True)
        if not self.paused:
            self._world_endpoints.publish_clock(self.world.now_ns, last=False)
        self._world_endpoints.publish_objects(self.world, last=self.paused)
        if self._fallen() != self._published_fallen:
            self._publish_state()

    def _fallen(self) -> frozenset[str]:
        """Return the names (in the world) of the robots that fell off an edge."""
        return frozenset(name for name, robot in self.world.robots.items() if robot.is_fallen)

    def _run_owed(self) -> None:
        expected = max(self._normal_ticks, self._wanted_ticks())
        ticks = self._pacer.owed(time.monotonic_ns())
        if self.params.real_time_factor > 0.0:
            self._late_ticks += max(0, ticks - expected)
        if ticks:
            self._advance(ticks)

    def _wanted_ticks(self) -> int:
        """Return the number of ticks until the next one with a result for a subscriber or a command."""
        now_ns = self.world.now_ns
        if now_ns < self._prompt_until_ns:
            return 1
        ticks = min(self._max_deferred_ticks, (self._demand.due_ns(now_ns) - now_ns) // TICK_NS)
        if ticks <= 1:
            return ticks
        clock_ns = self._world_endpoints.clock_due_ns
        return ticks if clock_ns is None else min(ticks, self._pacer.ticks_until(clock_ns))

    def _run_guarded(self, act: Callable[[], None]) -> bool:
        """Call `act`; on an internal error log it, pause and return False (docs/architecture.md, "Errors")."""
        try:
            act()
        except Exception:
            where = f"the world stopped at {self.world.now_ns} ns"
            self.node.get_logger().error(f"internal error (please report): {where}:\n{traceback.format_exc()}")
            self.paused = True
            self._publish_state()
            return False
        return True

    def _set_pace(self) -> None:
        factor = self.params.real_time_factor
        self._pacer = Pacer(factor, max_batch=MAX_CATCH_UP_TICKS)
        self._late_ticks = 0
        self._normal_ticks = max(1, round(factor))
        self._max_deferred_ticks = max(1, min(MAX_DEFERRED_TICKS, int(MAX_DEFERRED_TICKS * factor)))

    def _prepare(self, value: str) -> _Prepared:
        """Load a playground, on any thread. Raises PlaygroundError, ResourceError, StartError or OSError."""
        name, loaded = load_playground(value)
        playground = self.params.renamed(loaded)
        scene = SceneMessages.of(playground, self.params.map_frame, with_map=self.params.publish_map)
        return _Prepared(name, playground, Ground(playground.floors, playground.paints), scene)

    def _reject_sim_time(self) -> None:
        """Reset `use_sim_time`, which launch files often set for all nodes: this node is the source of time."""
        if self.node.get_parameter(USE_SIM_TIME).value is True:
            self.node.get_logger().warning(f"{USE_SIM_TIME} is ignored: {SIM_TIME_REASON}")
            self.node.set_parameters([Parameter(USE_SIM_TIME, value=False)])

    def _set_world(self, world: World) -> None:
        for note in world.playground.notes:
            self.node.get_logger().warning(f"playground {self.playground_name}: {note}")
        self.world = world
        if self._log is not None:
            self._log.begin(self.playground_name, self.world)
        self._publish_start()

    def _open_log(self, path: str) -> RunLog | None:
        if not path:
            return None
        try:
            return RunLog(open(path, "w", encoding="utf-8", newline="\n"), on_error=self._on_log_error)
        except OSError as error:
            raise StartError(f"log '{path}': {error.strerror}, expected a writable file") from error

    def _on_log_error(self, error: OSError) -> None:
        self.node.get_logger().error(f"the log ends here: {self.params.log}: {error.strerror}")

    def _driver_topics(self) -> DriverTopics:
        return driver_topics.found(self.node) if self.params.driver_topics else DriverTopics()

    def _new_endpoints(self, robot: str, names: RobotNames) -> RobotEndpoints:
        return RobotEndpoints(
            self.node,
            names,
            self._command_sender(robot),
            content=lambda: self._content,
            input_context=lambda: self._input_context(robot, names),
            options=self._endpoint_options,
            demand=self._demand,
            on_refusal=self.count_refusal,
            on_limit=self.count_limited,
        )

    @staticmethod
    def _new_world(playground: Playground, chosen: SimulatorParams, ground: Ground | None = None) -> World:
        return World(
            playground,
            seed=chosen.seed,
            noise=chosen.noise,
            proximity_model=chosen.proximity_model,
            motor_model=chosen.motor_model,
            periods_ns=chosen.periods_ns,
            ground=ground,
        )

    def _publish_start(self) -> None:
        """Publish the start of a run in order: retained topics, then the clock at zero; the first readings follow."""
        self._set_pace()
        self._prompt_until_ns = 0
        self._robot_endpoints.reset(self.world.robots)
        self._transforms.set_robots(self._robot_endpoints.names)
        self._world_endpoints.publish_scene(self._scene)
        self._world_endpoints.publish_objects(self.world, last=True)
        self._publish_state()
        self._world_endpoints.publish_clock(0, last=True)

    def _command_sender(self, robot: str) -> Callable[[Command], None]:
        def post(command: Command) -> None:
            self.catch_up()
            # The message may be for a robot of the previous playground.
            if robot in self.world.robots:
                self.world.post(robot, command)

        return post

    def _input_context(self, robot: str, names: RobotNames) -> InputContext:
        self.catch_up()

        def frames() -> Mapping[str, Pose]:
            there = self.world.robots.get(robot)  # the robot may have been removed
            return {} if there is None else frames_of(names, there.pose, there.wheels.odometry)

        return InputContext(self.world.now_ns, round(self.params.cmd_vel_timeout * SECOND_NS), frames)

    def _publish_heartbeat(self, now_ns: int) -> None:
        self._last_heartbeat_ns = now_ns
        if self.paused:
            self._world_endpoints.publish_clock(self.world.now_ns, last=True)
            self.update_robots()
            for name, robot in self.world.robots.items():
                self._robot_endpoints[name].publish_pose(self.world.now_ns, robot.pose, robot.tilt)
        self._publish_state()
        self._type_mismatches.poll()
        pace = PaceCounters(self._late_ticks, self._pacer.dropped_ticks, self._refused, self._limited)
        self._world_endpoints.publish_diagnostics(self._state(), pace, self._type_mismatches.status())

    def _state(self) -> WorldState:
        return WorldState(
            playground=self.playground_name,
            title=self.world.playground.title,
            notes=self.world.playground.notes[:MAX_NOTES],
            paused=self.paused,
            real_time_factor=self.params.real_time_factor,
            achieved=0.0 if self.paused else self._pacer.achieved,
            seed=self.params.seed,
            now_ns=self.world.now_ns,
            movables=self.world.movables,
            robots=self.names,
            raw=self._world_endpoints.raw.topic_name,
            fallen=self._fallen(),
        )

    def _publish_state(self) -> None:
        state = self._state()
        self._published_fallen = state.fallen
        self._world_endpoints.publish_state(state)

    def _has_own_parameters(self, parameters: list[Parameter]) -> bool:
        """Whether any is a parameter of this class; QoS overrides are declared while a robot's topics are created."""
        return not params.by_name(self.params).keys().isdisjoint(parameter.name for parameter in parameters)

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        if params.changes(parameters).get(USE_SIM_TIME) is True:
            return SetParametersResult(successful=False, reason=f"{USE_SIM_TIME} is rejected: {SIM_TIME_REASON}")
        if not self._has_own_parameters(parameters):
            return SetParametersResult(successful=True)
        self.catch_up()
        refusal = params.refusal(self.params, parameters)
        if refusal:
            return SetParametersResult(successful=False, reason=refusal)
        value = params.changes(parameters).get("playground")
        if value is not None:
            try:
                prepared = self._loader.load(value)
                is_other = value != self.params.playground or prepared.playground != self.world.playground
                chosen = params.updated(self.params, parameters)
                self._accepted = (
                    (prepared, self._new_world(prepared.playground, chosen, prepared.ground)) if is_other else None
                )
            except (PlaygroundError, resources.ResourceError, StartError, OSError) as error:
                return SetParametersResult(successful=False, reason=str(error))
            except Exception as error:  # internal error while reading a file: the node continues
                self.node.get_logger().error(
                    f"internal error (please report): the playground cannot be read:\n{traceback.format_exc()}"
                )
                return SetParametersResult(successful=False, reason=f"{type(error).__name__}: {error}")
        return SetParametersResult(successful=True)

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        if not self._has_own_parameters(parameters):
            return
        changed = params.changes(parameters)
        self.params = params.updated(self.params, parameters)
        self._content = self.params.convert_options
        if "real_time_factor" in changed:
            self._set_pace()
        if "playground" in changed and self._accepted is not None:
            prepared, world = self._accepted
            self.playground_name, self._scene, self._accepted = prepared.name, prepared.scene, None
            self._set_world(world)
        elif "seed" in changed:
            self._set_world(self._new_world(self.world.playground, self.params))
        self._publish_state()


def main(args: Sequence[str] | None = None) -> int:
    """Run the executable `simulator`."""
    with dds_profile.alone():
        return run_main(lambda context: announce([Simulator(context)]), args)
