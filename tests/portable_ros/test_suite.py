"""The suite runs unchanged on the embedded graph: bridge, simulator and Aseba runtime in a process without ROS."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import pytest

from tests.bridge.studio import Studio, set_and_answer
from tests.patience import until
from tests.processes import Process, free_port, wait_for_port
from thymio_sim_ros.bridge.protocol import messages as ms

pytestmark = pytest.mark.process

POSE_BYTES = 8 * (7 + 36 + 6 + 36)
"""Pose and twist with their covariances, at the end of an Odometry."""


def test_the_suite_is_driven_by_a_program_and_a_client(tmp_path: Path) -> None:
    port = free_port()
    words = ("-m", "thymio_sim_ros", "--no-web", "--no-aseba", "--no-tdm", "--foxglove-port", str(port))
    suite = Process(tmp_path, "thymio_sim_ros.portable_ros.__main__", *words)
    try:
        wait_for_port(port)
        with Studio(port, lambda condition, what="": until(condition, lambda: f"{what}; {suite.output}")) as client:
            pause = client.service("/simulator/pause").id
            client.subscribe(1, "/odom")
            client.next(ms.MessageData)
            program = "motor.left.target = 200\nmotor.right.target = 200"
            client.parameter("/aseba_runtime.script.source")
            set_and_answer(client, ms.Parameter("/aseba_runtime.script.source", program))
            start = client.next(ms.MessageData).payload
            client.next(ms.MessageData, lambda message: message.payload[-POSE_BYTES:] != start[-POSE_BYTES:])
            client.send(ms.ServiceRequest(pause, 1, "json", json.dumps({"data": True}).encode()))
            assert json.loads(client.next(ms.ServiceResponse).payload)["success"]
        suite.signal(signal.SIGINT)
        assert suite.wait() == 0
        assert "WARN" not in suite.output
    finally:
        suite.end()
