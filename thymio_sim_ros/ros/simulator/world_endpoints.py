"""Publishers for the world as a whole: clock, state, playgrounds, sensors, markers, diagnostics."""

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
from thymio_sim_ros.ros.simulator.sensor_list import displayed_sensors
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError
from thymio_sim_ros.sim.playground.scene import ObjectSnapshot
from thymio_sim_ros.sim.world import World

CLOCK_GAP = 0.9
"""Part of the clock's period after which it may be published again, since ticks do not divide the period evenly."""

OBJECTS_GAP_NS = 50_000_000
"""Shortest wall time between two messages about moving objects."""

SLOW = 0.9
"""Part of the requested real-time factor below which the diagnostics warn."""


@dataclass(frozen=True, slots=True)
class WorldTopic:
    """One topic of the world: type, rate, content, QoS and frame."""

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
        "JSON: playground, paused, factors, seed, ns, robots and which of them fell, movable objects, the "
        "topic `~/_raw`",
        qos.TRANSIENT_LOCAL,
    ),
    "~/_raw": WorldTopic(
        Int16MultiArray,
        "≤ 100",
        "integer readings of all robots: one dimension `robot/sensor` per reading",
        qos.EVENTS,
    ),
    "~/_playgrounds": WorldTopic(
        String, "once", "JSON: shipped playgrounds with titles and descriptions", qos.TRANSIENT_LOCAL
    ),
    "~/_sensors": WorldTopic(
        String, "once", "JSON: label, units and scales of the sensors' words, for viewers", qos.TRANSIENT_LOCAL
    ),
    "_markers": WorldTopic(MarkerArray, "change", "the playground: floors, paint, walls", qos.TRANSIENT_LOCAL, "map"),
    "_markers/objects": WorldTopic(
        MarkerArray, "≤ 20, change", "objects and doors at their current poses", qos.TRANSIENT_LOCAL, "map"
    ),
    "map": WorldTopic(
        OccupancyGrid, "change", "only with `publish_map`: walls, 1 cm cells", qos.TRANSIENT_LOCAL, "map"
    ),
    "/diagnostics": WorldTopic(
        DiagnosticArray,
        "1",
        "real-time factor requested and achieved, late and dropped ticks, rejected and clamped messages, robots; "
        "publishers with the wrong type; another simulator on the same clock",
        qos.SENSOR,
    ),
}
"""All topics of the world as a whole except transforms."""


@dataclass(frozen=True, slots=True)
class WorldState:
    """Content of `~/_state`: times in ns of simulated time, factors in simulated seconds per second."""

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
    """Topic with the integer readings of all robots."""
    fallen: frozenset[str] = frozenset()
    """Names (in the world) of the robots that fell off an edge."""

    def as_json(self) -> str:
        """Return the message text of `~/_state`."""
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
    """Late and dropped ticks since the last change of pace, and rejected and clamped messages since the start."""

    late_ticks: int
    dropped_ticks: int
    refused: int
    limited: int


@dataclass(frozen=True, slots=True)
class SceneMessages:
    """Messages for the fixed parts of a playground; a pure function of the playground."""

    markers: MarkerArray
    map: OccupancyGrid | None

    @classmethod
    def of(cls, playground: Playground, frame: str, *, with_map: bool) -> SceneMessages:
        """Create the messages; takes up to a second for large images."""
        fixed = [solid for solid in playground.solids if solid.is_fixed]
        markers = playground_markers((*playground.floors, *playground.paints, *fixed), frame)
        return cls(markers, occupancy(playground.floors, fixed, frame) if with_map else None)


class WorldEndpoints:
    """Publishers of the simulator for the world as a whole."""

    def __init__(
        self,
        node: Node,
        *,
        publish_clock: bool = True,
        clock_rate_hz: float = 50.0,
        publish_map: bool = False,
        map_frame: str = MAP_FRAME,
    ) -> None:
        """`clock_rate_hz`: largest rate of the clock in Hz of wall time."""
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
        self._publishers["~/_sensors"].publish(String(data=json.dumps(displayed_sensors())))
        self._last_clock_ns = self._last_objects_ns = 0
        self._shown: tuple[Playground, tuple[ObjectSnapshot, ...]] | None = None

    @property
    def raw(self) -> Any:
        """The publisher of the integer readings of all robots."""
        return self._publishers["~/_raw"]

    @property
    def clock_due_ns(self) -> int | None:
        """The wall time in ns from which the clock may be published again; None without subscribers."""
        return self._last_clock_ns + self._clock_gap_ns if self._has_clock_subscribers else None

    def publish_clock(self, now_ns: int, *, last: bool) -> None:
        """Publish simulated time, rate limited unless `last`: no other clock message is expected soon."""
        wall_ns = time.monotonic_ns()
        due_ns = self.clock_due_ns
        if self._send_clock is None or not (last or (due_ns is not None and wall_ns >= due_ns)):
            return
        self._last_clock_ns = wall_ns
        self._send_clock(self._clock.at(now_ns))
        if self._clock_conflict is not None:
            self._clock_conflict.record_published(now_ns)

    def poll(self) -> None:
        """Find out whether the clock has subscribers."""
        self._has_clock_subscribers = self._count_clock is not None and self._count_clock() > 0

    def publish_state(self, state: WorldState) -> None:
        """Publish the retained state as JSON."""
        self._publishers["~/_state"].publish(String(data=state.as_json()))

    def publish_scene(self, scene: SceneMessages) -> None:
        """Publish the retained markers, and the map, of the fixed parts of the playground."""
        self._publishers["_markers"].publish(scene.markers)
        if scene.map is not None:
            self._publishers["map"].publish(scene.map)

    def publish_objects(self, world: World, *, last: bool) -> None:
        """Publish retained markers of objects and doors if they have moved.

        Checked at most 20 times per second of wall time, unless `last`: no other check is expected soon.
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
        """Publish diagnostics: pace of the simulation, types of inputs, clock conflicts."""
        slow = not state.paused and 0 < state.achieved < SLOW * state.real_time_factor
        status = DiagnosticStatus(
            level=DiagnosticStatus.WARN if slow else DiagnosticStatus.OK,
            name=f"{self._name}: pace",
            hardware_id="thymio_sim_ros",
            message="paused" if state.paused else "slower than requested" if slow else "running",
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
    """Return name, title, description and translations of every shipped playground."""
    listed: list[dict[str, object]] = []
    for name, path in resources.playgrounds().items():
        try:
            shown = playgrounds.headline(path)
        except PlaygroundError as error:
            logging.getLogger(__name__).warning("playground skipped: %s", error)
            continue
        translations = {
            language: {"title": text.title, "description": text.description} for language, text in shown.translations
        }
        listed.append(
            {"name": name, "title": shown.title, "description": shown.description, "translations": translations}
        )
    return listed
