"""Start of the suite: seconds until it greets, and until another process gets its first odometry, and late starts.

Run: PYTHONPATH=. python benchmarks/start.py [--robots N] [--rounds N] [--order ORDER] [--profile] [--quick]
[--json FILE].

`--order listener` starts a subscriber of odometry first, as a student whose node is running; `--order suite` starts it
when the suite has greeted, as `ros2 topic echo` in another terminal. The subscriber uses no DDS profile unless
`--profile` is given, which sets that of `thymio-sim env`. A start is late if discovery alone took more than LATE_S
since the participants of both processes existed: one that depends on the announcement period of Fast DDS takes up to
3 s. CPU seconds are those of the suite until it greets.
"""

from __future__ import annotations

import argparse
import json
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

from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.rclpy_ext.node_runner import make_executor
from thymio_sim_ros.testing.ros.domain import reserved

SUITE = "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main(sys.argv[1:]))"
LISTENER = "import sys; from benchmarks.start import listen; listen(sys.argv[1])"
GREETING = "Stop "
LATE_S = 1.5
"""With load, discovery without a wait for an announcement takes up to 1 s; a wait of 3 s ends after 2 s on average."""
WAIT_S = 30.0
GAP_M = 0.4


def playground(robots: int) -> str:
    """Robots on a square floor, so far apart that none sees another."""
    side = next(n for n in range(1, robots + 1) if n * n >= robots)
    size = side * GAP_M + 1.0
    middle = (side - 1) * GAP_M / 2
    starts = [
        {"name": f"r{n}", "x_m": n % side * GAP_M - middle, "y_m": n // side * GAP_M - middle} for n in range(robots)
    ]
    floor = {"kind": "rectangle", "name": "ground", "size_x_m": size, "size_y_m": size, "color": "#ffffff"}
    return json.dumps({"format": 1, "title": "Start", "shapes": [floor], "robots": starts})


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


def cpu_s(pid: int) -> float:
    """CPU seconds of a running process."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


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


def main() -> None:
    """Print the medians, and how many starts were late, as JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=1, help="default: 1")
    parser.add_argument("--rounds", type=int, default=5, help="default: 5")
    parser.add_argument("--order", choices=("listener", "suite"), default="listener", help="which process starts first")
    parser.add_argument("--profile", action="store_true", help="the listener uses the profile of `thymio-sim env`")
    parser.add_argument("--quick", action="store_true", help="one round")
    parser.add_argument("--json", type=Path, help="also write the result to this file")
    options = parser.parse_args()
    for variable in (dds_profile.VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE"):
        os.environ.pop(variable, None)
    rounds = []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "start.json"
        file.write_text(playground(options.robots))
        for _ in range(1 if options.quick else options.rounds):
            with reserved():  # no test that runs meanwhile hears this suite
                rounds.append(one_round(file, options.robots, order=options.order, has_profile=options.profile))
            print({name: round(value, 2) for name, value in rounds[-1].items()}, file=sys.stderr, flush=True)
    late = sum(one["discovery_s"] > LATE_S for one in rounds)
    result: dict[str, object] = {"robots": options.robots, "rounds": len(rounds), "late": late}
    for name in rounds[0]:
        values = [one[name] for one in rounds]
        result[name] = {"median": round(statistics.median(values), 2), "worst": round(max(values), 2)}
    print(json.dumps(result))
    if options.json is not None:
        options.json.write_text(json.dumps(result | {"all": rounds}))


if __name__ == "__main__":
    main()
