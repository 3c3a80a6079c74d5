"""The simulator node in a test: it is stepped, so that a test counts simulated time, not wall time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from std_msgs.msg import Int16MultiArray, MultiArrayDimension, MultiArrayLayout

from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.ros.aseba.device_endpoints import DeviceEndpoints
from thymio_sim_ros.ros.aseba.node import AsebaRuntime
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import full_name
from thymio_sim_ros.ros.simulator.node import Simulator
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.world import World
from thymio_sim_ros.testing.failure_messages import describe_condition
from thymio_sim_ros.testing.record import SECOND_NS
from thymio_sim_ros.testing.report import robot_lines
from thymio_sim_ros.testing.ros.graph import Ros
from thymio_sim_ros.testing.sources import program_of
from thymio_sim_ros.testing.thymio import Thymio

__all__ = ["Simulation"]

HOPS = 2
"""Deliveries per tick: a reading reaches a node under test, and its command comes back."""

ANSWER_S = 2.0
"""Real seconds for what is still under way when simulated time has ended, such as the answer of a service."""

_NO_MACHINE = "no Aseba machine runs for {}: start one with the fixture `runtime`"


class Simulation:
    """A simulator node and its robots. Invariant: simulated time passes only in `tick`, `step` and `until`."""

    def __init__(self, ros: Ros, simulator: Simulator, *, folder: Path | None = None) -> None:
        """Relative paths of programs begin in `folder`."""
        self.ros = ros
        self.simulator = simulator
        self._folder = folder
        self._runtimes: list[AsebaRuntime] = []
        self._event_subscriptions: dict[str, Any] = {}
        """Subscriptions to what the program of each robot emits."""
        self._robots = {name: Thymio(name, self) for name in self.world.robots}
        ros.simulation = self

    @property
    def world(self) -> World:
        """The world itself, for the truth."""
        return self.simulator.runner.world

    @property
    def now(self) -> float:
        """Simulated time in s."""
        return self.world.now_ns / SECOND_NS

    # --- robots ---

    @property
    def robots(self) -> Mapping[str, Thymio]:
        """The robots by name, those that came later too."""
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
        """The only robot; LookupError where there are several."""
        if len(self.robots) != 1:
            raise LookupError(f"{len(self.robots)} robots: take one by its name: {', '.join(self.robots)}")
        return next(iter(self))

    def run_program(self, runtime: AsebaRuntime) -> None:
        """An Aseba runtime node of this test: its machines work with every tick, and what they emit is noted.

        It waits until the node knows the robots: a latched message takes its time.
        """
        if runtime.values.params.follow_simulator:
            wanted = [names.name for names in self.simulator.endpoints.robots.names.values()]
            self.ros.until(
                lambda: [ports.names.name for ports in runtime.robots] == wanted, what="the runtime knows the robots"
            )
        self._runtimes.append(runtime)
        self._subscribe_to_events()

    # --- time ---

    def step(self, seconds: float) -> None:
        """Advance simulated time tick by tick, delivering messages in between."""
        for _ in range(round(seconds * SECOND_NS / TICK_NS)):
            self.tick()

    def run(self, seconds: float) -> None:
        """The same as `step`."""
        self.step(seconds)

    def tick(self) -> None:
        """One tick of 10 ms, then whatever messages are there; long handlers of programs go on."""
        self.simulator.runner.advance(1)
        self._subscribe_to_events()
        for _ in range(HOPS):
            self.ros.deliver()
        for runtime in self._runtimes:
            for ports in runtime.robots:
                if ports.is_busy:
                    ports.run()
        for name, thymio in self.robots.items():
            robot = self.world.robots.get(name)
            if robot is not None:
                thymio.record.add_tick(robot, self.world.now_ns)

    def until(self, condition: Callable[[], Any], seconds: float = 60.0, *, what: str = "") -> Any:
        """Step until the condition is true, at most so many simulated seconds; returns its value.

        Fails the test otherwise, and tells how robots, programs, records and topics are.
        """
        __tracebackhide__ = True
        for _ in range(round(seconds * SECOND_NS / TICK_NS)):
            if value := condition():
                return value
            self.tick()
        return self.ros.spin_until(
            condition, ANSWER_S, lambda: f"not within {seconds:g} simulated s: {what or describe_condition(condition)}"
        )

    def lines(self) -> list[str]:
        """How simulated time and the robots are, for a person."""
        return [f"simulated time: {self.now:.2f} s", *robot_lines(self)]

    # --- programs ---

    def machine(self, robot: str) -> DeviceEndpoints | None:
        """The machine of a robot, if a runtime node of this test has one for it."""
        names = self.simulator.endpoints.robots.names
        wanted = names[robot].name if robot in names else robot
        found = (ports for runtime in self._runtimes for ports in runtime.robots if ports.names.name == wanted)
        return next(found, None)

    def load(self, robot: str, program: str | Path | ThymioProgram) -> None:
        """Give a robot that has a machine a program."""
        ports = self.machine(robot)
        if ports is None:
            raise LookupError(_NO_MACHINE.format(robot))
        ports.load(program_of(program, self._folder))

    def emit(self, event: str, args: Sequence[int]) -> None:
        """Let every robot that knows an event hear it, by the topic _aseba/emit of the first that has a machine."""
        found = ((runtime, ports) for runtime in self._runtimes for ports in runtime.robots)
        runtime, ports = next(found, (None, None))
        if runtime is None or ports is None:
            raise LookupError(_NO_MACHINE.format("any robot"))
        layout = MultiArrayLayout(dim=[MultiArrayDimension(label=event, size=len(args), stride=1)])
        publisher = self.ros.publisher(Int16MultiArray, full_name(runtime.node, ports.names.topic("_aseba/emit")))
        publisher.publish(Int16MultiArray(layout=layout, data=list(args)))

    def _subscribe_to_events(self) -> None:
        """Hear what the programs of all robots emit, of those too that have just come."""
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
