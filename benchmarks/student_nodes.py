"""Nodes of students: messages within a process, nodes over rosbridge, graded tests, and the start of a node.

On the embedded graph beside an installed ROS 2 in the same run, where both can. A message is published by a timer and
received by a callback of the same process and executor; figures are medians of the time between. The first message
of a process is another figure: it makes the code that serializes its type. Over rosbridge, ten
processes of `thymio-sim node` have two topics each, and each is subscribed to those of the next one; CPU is that of the
suite's process, above its CPU without them, and that of all nodes. Needs ROS.
"""

from __future__ import annotations

import argparse
import contextlib
import re
import statistics
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

from benchmarks.lib.processes import SUITE, cpu_s, suite
from benchmarks.lib.report import ROOT, Goal, Report, Table
from benchmarks.lib.rounds import in_turn, medians
from tests.patience import until
from tests.processes import Process

QUICK = {"seconds": 0.5, "rounds": 1, "rates": [100], "nodes": 2}
GRAPHS = ("embedded", "ROS 2")
KINDS = ("Twist", "LaserScan", "Image")
MOST_START_S, MOST_RUN_S = 0.35, 0.7
"""Half of what a test of ten simulated seconds took on an installed ROS 2 before."""
MOST_FIRST_S, MOST_PERCENT = 1.0, 50.0
LEAST_MESSAGES = 12
"""Messages of a process: the first one, and those whose median is the figure, also where they are rare."""
TOPICS, RATE_HZ = 2, 20
"""Topics of a node, and messages of each per second."""
LATENCY = "import sys; from benchmarks.student_nodes import print_latency; print_latency(*sys.argv[1:])"

TALKER = f"""
import sys, rclpy
from geometry_msgs.msg import Twist
own, other = sys.argv[1:3]
rclpy.init()
node = rclpy.create_node("node_" + own)
publishers = [node.create_publisher(Twist, f"talk_{{own}}_{{number}}", 10) for number in range({TOPICS})]
received = [0]
def count(message): received[0] += 1
for number in range({TOPICS}): node.create_subscription(Twist, f"talk_{{other}}_{{number}}", count, 10)
node.create_timer({1 / RATE_HZ}, lambda: [publisher.publish(Twist()) for publisher in publishers])
node.create_timer(0.5, lambda: print("received", received[0], flush=True))
rclpy.spin(node)
"""
FIRST = """
import rclpy
from nav_msgs.msg import Odometry
rclpy.init()
node = rclpy.create_node("first")
def show(message): print("first", flush=True)
node.create_subscription(Odometry, "odom", show, 10)
rclpy.spin(node)
"""
DRIVER = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import Range
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Range, "proximity/center", self.look, 10)
        self.create_timer(0.05, self.drive)
    def look(self, seen):
        self.seen = seen.range
    def drive(self):
        command = Twist()
        command.linear.x, command.angular.z = 0.1, 1.0
        self.wheels.publish(command)
def main():
    rclpy.init()
    rclpy.spin(Driver())
if __name__ == "__main__":
    main()
"""
GRADED = """
import time
import pytest
@pytest.mark.thymio(playground="base")
@pytest.mark.parametrize("way", ["start", "run"] * 2)
def test_ten_seconds(ros, simulation, way):
    sim = simulation()
    begin = time.perf_counter()
    getattr(ros, way)("driver.py")
    sim.step(10)
    print("took", way, time.perf_counter() - begin)
"""


def print_latency(graph: str, kind: str, rate_hz: str, seconds: str) -> None:
    """Print the time from `publish` to the callback in µs: that of the first message, and the median of the others."""
    if graph == GRAPHS[0]:
        from thymio_sim_ros.portable_ros import import_hook

        import_hook.install(is_forced=True)
    import rclpy
    from geometry_msgs.msg import Twist
    from rclpy.executors import SingleThreadedExecutor
    from sensor_msgs.msg import Image, LaserScan

    message = {
        "Twist": Twist,
        "LaserScan": lambda: LaserScan(ranges=[1.0] * 360, intensities=[0.0] * 360),
        "Image": lambda: Image(height=256, width=256, step=256, encoding="mono8", data=bytes(65536)),
    }[kind]()
    rclpy.init()
    node = rclpy.create_node("bench")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    publisher = node.create_publisher(type(message), "topic", 10)
    sent_ns = 0
    found_us: list[float] = []

    def publish() -> None:
        nonlocal sent_ns
        sent_ns = time.perf_counter_ns()
        publisher.publish(message)

    node.create_subscription(
        type(message), "topic", lambda _: found_us.append((time.perf_counter_ns() - sent_ns) / 1000), 10
    )
    node.create_timer(1 / float(rate_hz), publish)
    end_s = time.monotonic() + float(seconds)
    while time.monotonic() < end_s or len(found_us) < LEAST_MESSAGES:
        executor.spin_once(timeout_sec=0.1)
    print(found_us[0], statistics.median(found_us[1:]))


def latency_us(graph: str, kind: str, rate_hz: int, seconds: float, figure: int = -1) -> float:
    """A figure of a process of its own: -2 for its first message, -1 for the median of the others."""
    words = [sys.executable, "-c", LATENCY, graph, kind, str(rate_hz), str(seconds)]
    return float(subprocess.run(words, capture_output=True, text=True, check=True, cwd=ROOT).stdout.split()[figure])


def within_a_process(options: argparse.Namespace) -> tuple[Table, list[Goal]]:
    """Messages within a process on both graphs, in turn."""
    rows, goals = [], []
    for kind in KINDS:
        for rate_hz in options.rates:
            runs = {graph: partial(latency_us, graph, kind, rate_hz, options.seconds) for graph in GRAPHS}
            embedded, installed = medians(in_turn(runs, options.rounds, warm_up=0)).values()
            rows.append([f"{kind}, {rate_hz} Hz", embedded, installed, embedded / installed])
            goals.append(Goal(f"{kind} at {rate_hz} Hz, embedded graph to ROS 2", 1.0, embedded / installed, "×"))
    return Table(["publish to callback, µs", "embedded", "ROS 2", "ratio"], rows), goals


def first_messages(options: argparse.Namespace) -> tuple[Table, list[Goal]]:
    """The first message of a process on both graphs, in turn."""
    rows = []
    for kind in KINDS:
        runs = {graph: partial(latency_us, graph, kind, 100, 0.0, -2) for graph in GRAPHS}
        rows.append([kind, *(us / 1000 for us in medians(in_turn(runs, options.rounds, warm_up=0)).values())])
    return Table(["first message of a process, ms", "embedded", "ROS 2"], rows), []


def over_rosbridge(folder: Path, options: argparse.Namespace) -> tuple[Table, list[Goal]]:
    """Nodes that talk over the suite, and the time of a node from its start to its first message."""
    (folder / "talker.py").write_text(TALKER, encoding="utf-8")
    (folder / "first.py").write_text(FIRST, encoding="utf-8")
    with suite("--portable", "--program", "none", "--no-web") as running, contextlib.ExitStack() as stack:
        connect = ("--connect", f"ws://127.0.0.1:{running.bridge_port}")

        def started(file: str, *words: str) -> Process:
            own = Path(tempfile.mkdtemp(dir=folder))
            process = Process(own, SUITE, "node", str(folder / file), *words, *connect)
            stack.callback(process.end)
            return process

        first_s = []
        for _ in range(options.rounds):
            begin_s, node = time.monotonic(), started("first.py")
            until(partial(_has_message, node))
            first_s.append(time.monotonic() - begin_s)
            node.end()
        alone = _share([running.process.pid], options.seconds)
        nodes = [started("talker.py", str(n), str((n + 1) % options.nodes)) for n in range(options.nodes)]
        until(lambda: all(map(_received, nodes)), lambda: nodes[0].output)
        before, begin_s = [_received(node) for node in nodes], time.monotonic()
        with_nodes = _share([running.process.pid], max(2.0, options.seconds))
        rate = sum(map(_received, nodes)) - sum(before)
        rate_hz = rate / (time.monotonic() - begin_s)
        of_nodes = _share([node.pid for node in nodes], max(2.0, options.seconds))
    title = f"{options.nodes} nodes over rosbridge, {TOPICS} topics each at {RATE_HZ} Hz"
    rows = [
        ["suite alone, % CPU", alone],
        ["suite, above that, % CPU", with_nodes - alone],
        ["all nodes, % CPU", of_nodes],
        ["messages received per second", rate_hz],
        ["start of a node to its first message, s", statistics.median(first_s)],
    ]
    return Table([title, "measured"], rows), [
        Goal("nodes over rosbridge, suite", MOST_PERCENT, with_nodes - alone, "% CPU"),
        Goal("start of `thymio-sim node` to its first message", MOST_FIRST_S, statistics.median(first_s), "s"),
    ]


def _has_message(node: Process) -> bool:
    return "first" in node.output


def _received(node: Process) -> int:
    return int((re.findall(r"received (\d+)\n", node.output) or ["0"])[-1])


def _share(pids: list[int], seconds: float) -> float:
    """CPU of processes for some time, in % of a core."""
    before_s, begin_s = sum(map(cpu_s, pids)), time.monotonic()
    time.sleep(seconds)
    return 100 * (sum(map(cpu_s, pids)) - before_s) / (time.monotonic() - begin_s)


def graded(folder: Path, options: argparse.Namespace) -> tuple[Table, list[Goal]]:
    """A test of ten simulated seconds on both graphs, in turn."""
    (folder / "driver.py").write_text(DRIVER, encoding="utf-8")
    (folder / "test_it.py").write_text(GRADED, encoding="utf-8")
    found: dict[str, dict[str, list[float]]] = {graph: {"start": [], "run": []} for graph in GRAPHS}
    command = [sys.executable, "-m", "pytest", "-q", "-s", "-p", "thymio_sim_ros.pytest_plugin", "test_it.py"]
    for _ in range(options.rounds):
        for graph, words in zip(GRAPHS, ([], ["--ros"]), strict=True):
            output = subprocess.run([*command, *words], cwd=folder, capture_output=True, text=True, check=True).stdout
            for way, took_s in re.findall(r"took (\w+) ([\d.]+)", output)[2:]:  # the first ones import and compile
                found[graph][way].append(float(took_s))
    rows = [
        [f"ros.{way}", *(times := [statistics.median(found[graph][way]) for graph in GRAPHS]), times[0] / times[1]]
        for way in ("start", "run")
    ]
    return Table(["ten simulated seconds graded, s", "embedded", "ROS 2", "ratio"], rows), [
        Goal(f"test of ten simulated seconds by ros.{way}", limit, statistics.median(found[GRAPHS[0]][way]), "s")
        for way, limit in (("start", MOST_START_S), ("run", MOST_RUN_S))
    ]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--seconds", type=float, default=4.0, help="seconds of each measurement")
    parser.add_argument("--rounds", type=int, default=3, help="rounds; the figures are their medians")
    parser.add_argument("--rates", type=int, nargs="+", default=[1, 100, 1000], help="messages per second")
    parser.add_argument("--nodes", type=int, default=10, help="nodes over rosbridge")


def measure(options: argparse.Namespace) -> Report:
    """Measure all."""
    import rclpy  # noqa: F401  # the peer

    with tempfile.TemporaryDirectory() as name:
        parts = [
            within_a_process(options),
            first_messages(options),
            over_rosbridge(Path(name), options),
            graded(Path(name), options),
        ]
    return Report([table for table, _ in parts], [goal for _, goals in parts for goal in goals])
