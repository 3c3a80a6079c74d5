"""A client's service calls while another client does its worst: python benchmarks/bridge_fairness.py [NAME ...]

One `thymio-sim` serves all. A quiet client calls `/simulator/get_poses` ten times a second: first alone, then while the
attackers, in a process of their own, do what the row says. Printed are the median and the slowest call of both, and the
memory of the suite before and after; `lost` counts calls without an answer within `ANSWER_S`. At last: how long Ctrl-C
takes while nine attacks run at once.

The goal is a slowest call at most 0.5 s slower than alone. Other work on the machine counts in the figures: compare
them with those of the row `none`.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import signal
import socket
import statistics
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from foxglove_throughput import connected, frame_at
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.serialization import serialize_message

ANSWER_S = 20.0
PERIOD_S = 0.1
ALONE_S = 4.0
ATTACK_S = 6.0
START_S = 60.0
POSES = "/simulator/get_poses"
FRAME_BYTES = 4 * 1000 * 1000
ROBOTS = 20
TEXT, BINARY, PING, PONG = 0x81, 0x82, 0x89, 0x8A


def frame(kind: int, body: bytes) -> bytes:
    """A client's frame, masked with zeros."""
    size = len(body)
    if size < 126:
        return bytes([kind, 0x80 | size, 0, 0, 0, 0]) + body
    if size < 1 << 16:
        return struct.pack("!BBH", kind, 0xFE, size) + bytes(4) + body
    return struct.pack("!BBQ", kind, 0xFF, size) + bytes(4) + body


def said(**message: object) -> bytes:
    """A text frame of the protocol."""
    return frame(TEXT, json.dumps(message).encode())


class Peer:
    """A connection that blocks; knows channels, services and parameters by name."""

    def __init__(self, port: int) -> None:
        self.socket = connected(port)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._data = b""
        self.channels: dict[str, int] = {}
        self.services: dict[str, int] = {}
        self.parameters: dict[str, object] = {}
        self.calls = 0

    def next(self, timeout_s: float) -> bytes:
        """The next frame's contents; TimeoutError."""
        deadline = time.monotonic() + timeout_s
        while (found := frame_at(self._data, 0)) is None:
            left_s = deadline - time.monotonic()
            if left_s <= 0:
                raise TimeoutError
            self.socket.settimeout(left_s)
            more = self.socket.recv(1 << 20)
            if not more:
                raise ConnectionError("the server closed the connection")
            self._data += more
        begin, end = found
        body, self._data = self._data[begin:end], self._data[end:]
        if body.startswith(b"{"):
            self._note(json.loads(body))
        return body

    def _note(self, message: dict[str, list[dict[str, object]]]) -> None:
        for channel in message.get("channels", ()):
            self.channels[str(channel["topic"])] = int(str(channel["id"]))
        for service in message.get("services", ()):
            self.services[str(service["name"])] = int(str(service["id"]))
        for parameter in message.get("parameters", ()):
            self.parameters[str(parameter["name"])] = parameter.get("value")

    def until(self, condition: Callable[[], bool], what: str) -> None:
        """Read until the condition is true."""
        deadline = time.monotonic() + START_S
        while not condition():
            assert time.monotonic() < deadline, f"no {what}"
            with contextlib.suppress(TimeoutError):
                self.next(0.1)

    def call(self, name: str, payload: bytes) -> float:
        """Seconds until the answer; TimeoutError after `ANSWER_S`."""
        self.calls += 1
        began = time.monotonic()
        self.socket.settimeout(ANSWER_S)
        self.socket.sendall(request(self.services[name], self.calls, payload))
        while True:
            body = self.next(began + ANSWER_S - time.monotonic())
            # A ping of the server has four random bytes.
            if len(body) > 8 and body[0] == 3 and struct.unpack_from("<I", body, 5)[0] == self.calls:
                return time.monotonic() - began


def request(service: int, call: int, payload: bytes, encoding: bytes = b"cdr") -> bytes:
    """The frame of a service call."""
    return frame(BINARY, struct.pack("<BIII", 2, service, call, len(encoding)) + encoding + payload)


# --- what an attacker does: each yields bytes to send again and again ------------------------------------------------

Attack = Callable[[Peer], Iterator[bytes]]
NAMES = serialize_message(GetParameters.Request(names=["thymio"]))


def calls(peer: Peer) -> Iterator[bytes]:
    """3000 service calls in one go, repeated."""
    while True:
        yield b"".join(request(peer.services[POSES], number, NAMES) for number in range(3000))


def large_calls(peer: Peer) -> Iterator[bytes]:
    """Service requests of 4 MB with as many parts as fit."""
    value = Parameter(name="a", value=ParameterValue(type=ParameterType.PARAMETER_BOOL))
    payload = serialize_message(SetParameters.Request(parameters=[value] * 45_000))
    service = peer.services["/simulator/set_poses"]
    while True:
        yield request(service, 1, payload)
        yield request(service, 2, b'{"parameters": [' + b"{}," * 1_300_000 + b"{}]}", b"json")


def set_parameters(peer: Peer) -> Iterator[bytes]:
    """2000 setParameters in one go, repeated."""
    wish = {"name": "/simulator.real_time_factor", "value": 1.0, "type": "float64"}
    while True:
        yield b"".join(said(op="setParameters", parameters=[wish], id=str(number)) for number in range(2000))


def set_wide(peer: Peer) -> Iterator[bytes]:
    """setParameters of a thousand parameters of all nodes each."""
    names = list(peer.parameters)[:1000] or ["/simulator.real_time_factor"]
    wishes = [{"name": name, "value": 1} for name in names * (1000 // len(names) + 1)][:1000]
    while True:
        yield said(op="setParameters", parameters=wishes, id="wide")


def get_parameters(peer: Peer) -> Iterator[bytes]:
    """getParameters of everything, in a flood."""
    while True:
        yield said(op="getParameters", parameterNames=[], id="all") * 500


def advertise(peer: Peer) -> Iterator[bytes]:
    """256 channels opened and closed again without a pause."""
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
    """256 channels, kept open."""
    yield next(advertise(peer))
    while True:
        time.sleep(0.1)
        yield b""


def publish(peer: Peer) -> Iterator[bytes]:
    """A message of 4 MB with as many parts as fit, on a channel of its own; then small ones in a flood."""
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
    """Every topic subscribed to and left again without a pause."""
    ids = list(peer.channels.values())
    wanted = [{"id": number, "channelId": channel} for number, channel in enumerate(ids)]
    while True:
        yield said(op="subscribe", subscriptions=wanted)
        yield said(op="unsubscribe", subscriptionIds=list(range(len(ids))))


def watch_all(peer: Peer) -> Iterator[bytes]:
    """Every topic subscribed to, those that come later too."""
    known = 0
    while True:
        ids = list(peer.channels.values())
        if len(ids) > known:
            wanted = [{"id": number, "channelId": ids[number]} for number in range(known, len(ids))]
            known = len(ids)
            yield said(op="subscribe", subscriptions=wanted)
        yield b""


def graph(peer: Peer) -> Iterator[bytes]:
    """The connection graph asked for and left without a pause."""
    while True:
        yield (said(op="subscribeConnectionGraph") + said(op="unsubscribeConnectionGraph")) * 500


def assets(peer: Peer) -> Iterator[bytes]:
    """Files asked for in a flood, existing or not."""
    while True:
        yield said(op="fetchAsset", uri="package://thymio_sim_ros/meshes/none.stl", requestId=1) * 1000


def watch_parameters(peer: Peer) -> Iterator[bytes]:
    """Parameter subscriptions to ever new names."""
    number = 0
    while True:
        number += 1
        names = [f"/n{number}.{index}" for index in range(5000)]
        yield said(op="subscribeParameterUpdates", parameterNames=names)


def nonsense_binary(peer: Peer) -> Iterator[bytes]:
    """4 MB of random bytes."""
    data = frame(BINARY, random.Random(1).randbytes(FRAME_BYTES))
    while True:
        yield data


def nonsense_lists(peer: Peer) -> Iterator[bytes]:
    """4 MB of JSON: empty lists and objects."""
    data = frame(TEXT, b'{"op":"setParameters","parameters":[' + b"[],{}," * (FRAME_BYTES // 6) + b"1]}")
    while True:
        yield data


def nonsense_numbers(peer: Peer) -> Iterator[bytes]:
    """4 MB of JSON that fits the protocol: one parameter with two million numbers, and ids."""
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
    """4 MB of brackets, one in another."""
    data = frame(TEXT, b'{"op":' + b"[" * FRAME_BYTES)
    while True:
        yield data


def nonsense_text(peer: Peer) -> Iterator[bytes]:
    """4 MB of one string, full of escapes, and as an operation of that name."""
    plain = frame(TEXT, b'{"op":"' + b"x" * FRAME_BYTES + b'"}')
    escaped = frame(TEXT, b'{"op":"' + b"\\n" * (FRAME_BYTES // 2) + b'"}')
    bare = frame(TEXT, "\u00e9\u0001".encode() * (FRAME_BYTES // 3))
    while True:
        yield plain
        yield escaped
        yield bare


def tiny_frames(peer: Peer) -> Iterator[bytes]:
    """Pings, pongs and empty messages without a pause."""
    data = (frame(PING, b"") + frame(PONG, b"") + frame(TEXT, b"")) * 20_000
    while True:
        yield data


def fragments(peer: Peer) -> Iterator[bytes]:
    """Messages in fragments of one byte."""
    data = frame(0x01, b"{") + frame(0x00, b" ") * 4000 + frame(0x80, b"}")
    while True:
        yield data


def nothing(peer: Peer) -> Iterator[bytes]:
    """Nothing, for comparison."""
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
"""Name → what it does, and how many clients do it."""


def attack(name: str, port: int) -> None:
    """Never returns."""
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
    """Read, and subscribe to what is advertised."""
    for data in act(peer):
        peer.socket.settimeout(10)
        peer.socket.sendall(data)
        with contextlib.suppress(TimeoutError):
            peer.next(0.2)


def _drop(peer: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while peer.recv(1 << 18):
            pass


# --- measuring -------------------------------------------------------------------------------------------------------


def latencies(peer: Peer, seconds: float) -> tuple[list[float], int]:
    """How long calls took, s, and how many had no answer."""
    taken: list[float] = []
    lost = 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            taken.append(peer.call(POSES, NAMES))
        except TimeoutError:
            lost += 1
        time.sleep(PERIOD_S)
    return taken, lost


def rss_mb(process: int) -> float:
    """Memory of a process, MB."""
    for line in Path(f"/proc/{process}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024
    return 0.0


def row(name: str, port: int, process: int) -> str:
    """Measure one attack."""
    quiet = Peer(port)
    quiet.until(lambda: POSES in quiet.services, "service")
    before = rss_mb(process)
    if name == "robots-20":
        spawn(quiet)
    alone, _ = latencies(quiet, ALONE_S)
    attackers = subprocess.Popen([sys.executable, __file__, "--attack", name, "--port", str(port)])
    try:
        time.sleep(1.0)  # they connect
        taken, lost = latencies(quiet, ATTACK_S * (2 if name == "robots-20" else 1))
    except OSError as error:
        return f"{name:18} the quiet client lost its connection: {error}"
    finally:
        attackers.kill()
        attackers.wait()
    peak = rss_mb(process)
    began = time.monotonic()
    with contextlib.suppress(OSError):
        quiet.call(POSES, NAMES)
        latencies(quiet, 2.0)
    quiet.socket.close()
    slowest = max(taken, default=float("inf"))
    more = slowest - max(alone)
    return (
        f"{name:18} {1e3 * statistics.median(alone):7.1f} {1e3 * max(alone):7.1f} "
        f"{1e3 * statistics.median(taken or [0]):9.1f} {1e3 * slowest:9.1f} {lost:5d} "
        f"{'ok' if more <= 0.5 and not lost else 'SLOW':5} {before:6.0f} {peak:6.0f} {rss_mb(process):6.0f}"
        f"  ({time.monotonic() - began - 2.0:4.1f} s)"
    )


def spawn(peer: Peer) -> None:
    """Twenty robots more."""
    for number in range(ROBOTS):
        place = ParameterValue(
            type=ParameterType.PARAMETER_DOUBLE_ARRAY,
            double_array_value=[0.05 + 0.12 * (number % 5), 0.05 + 0.12 * (number // 5), 0.0],
        )
        wish = SetParameters.Request(parameters=[Parameter(name=f"guest_{number}", value=place)])
        peer.call("/simulator/spawn", serialize_message(wish))


@contextlib.contextmanager
def suite(port: int) -> Iterator[subprocess.Popen[bytes]]:
    """A running `thymio-sim`."""
    start = "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main())"
    command = [sys.executable, "-c", start, "--no-web", "--foxglove-port", str(port)]
    with open(os.environ.get("SUITE_LOG", os.devnull), "ab") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output)
    try:
        peer = Peer(port)
        peer.until(lambda: POSES in peer.services, "service")
        peer.socket.close()
        time.sleep(2.0)
        yield process
    finally:
        process.kill()
        process.wait()


def ctrl_c_s(port: int, process: subprocess.Popen[bytes]) -> float:
    """Seconds from Ctrl-C to the end while everything at once goes on."""
    names = ["calls", "set", "get", "advertise", "subscribe", "numbers", "tiny", "publish", "never-reads"]
    attackers = [subprocess.Popen([sys.executable, __file__, "--attack", name, "--port", str(port)]) for name in names]
    try:
        time.sleep(6.0)
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.wait(30)
        return time.monotonic() - began
    finally:
        for attacker in attackers:
            attacker.kill()
        for attacker in attackers:
            attacker.wait()


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help=f"some of {', '.join(ATTACKS)}, ctrl-c; default: all")
    parser.add_argument("--port", type=int, default=9230)
    parser.add_argument("--rounds", type=int, default=1, help="times each attack is run in one suite")
    parser.add_argument("--attack", choices=list(ATTACKS), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.attack:
        attack(options.attack, options.port)
    names = options.names or [*ATTACKS, "ctrl-c"]
    print("                     alone, ms        attacked, ms              memory, MB")
    print("attack              median     max    median       max  lost      before   peak  after", flush=True)
    for name in names:
        with suite(options.port) as process:
            if name == "ctrl-c":
                print(f"Ctrl-C under nine attacks at once: {ctrl_c_s(options.port, process):.1f} s")
                continue
            for _ in range(options.rounds):
                print(row(name, options.port, process.pid), flush=True)


if __name__ == "__main__":
    main()
