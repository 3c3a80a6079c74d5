"""The simulator node in a test. The test steps it, so that only simulated time counts, not wall time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

from rclpy.subscription import Subscription
from std_msgs.msg import Int16MultiArray, MultiArrayDimension, MultiArrayLayout

from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.device.programs.program_assignment import Assignment, RobotId
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import robot_ids
from thymio_sim_ros.ros.aseba.device_endpoints import DeviceEndpoints
from thymio_sim_ros.ros.aseba.node import AsebaRuntime
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import full_name
from thymio_sim_ros.ros.simulator.node import Simulator
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.world import World
from thymio_sim_ros.testing.awaited import Awaited
from thymio_sim_ros.testing.failure_messages import describe_condition
from thymio_sim_ros.testing.record import SECOND_NS
from thymio_sim_ros.testing.report import robot_lines
from thymio_sim_ros.testing.ros.graph import Ros
from thymio_sim_ros.testing.sources import programs_of
from thymio_sim_ros.testing.thymio import Thymio

__all__ = ["Simulation"]

T = TypeVar("T")

HOPS = 2
"""Deliveries per tick: a reading reaches a node under test, and its command comes back."""

ANSWER_S = 2.0
"""Time for pending messages after a wait in simulated time, in s of real time on an idle machine."""

_NO_MACHINE = "no Aseba machine runs for {}: start one with the fixture `runtime`"


class Simulation:
    """A simulator node and its robots. Invariant: simulated time passes only in `tick`, `step` and `until`."""

    def __init__(self, ros: Ros, simulator: Simulator, *, folder: Path | None = None) -> None:
        """`folder`: where relative paths of programs start."""
        self.ros = ros
        self.simulator = simulator
        self._folder = folder
        self._runtimes: list[AsebaRuntime] = []
        self._event_subscriptions: dict[str, Subscription] = {}
        """Subscriptions to the events of each robot's program."""
        self._robots = {name: Thymio(name, self) for name in self.world.robots}
        ros.simulation = self

    @property
    def world(self) -> World:
        """The world itself (ground truth)."""
        return self.simulator.runner.world

    @property
    def engine(self) -> Engine:
        """The engine of the simulator, to which commands are posted."""
        return self.simulator.runner.engine

    @property
    def now(self) -> float:
        """Simulated time in s."""
        return self.world.now_ns / SECOND_NS

    # --- robots ---

    @property
    def robots(self) -> Mapping[str, Thymio]:
        """All present robots by name."""
        for name in self.world.robots:
            if name not in self._robots:
                self._robots[name] = Thymio(name, self)
        return self._robots

    def __getitem__(self, robot: str) -> Thymio:
        return self.robots[robot]

    def __iter__(self) -> Iterator[Thymio]:
        """The robots, in the order of the playground."""
        return iter(self.robots.values())

    @property
    def thymio(self) -> Thymio:
        """The only robot; raises LookupError if there are several."""
        if len(self.robots) != 1:
            raise LookupError(f"{len(self.robots)} robots: take one by its name: {', '.join(self.robots)}")
        return next(iter(self))

    def run_program(self, runtime: AsebaRuntime) -> None:
        """Add an Aseba runtime node, whose programs the engine runs, and record their events."""
        self._runtimes.append(runtime)
        self._subscribe_to_events()

    # --- time ---

    def step(self, seconds: float) -> None:
        """Advance simulated time tick by tick, delivering messages in between."""
        for _ in range(round(seconds * SECOND_NS / TICK_NS)):
            self.tick()

    def run(self, seconds: float) -> None:
        """Advance simulated time by `seconds`; the same as `step`."""
        self.step(seconds)

    def tick(self) -> None:
        """Advance by one tick of 10 ms, and handle all pending messages."""
        __tracebackhide__ = True
        if self.ros.programs.running:
            self.ros.programs.take_turns(self.world.now_ns + TICK_NS)
            self.ros.deliver()
        self.simulator.runner.advance(1)
        self._subscribe_to_events()
        for _ in range(HOPS):
            self.ros.deliver()
        for name, thymio in self.robots.items():
            robot = self.world.robots.get(name)
            if robot is not None:
                thymio.record.add_tick(robot, self.world.now_ns)

    def reset(self) -> None:
        """Reset world, time and noise to the start, and clear the records of the robots."""
        self.simulator.runner.reset()
        for thymio in self:
            thymio.record.clear()

    def until(self, condition: Callable[[], T], seconds: float = 60.0, *, what: str = "") -> T:
        """Step until the condition is true, for at most `seconds` of simulated time; returns its value.

        A condition that needs the first message of a topic waits for it (`Recorder.latest`).
        Fails the test otherwise, with a report on robots, programs, recorded messages and topics.
        """
        __tracebackhide__ = True
        awaited = Awaited(condition)
        for _ in range(round(seconds * SECOND_NS / TICK_NS)):
            if value := awaited():
                return value
            self.tick()
        return self.ros.spin_until(
            condition, ANSWER_S, lambda: f"not within {seconds:g} simulated s: {what or describe_condition(condition)}"
        )

    def lines(self) -> list[str]:
        """Describe simulated time and robots, one line each."""
        return [f"simulated time: {self.now:.2f} s", *robot_lines(self)]

    # --- programs ---

    def machine(self, robot: str) -> DeviceEndpoints | None:
        """The machine of a robot if a runtime node of this test has one, otherwise None."""
        names = self.simulator.endpoints.robots.names
        wanted = names[robot].name if robot in names else robot
        endpoints = (ports for runtime in self._runtimes for ports in runtime.robots if ports.names.name == wanted)
        return next(endpoints, None)

    def load(self, robot: str, program: str | Path | ThymioProgram) -> None:
        """Load a program into the machine of a robot. Raises LookupError if it has no machine."""
        ports = self.machine(robot)
        if ports is None:
            raise LookupError(_NO_MACHINE.format(robot))
        ports.load(Assignment(programs_of(program, {robot: self._id_of(robot)}, self._folder)[robot]))

    def set_variable(self, robot: str, variable: str, words: Sequence[int]) -> None:
        """Write a whole variable of the program of a robot. Raises LookupError if it has no machine."""
        ports = self.machine(robot)
        if ports is None:
            raise LookupError(_NO_MACHINE.format(robot))
        self.engine.set_variable(robot, variable, words)

    def _id_of(self, robot: str) -> RobotId:
        names = list(self.simulator.endpoints.robots.names)
        return robot_ids(names).get(robot, RobotId("", 1))

    def emit(self, event: str, args: Sequence[int]) -> None:
        """Send an event to all robots that know it, by `_aseba/emit` of the first machine.

        Raises LookupError if there is no machine.
        """
        machines = ((runtime, ports) for runtime in self._runtimes for ports in runtime.robots)
        runtime, ports = next(machines, (None, None))
        if runtime is None or ports is None:
            raise LookupError(_NO_MACHINE.format("any robot"))
        layout = MultiArrayLayout(dim=[MultiArrayDimension(label=event, size=len(args), stride=1)])
        publisher = self.ros.publisher(Int16MultiArray, full_name(runtime.node, ports.names.topic("_aseba/emit")))
        publisher.publish(Int16MultiArray(layout=layout, data=list(args)))

    def _subscribe_to_events(self) -> None:
        """Subscribe to the events of all programs, including those of new robots."""
        if not self._runtimes or len(self._event_subscriptions) == len(self.world.robots):
            return
        for name, names in self.simulator.endpoints.robots.names.items():
            if name not in self._event_subscriptions:
                topic = full_name(self.simulator.node, names.topic("_aseba/events"))
                self._event_subscriptions[name] = self.ros.node.create_subscription(
                    Int16MultiArray, topic, partial(self._record_event, name), qos.EVENTS
                )
        for name in self._event_subscriptions.keys() - self.simulator.endpoints.robots.names.keys():
            self.ros.node.destroy_subscription(self._event_subscriptions.pop(name))

    def _record_event(self, robot: str, message: Int16MultiArray) -> None:
        self.robots[robot].record.add_event(message.layout.dim[0].label, message.data, self.world.now_ns)
