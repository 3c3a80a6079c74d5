"""Attacks on the bridge for `bridge_fairness.py`, run as: python -m benchmarks.lib.bridge_attacks NAME PORT

An attack is a generator of bytes that its clients send again and again.
"""

from __future__ import annotations

import contextlib
import random
import socket
import struct
import sys
import threading
import time
from collections.abc import Callable, Iterator

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.serialization import serialize_message

from benchmarks.lib.bridge_client import BINARY, PING, PONG, TEXT, Peer, frame, request, said

POSES = "/simulator/get_poses"
FRAME_BYTES = 4 * 1000 * 1000

Attack = Callable[[Peer], Iterator[bytes]]
NAMES = serialize_message(GetParameters.Request(names=["thymio"]))


def calls(peer: Peer) -> Iterator[bytes]:
    """Send 3000 service calls at once, repeatedly."""
    while True:
        yield b"".join(request(peer.services[POSES], number, NAMES) for number in range(3000))


def large_calls(peer: Peer) -> Iterator[bytes]:
    """Send service requests of 4 MB with as many parts as fit."""
    value = Parameter(name="a", value=ParameterValue(type=ParameterType.PARAMETER_BOOL))
    payload = serialize_message(SetParameters.Request(parameters=[value] * 45_000))
    service = peer.services["/simulator/set_poses"]
    while True:
        yield request(service, 1, payload)
        yield request(service, 2, b'{"parameters": [' + b"{}," * 1_300_000 + b"{}]}", b"json")


def set_parameters(peer: Peer) -> Iterator[bytes]:
    """Send 2000 setParameters at once, repeatedly."""
    wish = {"name": "/simulator.real_time_factor", "value": 1.0, "type": "float64"}
    while True:
        yield b"".join(said(op="setParameters", parameters=[wish], id=str(number)) for number in range(2000))


def set_wide(peer: Peer) -> Iterator[bytes]:
    """Send setParameters with a thousand parameters of all nodes each."""
    names = list(peer.parameters)[:1000] or ["/simulator.real_time_factor"]
    wishes = [{"name": name, "value": 1} for name in names * (1000 // len(names) + 1)][:1000]
    while True:
        yield said(op="setParameters", parameters=wishes, id="wide")


def get_parameters(peer: Peer) -> Iterator[bytes]:
    """Flood with getParameters of everything."""
    while True:
        yield said(op="getParameters", parameterNames=[], id="all") * 500


def advertise(peer: Peer) -> Iterator[bytes]:
    """Open and close 256 channels without a pause."""
    count = 256
    name = f"/attack_{peer.socket.getsockname()[1]}"
    opened = [
        {"id": number, "topic": f"{name}/c{number}", "encoding": "cdr", "schemaName": "std_msgs/Bool"}
        for number in range(count)
    ]
    while True:
        yield said(op="advertise", channels=opened)
        yield said(op="unadvertise", channelIds=list(range(count)))


def channels(peer: Peer) -> Iterator[bytes]:
    """Open 256 channels and keep them open."""
    yield next(advertise(peer))
    while True:
        time.sleep(0.1)
        yield b""


def publish(peer: Peer) -> Iterator[bytes]:
    """Send a message of 4 MB with as many parts as fit, then a flood of small ones on another channel."""
    yield said(
        op="advertise",
        channels=[
            {"id": 1, "topic": "/attack_large", "encoding": "cdr", "schemaName": "rcl_interfaces/ParameterEvent"},
            {"id": 2, "topic": "/attack_small", "encoding": "json", "schemaName": "geometry_msgs/Twist"},
        ],
    )
    value = ParameterValue(type=ParameterType.PARAMETER_BOOL)
    from rcl_interfaces.msg import ParameterEvent

    event = ParameterEvent(new_parameters=[Parameter(name="a", value=value)] * 45_000)
    large = frame(BINARY, struct.pack("<BI", 1, 1) + serialize_message(event))
    small = frame(BINARY, struct.pack("<BI", 1, 2) + b'{"linear": {"x": 0.1}}')
    while True:
        yield large
        yield small * 5000


def subscribe(peer: Peer) -> Iterator[bytes]:
    """Subscribe to all topics and unsubscribe without a pause."""
    ids = list(peer.channels.values())
    wanted = [{"id": number, "channelId": channel} for number, channel in enumerate(ids)]
    while True:
        yield said(op="subscribe", subscriptions=wanted)
        yield said(op="unsubscribe", subscriptionIds=list(range(len(ids))))


def watch_all(peer: Peer) -> Iterator[bytes]:
    """Subscribe to all topics, also to those that are advertised later."""
    known = 0
    while True:
        ids = list(peer.channels.values())
        if len(ids) > known:
            wanted = [{"id": number, "channelId": ids[number]} for number in range(known, len(ids))]
            known = len(ids)
            yield said(op="subscribe", subscriptions=wanted)
        yield b""


def graph(peer: Peer) -> Iterator[bytes]:
    """Subscribe to the connection graph and unsubscribe without a pause."""
    while True:
        yield (said(op="subscribeConnectionGraph") + said(op="unsubscribeConnectionGraph")) * 500


def assets(peer: Peer) -> Iterator[bytes]:
    """Flood with requests for a file that does not exist."""
    while True:
        yield said(op="fetchAsset", uri="package://thymio_sim_ros/meshes/none.stl", requestId=1) * 1000


def watch_parameters(peer: Peer) -> Iterator[bytes]:
    """Subscribe to updates of ever new parameter names."""
    number = 0
    while True:
        number += 1
        names = [f"/n{number}.{index}" for index in range(5000)]
        yield said(op="subscribeParameterUpdates", parameterNames=names)


def nonsense_binary(peer: Peer) -> Iterator[bytes]:
    """Send 4 MB of random bytes."""
    data = frame(BINARY, random.Random(1).randbytes(FRAME_BYTES))
    while True:
        yield data


def nonsense_lists(peer: Peer) -> Iterator[bytes]:
    """Send 4 MB of JSON: empty lists and objects."""
    data = frame(TEXT, b'{"op":"setParameters","parameters":[' + b"[],{}," * (FRAME_BYTES // 6) + b"1]}")
    while True:
        yield data


def nonsense_numbers(peer: Peer) -> Iterator[bytes]:
    """Send 4 MB of JSON that fits the protocol: one parameter with two million numbers, and ids."""
    value = frame(
        TEXT,
        b'{"op":"setParameters","id":"1","parameters":[{"name":"/simulator.seed","value":['
        + b"1," * (FRAME_BYTES // 2)
        + b"1]}]}",
    )
    ids = frame(TEXT, b'{"op":"unsubscribe","subscriptionIds":[' + b"1," * (FRAME_BYTES // 2) + b"1]}")
    while True:
        yield value
        yield ids


def nonsense_deep(peer: Peer) -> Iterator[bytes]:
    """Send 4 MB of nested brackets."""
    data = frame(TEXT, b'{"op":' + b"[" * FRAME_BYTES)
    while True:
        yield data


def nonsense_text(peer: Peer) -> Iterator[bytes]:
    """Send 4 MB of one string: as a name of an operation, full of escapes, and not as JSON."""
    plain = frame(TEXT, b'{"op":"' + b"x" * FRAME_BYTES + b'"}')
    escaped = frame(TEXT, b'{"op":"' + b"\\n" * (FRAME_BYTES // 2) + b'"}')
    bare = frame(TEXT, "\u00e9\u0001".encode() * (FRAME_BYTES // 3))
    while True:
        yield plain
        yield escaped
        yield bare


def tiny_frames(peer: Peer) -> Iterator[bytes]:
    """Send pings, pongs and empty messages without a pause."""
    data = (frame(PING, b"") + frame(PONG, b"") + frame(TEXT, b"")) * 20_000
    while True:
        yield data


def fragments(peer: Peer) -> Iterator[bytes]:
    """Send messages in fragments of one byte."""
    data = frame(0x01, b"{") + frame(0x00, b" ") * 4000 + frame(0x80, b"}")
    while True:
        yield data


def nothing(peer: Peer) -> Iterator[bytes]:
    """Send nothing, for comparison."""
    while True:
        time.sleep(0.1)
        yield b""


ATTACKS: dict[str, tuple[Attack, int]] = {
    "none": (nothing, 1),
    "calls": (calls, 1),
    "calls-10": (calls, 10),
    "large-calls": (large_calls, 1),
    "set": (set_parameters, 1),
    "set-10": (set_parameters, 10),
    "set-wide": (set_wide, 1),
    "get": (get_parameters, 1),
    "get-10": (get_parameters, 10),
    "channels-10": (channels, 10),
    "advertise": (advertise, 1),
    "advertise-10": (advertise, 10),
    "publish": (publish, 1),
    "subscribe": (subscribe, 1),
    "subscribe-10": (subscribe, 10),
    "graph": (graph, 1),
    "assets": (assets, 1),
    "watch-parameters": (watch_parameters, 1),
    "binary": (nonsense_binary, 1),
    "lists": (nonsense_lists, 1),
    "numbers": (nonsense_numbers, 1),
    "numbers-10": (nonsense_numbers, 10),
    "deep": (nonsense_deep, 1),
    "text": (nonsense_text, 1),
    "text-10": (nonsense_text, 10),
    "tiny": (tiny_frames, 1),
    "tiny-10": (tiny_frames, 10),
    "fragments": (fragments, 1),
    "never-reads": (watch_all, 1),
    "never-reads-get": (get_parameters, 1),
    "connections": (nothing, 1000),
    "come-and-go": (nothing, 8),
    "robots-20": (watch_all, 1),
}
"""Name → attack, and number of clients that do it."""


def attack(name: str, port: int) -> None:
    """Run an attack with all its clients until the process is killed."""
    act, count = ATTACKS[name]
    threading.stack_size(1 << 18)
    if name == "connections":
        kept = []
        for _ in range(count):
            with contextlib.suppress(OSError):
                peer = socket.create_connection(("127.0.0.1", port), timeout=5)
                peer.sendall(
                    b"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                    b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n"
                    b"Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
                )
                kept.append(peer)
        while True:
            time.sleep(1)
    threads = [threading.Thread(target=_attack, args=(name, act, port), daemon=True) for _ in range(count)]
    for thread in threads:
        thread.start()
    while True:
        time.sleep(1)


def _attack(name: str, act: Attack, port: int) -> None:
    while True:
        try:
            peer = Peer(port)
            if name == "come-and-go":
                for message in (said(op="subscribeConnectionGraph"), said(op="getParameters", parameterNames=[])):
                    peer.socket.sendall(message)
                peer.socket.close()
                continue
            peer.until(lambda: POSES in peer.services, "service")  # noqa: B023
            if name == "set-wide":
                peer.socket.sendall(said(op="getParameters", parameterNames=[], id="all"))
                peer.until(lambda: bool(peer.parameters), "parameters")  # noqa: B023
            peer.socket.settimeout(None)
            if name == "robots-20":
                _watch(peer, act)
            if not name.startswith("never-reads"):
                threading.Thread(target=_drop, args=(peer.socket,), daemon=True).start()
            for data in act(peer):
                peer.socket.sendall(data)
        except (OSError, AssertionError):
            time.sleep(0.05)


def _watch(peer: Peer, act: Attack) -> None:
    """Send what an attack yields, and read what is advertised."""
    for data in act(peer):
        peer.socket.settimeout(10)
        peer.socket.sendall(data)
        with contextlib.suppress(TimeoutError):
            peer.next(0.2)


def _drop(peer: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while peer.recv(1 << 18):
            pass


if __name__ == "__main__":
    attack(sys.argv[1], int(sys.argv[2]))
