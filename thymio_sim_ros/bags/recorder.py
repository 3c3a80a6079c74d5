"""Records topics in a bag: each one that appears is subscribed to, and its messages are written as they are."""

from __future__ import annotations

from collections.abc import Callable, Collection
from pathlib import Path
from types import TracebackType
from typing import Any

from rclpy.node import Node
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden
from rosbags.interfaces import Connection
from rosbags.rosbag2 import StoragePlugin, Writer, WriterError

from thymio_sim_ros.bags import qos
from thymio_sim_ros.bags.errors import BagError
from thymio_sim_ros.ros.foxglove.schemas import message_definition
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, load_type

__all__ = ["Recorder"]

DISCOVERY_S = 0.1


class Recorder:
    """A node that records, until it is closed; a context manager.

    Messages have the time of the clock of the node at which they arrive. The bag can be read once it is closed.
    """

    def __init__(
        self,
        node: Node,
        path: Path,
        *,
        storage: str = "mcap",
        topics: Collection[str] = (),
        includes_hidden: bool = False,
    ) -> None:
        """Open a bag, a new folder; without `topics`, all that are not hidden are recorded. Raises BagError."""
        self.count = 0
        """The messages that have been recorded."""
        self._node, self._path, self._includes_hidden = node, path, includes_hidden
        self._topics = {node.resolve_topic_name(topic) for topic in topics}
        self._known: set[tuple[str, str]] = set()
        self._subscriptions: list[Any] = []
        try:
            self._writer = Writer(path, version=Writer.VERSION_LATEST, storage_plugin=StoragePlugin[storage.upper()])
            self._writer.open()
        except (OSError, WriterError) as error:
            raise BagError(f"{path}: cannot be written: {error}") from error
        self._timer = node.create_timer(DISCOVERY_S, self._discover)
        self._discover()

    @property
    def topics(self) -> list[str]:
        """The topics that are recorded, in the order of their discovery."""
        return [one.topic for one in self._writer.connections]

    def close(self) -> None:
        """Stop and complete the bag. Raises BagError."""
        self._node.destroy_timer(self._timer)
        for one in self._subscriptions:
            self._node.destroy_subscription(one)
        if self._writer.storage is None:
            return
        try:
            self._writer.close()
        except OSError as error:
            raise BagError(f"{self._path}: cannot be completed: {error}") from error

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _discover(self) -> None:
        """Subscribe to the topics that are new."""
        for topic, types in self._node.get_topic_names_and_types():
            for name in types:
                if (topic, name) not in self._known and self._is_wanted(topic):
                    self._known.add((topic, name))
                    self._add(topic, name)

    def _is_wanted(self, topic: str) -> bool:
        if self._topics:
            return topic in self._topics
        return self._includes_hidden or not topic_or_service_is_hidden(topic)

    def _add(self, topic: str, name: str) -> None:
        publishers = [one for one in self._node.get_publishers_info_by_topic(topic) if one.topic_type == name]
        try:
            kind, definition = load_type(name), message_definition(name)
        except MissingTypeError as error:
            self._node.get_logger().warning(f"{topic}: not recorded: {error}")
            return
        offered = [one.qos_profile for one in publishers]
        connection = self._writer.add_connection(
            topic,
            name,
            msgdef=definition,
            rihs01=next((str(one.topic_type_hash) for one in publishers), "INVALID"),
            offered_qos_profiles=list(map(qos.of_bag, offered)),
        )
        self._subscriptions.append(
            self._node.create_subscription(kind, topic, self._writes(connection), qos.of_recording(offered), raw=True)
        )

    def _writes(self, connection: Connection) -> Callable[[bytes], None]:
        def write(data: bytes) -> None:
            try:
                self._writer.write(connection, self._node.get_clock().now().nanoseconds, data)
            except OSError as error:
                raise BagError(f"{self._path}: cannot be written: {error}") from error
            self.count += 1

        return write
