"""From `cmd_vel` to the first odometry that shows it, between processes: p50, p90, p99 and the longest, in ms.

Run: PYTHONPATH=. python benchmarks/ros_latency.py [--commands N] [--robots N] [--json FILE].
A command that comes at any moment takes effect in the tick that follows, at most 10 ms later; what is beyond is the way
there and back. Two ways to send odometry are measured: with every tick, and at the usual 20 Hz, where the next message
alone takes up to 50 ms. Other work on the machine lengthens the tail: the load is printed, and what the way alone
takes, through a node that echoes.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import statistics
import tempfile
import time
from pathlib import Path

import rclpy
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.node import Node

from benchmarks.ros_load import DOMAIN, NODE, START_S, playground, process
from thymio_sim_ros.ros.rclpy_ext.node_runner import make_executor

SPEEDS_M_S = (0.05, 0.1)
CHANGED_M_S = 0.01
PAUSE_S = (0.06, 0.12)
LOST_S = 5.0
ECHO = "an echo, no simulator"
ECHOING = "import sys; from benchmarks.ros_latency import echo; echo()"
RATES = {ECHO: 0.0, "every tick": -1.0, "20 Hz": 20.0}
ALLOWED_MS = 12.0
"""One tick and 2 ms: at most this in 99 of 100 with odometry in every tick."""


def echo() -> None:
    """Answer each command with odometry of its speed."""
    context = Context()
    rclpy.init(args=[], context=context)
    node = Node("echo", context=context, enable_rosout=False, start_parameter_services=False)
    publisher = node.create_publisher(Odometry, "/odom", 10)
    answer = Odometry()

    def take(message: Twist) -> None:
        answer.twist.twist = message
        publisher.publish(answer)

    node.create_subscription(Twist, "/cmd_vel", take, 1)
    executor = make_executor(context)
    executor.add_node(node)
    with contextlib.suppress(KeyboardInterrupt):
        while context.ok():
            executor.spin_once(timeout_sec=0.1)


class Asker:
    """The other process: tells a robot speeds in turn, and waits for the odometry that shows each."""

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


def measure(robots: int, rate_hz: float, count: int) -> list[float]:
    """Milliseconds of each command; pauses between them are random, so that they come at any phase of a tick."""
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "load.json"
        world.write_text(playground(robots), encoding="utf-8")
        values = (f"playground:={world}", f"odom_max_rate:={rate_hz}")
        simulator = [NODE, "--ros-args", *(part for value in values for part in ("-p", value))]
        with process(*(simulator if rate_hz else [ECHOING])):
            asker, pauses = Asker(robots), random.Random(1)
            asker.meet()
            waits = []
            for number in range(count):
                asker.rest(pauses.uniform(*PAUSE_S))
                waits.append(1000 * asker.ask(SPEEDS_M_S[number % 2]))
            asker.close()
    return waits[2:]  # the first ones fill caches and templates


def main() -> None:
    """Print a table, and all figures as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--commands", type=int, default=500)
    parser.add_argument("--robots", type=int, default=1)
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    os.environ.update(ROS_DOMAIN_ID=str(DOMAIN), ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
    found = []
    print("| odometry | p50, ms | p90 | p99 | longest | load |\n|---|---:|---:|---:|---:|---:|")
    for name, rate_hz in RATES.items():
        waits = sorted(measure(chosen.robots if rate_hz else 1, rate_hz, chosen.commands))
        one = {
            "odometry": name,
            "p50_ms": round(statistics.median(waits), 1),
            "p90_ms": round(waits[int(0.9 * len(waits))], 1),
            "p99_ms": round(waits[int(0.99 * len(waits))], 1),
            "longest_ms": round(waits[-1], 1),
            "load": round(os.getloadavg()[0], 1),
        }
        found.append(one)
        print("|", " | ".join(str(value) for value in one.values()), "|", flush=True)
    print(json.dumps({"allowed_ms": ALLOWED_MS, "robots": chosen.robots, "figures": found}))
    if chosen.json is not None:
        chosen.json.write_text(json.dumps(found, indent=2), encoding="utf-8")


if __name__ == "__main__":
    main()
