"""What the simulator says about the world as a whole: clock, state, playgrounds, markers, diagnostics."""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from nav_msgs.msg import OccupancyGrid
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Int16MultiArray, String
from visualization_msgs.msg import MarkerArray

from thymio_sim_ros import resources
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.cdr_templates import Patch, Template
from thymio_sim_ros.ros.interface.headers import SECOND_NS, stamp
from thymio_sim_ros.ros.interface.names import MAP_FRAME, RobotNames
from thymio_sim_ros.ros.rclpy_ext import raw_publisher
from thymio_sim_ros.ros.simulator.clock_conflict import ClockConflict
from thymio_sim_ros.ros.simulator.markers import playground_markers
from thymio_sim_ros.ros.simulator.occupancy_grid import occupancy
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError
from thymio_sim_ros.sim.playground.scene import ObjectSnapshot
from thymio_sim_ros.sim.world import World

CLOCK_GAP = 0.9
"""Part of its period of wall time after which the clock may be told again: ticks come when they come."""

OBJECTS_GAP_NS = 50_000_000
"""Shortest wall time between two messages of objects that move."""

SLOW = 0.9
"""Below this part of the wanted factor the diagnostics warn."""


@dataclass(frozen=True, slots=True)
class WorldTopic:
    """One topic of the world: how often it is sent, what it holds."""

    type: type
    rate: str
    about: str
    profile: QoSProfile
    frame: str = ""


TOPICS: Mapping[str, WorldTopic] = {
    "/clock": WorldTopic(Clock, "≤ 50", "simulated time; 1 Hz while paused", qos.CLOCK),
    "~/_state": WorldTopic(
        String,
        "1, change",
        "JSON: playground, paused, factors, seed, ns, robots and which of them fell, things that can be moved, the "
        "topic `~/_raw`",
        qos.TRANSIENT_LOCAL,
    ),
    "~/_raw": WorldTopic(
        Int16MultiArray,
        "≤ 100",
        "Aseba's integers of all robots: a dimension `robot/sensor` for each reading",
        qos.EVENTS,
    ),
    "~/_playgrounds": WorldTopic(
        String, "once", "JSON: shipped playgrounds with titles and descriptions", qos.TRANSIENT_LOCAL
    ),
    "_markers": WorldTopic(MarkerArray, "change", "the playground: floors, paint, walls", qos.TRANSIENT_LOCAL, "map"),
    "_markers/objects": WorldTopic(
        MarkerArray, "≤ 20, change", "movable things and doors as they stand", qos.TRANSIENT_LOCAL, "map"
    ),
    "map": WorldTopic(
        OccupancyGrid, "change", "only with `publish_map`: walls, 1 cm cells", qos.TRANSIENT_LOCAL, "map"
    ),
    "/diagnostics": WorldTopic(
        DiagnosticArray,
        "1",
        "real-time factor wanted and achieved, late and dropped ticks, refused and limited messages, robots; "
        "publishers of a wrong type; another simulator with the same clock",
        qos.SENSOR,
    ),
}
"""Every topic that the simulator publishes for the world as a whole, but for transforms."""


@dataclass(frozen=True, slots=True)
class WorldState:
    """What `~/_state` tells: times in ns of simulated time, factors in simulated seconds per second."""

    playground: str
    title: str
    notes: tuple[str, ...]
    paused: bool
    real_time_factor: float
    achieved: float
    seed: int
    now_ns: int
    robots: Mapping[str, RobotNames]
    movables: tuple[str, ...] = ()
    raw: str = ""
    """Where the integers of all robots are told."""
    fallen: frozenset[str] = frozenset()
    """Names in the world of the robots that fell off an edge."""

    def as_json(self) -> str:
        """The text of `~/_state`."""
        robots = [
            {
                "name": names.name,
                "frame": names.frame("base_link"),
                "robot": robot,
                "fallen": robot in self.fallen,
            }
            for robot, names in self.robots.items()
        ]
        fields = {name: getattr(self, name) for name in self.__slots__ if name not in {"robots", "fallen"}}
        return json.dumps(fields | {"achieved": round(self.achieved, 3), "robots": robots})


@dataclass(frozen=True, slots=True)
class PaceCounters:
    """Since the start or the last change of pace: ticks that came late, or never.

    Since the start: messages that were refused, and those with something beyond the robot's limits.
    """

    late_ticks: int
    dropped_ticks: int
    refused: int
    limited: int


@dataclass(frozen=True, slots=True)
class SceneMessages:
    """Everything in a playground that stays where it is, as messages; a pure function of the playground."""

    markers: MarkerArray
    map: OccupancyGrid | None

    @classmethod
    def of(cls, playground: Playground, frame: str, *, with_map: bool) -> SceneMessages:
        """The messages; making them takes a second for large pictures."""
        fixed = [solid for solid in playground.solids if solid.is_fixed]
        markers = playground_markers((*playground.floors, *playground.paints, *fixed), frame)
        return cls(markers, occupancy(playground.floors, fixed, frame) if with_map else None)


class WorldEndpoints:
    """Publishers of the simulator that belong to no robot."""

    def __init__(
        self,
        node: Node,
        *,
        publish_clock: bool = True,
        clock_rate_hz: float = 50.0,
        publish_map: bool = False,
        map_frame: str = MAP_FRAME,
    ) -> None:
        """`clock_rate_hz`: of wall time, at most."""
        self._name = node.get_fully_qualified_name().removeprefix("/")
        left_out = {"/clock": not publish_clock, "map": not publish_map}
        self._publishers = {
            name: node.create_publisher(topic.type, name, topic.profile)
            for name, topic in TOPICS.items()
            if not left_out.get(name)
        }
        self._clock_gap_ns = round(CLOCK_GAP * SECOND_NS / clock_rate_hz)
        self._has_clock_subscribers = False
        self._clock = Template(Patch(()), Clock(), None)
        clock = self._publishers.get("/clock")
        self._send_clock = raw_publisher.sender(clock) if clock is not None else None
        self._count_clock = raw_publisher.counter(clock) if clock is not None else None
        self._clock_conflict = None
        if clock is not None:
            self._clock_conflict = ClockConflict(node, clock.topic_name, node.context.get_domain_id())
        self._map_frame = map_frame
        self._publishers["~/_playgrounds"].publish(String(data=json.dumps(shipped_playgrounds())))
        self._last_clock_ns = self._last_objects_ns = 0
        self._shown: tuple[Playground, tuple[ObjectSnapshot, ...]] | None = None

    @property
    def raw(self) -> Any:
        """The publisher of all robots' integers."""
        return self._publishers["~/_raw"]

    @property
    def clock_due_ns(self) -> int | None:
        """The wall time from which the clock may be told again; None when nobody hears it."""
        return self._last_clock_ns + self._clock_gap_ns if self._has_clock_subscribers else None

    def publish_clock(self, now_ns: int, *, last: bool) -> None:
        """Simulated time; limited by its rate of wall time unless it is the `last` one for a while."""
        wall_ns = time.monotonic_ns()
        due_ns = self.clock_due_ns
        if self._send_clock is None or not (last or (due_ns is not None and wall_ns >= due_ns)):
            return
        self._last_clock_ns = wall_ns
        self._send_clock(self._clock.at(now_ns))
        if self._clock_conflict is not None:
            self._clock_conflict.record_published(now_ns)

    def poll(self) -> None:
        """Find out whether somebody hears the clock now."""
        self._has_clock_subscribers = self._count_clock is not None and self._count_clock() > 0

    def publish_state(self, state: WorldState) -> None:
        """Latched state as JSON."""
        self._publishers["~/_state"].publish(String(data=state.as_json()))

    def publish_scene(self, scene: SceneMessages) -> None:
        """Latched markers of all in the playground that stays where it is."""
        self._publishers["_markers"].publish(scene.markers)
        if scene.map is not None:
            self._publishers["map"].publish(scene.map)

    def publish_objects(self, world: World, *, last: bool) -> None:
        """Latched markers of movable things and doors, when they have moved.

        They are looked at at most 20 times a second of wall time, unless it is the `last` time for a while.
        """
        wall_ns = time.monotonic_ns()
        if not (last or wall_ns - self._last_objects_ns >= OBJECTS_GAP_NS):
            return
        self._last_objects_ns = wall_ns
        shown = (world.playground, world.objects)
        if shown == self._shown:
            return
        self._shown = shown
        solids = {solid.name: solid for solid in world.playground.solids if not solid.is_fixed}
        placed = [solids[thing.name].at(thing.pose) for thing in world.objects if not thing.is_fallen]
        self._publishers["_markers/objects"].publish(playground_markers(placed, self._map_frame))

    def publish_diagnostics(self, state: WorldState, pace: PaceCounters, inputs: DiagnosticStatus) -> None:
        """Pace of the simulation, its inputs, and whether another simulator publishes its clock."""
        slow = not state.paused and 0 < state.achieved < SLOW * state.real_time_factor
        status = DiagnosticStatus(
            level=DiagnosticStatus.WARN if slow else DiagnosticStatus.OK,
            name=f"{self._name}: pace",
            hardware_id="thymio_sim_ros",
            message="paused" if state.paused else "slower than wanted" if slow else "running",
            values=[
                KeyValue(key="real-time factor wanted", value=f"{state.real_time_factor:g}"),
                KeyValue(key="real-time factor achieved", value=f"{state.achieved:.3f}"),
                KeyValue(key="simulated seconds", value=f"{state.now_ns / SECOND_NS:.2f}"),
                KeyValue(key="ticks late", value=str(pace.late_ticks)),
                KeyValue(key="ticks dropped", value=str(pace.dropped_ticks)),
                KeyValue(key="messages refused", value=str(pace.refused)),
                KeyValue(key="messages limited", value=str(pace.limited)),
                KeyValue(key="robots", value=str(len(state.robots))),
            ],
        )
        statuses = [status, inputs]
        if self._clock_conflict is not None:
            self._clock_conflict.poll()
            statuses.append(self._clock_conflict.status())
        message = DiagnosticArray(status=statuses)
        message.header.stamp = stamp(state.now_ns)
        self._publishers["/diagnostics"].publish(message)


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
