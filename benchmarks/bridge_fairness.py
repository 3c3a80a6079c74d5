"""Service calls of one client while others flood the bridge: python benchmarks/bridge_fairness.py [NAME ...]

One `thymio-sim` serves all clients. A quiet client calls `/simulator/get_poses` ten times a second: first alone, then
while attackers in another process run the attack of the row (`bridge_attacks.py`). The table shows the median and the
slowest call of both phases, and the memory of the suite before and after; `lost` counts calls without an answer within
`ANSWER_S`. The last line is the time that Ctrl-C takes during nine attacks at once.

The goal: the slowest call takes at most 0.5 s longer than alone. Other work on the machine affects the figures: compare
them with those of the row `none`.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import bridge_attacks
from bridge_attacks import ATTACKS, NAMES, POSES
from bridge_peer import Peer
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.serialization import serialize_message

PERIOD_S = 0.1
ALONE_S = 4.0
ATTACK_S = 6.0
ROBOTS = 20


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


def rss_mb(process: int) -> float:
    """Return the memory of a process in MB."""
    for line in Path(f"/proc/{process}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024
    return 0.0


def row(name: str, port: int, process: int) -> str:
    """Measure one attack; return its row of the table."""
    quiet = Peer(port)
    quiet.until(lambda: POSES in quiet.services, "service")
    before = rss_mb(process)
    if name == "robots-20":
        spawn(quiet)
    alone, _ = latencies(quiet, ALONE_S)
    attackers = subprocess.Popen([sys.executable, bridge_attacks.__file__, name, str(port)])
    try:
        time.sleep(1.0)  # they connect
        durations, lost = latencies(quiet, ATTACK_S * (2 if name == "robots-20" else 1))
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
    slowest = max(durations, default=float("inf"))
    more = slowest - max(alone)
    return (
        f"{name:18} {1e3 * statistics.median(alone):7.1f} {1e3 * max(alone):7.1f} "
        f"{1e3 * statistics.median(durations or [0]):9.1f} {1e3 * slowest:9.1f} {lost:5d} "
        f"{'ok' if more <= 0.5 and not lost else 'SLOW':5} {before:6.0f} {peak:6.0f} {rss_mb(process):6.0f}"
        f"  ({time.monotonic() - began - 2.0:4.1f} s)"
    )


def spawn(peer: Peer) -> None:
    """Add twenty robots."""
    for number in range(ROBOTS):
        place = ParameterValue(
            type=ParameterType.PARAMETER_DOUBLE_ARRAY,
            double_array_value=[0.05 + 0.12 * (number % 5), 0.05 + 0.12 * (number // 5), 0.0],
        )
        wish = SetParameters.Request(parameters=[Parameter(name=f"guest_{number}", value=place)])
        peer.call("/simulator/spawn", serialize_message(wish))


@contextlib.contextmanager
def suite(port: int) -> Iterator[subprocess.Popen[bytes]]:
    """Run `thymio-sim` within this context."""
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
    """Return the seconds from Ctrl-C to the end of the suite during nine attacks at once."""
    names = ["calls", "set", "get", "advertise", "subscribe", "numbers", "tiny", "publish", "never-reads"]
    attackers = [subprocess.Popen([sys.executable, bridge_attacks.__file__, name, str(port)]) for name in names]
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
    options = parser.parse_args()
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
