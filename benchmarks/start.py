"""From the start of `thymio-sim` to its first odometry message in another process: wall and CPU seconds.

Discovery between processes is part of it and varies by itself (a participant seen late costs up to some seconds), hence
the median of several rounds. Needs ROS.
"""

from __future__ import annotations

import argparse
import resource
import signal
import statistics
import subprocess
import sys
import time

import rclpy
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.node import Node

from benchmarks.lib.report import Report, Table
from thymio_sim_ros.ros.rclpy_ext.node_runner import make_executor
from thymio_sim_ros.testing.ros.domain import reserved

QUICK = {"rounds": 1}
COMMAND = "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main(['--headless']))"


def one_round(domain: int) -> tuple[float, float]:
    """Seconds of wall time until the first message, and CPU seconds of the suite's whole short life."""
    context = Context()
    rclpy.init(args=[], context=context, domain_id=domain)
    node = Node("listener", context=context)
    executor = make_executor(context)
    executor.add_node(node)
    seen: list[float] = []
    node.create_subscription(Odometry, "/odom", lambda _message: seen.append(time.monotonic()), 10)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.monotonic()
    suite = subprocess.Popen([sys.executable, "-c", COMMAND], stdout=subprocess.DEVNULL)
    while not seen and time.monotonic() - begin < 30.0:
        executor.spin_once(timeout_sec=0.01)
    suite.send_signal(signal.SIGINT)
    suite.wait()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    executor.shutdown()
    node.destroy_node()
    context.try_shutdown()
    return seen[0] - begin, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--rounds", type=int, default=5, help="rounds; the figures are their medians")


def measure(options: argparse.Namespace) -> Report:
    """Measure the rounds."""
    measured = []
    for _ in range(options.rounds):
        with reserved() as domain:  # no test that runs meanwhile hears this suite
            measured.append(one_round(domain))
    walls, cpus = zip(*measured, strict=True)
    rows = [
        [name, statistics.median(found), min(found), max(found)]
        for name, found in (("first odometry, s", walls), ("CPU of the suite, s", cpus))
    ]
    return Report([Table(["", "median", "best", "worst"], rows)])
