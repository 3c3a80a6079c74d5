"""Service calls of one client while others flood the bridge.

One `thymio-sim` for each attack serves all clients. A quiet client calls `/simulator/get_poses` ten times a second:
first alone, then while attackers in another process run the attack of the row (`lib/bridge_attacks.py`). The table
shows the median and the slowest call of both phases, and the memory of the suite before, during and after the attack;
`lost` counts calls without an answer. The last row is the time that Ctrl-C takes during nine attacks at once.

Other work on the machine affects the figures: compare them with those of the row `none`. Needs ROS.
"""

from __future__ import annotations

import argparse
import contextlib
import math
import signal
import statistics
import subprocess
import sys
import time

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.serialization import serialize_message

from benchmarks.lib.bridge_attacks import ATTACKS, NAMES, POSES
from benchmarks.lib.bridge_client import Peer
from benchmarks.lib.processes import Suite, status_mb, suite
from benchmarks.lib.report import Cell, Goal, Report, Table

QUICK = {"attacks": ["calls", "ctrl-c"], "seconds": 0.5, "settle": 0.2}
CTRL_C = "ctrl-c"
PERIOD_S = 0.1
ROBOTS = 20
MOST_LONGER_S = 0.5
"""By so much the slowest call may be longer than alone."""
MOST_CTRL_C_S = 5.0


def latencies(peer: Peer, seconds: float) -> tuple[list[float], int]:
    """Return how long calls took in s, and how many had no answer."""
    durations: list[float] = []
    lost = 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            durations.append(peer.call(POSES, NAMES))
        except TimeoutError:
            lost += 1
        time.sleep(PERIOD_S)
    return durations, lost


def attacker(name: str, port: int) -> subprocess.Popen[bytes]:
    """Start a process that runs an attack."""
    return subprocess.Popen([sys.executable, "-m", "benchmarks.lib.bridge_attacks", name, str(port)])


def run(name: str, running: Suite, options: argparse.Namespace) -> tuple[list[Cell], float]:
    """Run one attack; return its row, and by how many seconds the slowest call was longer than alone."""
    port, pid = running.bridge_port, running.process.pid
    quiet = Peer(port)
    quiet.until(lambda: POSES in quiet.services, "service")
    before = status_mb(pid, "VmRSS")
    if name == "robots-20":
        spawn(quiet)
    alone, _ = latencies(quiet, options.seconds)
    process = attacker(name, port)
    try:
        time.sleep(options.settle)  # they connect
        durations, lost = latencies(quiet, options.seconds * (2 if name == "robots-20" else 1))
    except OSError:  # the quiet client lost its connection
        durations, lost = [], math.inf
    finally:
        process.kill()
        process.wait()
    peak = status_mb(pid, "VmRSS")
    if durations:
        with contextlib.suppress(OSError):
            latencies(quiet, options.settle)
    quiet.socket.close()
    slowest = max(durations, default=math.inf)
    times = [statistics.median(alone), max(alone), statistics.median(durations or [math.inf]), slowest]
    memory = [round(size) for size in (before, peak, status_mb(pid, "VmRSS"))]
    row = [f"`{name}`", *(1000 * seconds for seconds in times), lost, *memory]
    return row, math.inf if lost else slowest - max(alone)


def spawn(peer: Peer) -> None:
    """Add twenty robots."""
    for number in range(ROBOTS):
        place = ParameterValue(
            type=ParameterType.PARAMETER_DOUBLE_ARRAY,
            double_array_value=[0.05 + 0.12 * (number % 5), 0.05 + 0.12 * (number // 5), 0.0],
        )
        wish = SetParameters.Request(parameters=[Parameter(name=f"guest_{number}", value=place)])
        peer.call("/simulator/spawn", serialize_message(wish))


def ctrl_c_s(running: Suite, settle_s: float) -> float:
    """Return the seconds from Ctrl-C to the end of the suite during nine attacks at once."""
    names = ["calls", "set", "get", "advertise", "subscribe", "numbers", "tiny", "publish", "never-reads"]
    attackers = [attacker(name, running.bridge_port) for name in names]
    try:
        time.sleep(6 * settle_s)
        began = time.monotonic()
        running.process.signal(signal.SIGINT)
        running.process.wait()
        return time.monotonic() - began
    finally:
        for one in attackers:
            one.kill()
        for one in attackers:
            one.wait()


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    about = f"some of {', '.join([*ATTACKS, CTRL_C])}; default: all"
    parser.add_argument(
        "--attacks", nargs="+", choices=[*ATTACKS, CTRL_C], default=[*ATTACKS, CTRL_C], help=about, metavar="ATTACK"
    )
    parser.add_argument("--seconds", type=float, default=5.0, help="of each phase")
    parser.add_argument("--settle", type=float, default=1.0, help="seconds for the attackers to connect")


def measure(options: argparse.Namespace) -> Report:
    """Run all attacks."""
    rows, goals, longer_s = [], [], []
    for name in options.attacks:
        with suite("--no-web") as running:
            if name == CTRL_C:
                found_s = ctrl_c_s(running, options.settle)
                goals.append(Goal("Ctrl-C during nine attacks", MOST_CTRL_C_S, found_s, "s"))
            else:
                row, longer = run(name, running, options)
                rows.append(row)
                longer_s.append(longer)
    if longer_s:
        goals.append(Goal("slowest call, longer than alone", MOST_LONGER_S, max(longer_s), "s"))
    columns = ["attack", "alone, ms", "slowest", "attacked, ms", "slowest", "lost", "before, MB", "during", "after"]
    return Report([Table(columns, rows)], goals)
