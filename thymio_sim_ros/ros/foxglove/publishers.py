"""What clients publish: checked, then handed to ROS."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from rclpy._rclpy_pybind11 import RCLError, RMWError
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.exceptions import InvalidTopicNameException
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.serialization import deserialize_message
from rclpy.validate_full_topic_name import validate_full_topic_name

from thymio_sim_ros.bridge.protocol.constants import JSON, StatusLevel
from thymio_sim_ros.bridge.protocol.messages import ClientChannel, Status
from thymio_sim_ros.bridge.switchboard.events import Command, SendToClient
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.foxglove import json_messages
from thymio_sim_ros.ros.foxglove.cdr_complexity import TooManyPartsError, check_parts
from thymio_sim_ros.ros.foxglove.qos import publisher_qos
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, full_name, load_type
from thymio_sim_ros.ros.rclpy_ext.fair_queue import FairQueue

__all__ = ["ClientPublishers"]

_HELD = 10
_DISCOVERY_S = 1.0
"""A new publisher holds its last `_HELD` messages until it has met all subscribers, at most this long.

They leave as far apart as they came: a button that is pressed and let go meanwhile was held all the same.
"""

_SLICE_S = 0.005
"""Longest time for which publishers are created in one `poll`; each takes DDS some milliseconds."""

_NO_EVENTS = PublisherEventCallbacks(use_default_callbacks=False)
"""Each event handler would be one more thing that the executor waits for, in every turn."""

_MOTION_TYPES = frozenset(f"geometry_msgs/msg/{name}" for name in ("Twist", "TwistStamped"))


class _RefusalError(ThymioSimError):
    """Why a client's channel or message is not accepted; the text is for its user."""


@dataclass(slots=True)
class _SharedPublisher:
    """One ROS publisher, shared by all clients' channels of its topic and type."""

    topic: str
    type_name: str
    message_type: Any
    publisher: Publisher
    discovery_end_s: float
    users: int = 0
    held: deque[tuple[float, Any]] = field(default_factory=lambda: deque(maxlen=_HELD))
    """When it came, s, and what."""
    is_waiting: bool = False
    late_s: float = 0.0
    met_s: float = 0.0
    """What had come when all were met leaves so much later than it came; the rest at once, in order."""


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
        """`wake` asks for `poll` soon and again until it has nothing to do."""
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
        """Prepare for a client's messages.

        The publisher is created with the first message, or by `poll`, for all clients in turn; a channel that is closed
        before that costs DDS nothing. A channel that is refused is reported to the client then.
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
        """The channel is over; the last one takes the publisher with it."""
        if self._opening.pop((client, channel_id), None) is not None:
            self._order.remove(client, (client, channel_id))
            return
        shared, _ = self._channels.pop((client, channel_id), (None, ""))
        if shared is None:
            return
        shared.users -= 1
        if shared.users == 0:
            del self._by_topic[shared.topic, shared.type_name]
            self._node.destroy_publisher(shared.publisher)

    def publish(self, client: int, channel_id: int, payload: bytes) -> None:
        """Publish a client's message, or tell the client why not."""
        channel = self._opening.pop((client, channel_id), None)
        if channel is not None:
            self._order.remove(client, (client, channel_id))
            self._create(client, channel)
        shared, encoding = self._channels.get((client, channel_id), (None, ""))
        if shared is None:  # refused when it was opened, and told so
            return
        try:
            message = _decode(payload, encoding, shared)
        except _RefusalError as error:
            self._refuse(client, f"{shared.topic}: {error}")
            return
        shared.held.append((self._now_s(), message))
        if not self._flush(shared):
            self._wake()

    def poll(self) -> bool:
        """Create publishers and send held messages to new subscribers; return whether work is left."""
        end_s = time.monotonic() + _SLICE_S
        while self._order and time.monotonic() < end_s:
            client, channel_id = self._order.pop()
            self._create(client, self._opening.pop((client, channel_id)))
        flushed = [self._flush(shared) for shared in self._by_topic.values()]
        return bool(self._order) or not all(flushed)

    def close_all(self) -> None:
        """End all publishers."""
        for shared in self._by_topic.values():
            self._node.destroy_publisher(shared.publisher)
        self._by_topic.clear()
        self._channels.clear()
        self._opening.clear()
        self._order = FairQueue()

    def _flush(self, shared: _SharedPublisher) -> bool:
        """Publish what is due, unless the publisher has still to meet subscribers; whether nothing is left."""
        now_s = self._now_s()
        if shared.held and now_s < shared.discovery_end_s and not self._has_met_all(shared):
            shared.is_waiting = True
            return False
        if shared.is_waiting:
            shared.is_waiting, shared.late_s, shared.met_s = False, now_s - shared.held[0][0], now_s
        while shared.held:
            came_s, message = shared.held[0]
            if came_s <= shared.met_s and came_s + shared.late_s > now_s:
                return False
            shared.held.popleft()
            try:
                shared.publisher.publish(message)
            except RCLError as error:  # beyond a bound of its type, which reading does not check
                self._node.get_logger().warning(f"{shared.topic}: a client's message was refused: {error}")
        return True

    def _has_met_all(self, shared: _SharedPublisher) -> bool:
        known = self._node.count_subscribers(shared.topic)
        return 0 < known <= shared.publisher.get_subscription_count()

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
            publisher = self._node.create_publisher(message_type, topic, profile, event_callbacks=_NO_EVENTS)
        except InvalidTopicNameException as error:
            raise _RefusalError(f"{topic}: not a topic name") from error
        except MissingTypeError as error:
            raise _RefusalError(f"{topic}: {error}") from error
        except RCLError as error:
            raise _RefusalError(f"{topic}: cannot publish {type_name} here, it carries another type") from error
        except (ValueError, TypeError, RuntimeError) as error:  # no text, no type of messages
            raise _RefusalError(f"{topic!r}: cannot publish {type_name}: {error}") from error
        shared = self._by_topic[topic, type_name] = _SharedPublisher(
            topic, type_name, message_type, publisher, self._now_s() + _DISCOVERY_S
        )
        return shared

    def _refuse(self, client: int, text: str) -> None:
        self._post(SendToClient(client, Status(StatusLevel.ERROR, text)))


def _decode(payload: bytes, encoding: str, shared: _SharedPublisher) -> Any:
    """The message, or its checked bytes where there is no class for it."""
    try:
        if shared.type_name == tf2_messages.TF_TYPE_NAME and encoding != JSON:
            check_parts(payload, shared.message_type)
            tf2_messages.decode(payload)
            return payload
        if encoding == JSON:
            message = json_messages.from_json(payload, shared.message_type)
        else:
            check_parts(payload, shared.message_type)
            message = deserialize_message(payload, shared.message_type)
    except (
        RMWError,
        json_messages.JsonMessageError,
        tf2_messages.TransformDataError,
        TooManyPartsError,
    ) as error:
        first_line = str(error).partition("\n")[0]
        raise _RefusalError(f"expected a {shared.type_name} in {encoding}: {first_line}") from error
    except TypeError as error:  # a type without a Python class
        raise _RefusalError(f"{shared.type_name} is accepted as cdr only") from error
    if shared.type_name in _MOTION_TYPES and not _is_finite(getattr(message, "twist", message)):
        raise _RefusalError("a velocity that is not a number or infinite is refused")
    return message


def _is_finite(twist: Any) -> bool:
    return all(math.isfinite(getattr(part, axis)) for part in (twist.linear, twist.angular) for axis in "xyz")
