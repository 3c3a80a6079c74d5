"""What the simulator says about the world as a whole: clock, state, playgrounds, markers, diagnostics."""

from __future__ import annotations

import json
import logging
import time
from dataclasses import dataclass

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

from thymio_sim_ros import resources
from thymio_sim_ros.nodes import qos
from thymio_sim_ros.nodes.headers import SECOND_NS, stamp
from thymio_sim_ros.nodes.markers import playground_markers
from thymio_sim_ros.nodes.names import RobotNames
from thymio_sim_ros.sim import playground as playgrounds
from thymio_sim_ros.sim.playground import Playground, PlaygroundError
from thymio_sim_ros.sim.scene import ObjectSnapshot
from thymio_sim_ros.sim.world import World

CLOCK_GAP_NS = 18_000_000
"""Shortest wall time between two clock messages: at most about 50 Hz (ros-interface.md section 5)."""

OBJECTS_GAP_NS = 50_000_000
"""Shortest wall time between two messages of objects that move."""

SLOW = 0.9
"""Below this part of the wanted factor the diagnostics warn."""


@dataclass(frozen=True, slots=True)
class WorldState:
    """What `~/state` tells: times in ns of simulated time, factors in simulated seconds per second."""

    playground: str
    title: str
    notes: tuple[str, ...]
    paused: bool
    real_time_factor: float
    achieved: float
    seed: int
    now_ns: int
    robots: tuple[RobotNames, ...]

    def as_json(self) -> str:
        """The text of `~/state`."""
        robots = [{"name": names.name, "frame": names.frame("base_link")} for names in self.robots]
        fields = {name: getattr(self, name) for name in self.__slots__ if name != "robots"}
        return json.dumps(fields | {"achieved": round(self.achieved, 3), "robots": robots})


class WorldPorts:
    """Publishers of the simulator that belong to no robot."""

    def __init__(self, node: Node, *, publish_clock: bool) -> None:
        self._clock = node.create_publisher(Clock, "/clock", qos.CLOCK) if publish_clock else None
        self._state = node.create_publisher(String, "~/state", qos.LATCHED)
        self._markers = node.create_publisher(MarkerArray, "/markers", qos.LATCHED)
        self._diagnostics = node.create_publisher(DiagnosticArray, "/diagnostics", qos.SENSOR)
        self._playgrounds = node.create_publisher(String, "~/playgrounds", qos.LATCHED)
        self._playgrounds.publish(String(data=json.dumps(shipped_playgrounds())))
        self._objects = node.create_publisher(MarkerArray, "/markers/objects", qos.LATCHED)
        self._last_clock_ns = self._last_objects_ns = 0
        self._shown: tuple[Playground, tuple[ObjectSnapshot, ...]] | None = None

    def publish_clock(self, now_ns: int, *, last: bool) -> None:
        """Simulated time; limited to 50 Hz of wall time unless it is the `last` one for a while."""
        wall_ns = time.monotonic_ns()
        if self._clock is None or not (last or wall_ns - self._last_clock_ns >= CLOCK_GAP_NS):
            return
        self._last_clock_ns = wall_ns
        self._clock.publish(Clock(clock=stamp(now_ns)))

    def publish_state(self, state: WorldState) -> None:
        """Latched state as JSON."""
        self._state.publish(String(data=state.as_json()))

    def publish_scene(self, playground: Playground) -> None:
        """Latched markers of all in the playground that stays where it is."""
        fixed = [solid for solid in playground.solids if solid.is_fixed]
        self._markers.publish(playground_markers((*playground.floors, *playground.paints, *fixed)))

    def publish_objects(self, world: World, *, last: bool) -> None:
        """Latched markers of movable things and doors, when they have moved.

        At most 20 Hz of wall time, unless it is the `last` one for a while.
        """
        wall_ns = time.monotonic_ns()
        if not (last or wall_ns - self._last_objects_ns >= OBJECTS_GAP_NS):
            return
        shown = (world.playground, world.objects)
        if shown == self._shown:
            return
        self._shown, self._last_objects_ns = shown, wall_ns
        solids = {solid.name: solid for solid in world.playground.solids if not solid.is_fixed}
        placed = [solids[thing.name].at(thing.pose) for thing in world.objects if not thing.is_fallen]
        self._objects.publish(playground_markers(placed))

    def publish_diagnostics(self, state: WorldState, dropped_ticks: int) -> None:
        """Pace of the simulation (ros-interface.md section 5)."""
        slow = not state.paused and 0 < state.achieved < SLOW * state.real_time_factor
        status = DiagnosticStatus(
            level=DiagnosticStatus.WARN if slow else DiagnosticStatus.OK,
            name="simulator: pace",
            hardware_id="thymio_sim_ros",
            message="paused" if state.paused else "slower than wanted" if slow else "running",
            values=[
                KeyValue(key="real-time factor wanted", value=f"{state.real_time_factor:g}"),
                KeyValue(key="real-time factor achieved", value=f"{state.achieved:.3f}"),
                KeyValue(key="simulated seconds", value=f"{state.now_ns / SECOND_NS:.2f}"),
                KeyValue(key="ticks dropped", value=str(dropped_ticks)),
                KeyValue(key="robots", value=str(len(state.robots))),
            ],
        )
        message = DiagnosticArray(status=[status])
        message.header.stamp = stamp(state.now_ns)
        self._diagnostics.publish(message)


def shipped_playgrounds() -> list[dict[str, object]]:
    """Name, title, description and their translations of every shipped playground."""
    listed: list[dict[str, object]] = []
    for name, path in resources.playgrounds().items():
        try:
            shown = playgrounds.headline(path)
        except PlaygroundError as error:
            logging.getLogger(__name__).warning("playground left out: %s", error)
            continue
        translations = {
            language: {"title": text.title, "description": text.description} for language, text in shown.translations
        }
        listed.append(
            {"name": name, "title": shown.title, "description": shown.description, "translations": translations}
        )
    return listed
