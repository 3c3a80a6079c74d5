"""Examines a running suite as another node sees it: its connections, the last messages, and faults.

Simulator and Aseba runtime find faults of endpoints and messages (`rclpy_ext/connections.py`,
`rclpy_ext/message_reports.py`), the runtime also those of its programs; both publish them. This module collects them,
with the topics that other nodes use.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo
from std_msgs.msg import String

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, load_type
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.rclpy_ext.peers import PUBLISHING_PEER, SUBSCRIBING_PEER

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["Examination", "NothingFoundError", "TopicUse", "examine"]

NAME = "thymio_doctor"
SUITE = ("simulator", "aseba_runtime", "foxglove_bridge", "web_ui", SUBSCRIBING_PEER, PUBLISHING_PEER)
"""Names of the nodes of a suite."""
FIND_S = 8.0
"""Longest wait for a simulator: discovery, and the next `/diagnostics`."""
LOOK_S, LOOKS = 2.0, 4
"""Time for which messages are collected, and number of searches for new topics meanwhile."""

_STATE, _DIAGNOSTICS = "_state", "/diagnostics"
_OF_EVERY_NODE = frozenset({"/rosout", "/parameter_events", "/clock", _DIAGNOSTICS})
_MESSAGES, _CONNECTIONS = ": messages", ": connections"
"""Ends of names of statuses whose values are sentences."""
_PACE = ": pace"
"""End of names of statuses about a simulation that is slower than requested."""
_CLAMPED = " clamped: "
_MAX_VALUES = 6
"""Largest number of values of a message that are shown."""


class NothingFoundError(ThymioSimError):
    """No running simulator was found, or not this robot; the text says what to do."""


@dataclass(frozen=True, slots=True)
class TopicUse:
    """A topic that nodes outside the suite use, with the nodes on both sides and the last message as text."""

    name: str
    type: str
    publishers: tuple[str, ...]
    subscribers: tuple[str, ...]
    last: str = ""
    age_s: float | None = None
    """Time since the last message in s; None if none arrived within `LOOK_S`."""


@dataclass(slots=True)
class Examination:
    """The result. `faults` are sentences with the cure each; `notes` explain what is no fault."""

    where: str
    playground: str = ""
    robots: tuple[str, ...] = ()
    paused: bool = False
    topics: list[TopicUse] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def examine(where: str, robot: str = "") -> Examination:
    """Examine the suite of the graph of this process, `where` in words, or one of its robots, for some seconds.

    Raises NothingFoundError if there is no simulator, or no such robot.
    """
    context = Context()
    rclpy.init(context=context)
    try:
        node = Node(NAME, context=context, enable_rosout=False, start_parameter_services=False)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        return _Doctor(node, executor, where, robot).examine()
    finally:
        rclpy.shutdown(context=context)


class _Doctor:
    """One examination by one node."""

    def __init__(self, node: Node, executor: SingleThreadedExecutor, where: str, robot: str) -> None:
        self._node, self._executor, self._robot = node, executor, robot
        self._found = Examination(where)
        self._statuses: dict[str, DiagnosticStatus] = {}
        self._states: dict[str, dict[str, Any]] = {}
        self._listened: set[tuple[str, str]] = set()
        self._last: dict[tuple[str, str], tuple[str, float]] = {}
        node.create_subscription(DiagnosticArray, _DIAGNOSTICS, self._on_diagnostics, qos.SENSOR)

    def examine(self) -> Examination:
        """Find the simulators, collect, and describe what is found."""
        followed: set[str] = set()
        self._spin(FIND_S, lambda: self._follow_simulators(followed) and bool(self._statuses) and bool(self._states))
        if not self._states:
            raise NothingFoundError(
                f"no simulator found on {self._found.where}: start `thymio-sim`; on ROS 2, run this command in a"
                ' terminal with the same ROS_DOMAIN_ID (`eval "$(thymio-sim env)"`)'
            )
        for _ in range(LOOKS):  # the first looks may be before the discovery of some nodes
            for use in self._uses():
                self._listen(use)
            self._spin(LOOK_S / LOOKS, lambda: False)
        now_s = time.monotonic()
        self._found.topics = [self._with_last(use, now_s) for use in self._uses()]
        for state in self._states.values():
            self._describe(state)
        self._found.faults = list(dict.fromkeys([*self._found.faults, *self._other_faults()]))
        self._found.notes = list(dict.fromkeys([*self._found.notes, *self._slow(), *self._clamped(), *self._unused()]))
        return self._found

    def _spin(self, seconds: float, is_done: Callable[[], bool]) -> None:
        end_s = time.monotonic() + seconds
        while not is_done() and time.monotonic() < end_s:
            self._executor.spin_once(timeout_sec=0.1)

    def _follow_simulators(self, followed: set[str]) -> bool:
        """Subscribe to the state of each simulator that is found."""
        for name, namespace in self._node.get_node_names_and_namespaces():
            topic = f"{namespace.rstrip('/')}/{name}/{_STATE}"
            if name == SUITE[0] and topic not in followed:
                followed.add(topic)
                self._node.create_subscription(String, topic, self._on_state(topic), qos.TRANSIENT_LOCAL)
        return bool(followed)

    def _on_state(self, topic: str) -> Callable[[String], None]:
        def receive(message: String) -> None:
            self._states[topic] = json.loads(message.data)

        return receive

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        self._statuses |= {status.name: status for status in message.status}

    # --- topics ---

    def _uses(self) -> Iterator[TopicUse]:
        """Yield the topics of the suite that other nodes publish or subscribe to, once for each type."""
        for topic, kinds in self._node.get_topic_names_and_types():
            if topic in _OF_EVERY_NODE or not self._is_of_robot(topic):
                continue
            published = self._node.get_publishers_info_by_topic(topic)
            subscribed = [info for info in self._node.get_subscriptions_info_by_topic(topic) if info.node_name != NAME]
            names = {info.node_name for info in (*published, *subscribed)}
            if names.intersection(SUITE) and names.difference(SUITE):
                yield from (TopicUse(topic, kind, _nodes(published, kind), _nodes(subscribed, kind)) for kind in kinds)

    def _is_of_robot(self, topic: str) -> bool:
        return not self._robot or topic.startswith(f"/{self._robot.strip('/')}/")

    def _listen(self, use: TopicUse) -> None:
        """Subscribe to a topic with the type of the suite; one process cannot use two types on the same topic."""
        nodes = (node.rpartition("/")[2] for node in (*use.publishers, *use.subscribers))
        if not use.publishers or not set(nodes).intersection(SUITE) or (use.name, use.type) in self._listened:
            return
        self._listened.add((use.name, use.type))

        def receive(message: Message) -> None:
            self._last[use.name, use.type] = _text(message), time.monotonic()

        try:
            profile = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
            self._node.create_subscription(load_type(use.type), use.name, receive, profile)
        except MissingTypeError as error:
            self._found.notes.append(f"{use.name}: {error}")

    def _with_last(self, use: TopicUse, now_s: float) -> TopicUse:
        if (use.name, use.type) not in self._last:
            return use
        text, when_s = self._last[use.name, use.type]
        return TopicUse(use.name, use.type, use.publishers, use.subscribers, text, now_s - when_s)

    # --- what is wrong ---

    def _describe(self, state: Mapping[str, Any]) -> None:
        """Process the state that a simulator publishes."""
        names = tuple(robot["name"] for robot in state["robots"])
        if self._robot and self._robot.strip("/") not in names:
            listed = ", ".join(filter(None, names)) or "one without a name (its topics have no prefix)"
            raise NothingFoundError(f"no robot '{self._robot}': the robots are {listed}")
        found = self._found
        found.playground, found.robots, found.paused = state["playground"], names, state["paused"]
        if state["paused"]:
            found.faults.append(
                "The simulation is paused: press Play on the page, or call /simulator/pause with data false"
            )
        fallen = [robot["name"] or robot["robot"] for robot in state["robots"] if robot["fallen"]]
        found.faults += [f"Robot {robot} fell off an edge: put it back on the page, or reset" for robot in fallen]
        found.faults += state["faults"]

    def _other_faults(self) -> Iterable[str]:
        """Statuses with a fault that the state does not have: clock, programs, messages to the runtime."""
        in_state = {f"{topic.strip('/').removesuffix(f'/{_STATE}')}{_MESSAGES}" for topic in self._states}
        for name, status in self._statuses.items():
            if status.level == DiagnosticStatus.OK or name in in_state or name.endswith(_PACE):
                continue
            if name.endswith((_MESSAGES, _CONNECTIONS)):
                yield from (pair.value for pair in status.values if " " in pair.value and _CLAMPED not in pair.value)
            else:
                yield f"{name}: {status.message}"

    def _slow(self) -> Iterable[str]:
        """Simulations for which the computer has too little time: robot and nodes are well, only later."""
        for name, status in self._statuses.items():
            if name.endswith(_PACE) and status.level != DiagnosticStatus.OK:
                factors = {pair.key.rpartition(" ")[2]: pair.value for pair in status.values}
                yield (
                    f"{name.removesuffix(_PACE)} is {status.message}: real-time factor {factors['achieved']},"
                    f" expected {factors['wanted']}; this computer is busy"
                )

    def _clamped(self) -> Iterable[str]:
        values = (pair.value for status in self._statuses.values() for pair in status.values)
        return [text for text in values if _CLAMPED in text]

    def _unused(self) -> Iterable[str]:
        """Speed topics without a publisher."""
        for name in self._found.robots:
            topic = f"/{name}/cmd_vel" if name else "/cmd_vel"
            if self._is_of_robot(topic) and not self._node.count_publishers(topic):
                yield f"{topic} has no publisher: the robot moves by its program and from the page only"


def _nodes(infos: Iterable[TopicEndpointInfo], kind: str) -> tuple[str, ...]:
    """The nodes of the endpoints of a type."""
    return tuple(
        sorted({f"{info.node_namespace.rstrip('/')}/{info.node_name}" for info in infos if info.topic_type == kind})
    )


def _text(message: Message) -> str:
    """The values of a message that are not zero or empty, on one line."""
    values = list(_values(message, ""))
    shown = ", ".join(f"{name} {value}" for name, value in values[:_MAX_VALUES])
    return (shown or "all values are zero") + (", …" if len(values) > _MAX_VALUES else "")


def _values(message: Message, prefix: str) -> Iterator[tuple[str, str]]:
    for name in message.get_fields_and_field_types():
        value = getattr(message, name)
        full = f"{prefix}{name}"
        if name == "header":
            continue
        if hasattr(value, "get_fields_and_field_types"):
            yield from _values(value, f"{full}.")
        elif isinstance(value, bool | int | float):
            if value or math.isnan(value):
                yield full, f"{value:g}" if isinstance(value, float) else str(value)
        elif len(value):
            yield full, str(value) if isinstance(value, str) else f"[{len(value)} values]"
