"""One client of rosbridge: its operations become endpoints on the ROS graph."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import Any

from thymio_sim_ros.access import Role
from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.rosbridge import frames
from thymio_sim_ros.bridge.rosbridge.fragments import Fragments
from thymio_sim_ros.bridge.rosbridge.frames import Operation
from thymio_sim_ros.bridge.rosbridge.operations import OPERATIONS, check
from thymio_sim_ros.bridge.switchboard.switchboard import READ_ONLY
from thymio_sim_ros.portable_ros import import_hook
from thymio_sim_ros.portable_ros.messages.definition_text import DefinitionError
from thymio_sim_ros.ros.foxglove.rosbridge import rosapi
from thymio_sim_ros.ros.foxglove.rosbridge.client_node import ClientNode
from thymio_sim_ros.ros.foxglove.rosbridge.client_services import ClientServices
from thymio_sim_ros.ros.foxglove.rosbridge.client_topics import ClientTopics
from thymio_sim_ros.ros.foxglove.rosbridge.graph_feed import GraphFeed
from thymio_sim_ros.ros.foxglove.rosbridge.host import Host, RefusedError
from thymio_sim_ros.ros.foxglove.rosbridge.outbox import Outbox
from thymio_sim_ros.ros.foxglove.rosbridge.values import ValueRefusedError

__all__ = ["MAX_ENDPOINTS", "MAX_NODES", "Session"]

MAX_ENDPOINTS = 512
"""Publishers, subscriptions, services and actions of one client."""

MAX_NODES = 32
"""Nodes of one client."""

_CREATES = frozenset({"advertise", "publish", "subscribe", "advertise_service", "advertise_action"})
"""Operations that create an endpoint."""

_ANSWERED = {"call_service": ("service_response", "service"), "send_action_goal": ("action_result", "action")}
"""Operations that expect an answer, also if they are rejected: its name, and the field that it repeats."""


class Session:
    """The nodes and endpoints of one client. Belongs to the executor's thread."""

    def __init__(self, host: Host, feed: GraphFeed, client: int, role: Role) -> None:
        self._host, self._feed, self._role = host, feed, role
        self._outbox = Outbox(host, client)
        self._fragments = Fragments(host.max_size)
        self._places = {"": ClientNode(host)}
        """The nodes of the client by the ID that it chose; the empty one is for operations without a node."""
        self._topics = ClientTopics(host, self._outbox)
        self._services = ClientServices(host, self._outbox, client)
        self._graph_id: object = None
        self.follows_graph = False
        """Whether the client gets the graph."""
        topics, services = self._topics, self._services
        self._handlers: dict[str, Callable[[Operation], object]] = {
            "advertise": lambda operation: topics.advertise(operation, self._place(operation)),
            "unadvertise": topics.unadvertise,
            "publish": lambda operation: topics.publish(operation, self._place(operation)),
            "subscribe": lambda operation: topics.subscribe(operation, self._place(operation)),
            "unsubscribe": topics.unsubscribe,
            "call_service": lambda operation: services.call(operation, self._place(operation)),
            "advertise_service": lambda operation: services.advertise(operation, self._place(operation)),
            "unadvertise_service": services.unadvertise,
            "service_response": services.respond,
            "send_action_goal": lambda operation: services.goals.send(operation, self._place(operation)),
            "cancel_action_goal": services.goals.cancel,
            "advertise_action": lambda operation: services.advertise_action(operation, self._place(operation)),
            "unadvertise_action": services.unadvertise_action,
            "action_feedback": lambda operation: services.action_of(operation).feedback(operation),
            "action_result": lambda operation: services.action_of(operation).end(operation),
            "fragment": self._add_fragment,
            "set_level": self._set_level,
            "status": lambda operation: None,
            "node": self._add_node,
            "remove_node": self._remove_node,
            "graph": self._follow_graph,
            "interfaces": _learn,
        }
        assert self._handlers.keys() == OPERATIONS.keys()

    def receive(self, frame: str | bytes) -> None:
        """Handle a message of the client; a status says why one is rejected."""
        operation: Operation = {}
        try:
            operation = frames.decode(frame)
            checked = check(operation)
            self._check_allowed(checked)
            self._handlers[checked["op"]](checked)
        except (FrameError, RefusedError, ValueRefusedError) as error:
            self._refuse(operation, str(error))
        except Exception:
            self._host.node.get_logger().error(
                f"internal error (please report): {operation.get('op')!r:.40} failed:\n{traceback.format_exc()}"
            )
            self._refuse(operation, "internal error (please report), see the log")

    def _refuse(self, operation: Operation, reason: str) -> None:
        given = operation.get("id")
        self._outbox.status("error", reason, given if isinstance(given, str | int) else None)
        answer, name = _ANSWERED.get(str(operation.get("op")), ("", ""))
        if answer and isinstance(operation.get(name), str):
            status = {"status": 0} if answer == "action_result" else {}
            plain = {key: operation[key] for key in (name, "id") if key in operation}
            self._outbox.answer(answer, name, plain, values=reason, result=False, **status)

    def _check_allowed(self, operation: Operation) -> None:
        """Raise RefusedError for an operation that the server does not offer, or not to this client, or any more."""
        name = operation["op"]
        kind = OPERATIONS[name]
        if kind.capability is not None and kind.capability not in self._host.offered:
            raise RefusedError(f"{name}: this server does not offer {kind.capability}")
        if self._role is Role.READ_ONLY and (kind.is_change or self._is_changing_call(operation)):
            raise RefusedError(f"{name}: {READ_ONLY}")
        if name in _CREATES and len(self._topics) + len(self._services) >= MAX_ENDPOINTS:
            raise RefusedError(f"{name}: this client has {MAX_ENDPOINTS} endpoints, the maximum")

    def _is_changing_call(self, operation: Operation) -> bool:
        if operation["op"] != "call_service":
            return False
        name = self._place(operation).resolve(operation["service"], "call_service.service")
        if rosapi.serves(name):
            return name in rosapi.CHANGES
        return not self._host.is_read_only_service(name)

    def _place(self, operation: Operation) -> ClientNode:
        place = self._places.get(str(operation.get("node", "")))
        if place is None:
            raise RefusedError(f"{operation['op']}.node: expected the id of a node, found {operation['node']}")
        return place

    # --- operations that concern the connection ---

    def _add_fragment(self, operation: Operation) -> None:
        text = self._fragments.add(operation)
        if text is not None:
            self.receive(text)

    def _set_level(self, operation: Operation) -> None:
        self._outbox.level = operation["level"]

    def _add_node(self, operation: Operation) -> None:
        node_id, name, namespace = str(operation["id"]), operation["name"], operation.get("namespace", "/") or "/"
        if node_id in self._places:
            raise RefusedError(f"node.id: expected a new one, found {node_id!r}")
        if len(self._places) > MAX_NODES:
            raise RefusedError(f"node: this client has {MAX_NODES} nodes, the maximum")
        if not name:
            raise RefusedError("node.name: expected a name, found an empty text")
        namespace = namespace if namespace.startswith("/") else f"/{namespace}"
        self._places[node_id] = ClientNode(self._host, name, namespace)
        self._outbox.send({"op": "node", "id": operation["id"], "name": name, "namespace": namespace})

    def _remove_node(self, operation: Operation) -> None:
        node_id = str(operation["id"])
        if not node_id or node_id not in self._places:
            raise RefusedError(f"remove_node.id: expected the id of a node, found {node_id!r}")
        self._topics.close(node_id)
        self._services.close(node_id)
        self._places.pop(node_id).destroy()

    def _follow_graph(self, operation: Operation) -> None:
        self.follows_graph, self._graph_id = True, operation.get("id")
        self._feed.update()
        self.send_graph()

    # --- called by the owner of all sessions ---

    def send_graph(self) -> None:
        """Send the graph without the nodes of the client."""
        own = {(place.name, place.namespace) for place in self._places.values() if place.own is not None}
        nodes: list[dict[str, Any]] = [
            node for node in self._feed.nodes if (node["name"], node["namespace"]) not in own
        ]
        given = {} if self._graph_id is None else {"id": self._graph_id}
        self._outbox.send({"op": "graph", "nodes": nodes, **given})

    def poll(self) -> bool:
        """Do what is due; return whether more waits."""
        return any([self._topics.poll(), self._services.goals.poll()])

    def refresh(self) -> None:
        """Adapt to changes of the graph."""
        self._topics.refresh()

    def close(self) -> None:
        """End all endpoints and nodes."""
        self._topics.close()
        self._services.close()
        for place in self._places.values():
            place.destroy()


def _learn(operation: Operation) -> None:
    """Learn the types of a client; those of an installed ROS need a build. Raises RefusedError."""
    if not import_hook.is_served("rclpy"):
        return
    from thymio_sim_ros.portable_ros.messages.taught_packages import teach

    package, texts = operation["package"], operation["texts"]
    if not all(isinstance(text, str) for text in texts.values()):
        raise RefusedError("interfaces.texts: expected texts by names such as msg/Num")
    try:
        teach(package, texts)
    except DefinitionError as error:
        raise RefusedError(f"interfaces: {error}") from error
