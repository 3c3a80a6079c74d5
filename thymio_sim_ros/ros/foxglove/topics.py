"""Topics of the ROS graph as channels of the bridge; serialized messages are forwarded without decoding."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from rclpy._rclpy_pybind11 import RCLError
from rclpy.node import Node
from rclpy.subscription import Subscription

from thymio_sim_ros.bridge.protocol.constants import CDR
from thymio_sim_ros.bridge.protocol.messages import Channel
from thymio_sim_ros.bridge.switchboard.events import AddChannels, Command, RemoveChannels, RetainLast
from thymio_sim_ros.ros.foxglove.qos import SubscriptionQos, subscription_qos
from thymio_sim_ros.ros.foxglove.schemas import message_definition
from thymio_sim_ros.ros.foxglove.time_share import TimeShare
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, load_type

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["Topics"]

_FULL_CHECK_PERIOD = 10
"""The QoS of the publishers of a topic is queried when their number has changed, and otherwise in one of this many
refreshes: a query takes 0.3 ms, in total a tenth of a core for the hundred topics of a page with twenty robots."""


_DEMAND_SHARE = 0.25
"""Largest share of the thread's time for subscribing: 1500 topics take 1.5 s."""

_SLICE_S = 0.005
"""Longest time that one call of `poll` subscribes."""

KEEP_S = 30.0
"""Time for which a subscription is kept after its last client, because a page that is loaded again uses it, too. Each
new subscription leaks 97 bytes in Fast DDS 2.14; while one is kept, its publishers work."""


class _Topic:
    """A channel and, while it has subscribers and for `KEEP_S`, the subscription to its topic."""

    def __init__(self, channel: Channel, message_type: type[Message]) -> None:
        self.channel = channel
        self.message_type = message_type
        self.qos: SubscriptionQos | None = None
        self.publishers = 0
        """Number of publishers when the QoS was chosen."""
        self.subscription: Subscription | None = None
        self.is_wanted = False
        self.unwanted_s = 0.0
        """Time at which the last client left."""


class Topics:
    """One channel for each topic of the graph, and a ROS subscription while a client subscribes to it and for `KEEP_S`.

    Belongs to the executor's thread; `poll` must be called while it returns True. Subscribing and queries for
    publishers are done in slices of time, topic by topic, so that other work is not delayed.
    """

    def __init__(
        self,
        node: Node,
        post: Callable[[Command], None],
        publish: Callable[[int, int, bytes], None],
        now_ns: Callable[[], int],
        *,
        min_depth: int = 10,
        max_depth: int = 25,
        is_best_effort: Callable[[str], bool] = lambda topic: False,
        wake: Callable[[], None] = lambda: None,
    ) -> None:
        self._node = node
        self._post = post
        self._publish = publish
        self._now_ns = now_ns
        self._depths = {"min_depth": min_depth, "max_depth": max_depth}
        self._is_best_effort = is_best_effort
        self._ids = itertools.count(1)
        self._wake = wake
        self._share = TimeShare(_DEMAND_SHARE)
        self._demand: dict[int, None] = {}
        """Channels that may have to be subscribed, the oldest first."""
        self._refreshes = 0
        self._round = self._check_all()
        """The rest of the current refresh."""
        self._by_name: dict[str, _Topic] = {}
        self._by_id: dict[int, _Topic] = {}
        self._refused: set[tuple[str, str]] = set()
        self._types: dict[str, tuple[type[Message], str]] = {}
        """Class and definition of each type that was used so far."""

    def update(self, topics: Mapping[str, Sequence[str]]) -> None:
        """Add channels for new topics and remove those of vanished ones.

        `topics` maps topic names to types, of which the first one is used.
        """
        gone = [name for name, topic in self._by_name.items() if topic.channel.schema_name not in topics.get(name, ())]
        if gone:
            self._remove(gone)
        added = [
            topic.channel
            for name, types in topics.items()
            if name not in self._by_name and (topic := self._add(name, types[0])) is not None
        ]
        if added:
            self._post(AddChannels(tuple(added)))

    def subscribe(self, channel_id: int) -> None:
        """Request a subscription for the first client; `poll` makes it."""
        self._set_wanted(channel_id, is_wanted=True)

    def unsubscribe(self, channel_id: int) -> None:
        """Request the end of the subscription, after the last client; `refresh` ends it."""
        self._set_wanted(channel_id, is_wanted=False)

    def _set_wanted(self, channel_id: int, *, is_wanted: bool) -> None:
        topic = self._by_id.get(channel_id)
        if topic is None:
            return
        topic.is_wanted = is_wanted
        if not is_wanted:
            topic.unwanted_s = time.monotonic()
            self._end_if_unused(topic)
            return
        self._demand[channel_id] = None
        if self.poll():
            self._wake()

    def poll(self) -> bool:
        """Subscribe for a slice of time; return whether work is left."""
        if self._demand and self._share.is_due:
            with self._share.work():
                end_s = time.monotonic() + _SLICE_S
                while self._demand and time.monotonic() < end_s:
                    channel_id = next(iter(self._demand))
                    del self._demand[channel_id]
                    self._apply_demand(channel_id)
        return bool(self._demand)

    def _apply_demand(self, channel_id: int) -> None:
        topic = self._by_id.get(channel_id)
        if topic is None:
            return
        if topic.is_wanted and topic.subscription is None:
            self._subscribe(topic, self._subscription_qos(topic))

    def refresh(self, slice_s: float = float("inf")) -> bool:
        """Subscribe again to topics whose publishers now need another QoS, and end those without a client.

        Return whether all topics have been checked.

        A call continues where the previous one stopped after `slice_s`.
        """
        end_s = time.monotonic() + slice_s
        for _ in self._round:
            if time.monotonic() >= end_s:
                return False
        self._round = self._check_all()
        return True

    def _check_all(self) -> Iterator[None]:
        self._refreshes += 1
        for number, topic in list(self._by_id.items()):
            if topic.subscription is None and not topic.is_wanted:
                continue
            self._check(number, topic)
            yield

    def _check(self, number: int, topic: _Topic) -> None:
        if not topic.is_wanted:
            self._end_if_unused(topic)
            return
        if topic.subscription is None:
            if self._node.count_publishers(topic.channel.topic):  # there is one again
                self._demand[number] = None
                self._wake()
            return
        if self._is_alone(topic):
            self._end(topic)
            return
        is_due = number % _FULL_CHECK_PERIOD == self._refreshes % _FULL_CHECK_PERIOD
        if not is_due and self._node.count_publishers(topic.channel.topic) == topic.publishers:
            return
        qos = self._subscription_qos(topic)
        if qos != topic.qos:
            self._unsubscribe(topic)
            self._subscribe(topic, qos)

    def _end_if_unused(self, topic: _Topic) -> None:
        """End the subscription of a topic without clients: after `KEEP_S`, or at once if it alone keeps the topic."""
        if topic.subscription is not None and (time.monotonic() >= topic.unwanted_s + KEEP_S or self._is_alone(topic)):
            self._end(topic)

    def _is_alone(self, topic: _Topic) -> bool:
        """Whether the subscription of the bridge alone keeps a topic in the graph, as after the end of a robot."""
        name = topic.channel.topic
        return self._node.count_publishers(name) == 0 and self._node.count_subscribers(name) <= 1

    def _end(self, topic: _Topic) -> None:
        self._unsubscribe(topic)
        self._post(RetainLast(topic.channel.id, 0))

    def close(self) -> None:
        """End all subscriptions."""
        for topic in self._by_id.values():
            self._unsubscribe(topic)

    @property
    def subscribed(self) -> tuple[str, ...]:
        """Topics that have a subscription."""
        return tuple(name for name, topic in self._by_name.items() if topic.subscription is not None)

    def _add(self, name: str, type_name: str) -> _Topic | None:
        try:
            known = self._types.get(type_name) or (load_type(type_name), message_definition(type_name))
        except MissingTypeError as error:
            self._refuse(name, type_name, str(error))
            return None
        message_type, schema = self._types[type_name] = known
        channel = Channel(next(self._ids), name, CDR, type_name, schema, "ros2msg")
        topic = self._by_name[name] = self._by_id[channel.id] = _Topic(channel, message_type)
        return topic

    def _remove(self, names: Sequence[str]) -> None:
        topics = [self._by_name.pop(name) for name in names]
        for topic in topics:
            self._unsubscribe(topic)
            del self._by_id[topic.channel.id]
        self._post(RemoveChannels(tuple(topic.channel.id for topic in topics)))

    def _subscription_qos(self, topic: _Topic) -> SubscriptionQos:
        name = topic.channel.topic
        publishers = self._node.get_publishers_info_by_topic(name)
        topic.publishers = len(publishers)
        return subscription_qos(publishers, **self._depths, best_effort=self._is_best_effort(name))

    def _subscribe(self, topic: _Topic, qos: SubscriptionQos) -> None:
        channel_id, now_ns, publish = topic.channel.id, self._now_ns, self._publish

        def forward(payload: bytes) -> None:
            publish(channel_id, now_ns(), payload)

        self._post(RetainLast(channel_id, qos.retained))
        try:
            topic.subscription = self._node.create_subscription(
                topic.message_type, topic.channel.topic, forward, qos.profile, raw=True
            )
        except RCLError:  # this process uses the topic with another type
            name, found = topic.channel.topic, topic.channel.schema_name
            types = dict(self._node.get_topic_names_and_types()).get(name, [])
            others = " or ".join(kind for kind in types if kind != found)
            self._refuse(name, found, f"found {found}, expected {others or 'the type'} that this process uses there")
            return
        topic.qos = qos

    def _unsubscribe(self, topic: _Topic) -> None:
        if topic.subscription is not None:
            self._node.destroy_subscription(topic.subscription)
            topic.subscription = topic.qos = None

    def _refuse(self, name: str, type_name: str, reason: str) -> None:
        """Log once why a topic is not bridged."""
        if (name, type_name) not in self._refused:
            self._refused.add((name, type_name))
            self._node.get_logger().warning(f"topic {name} is not bridged: {reason}")
