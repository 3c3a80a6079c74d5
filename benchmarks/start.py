"""Start of the suite: seconds until it greets, and until another process gets its first odometry, and late starts.

`--order listener` starts a subscriber of odometry first, as a student whose node is running; `--order suite` starts it
when the suite has greeted, as `ros2 topic echo` in another terminal. The subscriber uses no DDS profile unless
`--profile` is given, which sets that of `thymio-sim env`. A start is late if discovery alone took more than LATE_S
since the participants of both processes existed: one that depends on the announcement period of Fast DDS takes up to
3 s. CPU seconds are those of the suite until it greets. Late starts are rare, hence the many starts with one robot.
Needs ROS.
"""

from __future__ import annotations

import argparse
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import rclpy
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.node import Node

from benchmarks.lib.processes import cpu_s
from benchmarks.lib.report import Goal, Report, Table
from benchmarks.lib.scenes import grid
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.rclpy_ext.node_runner import make_executor
from thymio_sim_ros.testing.ros.domain import reserved

QUICK = {"robots": [1, 2], "rounds": 1, "starts": 1}
MOST_GREETING_S = {100: 10.0}
SUITE = "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main(sys.argv[1:]))"
LISTENER = "import sys; from benchmarks.start import listen; listen(sys.argv[1])"
GREETING = "Stop "
LATE_S = 1.5
"""With load, discovery without a wait for an announcement takes up to 1 s; a wait of 3 s ends after 2 s on average."""
WAIT_S = 30.0
GAP_M = 0.4


def listen(topic: str) -> None:
    """Print the time at which this node exists, then that of the first odometry (0: none)."""
    context = Context()
    rclpy.init(args=[], context=context)
    node = Node("listener", context=context)
    executor = make_executor(context)
    executor.add_node(node)
    seen: list[float] = []
    node.create_subscription(Odometry, topic, lambda _message: seen.append(time.monotonic()), 10)
    print(time.monotonic(), flush=True)
    end = time.monotonic() + WAIT_S
    while not seen and time.monotonic() < end:
        executor.spin_once(timeout_sec=0.01)
    print(seen[0] if seen else 0.0, flush=True)
    context.try_shutdown()


def start_listener(robots: int, *, has_profile: bool) -> tuple[subprocess.Popen[str], float]:
    """Start a listener; return it with the time at which its node existed."""
    environment = dict(os.environ)
    if has_profile:
        environment[dds_profile.VARIABLE] = str(dds_profile.ANNOUNCING)
    topic = "/odom" if robots == 1 else "/r0/odom"
    command = [sys.executable, "-c", LISTENER, topic]
    listener = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
    assert listener.stdout is not None
    return listener, float(listener.stdout.readline())


def one_round(file: Path, robots: int, *, order: str, has_profile: bool) -> dict[str, float]:
    """Start both processes once; return seconds by name."""
    listener, ready = start_listener(robots, has_profile=has_profile) if order == "listener" else (None, 0.0)
    begin = time.monotonic()
    command = [sys.executable, "-u", "-c", SUITE, "--headless", "--playground", str(file)]
    suite = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert suite.stdout is not None
    while not suite.stdout.readline().startswith(GREETING):
        pass
    greeted, used = time.monotonic(), cpu_s(suite.pid)
    if listener is None:
        listener, ready = start_listener(robots, has_profile=has_profile)
    assert listener.stdout is not None
    first = float(listener.stdout.readline())
    suite.send_signal(signal.SIGTERM)
    suite.stdout.read()
    suite.wait()
    listener.wait()
    waited = first - max(greeted, ready) if first else WAIT_S
    return {
        "greeting_s": greeted - begin,
        "greeting_cpu_s": used,
        "first_odometry_s": first - (begin if order == "listener" else ready) if first else WAIT_S,
        "discovery_s": max(0.0, waited),
    }


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--robots", type=int, nargs="+", default=[1, 20, 100], help="numbers of robots")
    parser.add_argument("--rounds", type=int, default=5, help="starts with more than one robot")
    parser.add_argument("--starts", type=int, default=200, help="starts with one robot")
    parser.add_argument("--order", choices=("suite", "listener"), default="suite", help="which process starts first")
    parser.add_argument("--profile", action="store_true", help="the listener uses the profile of `thymio-sim env`")


def measure(options: argparse.Namespace) -> Report:
    """Measure all numbers of robots."""
    for variable in (dds_profile.VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE"):
        os.environ.pop(variable, None)
    rows: list[list[str | float]] = []
    goals = []
    late = 0
    for robots in options.robots:
        starts = [one_start(robots, options) for _ in range(options.starts if robots == 1 else options.rounds)]
        late += sum(one["discovery_s"] > LATE_S for one in starts)
        found = {name: [one[name] for one in starts] for name in starts[0]}
        for name, values in found.items():
            what = name.removesuffix("_s").replace("_", " ")
            count = "1 robot" if robots == 1 else f"{robots} robots"
            rows.append([f"{count}: {what}", statistics.median(values), max(values), len(values)])
        if robots in MOST_GREETING_S:
            greeting_s = statistics.median(found["greeting_s"])
            goals.append(Goal(f"{robots} robots, greeting", MOST_GREETING_S[robots], greeting_s, "s"))
    goals.append(Goal(f"late starts of {sum(int(row[-1]) for row in rows[:: len(found)])}", 0, late))
    return Report([Table(["seconds", "median", "worst", "starts"], rows)], goals)


def one_start(robots: int, options: argparse.Namespace) -> dict[str, float]:
    """Start once in a domain of its own, which no test that runs meanwhile uses."""
    with reserved(), tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "start.json"
        file.write_text(grid(robots, GAP_M))
        return one_round(file, robots, order=options.order, has_profile=options.profile)
