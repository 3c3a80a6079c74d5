"""One robot's Aseba device joined to its topics: readings in, commands out, events both ways, run control.

Topics: docs/spec/ros-interface.md section 6. The integers of a sensor come on `_raw/<sensor>`, or are made of the
topics of the ROS driver; commands leave on the topics that any robot listens to.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from rclpy.node import Node
from std_msgs.msg import Empty, Int16MultiArray
from std_srvs.srv import Trigger

from thymio_sim_ros.device.bindings import sensor_names
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.firmware.behavior_host import BehaviorHost
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.programs.program_assignment import Assignment
from thymio_sim_ros.device.programs.status import OFF, RUNNING
from thymio_sim_ros.ros.aseba import driver_input
from thymio_sim_ros.ros.aseba.event_endpoints import EventPorts
from thymio_sim_ros.ros.aseba.output_endpoints import OutputPorts
from thymio_sim_ros.ros.aseba.status_endpoints import Loaded, StatusPorts, place
from thymio_sim_ros.ros.aseba.variable_endpoints import VariablePorts
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import RobotNames, full_name, raw_topic
from thymio_sim_ros.ros.rclpy_ext import raw_publisher
from thymio_sim_ros.ros.rclpy_ext.throttled_log import Warner

__all__ = ["DevicePorts", "Surroundings", "Wishes"]

RUN_BUDGET = 5000
"""Instructions per turn; a handler that needs more goes on in the next (a robot does 65535 between polls)."""
CONTINUE_S = 0.01
"""Wall time after a turn in which a handler goes on without a message: the simulator measures as often."""
MOST_COMMANDS = 64
"""Commands of a turn that are all sent; of more, and of a turn that the budget has cut, the latest of each kind are."""

ALL = "*"
"""In place of the names of local events: all there are."""


@dataclass(frozen=True, slots=True)
class Wishes:
    """What a user wants to see of a robot: lines to stop at, variables and local events with topics, a language."""

    breakpoints: tuple[int, ...] = ()
    watch: tuple[str, ...] = ()
    local_events: tuple[str, ...] = ()
    language: str = "en"


class Surroundings(Protocol):
    """What a robot needs of the others."""

    def settle(self, *robots: DevicePorts) -> None:
        """Something happened to these robots: let them take turns, and those that they wake."""

    def pass_on(self, sender: DevicePorts, event: str, args: Sequence[int], /) -> None:
        """A robot emitted an event: tell the others."""

    def emit(self, ports: DevicePorts, event: str, args: Sequence[int], /) -> None:
        """Somebody in ROS emitted an event on this robot's topics."""

    def told(self, ports: DevicePorts, /) -> None:
        """The status of this robot is another."""

    def forget(self, robot: DevicePorts, /) -> None:
        """This robot goes: it takes no more turns."""


class DevicePorts:
    """An `AsebaDevice` with the topics and services of its robot."""

    def __init__(
        self,
        node: Node,
        names: RobotNames,
        *,
        number: int,
        around: Surroundings,
        options: DeviceOptions = DEFAULTS,
        wishes: Wishes | None = None,
        has_driver: bool = False,
        is_fed: bool = False,
    ) -> None:
        """`has_driver`: it has the topics of the ROS driver; `is_fed` as the property."""
        self.names = names
        self.number = number
        self.device = AsebaDevice(node_id=number, options=options)
        self.share: Assignment | None = None
        self._host = BehaviorHost(self.device)
        self._node = node
        self._around = around
        self._wishes = wishes or Wishes()
        self._program = self._own = self._host.program
        self._is_closed = False
        self._turned_s = 0.0
        self._replaced = 0
        self._overload = ""
        self._has_driver, self._is_fed = has_driver, is_fed
        self._outputs = OutputPorts(node, names, has_driver=has_driver)
        self.warn = Warner(node)
        self.status = StatusPorts(node, names, number=number)
        self._events = EventPorts(node, names, lambda event, args: around.emit(self, event, args), self.warn)
        self._variables = VariablePorts(node, names, self.device, self.run, language=self._wishes.language)
        self._shutdown = node.create_subscription(Empty, names.topic("shutdown"), self._on_shutdown, qos.EVENTS)
        self._senses = self._sense()
        controls = {
            "run": self._host.resume,
            "pause": self.device.pause,
            "step": self.device.step,
            "step_line": self.device.step_line,
            "stop": self.device.stop,
            "reset": self.device.reset,
        }
        self._services = [
            node.create_service(Trigger, names.topic(f"aseba/{word}"), self._controller(word, act))
            for word, act in controls.items()
        ]

    @property
    def is_fed(self) -> bool:
        """Whether who has it calls `feed`; else its own topics do."""
        return self._is_fed

    @is_fed.setter
    def is_fed(self, is_fed: bool) -> None:
        if is_fed != self._is_fed:
            for subscription in self._senses:
                self._node.destroy_subscription(subscription)
            self._is_fed = is_fed
            self._senses = self._sense()

    @property
    def is_busy(self) -> bool:
        """Whether a handler still has instructions to execute."""
        return self.device.is_busy

    @property
    def resumes_s(self) -> float:
        """The time by `time.monotonic` when a busy robot takes its next turn, if nothing else gives it one."""
        return self._turned_s + CONTINUE_S

    @property
    def program(self) -> ThymioProgram:
        """What the robot runs."""
        return self._program

    def load(self, program: ThymioProgram | None, notes: Sequence[str] = ()) -> None:
        """Load a program, or nothing, and run its beginning; `notes` are for people."""
        self.share = Assignment(program, tuple(notes))
        self._own = program or load_program("", "none", self.device.layout)
        self._host.load(self._own)
        self._begin()
        self.run()

    def start(self, behaviour: str, share: Assignment | None) -> None:
        """Switch the robot on with a built-in behaviour; a program of one's own waits in its menu."""
        self.share = share
        own = share.program if share is not None else None
        self._own = own or load_program("", "none", self.device.layout)
        self._host.start(behaviour, own)
        self._begin()
        self.run()

    def restart(self) -> None:
        """Time went back: the robot begins anew."""
        self._host.restart()
        self._begin()
        self.run()

    def want(self, wishes: Wishes) -> None:
        """Show other things of the program that goes on."""
        old, self._wishes = self._wishes, wishes
        if wishes != old:
            self._begin(with_events=wishes.local_events != old.local_events)
            self.run()

    def hear(self, event: str, args: Sequence[int], *, source: int) -> bool:
        """A global event waits for the robot's next turn; False if its program does not declare it."""
        if not self.device.declares(event):
            return False
        self.device.receive_event(event, args, source=source)
        return True

    def feed(self, sensor: str, words: Sequence[int]) -> None:
        """Store what a sensor measured; `run` or `is_due` comes next."""
        try:
            self.device.feed(sensor, words)
        except ValueError as error:
            self.warn(full_name(self._node, self.names.topic(raw_topic(sensor))), f"refused: {error}")

    def is_due(self, now_ns: int) -> bool:
        """Whether there is anything to do now for a robot that has been fed."""
        self.device.advance(now_ns)
        return self.device.is_due

    def run(self) -> None:
        """Something happened: take turns; nothing once it is closed, as messages may still come."""
        if not self._is_closed:
            self._around.settle(self)

    def turn(self) -> None:
        """Run what is pending up to the budget, then send what came of it."""
        if self._is_closed:
            return
        now_ns = self._node.get_clock().now().nanoseconds
        self.device.advance(now_ns)
        self.device.run(RUN_BUDGET)
        is_cut = self.device.is_busy
        events = self._host.pop_events()
        commands = self.device.pop_commands()
        self._replaced += self._outputs.send_all(commands, latest=is_cut or len(commands) > MOST_COMMANDS)
        for name in self.device.pop_local_events():
            self._events.publish(name, ())
        for event in events:
            self._events.publish(event.name, event.args)
            self._around.pass_on(self, event.name, event.args)
        if self._host.program is not self._program:
            self._begin()
        for notice in self._host.pop_notices():
            self._node.get_logger().warning(f"{self.names.name or 'robot'}: {notice}")
        self._tell()
        self._turned_s = time.monotonic()

    def observe_load(self) -> None:
        """Tell whether the program has done more than can be served since the last time."""
        load = replace(self.device.pop_load(), replaced=self._replaced)
        self._replaced = 0
        overload = load.warning if self.device.status.state == RUNNING else ""
        if overload and not self._overload:
            self.warn(f"{self.names.name or 'robot'}:", overload)
        self._overload = overload
        self._tell()

    def _tell(self) -> None:
        if self.status.tell(self.device.status, self._overload):
            self._around.told(self)

    def look(self) -> None:
        """Publish variables that changed."""
        self._variables.look()

    def see_listeners(self) -> None:
        """Tell a robot that has come what the program has said already."""
        self._outputs.look()

    def halt(self) -> None:
        """The robot does not go on without its program: wheels stop, and nothing runs any more."""
        if not self._is_closed:
            self._is_closed = True
            self._around.forget(self)
            self.device.stop()
            self._outputs.send_all(self.device.pop_commands(), latest=True)

    def close(self) -> None:
        """`halt` it; its topics and services go."""
        self.halt()
        for ports in (self._events, self._variables, self.status, self._outputs):
            ports.close()
        for service in self._services:
            self._node.destroy_service(service)
        for subscription in (self._shutdown, *self._senses):
            self._node.destroy_subscription(subscription)

    def _begin(self, *, with_events: bool = True) -> None:
        """The program is another or begins anew, or other things of it are wanted."""
        wishes, program = self._wishes, self._host.program
        is_own = program is self._own
        local = {event.name for event in target(self.device.layout).local_events}
        local_events = local if ALL in wishes.local_events else local & set(wishes.local_events)
        self._outputs.begin()
        if with_events:
            self.device.watch_events(local_events)
            self._events.open(program, sorted(local_events))
        self._program = program
        self._variables.language = wishes.language
        self._variables.begin(wishes.watch)
        points = self.device.set_breakpoints(wishes.breakpoints if is_own else ())
        notes = self.share.notes if is_own and self.share is not None else ()
        self.status.begin(Loaded(program, self._events.words, notes, points), wishes.language)

    def _sense(self) -> list[Any]:
        if self._has_driver:
            return driver_input.subscribe(self._node, self.names, self._sensed)
        if self._is_fed:
            return []
        return [
            self._node.create_subscription(
                Int16MultiArray, self.names.topic(raw_topic(sensor)), self._feeder(sensor), qos.SENSOR, raw=True
            )
            for sensor in sensor_names()
        ]

    def _feeder(self, sensor: str) -> Callable[[bytes], None]:
        return lambda message: self._sensed(sensor, raw_publisher.words_of(message))

    def _sensed(self, sensor: str, words: Sequence[int]) -> None:
        self.feed(sensor, words)
        self.run()

    def _on_shutdown(self, _message: Empty) -> None:
        self.device.switch_off()
        self.run()

    def _controller(
        self, word: str, act: Callable[[], None]
    ) -> Callable[[Trigger.Request, Trigger.Response], Trigger.Response]:
        def callback(_request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            act()
            self.turn()  # at once, whichever robots wait for theirs
            self._around.settle()
            status = self.device.status
            response.success = status.state != OFF
            response.message = (
                place(status) if response.success else f"{word}: the robot is off, aseba/run switches it on"
            )
            return response

        return callback
