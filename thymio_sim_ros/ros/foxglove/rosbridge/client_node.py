"""The node by which a client is on the graph: one of its own, or the nodes of the bridge."""

from __future__ import annotations

from rclpy.exceptions import InvalidNamespaceException, InvalidNodeNameException, InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.validate_full_topic_name import validate_full_topic_name

from thymio_sim_ros.ros.foxglove.rosbridge.host import Host, RefusedError
from thymio_sim_ros.ros.rclpy_ext.callback_groups import forget_destroyed

__all__ = ["ClientNode"]

_DEFAULT_NAME = "rosbridge"
"""For private names (`~/…`) of clients without a node."""


class ClientNode:
    """Where the endpoints of a client belong.

    A node of its own is in the participant of `Host.publisher`. If endpoints of one participant do not match each other
    (`rclpy_ext/peers.py`), messages come by `Host.subscriber` instead, which is in another one.
    """

    def __init__(self, host: Host, name: str = "", namespace: str = "/") -> None:
        """Without a name, the endpoints belong to the nodes of the bridge. Raises RefusedError."""
        self._host = host
        self.name, self.namespace = name or _DEFAULT_NAME, namespace
        self.own: Node | None = self._create(name, namespace) if name else None
        self.publisher = self.own or host.publisher
        is_matched = host.subscriber.context is host.publisher.context
        self.subscriber = self.own if self.own is not None and is_matched else host.subscriber

    def _create(self, name: str, namespace: str) -> Node:
        try:
            node = Node(
                name,
                context=self._host.publisher.context,
                namespace=namespace,
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=False,
                parameter_overrides=[Parameter("start_type_description_service", value=False)],
            )
        except (InvalidNodeNameException, InvalidNamespaceException) as error:
            raise RefusedError(f"node.name: {error}".partition("\n")[0]) from error
        forget_destroyed(node)
        executor = self._host.publisher.executor
        if executor is not None:
            executor.add_node(node)
        return node

    def resolve(self, name: str, where: str) -> str:
        """The full name of a topic or service. Raises RefusedError; `where` is the place of the name."""
        try:
            full = expand_topic_name(name, self.name, self.namespace)
            validate_full_topic_name(full)
        except (InvalidTopicNameException, ValueError) as error:
            reason = " ".join(str(error).split("\n")[:1])
            raise RefusedError(f"{where}: expected a name of ROS, found {name!r:.80}: {reason}") from error
        return str(full)

    def destroy(self) -> None:
        """End the node with all of its endpoints."""
        if self.own is not None:
            if self.own.executor is not None:
                self.own.executor.remove_node(self.own)
            self.own.destroy_node()
