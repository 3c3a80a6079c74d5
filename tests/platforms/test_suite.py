"""`thymio-sim` on a computer without ROS 2: page, Foxglove bridge, servers for other programs, Ctrl-C."""

from __future__ import annotations

import json
import struct
import subprocess
import sys
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from aseba_vm.protocol import PROTOCOL_VERSION
from aseba_vm.protocol import messages as aseba
from tests.bridge.studio import Studio, set_and_answer
from tests.network.aseba_client import AsebaClient
from tests.patience import PATIENCE_S, until
from tests.processes import SUITE, Process, free_port, wait_for_port
from thymio_sim_ros.bridge.protocol import messages as ms

pytestmark = pytest.mark.process

POSE_BYTES = 8 * (7 + 36 + 6 + 36)
"""Pose and twist with their covariances, at the end of an Odometry."""
FORWARD = "motor.left.target = 200\nmotor.right.target = 200"
"""A program as text, that drives."""
STAND = "motor.left.target = 0\nmotor.right.target = 0"


class Suite:
    """A running suite, and a client of its bridge."""

    def __init__(self, folder: Path) -> None:
        self.page, self.foxglove, self.tdm, self.tdm_ws, self.aseba = (free_port() for _ in range(5))
        options = {"--port": self.page, "--foxglove-port": self.foxglove, "--aseba-port": self.aseba}
        options |= {"--tdm-port": self.tdm, "--tdm-ws-port": self.tdm_ws}
        words = [word for option, port in options.items() for word in (option, str(port))]
        self.process = Process(folder, SUITE, "--program", "none", *words)

    def client(self) -> Studio:
        """A client of the bridge, once it listens."""
        wait_for_port(self.foxglove)

        def wait(condition: Callable[[], object], what: str = "") -> object:
            return until(condition, lambda: f"{what}; {self.process.output}")

        return Studio(self.foxglove, wait)


@pytest.fixture(scope="module")
def suite(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Suite]:
    """The suite of all tests of this module, on the graph that it chooses by itself."""
    running = Suite(tmp_path_factory.mktemp("suite"))
    try:
        wait_for_port(running.page)
        yield running
    finally:
        running.process.end()


def test_the_first_line_names_the_embedded_graph(suite: Suite) -> None:
    assert suite.process.output.startswith("ROS       embedded graph:")


def test_the_page_is_served(suite: Suite) -> None:
    with urllib.request.urlopen(f"http://127.0.0.1:{suite.page}/", timeout=PATIENCE_S) as answer:
        assert "<script" in answer.read().decode()
        assert answer.headers["Server"] == "thymio-sim"


def test_a_client_loads_a_program_that_drives(suite: Suite) -> None:
    with suite.client() as client:
        client.subscribe(1, "/odom")
        client.parameter("/aseba_runtime.script.source")
        set_and_answer(client, ms.Parameter("/aseba_runtime.script.source", FORWARD))
        _expect_motion(client)
        set_and_answer(client, ms.Parameter("/aseba_runtime.script.source", STAND))


def test_a_client_drives_with_messages(suite: Suite) -> None:
    twist = b"\x00\x01\x00\x00" + struct.pack("<6d", 0.1, 0, 0, 0, 0, 0)
    with suite.client() as client:
        client.subscribe(1, "/odom")
        client.channel("/odom")
        client.advertise(1, "/cmd_vel", "geometry_msgs/msg/Twist")
        client.send(ms.ClientMessageData(1, twist))
        _expect_motion(client)


def test_a_client_pauses_the_world(suite: Suite) -> None:
    with suite.client() as client:
        pause = client.service("/simulator/pause").id
        for number, is_paused in enumerate((True, False), start=1):
            client.send(ms.ServiceRequest(pause, number, "json", json.dumps({"data": is_paused}).encode()))
            assert json.loads(client.next(ms.ServiceResponse).payload)["success"]


def test_tdmclient_finds_the_robot(suite: Suite) -> None:
    pytest.importorskip("tdmclient", reason="needs tdmclient (pip install tdmclient)")
    wait_for_port(suite.tdm)
    command = [sys.executable, "-m", "tdmclient", "list", "--tdmaddr=127.0.0.1", f"--tdmport={suite.tdm}"]
    listed = subprocess.run(command, capture_output=True, text=True, check=True, timeout=PATIENCE_S).stdout
    assert "Simulated Thymio II" in listed


def test_an_aseba_client_finds_the_robot(suite: Suite) -> None:
    wait_for_port(suite.aseba)
    client = AsebaClient(suite.aseba)
    try:
        client.ask(aseba.ListNodes(source=0, version=PROTOCOL_VERSION), aseba.NodePresent)
    finally:
        client.close()


def test_an_ended_client_does_not_end_the_servers(suite: Suite) -> None:
    with suite.client() as client:
        client.subscribe(1, "/odom")
    with suite.client() as client:
        client.subscribe(1, "/odom")
        client.next(ms.MessageData)


def test_a_second_suite_on_the_same_ports_says_so(suite: Suite, tmp_path: Path) -> None:
    second = Process(tmp_path, SUITE, "--port", str(suite.page), "--foxglove-port", str(suite.foxglove))
    try:
        assert second.wait() == 2
    finally:
        second.end()
    (line,) = second.output.splitlines()
    assert f"port {suite.page} of the page: cannot listen on" in line


def test_ctrl_c_ends_the_suite_with_code_0(tmp_path: Path) -> None:
    running = Suite(tmp_path)
    try:
        with running.client() as client:
            client.subscribe(1, "/odom")
            client.next(ms.MessageData)
            running.process.interrupt()
            assert running.process.wait() == 0, running.process.output
    finally:
        running.process.end()
    assert "Traceback" not in running.process.output
    assert "internal error" not in running.process.output


def _expect_motion(client: Studio) -> None:
    client.received.clear()
    start = client.next(ms.MessageData).payload
    client.next(ms.MessageData, lambda message: message.payload[-POSE_BYTES:] != start[-POSE_BYTES:])
