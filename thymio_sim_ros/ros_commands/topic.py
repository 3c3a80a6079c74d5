"""The verbs of topics."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from rclpy.duration import Duration

from thymio_sim_ros.bags import qos
from thymio_sim_ros.ros_commands import rates
from thymio_sim_ros.ros_commands.member import Member, find_by_type, listed, load, print_types
from thymio_sim_ros.ros_commands.values import LONGEST, from_yaml, part_of, to_yaml

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["VERBS", "echoed", "recorded"]

_DEPTH = 10
_SENT = Duration(seconds=1)
"""Longest wait for the arrival of the last message."""


def _list(member: Member, options: argparse.Namespace) -> None:
    member.discover()
    listed(member.topics(), types=options.show_types, count=options.count, hidden=options.include_hidden)


def _info(member: Member, options: argparse.Namespace) -> None:
    topic = member.find("topic", options.topic, member.topics)
    member.discover()
    end = "\n\n" if options.verbose else "\n"
    types = member.topics()[topic]
    print(f"Type: {types[0] if len(types) == 1 else types}", end=end)
    for role, found in (
        ("Publisher", member.node.get_publishers_info_by_topic(topic)),
        ("Subscription", member.node.get_subscriptions_info_by_topic(topic)),
    ):
        print(f"{role} count: {len(found)}", end=end)
        for one in found if options.verbose else ():
            print(one, end=end)


def _type(member: Member, options: argparse.Namespace) -> None:
    print_types(member, "topic", options.topic, member.topics)


def _find(member: Member, options: argparse.Namespace) -> None:
    find_by_type(member, options, "msg", member.topics)


def _subscribe(
    member: Member, options: argparse.Namespace, callback: Callable[[Any], None], *, raw: bool = False
) -> None:
    """Subscribe to a topic that is there, or with a type that is given."""
    given = getattr(options, "type", None)
    if given is None:
        topic, name = member.find_type("topic", options.topic, member.topics)
    else:
        name, _ = load(given, "msg")
        topic = member.check_type("topic", options.topic, name, member.topics)
    _, kind = load(name, "msg")
    member.node.create_subscription(kind, topic, callback, recorded(member, topic), raw=raw)


def recorded(member: Member, topic: str) -> QoSProfile:
    """The profile with which a subscription gets most from the publishers that are there."""
    return qos.of_recording([one.qos_profile for one in member.node.get_publishers_info_by_topic(topic)])


def echoed(message: Any, options: argparse.Namespace) -> str:
    """A message, or a part of one, as `echo` prints it."""
    longest = None if options.full_length else LONGEST
    return f"{to_yaml(message, longest=longest, lists=not options.no_arr)}---"


def _echo(member: Member, options: argparse.Namespace) -> None:
    count = 0

    def show(message: Message) -> None:
        nonlocal count
        if options.once and count:
            return
        count += 1
        print(echoed(message if options.field is None else part_of(message, options.field), options), flush=True)

    _subscribe(member, options, show)
    member.spin_until(lambda: options.once and count)


def _measure(measure: rates.Measure) -> Callable[[Member, argparse.Namespace], None]:
    """A verb that prints a measure of the serialized messages once a second."""

    def run(member: Member, options: argparse.Namespace) -> None:
        window = rates.Window(options.window)
        _subscribe(member, options, lambda data: window.add(len(data)), raw=True)
        if measure is rates.bandwidth:
            print(f"Subscribed to [{member.node.resolve_topic_name(options.topic)}]", flush=True)
        while True:
            member.spin_until(lambda: False, rates.EVERY_S)
            if window.is_new:
                print(measure(window), flush=True)

    return run


def _pub(member: Member, options: argparse.Namespace) -> None:
    name, kind = load(options.type, "msg")
    from_yaml(options.values, kind, member.node)  # errors come before the wait
    topic = member.check_type("topic", options.topic, name, member.topics)
    publisher = member.node.create_publisher(kind, topic, _DEPTH)
    wanted = options.wait_matching_subscriptions
    wanted = (options.times is not None) if wanted is None else wanted
    if publisher.get_subscription_count() < wanted:
        print(f"Waiting for at least {wanted:d} matching subscription(s)...", flush=True)
        member.spin_until(lambda: publisher.get_subscription_count() >= wanted)
    print("publisher: beginning loop", flush=True)
    count = 0

    def publish() -> None:
        nonlocal count
        if count == options.times:
            return
        count += 1
        message = from_yaml(options.values, kind, member.node)
        print(f"publishing #{count}: {message!r}\n", flush=True)
        publisher.publish(message)

    publish()
    timer = member.node.create_timer(1.0 / options.rate, publish)
    member.spin_until(lambda: count == options.times)
    member.node.destroy_timer(timer)
    publisher.wait_for_all_acked(_SENT)


VERBS: Mapping[str, Callable[[Member, argparse.Namespace], None]] = {
    "list": _list,
    "echo": _echo,
    "hz": _measure(rates.rate),
    "bw": _measure(rates.bandwidth),
    "info": _info,
    "type": _type,
    "find": _find,
    "pub": _pub,
}
