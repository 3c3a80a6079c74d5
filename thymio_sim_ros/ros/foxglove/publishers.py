"""Publishers for messages of clients, which are checked before they are published."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from geometry_msgs.msg import Twist, TwistStamped
from rclpy._rclpy_pybind11 import RCLError, RMWError
from rclpy.exceptions import InvalidTopicNameException
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from rclpy.validate_full_topic_name import validate_full_topic_name

from thymio_sim_ros.bridge.fair_queue import FairQueue
from thymio_sim_ros.bridge.protocol.constants import JSON, StatusLevel
from thymio_sim_ros.bridge.protocol.messages import ClientChannel, Status
from thymio_sim_ros.bridge.switchboard.events import Command, SendToClient
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.foxglove import json_messages
from thymio_sim_ros.ros.foxglove.cdr_complexity import TooManyPartsError, check_parts
from thymio_sim_ros.ros.foxglove.held_publisher import HeldPublisher
from thymio_sim_ros.ros.foxglove.qos import publisher_qos
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, full_name, load_type

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["ClientPublishers", "velocity_fault"]

_SLICE_S = 0.005
"""Longest time for which one `poll` creates publishers; each takes some milliseconds in DDS."""


class _RefusalError(ThymioSimError):
    """A client's channel or message is rejected; the text is sent to the client."""


@dataclass(slots=True)
class _SharedPublisher:
    """One ROS publisher, shared by all clients' channels of its topic and type."""

    topic: str
    type_name: str
    held: HeldPublisher
    users: int = 0


class ClientPublishers:
    """Publishers for clients' channels. Belongs to the executor's thread."""

    def __init__(
        self,
        node: Node,
        post: Callable[[Command], None],
        *,
        is_allowed: Callable[[str], bool] = lambda topic: True,
        wake: Callable[[], None] = lambda: None,
        now_s: Callable[[], float] = time.monotonic,
    ) -> None:
        """`wake` requests calls of `poll` until it returns False."""
        self._node = node
        self._post = post
        self._is_allowed = is_allowed
        self._wake = wake
        self._now_s = now_s
        self._by_topic: dict[tuple[str, str], _SharedPublisher] = {}
        self._channels: dict[tuple[int, int], tuple[_SharedPublisher, str]] = {}
        self._opening: dict[tuple[int, int], ClientChannel] = {}
        self._order: FairQueue[int, tuple[int, int]] = FairQueue()
        """The channels of `_opening` by client, in the order in which their publishers are created."""

    def open(self, client: int, channel: ClientChannel) -> None:
        """Open a channel of a client.

        The publisher is created with the first message, or by `poll`, which serves the clients in turn; a channel that
        is closed before causes no work in DDS. A rejected channel is reported to the client at that time.
        """
        self._opening[client, channel.id] = channel
        self._order.put(client, (client, channel.id))
        self._wake()

    def _create(self, client: int, channel: ClientChannel) -> None:
        try:
            shared = self._publisher_for(channel)
        except _RefusalError as error:
            self._refuse(client, str(error))
            return
        shared.users += 1
        self._channels[client, channel.id] = (shared, channel.encoding)

    def close(self, client: int, channel_id: int) -> None:
        """Close a channel of a client; the last channel of a topic and type ends the publisher."""
        if self._opening.pop((client, channel_id), None) is not None:
            self._order.remove(client, (client, channel_id))
            return
        shared, _ = self._channels.pop((client, channel_id), (None, ""))
        if shared is None:
            return
        shared.users -= 1
        if shared.users == 0:
            del self._by_topic[shared.topic, shared.type_name]
            shared.held.destroy()

    def publish(self, client: int, channel_id: int, payload: bytes) -> None:
        """Publish a message of a client, or report to the client why it is rejected."""
        channel = self._opening.pop((client, channel_id), None)
        if channel is not None:
            self._order.remove(client, (client, channel_id))
            self._create(client, channel)
        shared, encoding = self._channels.get((client, channel_id), (None, ""))
        if shared is None:  # rejected when it was opened, and reported
            return
        try:
            message = _decode(payload, encoding, shared)
        except _RefusalError as error:
            self._refuse(client, f"{shared.topic}: {error}")
            return
        if not shared.held.publish(message):
            self._wake()

    def poll(self) -> bool:
        """Create publishers and send held messages to new subscribers; return whether work is left."""
        end_s = time.monotonic() + _SLICE_S
        while self._order and time.monotonic() < end_s:
            client, channel_id = self._order.pop()
            self._create(client, self._opening.pop((client, channel_id)))
        flushed = [shared.held.flush() for shared in self._by_topic.values()]
        return bool(self._order) or not all(flushed)

    def close_all(self) -> None:
        """End all publishers."""
        for shared in self._by_topic.values():
            shared.held.destroy()
        self._by_topic.clear()
        self._channels.clear()
        self._opening.clear()
        self._order = FairQueue()

    def _publisher_for(self, channel: ClientChannel) -> _SharedPublisher:
        topic = channel.topic if channel.topic.startswith("/") else f"/{channel.topic}"
        type_name = full_name(channel.schema_name)
        shared = self._by_topic.get((topic, type_name))
        if shared is not None:
            return shared
        if not self._is_allowed(topic):
            raise _RefusalError(f"{topic}: clients may not publish here (client_topic_whitelist)")
        try:
            validate_full_topic_name(topic)
            message_type = load_type(type_name)
            profile = publisher_qos(
                self._node.get_publishers_info_by_topic(topic), self._node.get_subscriptions_info_by_topic(topic)
            )
            held = HeldPublisher(self._node, message_type, topic, profile, self._now_s)
        except InvalidTopicNameException as error:
            raise _RefusalError(f"{topic}: not a valid topic name") from error
        except MissingTypeError as error:
            raise _RefusalError(f"{topic}: {error}") from error
        except RCLError as error:
            raise _RefusalError(f"{topic}: cannot publish {type_name}, the topic has another type") from error
        except (ValueError, TypeError, RuntimeError) as error:  # invalid Unicode, or not a message type
            raise _RefusalError(f"{topic!r}: cannot publish {type_name}: {error}") from error
        shared = self._by_topic[topic, type_name] = _SharedPublisher(topic, type_name, held)
        return shared

    def _refuse(self, client: int, text: str) -> None:
        self._post(SendToClient(client, Status(StatusLevel.ERROR, text)))


def _decode(payload: bytes, encoding: str, shared: _SharedPublisher) -> Message | bytes:
    """Decode and check a message; return its bytes if there is no class for it. Raises _RefusalError."""
    try:
        if shared.type_name == tf2_messages.TF_TYPE_NAME and encoding != JSON:
            check_parts(payload, shared.held.message_type)
            tf2_messages.decode(payload)
            return payload
        if encoding == JSON:
            message = json_messages.from_json(payload, shared.held.message_type)
        else:
            check_parts(payload, shared.held.message_type)
            message = deserialize_message(payload, shared.held.message_type)
    except (
        RMWError,
        json_messages.JsonMessageError,
        tf2_messages.TransformDataError,
        TooManyPartsError,
    ) as error:
        first_line = str(error).partition("\n")[0]
        raise _RefusalError(f"expected a {shared.type_name} in {encoding}: {first_line}") from error
    except TypeError as error:  # the type has no Python class
        raise _RefusalError(f"{shared.type_name} is accepted in encoding cdr only") from error
    if fault := velocity_fault(message):
        raise _RefusalError(fault)
    return message


def velocity_fault(message: Message) -> str:
    """Why a message of a client must not be published: velocities that are not finite; otherwise an empty string."""
    twist = message.twist if isinstance(message, TwistStamped) else message
    is_wrong = isinstance(twist, Twist) and not _is_finite(twist)
    return "expected finite velocities, found NaN or infinity" if is_wrong else ""


def _is_finite(twist: Twist) -> bool:
    return all(math.isfinite(getattr(part, axis)) for part in (twist.linear, twist.angular) for axis in "xyz")
