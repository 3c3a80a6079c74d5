"""From `cmd_vel` to the first odometry that shows it, between processes: quantiles in ms.

A command that comes at any moment takes effect in the tick that follows, at most 10 ms later; the rest is the way there
and back. Two ways to send odometry are measured: with every tick, and at the usual 20 Hz, where the next message alone
takes up to 50 ms. Other work on the machine lengthens the tail: a node that echoes shows what the way alone takes.
Needs ROS.
"""

from __future__ import annotations

import argparse
import random
import signal
import statistics
import tempfile
import time
from pathlib import Path

import rclpy
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from benchmarks.lib.processes import child
from benchmarks.lib.report import Goal, Report, Table
from benchmarks.lib.scenes import grid
from thymio_sim_ros.ros.rclpy_ext.node_runner import make_executor

QUICK = {"commands": 5}
GAP_M = 0.4
START_S = 120.0
SPEEDS_M_S = (0.05, 0.1)
CHANGED_M_S = 0.01
PAUSE_S = (0.06, 0.12)
LOST_S = 5.0
ECHO = "an echo, no simulator"
QUIET = ["--ros-args", "--log-level", "warn"]
NODE = "import sys; from thymio_sim_ros.ros.simulator.node import main; sys.exit(main())"
ECHOING = "import sys; from benchmarks.ros_latency import echo; echo()"
EVERY_TICK = "every tick"
RATES = {ECHO: 0.0, EVERY_TICK: -1.0, "20 Hz": 20.0}
ALLOWED_MS = 12.0
"""One tick and 2 ms: at most this in 99 of 100 with odometry in every tick."""


def echo() -> None:
    """Answer each command with odometry of its speed, until SIGINT."""
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    node = Node("echo", context=context, enable_rosout=False, start_parameter_services=False)
    publisher = node.create_publisher(Odometry, "/odom", 10)
    answer = Odometry()

    def take(message: Twist) -> None:
        answer.twist.twist = message
        publisher.publish(answer)

    node.create_subscription(Twist, "/cmd_vel", take, 1)
    ended: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _frame: ended.append(number))
    executor = make_executor(context)
    executor.add_node(node)
    while not ended:
        executor.spin_once(timeout_sec=0.1)


class Asker:
    """The other process: commands two speeds in turn, and waits for the odometry that shows each."""

    def __init__(self, robots: int) -> None:
        self.context = Context()
        rclpy.init(args=[], context=self.context)
        self.node = Node("asker", context=self.context, enable_rosout=False, start_parameter_services=False)
        self.executor = make_executor(self.context)
        self.executor.add_node(self.node)
        space = "" if robots == 1 else "/r0"
        self.publisher = self.node.create_publisher(Twist, f"{space}/cmd_vel", 1)
        self.node.create_subscription(Odometry, f"{space}/odom", self._take, 10)
        self._wanted = SPEEDS_M_S[0]
        self._seen_s = 0.0
        self.messages = 0

    def _take(self, message: Odometry) -> None:
        self.messages += 1
        if not self._seen_s and abs(message.twist.twist.linear.x - self._wanted) < CHANGED_M_S:
            self._seen_s = time.monotonic()

    def meet(self) -> None:
        """Wait until commands and odometry get through."""
        end = time.monotonic() + START_S
        while not self.messages:
            if time.monotonic() > end:
                raise TimeoutError("no odometry")
            self.publisher.publish(Twist())
            self.executor.spin_once(timeout_sec=0.1)

    def ask(self, speed_m_s: float) -> float:
        """Seconds until the odometry has this speed."""
        self._wanted, self._seen_s = speed_m_s, 0.0
        begin = time.monotonic()
        self.publisher.publish(Twist(linear=Vector3(x=speed_m_s), angular=Vector3(z=1.0)))
        while not self._seen_s:
            if time.monotonic() - begin > LOST_S:
                raise TimeoutError("a command had no effect")
            self.executor.spin_once(timeout_sec=0.1)
        return self._seen_s - begin

    def rest(self, seconds: float) -> None:
        """Take what comes for a while."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            self.executor.spin_once(timeout_sec=left)

    def close(self) -> None:
        """Leave the graph."""
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()


def run(robots: int, rate_hz: float, count: int) -> list[float]:
    """Milliseconds of each command; pauses between them are random, so that they come at any phase of a tick."""
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "load.json"
        world.write_text(grid(robots, GAP_M), encoding="utf-8")
        values = (f"playground:={world}", f"odom_max_rate:={rate_hz}")
        simulator = [NODE, *QUIET, *(part for value in values for part in ("-p", value))]
        with child(*(simulator if rate_hz else [ECHOING])):
            asker, pauses = Asker(robots), random.Random(1)
            asker.meet()
            waits = []
            for number in range(count):
                asker.rest(pauses.uniform(*PAUSE_S))
                waits.append(1000 * asker.ask(SPEEDS_M_S[number % 2]))
            asker.close()
    return waits[2:]  # the first ones fill caches and templates


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--commands", type=int, default=500, help="commands for each row")
    parser.add_argument("--robots", type=int, default=1, help="robots in the world; one is commanded")


def measure(options: argparse.Namespace) -> Report:
    """Measure the echo and both rates."""
    rows, goals = [], []
    for name, rate_hz in RATES.items():
        waits = sorted(run(options.robots if rate_hz else 1, rate_hz, options.commands))
        p99 = waits[int(0.99 * len(waits))]
        rows.append([name, statistics.median(waits), waits[int(0.9 * len(waits))], p99, waits[-1]])
        if name == EVERY_TICK:
            goals.append(Goal("99th percentile, every tick", ALLOWED_MS, p99, "ms"))
    return Report([Table(["odometry; ms", "p50", "p90", "p99", "longest"], rows)], goals)
