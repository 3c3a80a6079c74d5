"""The topics of the world as a whole, one row per topic (docs/ros.md)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import OccupancyGrid
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

from thymio_sim_ros.ros.interface import qos

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["TOPICS", "WorldTopic"]


@dataclass(frozen=True, slots=True)
class WorldTopic:
    """One topic of the world: type, rate, content, QoS and frame."""

    type: type[Message]
    rate: str
    about: str
    profile: QoSProfile
    frame: str = ""


TOPICS: Mapping[str, WorldTopic] = {
    "/clock": WorldTopic(Clock, "≤ 50", "simulated time; 1 Hz while paused", qos.CLOCK),
    "~/_state": WorldTopic(
        String,
        "1, change",
        "JSON: playground, paused, factors, seed, ns, robots and which of them fell, movable objects, what is wrong "
        "with endpoints and messages of other nodes",
        qos.TRANSIENT_LOCAL,
    ),
    "~/_overview": WorldTopic(
        String,
        "≤ 2.5",
        "JSON: poses of robots with the color of the top LED, poses of objects and doors; for small pictures, by wall "
        "time",
        qos.EVENTS,
    ),
    "~/_playgrounds": WorldTopic(
        String, "once", "JSON: shipped playgrounds with titles and descriptions", qos.TRANSIENT_LOCAL
    ),
    "~/_sensors": WorldTopic(
        String, "once", "JSON: label, units and scales of the sensors' words, for viewers", qos.TRANSIENT_LOCAL
    ),
    "~/_mission": WorldTopic(
        String,
        "change",
        "JSON: the mission that is open, with its texts, zones, checklist, start programs and hints; `null`: none",
        qos.TRANSIENT_LOCAL,
    ),
    "~/_mission/try": WorldTopic(
        String,
        "change",
        "JSON: what the present try of the mission has reached: state, checklist, stars, reasons, time; at the end its "
        "way",
        qos.TRANSIENT_LOCAL,
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
        "real-time factor requested and achieved, late and dropped ticks, robots; rejected and clamped messages, "
        "with the reasons of the last 10 s; endpoints of other nodes that are not connected; another simulator on "
        "the same clock",
        qos.SENSOR,
    ),
}
"""All topics of the world as a whole except transforms."""
