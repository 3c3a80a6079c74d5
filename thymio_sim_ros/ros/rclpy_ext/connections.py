"""Detects endpoints of other nodes that ROS silently does not connect to a node; warnings name reason and cure.

Such an endpoint has another type than ours, an incompatible QoS, or another name: a namespace that the robot does not
have, a misspelled name, or a topic that is switched off. The usual cases are a TwistStamped on `cmd_vel`, as published
by newer teleoperation nodes and Nav2, and a node in a namespace.

The graph is queried per node, because there are fewer nodes than topics: at once when a node comes or goes, else in a
period that depends on the cost of the query.
"""

from __future__ import annotations

import difflib
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.client import Client
from rclpy.node import Node, NodeNameNonExistentError
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

from thymio_sim_ros.lockstep.matching import fit
from thymio_sim_ros.names.type_names import type_name
from thymio_sim_ros.ros.rclpy_ext.peers import SUBSCRIBING_PEER

__all__ = [
    "ACTION_CLIENT",
    "CLIENT",
    "PUBLISHER",
    "SERVER",
    "SUBSCRIBER",
    "Connections",
    "Side",
    "Unconnected",
    "wrong_qos",
    "wrong_type",
]

SHARE = 0.002
"""Largest share of one core that polling may use."""
POLL_PERIOD_S = 1.0
"""Shortest wall time between two polls."""
VELOCITY, STAMPED_PARAMETER = "cmd_vel", "stamped_cmd_vel"
NAMES_PARAMETER = "robot_names"
SIMILAR = 0.8
"""Least similarity of two words, of which one may be a misspelling of the other (`difflib`)."""
MAX_NAMES = 3
"""Largest number of names that a warning proposes."""

_OURS = ("simulator", "aseba_runtime", "foxglove_bridge", SUBSCRIBING_PEER)
"""Nodes of this package with many endpoints, whose names come from the graph or fit: they are skipped, since queries
cost time."""
_OF_ACTION, _GOAL_SERVICE, _GOAL_TYPE = "/_action/", "/_action/send_goal", "_SendGoal"
"""In the names of all topics and services of an action; ends of name and type of the service that gets its goals."""
_OF_EVERY_NODE = frozenset({
    "rosout", "parameter_events", "describe_parameters", "get_parameter_types", "get_parameters", "list_parameters",
    "set_parameters", "set_parameters_atomically", "get_type_description",
})  # fmt: skip
"""Last words of names that every node has: a node that uses those of another node does not mean ours."""


@dataclass(frozen=True, slots=True)
class Side:
    """One side of a connection. `effect`: of an endpoint without a peer; `use`: what the user does there."""

    name: str
    peer: str
    effect: str
    use: str


PUBLISHER = Side("publisher", "subscriber", "its messages never arrive", "Publish on")
SUBSCRIBER = Side("subscriber", "publisher", "it gets no message", "Subscribe to")
CLIENT = Side("client", "server", "its calls are never answered", "Call")
ACTION_CLIENT = Side("action client", "action server", "its goals are never answered", "Send goals to")
SERVER = Side("server", "client", "it gets no call", "Serve")


@dataclass(frozen=True, slots=True)
class _Query:
    """Methods of a node that find endpoints of a side and their peers, and the attribute with our own peers."""

    side: Side
    by_node: str
    own_peers: str
    count_peers: str


_QUERIES = (
    _Query(PUBLISHER, "get_publisher_names_and_types_by_node", "subscriptions", "count_subscribers"),
    _Query(SUBSCRIBER, "get_subscriber_names_and_types_by_node", "publishers", "count_publishers"),
    _Query(CLIENT, "get_client_names_and_types_by_node", "services", "count_services"),
)
_GOALS = _Query(ACTION_CLIENT, "get_client_names_and_types_by_node", "", "count_services")
"""Clients of actions are known by one of their services."""


@dataclass(frozen=True, slots=True)
class Unconnected:
    """An endpoint that is not connected: fully qualified name and node, what was found and expected, and the cure."""

    topic: str
    node: str
    side: Side
    found: str
    expected: str
    cure: str

    def __str__(self) -> str:
        article = "an" if self.side.name.startswith("a") else "a"
        return (
            f"{self.topic} has {article} {self.side.name} of {self.found} by node {self.node};"
            f" expected {self.expected}: {self.side.effect}. {self.cure}"
        )


@dataclass(frozen=True, slots=True)
class _Endpoint:
    """An endpoint of another node; `node` without, `namespace` with a slash at its end only if it is the root."""

    query: _Query
    topic: str
    type: str
    node: str
    namespace: str

    @property
    def full_node(self) -> str:
        """Fully qualified name of the node."""
        return _full(self.namespace, self.node)


_OwnEndpoint: TypeAlias = "Publisher[Any] | Subscription | Client[Any, Any] | Service | tuple[str, str]"
"""An endpoint, or name and type of an action."""


class _OwnNames:
    """The names and types of endpoints of our node, with an index by their last words."""

    def __init__(self, endpoints: Sequence[_OwnEndpoint]) -> None:
        self.endpoints = endpoints
        self.pairs = frozenset(map(_name_and_type, endpoints))
        """Names with types: a profile may have a topic with two."""
        self.types: dict[str, str] = {}
        """The first type by name."""
        for name, kind in map(_name_and_type, endpoints):
            self.types.setdefault(name, kind)
        self._by_word: dict[str, list[str]] = {}
        for name in self.types:
            if (word := _last(name)) not in _OF_EVERY_NODE and not topic_or_service_is_hidden(name):
                self._by_word.setdefault(word, []).append(name)
        self._plain = {_plain(word): word for word in sorted(self._by_word)}
        self._similar: dict[str, str | None] = {}

    def meant(self, name: str, kind: str) -> list[str]:
        """Return the names that another one could mean: those with the same last word, or a similar one and its type.

        Several names are narrowed down: to those that share the most words at the end, then to those with its type,
        then to the shortest.
        """
        near = self._by_word.get(_last(name), [])
        if not near and (word := self._similar_word(_last(name))) is not None:
            near = [candidate for candidate in self._by_word[word] if self.types[candidate] == kind]
        ranks = {
            candidate: (_common_end(name, candidate), self.types[candidate] == kind, -candidate.count("/"))
            for candidate in near
        }
        best = max(ranks.values(), default=None)
        return [candidate for candidate in near if ranks[candidate] == best]

    def _similar_word(self, word: str) -> str | None:
        if word not in self._similar:
            found = difflib.get_close_matches(_plain(word), self._plain, n=1, cutoff=SIMILAR)
            self._similar[word] = self._plain[found[0]] if found else None
        return self._similar[word]


class Connections:
    """Finds endpoints that are not connected to the topics and services of a node, and warns once about each."""

    def __init__(
        self,
        node: Node,
        switched_off: Mapping[str, str] | None = None,
        *,
        beside: Sequence[Node] = (),
        missing: Callable[[str], str] = lambda _name: "",
        actions: Callable[[], Mapping[str, str]] = dict,
    ) -> None:
        """Watch the endpoints of a node.

        Args:
            node: The node.
            switched_off: Parameters by the topics that they would switch on, relative to a robot or the node.
            beside: Other nodes whose endpoints count as those of the node.
            missing: Says why a topic, service or action does not exist on purpose, by its full name; empty for any
                other one.
            actions: Returns the types of the actions that the nodes serve, by their full names.
        """
        self._node, self._own_nodes = node, (node, *beside)
        self._switched_off, self._missing, self._actions = switched_off or {}, missing, actions
        self._own: dict[Side, _OwnNames] = {}
        self._misfits: dict[_Endpoint, Unconnected | None] = {}
        """Endpoints with name and type of ours, with the fault of their QoS."""
        self._suspects: frozenset[_Endpoint] = frozenset()
        self._nodes: frozenset[tuple[str, str]] = frozenset()
        self._next_s = self._next_look_s = 0.0
        self.unconnected: tuple[Unconnected, ...] = ()
        """Result of the last poll."""

    def poll(self) -> None:
        """Query the graph if it is time, and warn about new endpoints that are not connected."""
        now_s = time.monotonic()
        if now_s >= self._next_look_s:
            self._next_look_s = now_s + POLL_PERIOD_S
            nodes = frozenset(self._node.get_node_names_and_namespaces())
            if nodes != self._nodes:
                self._nodes, self._next_s = nodes, now_s
        if now_s < self._next_s:
            return
        suspects = self._suspects
        began_s = time.thread_time()
        before, self.unconnected = self.unconnected, self.find()
        for endpoint in self.unconnected:
            if endpoint not in before:
                self._node.get_logger().warning(str(endpoint))
        cost_s = time.thread_time() - began_s
        is_open = not self._suspects <= suspects
        self._next_s = time.monotonic() + (POLL_PERIOD_S if is_open else max(POLL_PERIOD_S, cost_s / SHARE))

    def status(self) -> DiagnosticStatus:
        """Return the entry for `/diagnostics`: WARN while an endpoint is not connected."""
        count = len(self.unconnected)
        return DiagnosticStatus(
            level=DiagnosticStatus.WARN if count else DiagnosticStatus.OK,
            name=f"{self._node.get_name()}: connections",
            hardware_id="thymio_sim_ros",
            message=str(self.unconnected[0]) if count else "all nodes use the names and types of this node",
            values=[KeyValue(key=endpoint.topic, value=str(endpoint)) for endpoint in self.unconnected],
        )

    def find(self, *, is_settled: bool = False) -> tuple[Unconnected, ...]:
        """Return all endpoints that are not connected.

        One with a name that is not ours is included when it is found a second time, since its peer may be about to
        start; with `is_settled` the first time.
        """
        found: list[Unconnected | None] = []
        suspects: set[_Endpoint] = set()
        misfits, self._misfits = self._misfits, {}
        for endpoint in self._others():
            names = self._own_names(endpoint.query)
            types = names.types
            if endpoint.topic not in types:
                if not self._may_be_wrong(endpoint) or self._count_peers(endpoint):
                    continue
                suspects.add(endpoint)
                if is_settled or endpoint in self._suspects:
                    found.append(self._wrong_name(endpoint))
            elif (endpoint.topic, endpoint.type) not in names.pairs:
                found.append(wrong_type(endpoint.query.side, endpoint.topic, endpoint.full_node, endpoint.type, types))
            else:
                self._misfits[endpoint] = misfits[endpoint] if endpoint in misfits else self._wrong_qos(endpoint)
                found.append(self._misfits[endpoint])
        self._suspects = frozenset(suspects)
        return tuple(dict.fromkeys(endpoint for endpoint in found if endpoint is not None))

    def _others(self) -> Iterator[_Endpoint]:
        own = {(node.get_name(), node.get_namespace()) for node in self._own_nodes}
        for name, namespace in dict.fromkeys(self._node.get_node_names_and_namespaces()):
            if (name, namespace) in own or (namespace == self._node.get_namespace() and name in _OURS):
                continue
            for query in _QUERIES:
                try:
                    listed = getattr(self._node, query.by_node)(name, namespace)
                except NodeNameNonExistentError:  # the node has just ended
                    break
                for topic, kind in ((topic, kind) for topic, types in listed for kind in types):
                    if _OF_ACTION not in topic:
                        yield _Endpoint(query, topic, kind, name, namespace)
                    elif query.side is CLIENT and topic.endswith(_GOAL_SERVICE):
                        action = topic.removesuffix(_GOAL_SERVICE)
                        yield _Endpoint(_GOALS, action, kind.removesuffix(_GOAL_TYPE), name, namespace)

    def _count_peers(self, endpoint: _Endpoint) -> int:
        name = endpoint.topic + (_GOAL_SERVICE if endpoint.query is _GOALS else "")
        count: int = getattr(self._node, endpoint.query.count_peers)(name)
        return count

    def _own_names(self, query: _Query) -> _OwnNames:
        """Return the names of our node that connect to a side."""
        endpoints: list[_OwnEndpoint]
        if query is _GOALS:
            endpoints = list(self._actions().items())
        else:
            endpoints = [endpoint for node in self._own_nodes for endpoint in getattr(node, query.own_peers)]
        known = self._own.get(query.side)
        if known is None or known.endpoints != endpoints:
            self._own[query.side] = known = _OwnNames(endpoints)
        return known

    def _may_be_wrong(self, endpoint: _Endpoint) -> bool:
        """Whether a name that is not ours could mean one of ours."""
        return bool(
            self._parameter_of(endpoint)
            or self._missing(endpoint.topic)
            or self._own_names(endpoint.query).meant(endpoint.topic, endpoint.type)
        )

    def _parameter_of(self, endpoint: _Endpoint) -> str:
        """Return the parameter that would switch on the publisher of a topic; empty if there is none."""
        if endpoint.query.side is not SUBSCRIBER:
            return ""
        return next((of for topic, of in self._switched_off.items() if endpoint.topic.endswith(f"/{topic}")), "")

    def _wrong_name(self, endpoint: _Endpoint) -> Unconnected:
        side, names = endpoint.query.side, self._own_names(endpoint.query)
        meant = names.meant(endpoint.topic, endpoint.type)
        if reason := self._missing(endpoint.topic):
            return Unconnected(endpoint.topic, endpoint.full_node, side, endpoint.type, f"no {side.name}", reason)
        if parameter := self._parameter_of(endpoint):
            cure = f"It is switched off: start the simulator with {_argument(f'{parameter}:=true')}"
            return Unconnected(endpoint.topic, endpoint.full_node, side, endpoint.type, f"a {side.peer}", cure)
        meant_names = " or ".join(
            name if names.types[name] == endpoint.type else f"{name} of {names.types[name]}"
            for name in meant[:MAX_NAMES]
        )
        cures = [f"{side.use} {meant[0]}"]
        space = endpoint.namespace.rstrip("/")
        if space and endpoint.topic.removeprefix(space) in meant:
            cures.append(f"start the node without the namespace {space}")
        if (robot := self._robot_of(endpoint.topic, meant)) and self._node.has_parameter(NAMES_PARAMETER):
            argument = _argument(f"{NAMES_PARAMETER}:=[{robot}]")
            cures.append(f"start the simulator with {argument}")
        expected = f"{meant_names}, since {endpoint.topic} has no {side.peer}"
        return Unconnected(endpoint.topic, endpoint.full_node, side, endpoint.type, expected, _alternatives(cures))

    def _robot_of(self, topic: str, meant: Collection[str]) -> str:
        """Return the name that a robot without a name would need for this topic; empty if that is not the reason."""
        space = self._node.get_namespace().rstrip("/")
        robot, _, rest = topic.removeprefix(f"{space}/").partition("/")
        return robot if topic.startswith(f"{space}/") and f"{space}/{rest}" in meant else ""

    def _wrong_qos(self, endpoint: _Endpoint) -> Unconnected | None:
        """Return the fault of the QoS of an endpoint; services have the same QoS everywhere."""
        if endpoint.query.side in (CLIENT, ACTION_CLIENT):
            return None
        published = self._node.get_publishers_info_by_topic(endpoint.topic)
        subscribed = self._node.get_subscriptions_info_by_topic(endpoint.topic)
        is_publisher = endpoint.query.side is PUBLISHER
        theirs, ours = (published, subscribed) if is_publisher else (subscribed, published)
        own = {node.get_fully_qualified_name() for node in self._own_nodes}
        for info in theirs:
            for peer in ours:
                if _node_of(info) != endpoint.full_node or _node_of(peer) not in own:
                    continue
                found, expected = info.qos_profile, peer.qos_profile
                if wrong := wrong_qos(
                    endpoint.query.side, endpoint.topic, endpoint.full_node, endpoint.type, found, expected
                ):
                    return wrong
        return None


def wrong_type(side: Side, topic: str, node: str, found: str, types: Mapping[str, str]) -> Unconnected:
    """Describe an endpoint of type `found` on a topic of another one; `types`: those of all names of ours."""
    return Unconnected(topic, node, side, found, types[topic], cure(side, topic, found, types))


def wrong_qos(
    side: Side, topic: str, node: str, kind: str, found: QoSProfile, expected: QoSProfile
) -> Unconnected | None:
    """Describe an endpoint with the profile `found` that does not fit that of its peer, `expected`; None if it fits."""
    if fit(*((found, expected) if side is PUBLISHER else (expected, found))):
        return None
    policy, what, need = _misfit(found, expected)
    return Unconnected(
        topic, node, side, f"{kind} with {policy} {what}", f"{policy} {need}", f"Create it with the {policy} {need}"
    )


def cure(side: Side, topic: str, found: str, types: Mapping[str, str]) -> str:
    """Return advice for an endpoint of type `found` on a topic of another one; `types`: those of all names of ours."""
    space, _, word = topic.rpartition("/")
    family = VELOCITY if word.startswith(VELOCITY) else word
    others = [name for name, kind in types.items() if kind == found and name.startswith(f"{space}/{family}")]
    if not others:
        return f"Use the type {types[topic]}"
    is_stamped = found.endswith("TwistStamped") and word == VELOCITY
    option = f", or start the simulator with {_argument(f'{STAMPED_PARAMETER}:=true')}" if is_stamped else ""
    return f"{side.use} {others[0]}{option}"


def _misfit(found: QoSProfile, expected: QoSProfile) -> tuple[str, str, str]:
    """Return the policy that does not fit, its value and the value that fits."""
    for policy, kind in (("reliability", ReliabilityPolicy), ("durability", DurabilityPolicy)):
        what, need = (kind(getattr(profile, policy)).name.lower() for profile in (found, expected))
        if what != need:
            return policy, what, need
    return "deadline and liveliness", "of its own", "of the default profile"


def _argument(rule: str) -> str:
    """Return the command line argument that sets a parameter, for `thymio-sim` as for `ros2 run`."""
    return f"--ros-args -p '{rule}'" if "[" in rule else f"--ros-args -p {rule}"


def _name_and_type(endpoint: _OwnEndpoint) -> tuple[str, str]:
    if isinstance(endpoint, tuple):
        return endpoint
    if isinstance(endpoint, Client | Service):
        return endpoint.service_name, type_name(endpoint.srv_type)
    return endpoint.topic_name, type_name(endpoint.msg_type)


def _node_of(info: TopicEndpointInfo) -> str:
    return _full(info.node_namespace, info.node_name)


def _full(namespace: str, name: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"


def _last(name: str) -> str:
    return name.rpartition("/")[2]


def _plain(word: str) -> str:
    return word.lower().replace("_", "")


def _common_end(name: str, other: str) -> int:
    """Return the number of words at their ends that two names share."""
    pairs = zip(reversed(name.split("/")), reversed(other.split("/")), strict=False)
    return next((count for count, (left, right) in enumerate(pairs) if left != right), len(name))


def _alternatives(parts: Iterable[str]) -> str:
    *first, last = parts
    return f"{', '.join(first)}, or {last}" if first else last
