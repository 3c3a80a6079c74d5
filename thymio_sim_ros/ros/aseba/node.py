"""The Aseba runtime as a ROS node: creates its parts, connects them and runs their loop.

In the process of a simulator its engine runs the programs, and this node is their interface; alone, it runs them on
robots of other processes by their topics (docs/spec/ros-interface.md section 6, docs/aseba_ros.md). Programs are
parameters; a text that does not compile is rejected with its position, and the current program
continues. A robot without a program is switched on with its menu.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from builtin_interfaces.msg import Time
from rclpy.clock import Clock, ClockChange, JumpThreshold, TimeJump
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService
from std_msgs.msg import String

from thymio_sim_ros.access.hosts import is_loopback
from thymio_sim_ros.access.tokens import TOKEN_VARIABLE, Tokens
from thymio_sim_ros.device.options import OptionError
from thymio_sim_ros.files.loading import shipped_behaviours
from thymio_sim_ros.network.settings import HTTP, TDM, NetworkSettings
from thymio_sim_ros.ros.aseba import parameters as aseba_params
from thymio_sim_ros.ros.aseba.check_service import CheckService
from thymio_sim_ros.ros.aseba.diagnostics import RuntimeDiagnostics
from thymio_sim_ros.ros.aseba.load_service import LoadService
from thymio_sim_ros.ros.aseba.network_link import NetworkLink
from thymio_sim_ros.ros.aseba.outside import driver_input
from thymio_sim_ros.ros.aseba.parameter_callbacks import ParameterCallbacks
from thymio_sim_ros.ros.aseba.parameters import BEHAVIOUR, RuntimeParams, WrongValueError
from thymio_sim_ros.ros.aseba.robot_set import ROBOT_ERRORS, RobotSet
from thymio_sim_ros.ros.aseba.runtime_values import RuntimeValues
from thymio_sim_ros.ros.aseba.variable_timer import VariableTimer
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.headers import stamp
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode
from thymio_sim_ros.ros.rclpy_ext.node_runner import SPIN_SLICE_S, StartError, announce, deliver, run_main
from thymio_sim_ros.ros.rclpy_ext.parameter_node import parameter_node
from thymio_sim_ros.ros.simulator.node import Simulator
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.ros.web.tokens import given_tokens
from thymio_sim_ros.web.thread import ServerThread

__all__ = ["AsebaRuntime", "RuntimeParams", "main"]

DIAGNOSTICS_S = 1.0
"""Period of diagnostics, and of checking that the simulator is still there."""

PERIOD_S = 0.01
"""Shortest wall time between two runs of programs that are busy: a tick."""

SUBSCRIBERS_S = 0.25
"""Period of polling for new subscribers of commands."""

NO_OVERRIDES: Mapping[str, Any] = MappingProxyType({})


class AsebaRuntime:
    """The runtime node: one device per robot, all on one Aseba bus.

    `robots` owns the devices, `values` the parameters.
    """

    def __init__(
        self,
        context: Context,
        defaults: RuntimeParams | None = None,
        *,
        use_sim_time: bool | None = None,
        overrides: Mapping[str, Any] = NO_OVERRIDES,
        simulator: Simulator | None = None,
        tokens: Tokens | None = None,
        is_closed: bool = False,
        thread: ServerThread | None = None,
    ) -> None:
        """`overrides`: parameter values by name, like those of a command line; `simulator`: in the same process, whose
        engine runs the programs and whose thread runs this node; `tokens`: those that clients of the network servers
        need, None: those of the environment or of parameters; `is_closed`: only this process reaches its parameters,
        by `control`; `thread`: that of a page in the same process, in which the network servers run.

        Raises StartError for a parameter or a program that cannot be used.
        """
        given = dict(overrides) | ({} if use_sim_time is None else {"use_sim_time": use_sim_time})
        self.node = parameter_node(
            "aseba_runtime",
            context=context,
            is_set_again=self._is_set_again,
            parameter_overrides=[Parameter(name, value=value) for name, value in given.items()],
            is_free=aseba_params.is_free,
            repeat=_repeat,
            has_acted=self._has_started,
            start_parameter_services=not is_closed,
        )
        self.control: Node | LocalNode = LocalNode(self.node) if is_closed else self.node
        """Has the services of the parameters."""
        if isinstance(self.control, LocalNode):
            self._parameter_services = ParameterService(self.control)
        self._ran_s = 0.0
        try:
            self._start(defaults or RuntimeParams(), simulator, tokens, thread)
        except (OptionError, WrongValueError, *ROBOT_ERRORS) as error:
            self.node.destroy_node()
            raise StartError(str(error)) from error

    @property
    def startup_message(self) -> str:
        """The programs, as text for the user, and the inputs that they do not get on robots of other processes."""
        programs = dict.fromkeys(endpoints.program.name for endpoints in self.robots if endpoints.program.name)
        is_outside = self.robots.standalone is not None and not self.values.params.robot
        return f"Program: {', '.join(programs) or 'none'}" + (f"; {driver_input.MISSING}" if is_outside else "")

    def run_once(self, executor: Executor) -> None:
        """Handle messages until a program has work, then run it; at most once in `PERIOD_S` if programs are busy."""
        owner = self.robots.standalone
        if owner is None:  # the simulator runs the programs, and this node
            executor.spin_once(timeout_sec=SPIN_SLICE_S)
            return
        wait_s = max(owner.wait_s, self._ran_s + PERIOD_S - time.monotonic())
        if wait_s > 0.0:
            executor.spin_once(timeout_sec=min(wait_s, SPIN_SLICE_S))
            return
        deliver(executor)
        self._ran_s = time.monotonic()
        owner.run()

    def stop(self) -> None:
        """Stop the network servers, then the wheels and programs of all robots."""
        if self.network is not None:
            self.network.close()
        self.robots.stop()

    def close(self) -> None:
        """Stop the wheels, then destroy the node."""
        self._jumps.unregister()
        self.stop()
        self.robots.close()
        self.node.destroy_node()

    def _start(
        self,
        defaults: RuntimeParams,
        simulator: Simulator | None,
        tokens: Tokens | None,
        thread: ServerThread | None,
    ) -> None:
        node = self.node
        self.values = RuntimeValues(node, defaults)
        params = self.values.params
        runner = None if simulator is None else simulator.runner
        self._diagnostics = RuntimeDiagnostics(node, lambda: _now(node, runner))
        self.robots = RobotSet(node, self.values, self._diagnostics, runner)
        self.robots.emitter.reaches_all = params.emit_reaches == "network"
        self.robots.emitter.shares_numbers = params.network.aseba_shared
        self._publish_behaviours()
        self._check = CheckService(node, layout=lambda: self.values.params.layout, robots=lambda: self.robots.names)
        if simulator is None:
            self.robots.follow({name: RobotNames(name) for name in params.robots})
        else:
            self._follow(simulator)
        self.network: NetworkLink | None = None
        """The servers by which other programs reach the robots, if any is on."""
        if not (settings := params.network.settings).is_off:
            _check_servers(settings)
            tokens = _tokens(node, settings) if tokens is None else tokens
            self.network = NetworkLink(
                node, self.robots, settings, first_id=params.first_id, tokens=tokens, thread=thread
            )
        wall = Clock(clock_type=ClockType.STEADY_TIME)
        self._variable_timer = VariableTimer(node, wall, self.robots, params.watch_rate)
        self._callbacks = ParameterCallbacks(node, self.values, self.robots, self._variable_timer)
        self._load = LoadService(node, self._check, self._callbacks.load, robots=lambda: self.robots.names)
        self._jumps = node.get_clock().create_jump_callback(
            JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False),
            post_callback=self._on_jump,
        )
        node.create_timer(DIAGNOSTICS_S, lambda: self._diagnostics.publish_all(self.robots), clock=wall)
        node.create_timer(SUBSCRIBERS_S, self.robots.poll_subscribers, clock=wall)
        if self.network is not None:
            node.create_timer(SUBSCRIBERS_S, self.network.drain, clock=wall)

    def _follow(self, simulator: Simulator) -> None:
        """Serve the robots of a simulator, now and whenever they change."""
        runner, robots = simulator.runner, self.robots

        def follow(is_new: bool) -> None:
            try:
                robots.follow(simulator.endpoints.robots.names, is_new=is_new)
            except ROBOT_ERRORS as error:
                self.node.get_logger().error(f"robots {', '.join(runner.world.robots)}: {error}")

        robots.follow(simulator.endpoints.robots.names, is_new=True)
        runner.on_robots, runner.on_reset = follow, robots.refresh
        runner.on_tick.append(robots.publish)

    def _is_set_again(self, parameter: str) -> bool:
        """Whether a parameter acts even if its value is the same.

        It is so if its program is loaded anew, the file may differ, or a tool's program runs.
        """
        if getattr(self, "_callbacks", None) is not None and self._callbacks.started_again:
            return True
        is_replaced = any(endpoints.program.is_foreign for endpoints in getattr(self, "robots", ()))
        return parameter.endswith("script.path") or (is_replaced and parameter.endswith("script.source"))

    def _has_started(self) -> bool:
        return self._callbacks.has_started

    def _publish_behaviours(self) -> None:
        """Publish the retained list of built-in behaviors."""
        self._behaviours = self.node.create_publisher(String, "~/_behaviours", qos.TRANSIENT_LOCAL)
        listed = [{"name": name, "description": text} for name, text in shipped_behaviours().items()]
        self._behaviours.publish(String(data=json.dumps(listed)))

    def _on_jump(self, jump: TimeJump) -> None:
        """Restart all robots when time jumps back, as at a reset of the simulator."""
        if jump.clock_change in (ClockChange.ROS_TIME_NO_CHANGE, ClockChange.SYSTEM_TIME_NO_CHANGE):
            self.robots.restart()


def _now(node: Node, runner: WorldRunner | None) -> Time:
    """The time of the world; without one in this process, that of the node."""
    return node.get_clock().now().to_msg() if runner is None else stamp(runner.world.now_ns)


def _repeat(parameter: str) -> str:
    """Return how a robot runs its program again, for a parameter that chooses the program."""
    is_program = parameter.endswith(("script.path", "script.source")) or parameter == BEHAVIOUR
    return "the services aseba/reset and aseba/run of a robot restart its program" if is_program else ""


def _check_servers(settings: NetworkSettings) -> None:
    """Raise StartError for an unknown server."""
    for name in settings.on_page:
        if name not in (TDM, HTTP):
            raise StartError(f"parameter network.on_page: found {name!r}, expected some of {TDM}, {HTTP}")


def _tokens(node: Node, settings: NetworkSettings) -> Tokens:
    """The tokens that the user gave the node. Raises StartError without one if the network reaches the servers."""
    tokens = given_tokens(node)
    if not tokens.is_required and not is_loopback(settings.address):
        raise StartError(
            f"network.address: found {settings.address} without a token; set {TOKEN_VARIABLE} or the parameter token"
        )
    return tokens


def main(args: Sequence[str] | None = None) -> int:
    """Run the executable `aseba_runtime`."""
    with dds_profile.used(dds_profile.ANNOUNCING):
        return run_main(lambda context: announce([AsebaRuntime(context)]), args)
