"""Visitors of a suite for `soak.py`: each repeats a visit until the lesson ends, and some leave rudely."""

from __future__ import annotations

import contextlib
import json
import random
import signal
import socket
import struct
import subprocess
import sys
import threading
import urllib.error
import urllib.request
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import GetParameters
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import Range

from aseba_vm import protocol as aseba
from benchmarks.lib.bridge_client import Peer, said
from tests.network.aseba_client import AsebaClient
from tests.network.tdm.raw_client import RawClient
from thymio_sim_ros.network.tdm.protocol import messages as tdm
from thymio_sim_ros.network.tdm.protocol.constants import Command, CompileOption, Watch

__all__ = [
    "ANSWER_S",
    "PROGRAM",
    "RUDE",
    "Doors",
    "Lesson",
    "leave_rudely",
    "visit_aseba",
    "visit_foxglove",
    "visit_http",
    "visit_ros",
    "visit_tdm",
]

PROGRAM = "var n = 0\ntimer.period[0] = 50\nonevent timer0\nn += 1\nmotor.left.target = 100 + n % {0}\n"
"""What clients load, with a number that differs each time."""
ANSWER_S = 180.0
"""Longest time of an answer; generous for loaded computers, since a failed visit is a failure of the suite."""
STAY_S = (2.0, 8.0)
"""Least and most seconds of a visit."""
RUDE = 0.4
"""Part of the visits that end without a goodbye."""
_RESET = struct.pack("ii", 1, 0)
"""SO_LINGER with which closing a socket resets the connection."""


@dataclass(frozen=True)
class Doors:
    """The ports of a suite. That of Aseba is the last one: further robots have the ports that follow it."""

    page: int
    bridge: int
    tdm: int
    http: int
    aseba: int


@dataclass
class Lesson:
    """What the visitors of a lesson share. `counts` has what they did, `failures` what they did not expect."""

    doors: Doors
    is_over: threading.Event = field(default_factory=threading.Event)
    counts: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def did(self, what: str) -> None:
        """Count an action."""
        with self._lock:
            self.counts[what] += 1

    def repeat(self, visit: Callable[[Lesson, random.Random], None], seed: int) -> threading.Thread:
        """Start a thread that repeats a visit until the lesson is over; what a visit raises is a failure."""

        def run() -> None:
            dice = random.Random(seed)
            while not self.is_over.wait(dice.uniform(0.5, 2.0)):
                try:
                    visit(self, dice)
                except Exception as error:
                    with self._lock:
                        self.failures.append(f"{visit.__name__}: {type(error).__name__}: {error}")

        thread = threading.Thread(target=run, name=visit.__name__)
        thread.start()
        return thread

    def stay(self, dice: random.Random) -> bool:
        """Wait as long as a visit takes; return whether the lesson goes on."""
        return not self.is_over.wait(dice.uniform(*STAY_S))


def leave_rudely(stream: socket.socket) -> None:
    """Reset a connection in place of closing it."""
    with contextlib.suppress(OSError):
        stream.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _RESET)
        stream.close()


def visit_foxglove(lesson: Lesson, dice: random.Random) -> None:
    """Watch all topics that are advertised, parameters and the graph; some viewers stop reading before they leave."""
    viewer = Peer(lesson.doors.bridge)
    try:
        viewer.until(lambda: "/_markers" in viewer.channels, "channels")
        wanted = [{"id": number, "channelId": channel} for number, channel in enumerate(viewer.channels.values())]
        viewer.socket.sendall(
            said(op="subscribe", subscriptions=wanted)
            + said(op="getParameters", parameterNames=[], id="all")
            + said(op="subscribeConnectionGraph")
        )
        is_reading = dice.random() > 0.3
        for _ in range(dice.randint(20, 80) if is_reading else 0):
            with contextlib.suppress(TimeoutError):
                viewer.next(0.1)
        if not is_reading:
            lesson.stay(dice)
        lesson.did("Foxglove: watch" if is_reading else "Foxglove: stop reading")
    except ConnectionError:
        lesson.did("Foxglove: cut off")  # a client that does not read may be
    finally:
        leave_rudely(viewer.socket)


def visit_aseba(lesson: Lesson, dice: random.Random) -> None:
    """Read variables and send commands as Aseba Studio does, on the port of one of the robots."""
    try:
        client = AsebaClient(lesson.doors.aseba + dice.randrange(2))
    except ConnectionRefusedError:
        lesson.did("Aseba: no robot on the port")
        return
    try:
        client.ask(aseba.ListNodes(0, aseba.PROTOCOL_VERSION), aseba.NodePresent)
        for _ in range(dice.randint(3, 12)):
            client.ask(aseba.GetVariables(0, 1, 0, 256), aseba.Variables)
            command = dice.choice([aseba.Pause, aseba.Step, aseba.Run, aseba.Run])
            client.send(command(0, 1), aseba.SetVariables(0, 1, 0, (dice.randrange(100),)))
            if lesson.is_over.wait(0.2):
                break
        client.send(aseba.Run(0, 1))
        lesson.did("Aseba: watch and step")
    except (EOFError, ConnectionError, TimeoutError):
        # Robots and their ports go when the playground changes; a node has another number then.
        lesson.did("Aseba: robot removed")
    finally:
        leave_rudely(client.stream) if dice.random() < RUDE else client.close()


def visit_tdm(lesson: Lesson, dice: random.Random) -> None:
    """Lock a robot, load a program, watch it, and unlock it, as clients of the Thymio Device Manager do."""
    client = RawClient(lesson.doors.tdm, greet=False)
    try:
        client.send(tdm.ConnectionHandshake())
        nodes = client.wait_for(tdm.NodesChanged).nodes
        if not nodes:
            nodes = client.wait_for(tdm.NodesChanged, lambda message: bool(message.nodes)).nodes
        key = dice.choice(nodes).node_id
        text = PROGRAM.format(dice.randint(2, 300))
        client.send(tdm.LockNode(1, key))
        client.send(tdm.CompileAndLoadCodeOnVM(2, key, 1, text, CompileOption.LOAD_ON_TARGET))
        client.send(tdm.SetVMExecutionState(3, key, Command.RUN))
        client.send(tdm.WatchNode(4, key, Watch.VARIABLES))
        client.wait_for((tdm.RequestCompleted, tdm.Error), lambda message: message.request_id == 4)  # type: ignore[arg-type]
        lesson.stay(dice)
        if dice.random() > RUDE:
            client.send(tdm.UnlockNode(5, key))
        lesson.did("Device Manager: load and watch")
    finally:
        leave_rudely(client.socket)


def visit_http(lesson: Lesson, dice: random.Random) -> None:
    """List the robots and read a variable, as curl does; follow events and leave in the middle."""
    base = f"http://127.0.0.1:{lesson.doors.http}"
    for path in ("/nodes", f"/nodes/{dice.randint(1, 2)}/prox.horizontal"):
        try:
            with urllib.request.urlopen(base + path, timeout=ANSWER_S) as answer:
                json.load(answer)
        except urllib.error.HTTPError as error:
            if error.code != 404:
                raise
            error.close()
    with urllib.request.urlopen(f"{base}/events", timeout=ANSWER_S):
        lesson.stay(dice)
    lesson.did("HTTP: read and follow")


_NODE = """
import rclpy
from nav_msgs.msg import Odometry
rclpy.init()
node = rclpy.create_node("visitor")
def on_odometry(message):
    print("odometry", flush=True)
for name in ("/odom", "/blue/odom", "/red/odom"):
    node.create_subscription(Odometry, name, on_odometry, 10)
rclpy.spin(node)
"""


def visit_ros(lesson: Lesson, dice: random.Random) -> None:
    """Run a node that drives a robot and looks at it; one of four is a process that is killed."""
    if dice.random() < 0.25:
        _visit_and_be_killed(lesson, dice)
        return
    context = Context()
    rclpy.init(context=context)
    node = Node(f"visitor_{dice.randrange(1000)}", context=context, enable_rosout=False)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    prefix = dice.choice(["", "/blue", "/red"])
    seen: list[object] = []
    try:
        node.create_subscription(Odometry, f"{prefix}/odom", seen.append, 10)
        node.create_subscription(Range, f"{prefix}/proximity/center", seen.append, 10)
        wheels = node.create_publisher(Twist, f"{prefix}/cmd_vel", 10)
        poses = node.create_client(GetParameters, "/simulator/get_poses")
        for _ in range(dice.randint(20, 80)):
            twist = Twist()
            twist.linear.x = dice.uniform(-0.1, 0.1)
            wheels.publish(twist)
            if poses.service_is_ready():
                poses.call_async(GetParameters.Request(names=["blue", "thymio"]))
            executor.spin_once(timeout_sec=0.1)
            if lesson.is_over.is_set():
                break
        lesson.did("ROS: node comes and goes")
    except ExternalShutdownException:
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()


def _visit_and_be_killed(lesson: Lesson, dice: random.Random) -> None:
    process = subprocess.Popen([sys.executable, "-c", _NODE], stdout=subprocess.DEVNULL, process_group=0)
    try:
        lesson.stay(dice)
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()
    lesson.did("ROS: process is killed")
