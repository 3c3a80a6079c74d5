"""The simulator as a ROS node: owns the world, steps it, publishes readings, posts commands.

One thread does all of it: between ticks the executor delivers messages, whose callbacks only convert and
post. The world is paced by absolute deadlines, never by a ROS timer (architecture section 15). Topics,
services and parameters: ros-interface.md sections 4, 5 and 10.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.context import Context
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import SetBool, Trigger

from thymio_sim_ros import resources
from thymio_sim_ros.loading import load_playground
from thymio_sim_ros.nodes import params
from thymio_sim_ros.nodes.convert import ConvertOptions
from thymio_sim_ros.nodes.headers import SECOND_NS
from thymio_sim_ros.nodes.life import SPIN_SLICE_S, StartError, deliver, run_main
from thymio_sim_ros.nodes.names import RobotNames
from thymio_sim_ros.nodes.params import param
from thymio_sim_ros.nodes.robot_ports import RobotPorts
from thymio_sim_ros.nodes.roster import Roster
from thymio_sim_ros.nodes.transforms import Transforms
from thymio_sim_ros.nodes.world_ports import WorldPorts, WorldState
from thymio_sim_ros.runlog import RunLog
from thymio_sim_ros.sim.clock import Pacer
from thymio_sim_ros.sim.commands import MOTOR_MODELS, Command
from thymio_sim_ros.sim.playground import Playground, PlaygroundError
from thymio_sim_ros.sim.world import World

MOST_NOTES = 20
"""Remarks about a playground that the state tells; all of them are in the log."""

HEARTBEAT_NS = SECOND_NS
"""While paused the clock is repeated at 1 Hz, so that late nodes get it."""


@dataclass(frozen=True)
class SimulatorParams:
    """Parameters of the simulator node."""

    playground: str = param("line", "Playground: a shipped name, a file, or the JSON text itself")
    seed: int = param(0, "Seed of all noise; the same seed gives the same run", fixed=True)
    noise: bool = param(True, "Whether wheels and sensors are noisy as on the robot", fixed=True)
    motor_model: str = param(
        "ideal", "How motors follow: ideal (at once) or firmware (the robot's control loop and its lag)", fixed=True
    )
    real_time_factor: float = param(1.0, "Simulated seconds per second; 0 is as fast as possible", low=0.0, high=1000.0)
    start_paused: bool = param(False, "Whether the world waits for ~/pause or ~/step", fixed=True)
    step_ticks: int = param(1, "Ticks of 10 ms that ~/step does", low=1, high=100_000)
    publish_clock: bool = param(True, "Whether /clock is published", fixed=True)
    out_of_range: str = param(
        "rep117", "Range of nothing and too close: rep117 (+inf, -inf) or driver (-1, minimum)", fixed=True
    )
    ground_threshold: int = param(
        200, "Ground counts below are «not reflecting»", name="ground.threshold", low=0, high=1023, fixed=True
    )
    log: str = param("", "File that a run log is written to, for thymio-sim replay; empty: none", fixed=True)
    cmd_vel_timeout: float = param(0.0, "Seconds after which a velocity command ends; 0 is never", low=0.0, high=3600.0)


class Simulator:
    """The simulator node and its world. Invariant: only `turn`, `advance` and callbacks of `node` touch the world."""

    def __init__(self, context: Context, defaults: SimulatorParams | None = None) -> None:
        self.node = Node("simulator", context=context)
        self.params = params.declare(self.node, defaults or SimulatorParams())
        if self.params.out_of_range not in ("rep117", "driver"):
            raise StartError(f"out_of_range is '{self.params.out_of_range}', expected rep117 or driver")
        if self.params.motor_model not in MOTOR_MODELS:
            raise StartError(f"motor_model is '{self.params.motor_model}', expected {' or '.join(MOTOR_MODELS)}")
        try:
            self.playground_name, playground = load_playground(self.params.playground)
        except (PlaygroundError, resources.ResourceError, OSError) as error:
            self.node.destroy_node()
            raise StartError(str(error)) from error
        self.paused = self.params.start_paused
        self._pacer = Pacer(self.params.real_time_factor)
        self._last_beat_ns = 0
        self._world_ports = WorldPorts(self.node, publish_clock=self.params.publish_clock)
        self._transforms = Transforms(self.node)
        self._roster = Roster(self._ports)
        self._log = self._open_log(self.params.log)
        self._set_world(playground)
        self._services = [
            self.node.create_service(SetBool, "~/pause", self._on_pause),
            self.node.create_service(Trigger, "~/step", self._on_step),
            self.node.create_service(Trigger, "~/reset", self._on_reset),
        ]
        self._accepted: tuple[str, Playground] | None = None
        self.node.add_on_set_parameters_callback(self._check_parameters)
        self.node.add_post_set_parameters_callback(self._apply_parameters)

    def turn(self, executor: Executor) -> None:
        """Ticks that are owed, then messages until the next tick is due."""
        now = time.monotonic_ns()
        if self.paused:
            if now - self._last_beat_ns >= HEARTBEAT_NS:
                self._beat(now)
            executor.spin_once(timeout_sec=SPIN_SLICE_S)
            return
        self._guard(self._run_owed)
        if now - self._last_beat_ns >= HEARTBEAT_NS:
            self._beat(now)
        wait_s = self._pacer.wait_ns(time.monotonic_ns()) / SECOND_NS
        if wait_s > 0.0:
            executor.spin_once(timeout_sec=min(wait_s, SPIN_SLICE_S))
        else:
            deliver(executor)

    def advance(self, ticks: int) -> None:
        """Step the world by ticks of 10 ms at once, also while paused, and publish what they give."""
        if self._roster.follow(self.world.robots):
            self._transforms.begin(self._roster.names)
            self._publish_state()
        for _ in range(ticks):
            result = self.world.step()
            for robot, sensor, reading in result.readings:
                ports = self._roster[robot]
                ports.publish(sensor, reading)
                self._transforms.take(ports.names, sensor, reading)
            self._world_ports.publish_clock(result.now_ns, last=self.paused)
        self._world_ports.publish_objects(self.world, last=self.paused)

    def reset(self) -> None:
        """World, time and noise as at the start."""
        self.world.reset()
        self._begin()

    def close(self) -> None:
        """Destroy the node; the world goes with it, and its log ends."""
        if self._log is not None:
            self._log.close()
        self.node.destroy_node()

    def _run_owed(self) -> None:
        self.advance(self._pacer.owed(time.monotonic_ns()))

    def _guard(self, act: Callable[[], None]) -> None:
        """Our own bug in the core: log it, pause, stay alive for inspection (architecture section 12)."""
        try:
            act()
        except Exception:
            self.node.get_logger().error(f"the world stopped at {self.world.now_ns} ns", exc_info=sys.exc_info())
            self.paused = True
            self._publish_state()

    def _set_world(self, playground: Playground) -> None:
        for note in playground.notes:
            self.node.get_logger().warning(f"playground {self.playground_name}: {note}")
        self.world = self._new_world(playground)
        if self._log is not None:
            self._log.begin(self.playground_name, self.world)
        self._begin()

    def _open_log(self, path: str) -> RunLog | None:
        if not path:
            return None
        try:
            return RunLog(open(path, "w", encoding="utf-8", newline="\n"), on_error=self._on_full_disk)
        except OSError as error:
            self.node.destroy_node()
            raise StartError(f"log '{path}': {error.strerror}, expected a file that can be written") from error

    def _on_full_disk(self, error: OSError) -> None:
        self.node.get_logger().error(f"the log ends here: {self.params.log}: {error.strerror}")

    def _ports(self, robot: str, names: RobotNames) -> RobotPorts:
        return RobotPorts(
            self.node,
            names,
            self._poster(robot),
            options=ConvertOptions(
                driver_ranges=self.params.out_of_range == "driver", ground_threshold=self.params.ground_threshold
            ),
            now_ns=lambda: self.world.now_ns,
            timeout_ns=self._timeout_ns,
        )

    def _new_world(self, playground: Playground) -> World:
        chosen = self.params
        return World(playground, seed=chosen.seed, noise=chosen.noise, motor_model=chosen.motor_model)

    def _begin(self) -> None:
        """Order at a start: latched topics, then the clock at zero; the first readings follow (section 7)."""
        self._pacer = Pacer(self.params.real_time_factor)
        self._roster.begin(self.world.robots)
        self._transforms.begin(self._roster.names)
        self._world_ports.publish_scene(self.world.playground)
        self._world_ports.publish_objects(self.world, last=True)
        self._publish_state()
        self._world_ports.publish_clock(0, last=True)

    def _poster(self, robot: str) -> Callable[[Command], None]:
        def post(command: Command) -> None:
            # A message may be on its way to a robot that goes with the old playground.
            if robot in self.world.robots:
                self.world.post(robot, command)

        return post

    def _timeout_ns(self) -> int:
        return round(self.params.cmd_vel_timeout * SECOND_NS)

    def _beat(self, now_ns: int) -> None:
        self._last_beat_ns = now_ns
        if self.paused:
            self._world_ports.publish_clock(self.world.now_ns, last=True)
        self._publish_state()
        self._world_ports.publish_diagnostics(self._state(), self._pacer.dropped_ticks)

    def _state(self) -> WorldState:
        return WorldState(
            playground=self.playground_name,
            title=self.world.playground.title,
            notes=self.world.playground.notes[:MOST_NOTES],
            paused=self.paused,
            real_time_factor=self.params.real_time_factor,
            achieved=0.0 if self.paused else self._pacer.achieved,
            seed=self.params.seed,
            now_ns=self.world.now_ns,
            robots=self._roster.names,
        )

    def _publish_state(self) -> None:
        self._world_ports.publish_state(self._state())

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self.paused = bool(request.data)
        self._pacer = Pacer(self.params.real_time_factor)
        self._world_ports.publish_clock(self.world.now_ns, last=True)
        self._publish_state()
        response.success = True
        response.message = "paused" if self.paused else "running"
        return response

    def _on_step(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        if not self.paused:
            response.success, response.message = False, "the world is running: pause it first"
            return response
        self._guard(lambda: self.advance(self.params.step_ticks))
        self._world_ports.publish_clock(self.world.now_ns, last=True)
        self._publish_state()
        response.success, response.message = True, f"now {self.world.now_ns / SECOND_NS:.3f} s"
        return response

    def _on_reset(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self.reset()
        response.success, response.message = True, "world, time and noise are as at the start"
        return response

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        value = params.changes(parameters).get("playground")
        if value is not None:
            try:
                self._accepted = load_playground(value)
                self._new_world(self._accepted[1])
            except (PlaygroundError, resources.ResourceError, OSError) as error:
                return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        changed: dict[str, Any] = params.changes(parameters)
        known = {
            name: changed[name] for name in ("real_time_factor", "step_ticks", "cmd_vel_timeout") if name in changed
        }
        self.params = replace(self.params, **known)
        if "real_time_factor" in changed:
            self._pacer = Pacer(self.params.real_time_factor)
        if "playground" in changed and self._accepted is not None:
            self.playground_name, playground = self._accepted
            self._accepted = None
            self._set_world(playground)
        self._publish_state()


def main(args: Sequence[str] | None = None) -> int:
    """The executable `simulator`."""
    return run_main(lambda context: [Simulator(context)], args)
