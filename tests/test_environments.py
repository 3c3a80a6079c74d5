"""Machines on which something is odd: the clock jumps, the network is missing (docs/reliability.md)."""

from __future__ import annotations

import asyncio
import shutil
import subprocess
import sys
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S, until

pytest.importorskip("rclpy")

from websockets.asyncio.client import connect

from tests.processes import SUITE, Process, free_port
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol import wire
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS

pytestmark = pytest.mark.process

DOMAIN = "54"
FAKETIME = next(iter(sorted(Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))), None)
LO_UP = """
import fcntl, os, socket, struct, sys
fcntl.ioctl(socket.socket(), 0x8914, struct.pack("16sh14x", b"lo", 1))
os.execvp(sys.argv[1], sys.argv[1:])
"""
"""Switches the interface lo on (SIOCSIFFLAGS), without multicast, and becomes the command that follows."""


def _can_unshare() -> bool:
    unshare = shutil.which("unshare")
    return (
        unshare is not None
        and subprocess.run([unshare, "-n", "true"], capture_output=True, check=False).returncode == 0
    )


needs_unshare = pytest.mark.skipif(not _can_unshare(), reason="needs the right to make a network namespace")


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Process]]:
    """Starts processes, and ends them after the test."""
    started: list[Process] = []

    def begin(*arguments: str, prefix: tuple[str, ...] = (), **variables: str) -> Process:
        folder = tmp_path / str(len(started))
        folder.mkdir()
        process = Process(folder, SUITE, *arguments, prefix=prefix, variables={"ROS_DOMAIN_ID": DOMAIN, **variables})
        started.append(process)
        return process

    yield begin
    for process in started:
        process.end()


def _until(condition: Callable[[], bool], process: Process) -> None:
    until(lambda: condition() or not process.is_running, lambda: process.output)
    assert process.is_running, process.output


async def _simulated_time_passes(port: int) -> None:
    """Wait until the stamps of odometry have advanced by half a second."""
    async with connect(f"ws://127.0.0.1:{port}", subprotocols=SUBPROTOCOLS, max_size=None) as client:
        first = None
        async for frame in client:
            match wire.decode_server(frame):
                case ms.Advertise(channels=channels):
                    wanted = tuple(ms.Subscription(one.id, one.id) for one in channels if one.topic == "/odom")
                    if wanted:
                        await client.send(wire.encode_client(ms.Subscribe(wanted)))
                case ms.MessageData(payload=payload):
                    stamp_s = int.from_bytes(payload[4:8], "little") + int.from_bytes(payload[8:12], "little") * 1e-9
                    first = stamp_s if first is None else first
                    if stamp_s - first > 0.5:
                        return


@pytest.mark.slow
@pytest.mark.skipif(FAKETIME is None, reason="needs libfaketime (apt install faketime)")
def test_the_suite_does_not_care_for_jumps_of_the_clock(start: Callable[..., Process], tmp_path: Path) -> None:
    offset = tmp_path / "offset"
    offset.write_text("+0\n")
    port, foxglove_port = free_port(), free_port()
    suite = start(
        "--port", str(port), "--foxglove-port", str(foxglove_port),
        LD_PRELOAD=str(FAKETIME), FAKETIME_TIMESTAMP_FILE=str(offset), FAKETIME_CACHE_DURATION="1",
        FAKETIME_DONT_FAKE_MONOTONIC="1", FAKETIME_DONT_RESET="1",
    )  # fmt: skip
    _until(lambda: "Stop" in suite.output, suite)
    for jump in ("+1d", "-1d", "+3650d", "-2d"):
        offset.write_text(f"{jump}\n")
        asyncio.run(asyncio.wait_for(_simulated_time_passes(foxglove_port), PATIENCE_S))
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=PATIENCE_S) as page:
            assert page.status == 200
    suite.end()
    assert suite.wait() == 0, suite.output


@needs_unshare
def test_without_a_network_interface_the_suite_starts_and_says_so(start: Callable[..., Process]) -> None:
    suite = start("--port", str(free_port()), "--foxglove-port", str(free_port()), prefix=("unshare", "-n"))
    _until(lambda: "Stop" in suite.output, suite)
    assert "Network   this computer cannot reach itself (Network is unreachable)" in suite.output
    suite.end()
    assert suite.wait() == 0, suite.output


@needs_unshare
def test_without_multicast_another_process_gets_topics(start: Callable[..., Process], tmp_path: Path) -> None:
    """With the interface lo alone, which has no multicast. Both processes share the namespace of a shell."""
    looker = tmp_path / "looker.py"
    looker.write_text(
        "import rclpy, sys\nfrom rosgraph_msgs.msg import Clock\nrclpy.init()\nnode = rclpy.create_node('looker')\n"
        "got = []\nnode.create_subscription(Clock, '/clock', got.append, 10)\n"
        "while not got:\n    rclpy.spin_once(node, timeout_sec=1)\nprint('got', len(got), flush=True)\n"
    )
    script = f'"$@" & {sys.executable} {looker}; kill -INT $!; wait $!'
    prefix = ("unshare", "-n", sys.executable, "-c", LO_UP, "sh", "-c", script, "sh")
    suite = start(
        "--port", str(free_port()), "--foxglove-port", str(free_port()), prefix=prefix,
        ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST",
    )  # fmt: skip
    _until(lambda: "got 1" in suite.output, suite)
    assert "cannot reach itself" not in suite.output
