"""Publishers for the world: state, playgrounds, sensors, markers, map (docs/spec/ros-interface.md section 5)."""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from nav_msgs.msg import OccupancyGrid
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

from thymio_sim_ros.files import resources
from thymio_sim_ros.ros.interface.names import MAP_FRAME, RobotNames
from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode, LocalTopic
from thymio_sim_ros.ros.simulator.sensor_list import displayed_sensors
from thymio_sim_ros.ros.simulator.visualization.markers import playground_markers
from thymio_sim_ros.ros.simulator.visualization.occupancy_grid import occupancy
from thymio_sim_ros.ros.simulator.world_topics import TOPICS
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError
from thymio_sim_ros.sim.playground.scene import ObjectSnapshot
from thymio_sim_ros.sim.world import World

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["SceneMessages", "WorldEndpoints", "WorldState", "shipped_playgrounds"]

OBJECTS_GAP_NS = 50_000_000
"""Shortest wall time between two messages about moving objects."""

OVERVIEW_GAP_NS = 400_000_000
"""Shortest wall time between two overviews."""

_WORDS = ("~/_state", "~/_overview", "~/_playgrounds", "~/_sensors", "_markers", "_markers/objects")
"""Topics that are always published here; the clock and the diagnostics have publishers of their own."""

_SHOWING = ("~/_overview", "_markers", "_markers/objects", "map")
"""Topics that show positions."""


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
    fallen: frozenset[str] = frozenset()
    """Names (in the world) of the robots that fell off an edge."""
    faults: tuple[str, ...] = ()
    """Faults of endpoints and messages of other nodes, a sentence each."""

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
    """Publishers for the world as a whole: state, playgrounds, markers, map."""

    def __init__(
        self, node: Node, control: Node | LocalNode, *, publish_map: bool = False, map_frame: str = MAP_FRAME
    ) -> None:
        """`control` publishes the topics that show where things are."""
        words = (*_WORDS, "map") if publish_map else _WORDS
        self._publishers: dict[str, Publisher[Message] | LocalTopic] = {
            name: (control if name in _SHOWING else node).create_publisher(
                TOPICS[name].type, name, TOPICS[name].profile
            )
            for name in words
        }
        self._is_closed = control is not node
        self._map_frame = map_frame
        self._publishers["~/_playgrounds"].publish(String(data=json.dumps(shipped_playgrounds())))
        self._publishers["~/_sensors"].publish(String(data=json.dumps(displayed_sensors())))
        self._last_objects_ns = self._last_overview_ns = 0
        self._shown: tuple[Playground, tuple[ObjectSnapshot, ...]] | None = None

    def publish_state(self, state: WorldState) -> None:
        """Publish the retained state as JSON."""
        if self._is_closed:  # who the robots are may be known, the rest describes the world
            state = replace(state, playground="", title="", notes=(), movables=())
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

    def publish_overview_if_due(self, world: World, wall_ns: int) -> None:
        """Publish the positions of robots and objects, if there is a subscriber and the last overview is long enough
        ago.

        `wall_ns` is of `time.monotonic_ns`.
        """
        if wall_ns - self._last_overview_ns < OVERVIEW_GAP_NS:
            return
        self._last_overview_ns = wall_ns
        publisher = self._publishers["~/_overview"]
        if publisher.get_subscription_count():
            publisher.publish(String(data=overview(world)))


def overview(world: World) -> str:
    """Return the message text of `~/_overview`: [x, y, yaw, red, green, blue] of each robot, in m, rad and 0…32;
    [x, y, yaw] of each object and door by name, null for one that has fallen off an edge."""
    shown = world.snapshot()
    robots = {
        robot.name: [*_rounded(robot.pose), *dict(robot.leds).get("top", (0, 0, 0))[:3]] for robot in shown.robots
    }
    objects = {thing.name: None if thing.is_fallen else _rounded(thing.pose) for thing in shown.objects}
    return json.dumps({"robots": robots, "objects": objects}, separators=(",", ":"))


def _rounded(pose: Pose) -> list[float]:
    return [round(value, 3) for value in (pose.x_m, pose.y_m, pose.yaw_rad)]


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
