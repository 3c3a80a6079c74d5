"""A run of the suite on rclpy and on the embedded graph: the same messages on every topic, in order, bit for bit."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.patience import PROGRAM_S
from thymio_sim_ros.portable_ros.messages import cdr
from thymio_sim_ros.portable_ros.messages.message_class import message_type

SCRIPT = Path(__file__).parent.parent / "recorded_run.py"
REAL: tuple[str, ...] = ()
EMBEDDED = ("-m", "thymio_sim_ros.portable_ros")

LOG, EVENTS, NETWORK = "/rosout", "/parameter_events", "/_aseba/network"
ROBOTS = ("red", "blue", "late")
Messages = dict[str, list[tuple[str, bytes]]]
"""The messages of each topic, as text and as the bytes that the embedded graph writes."""


pytestmark = [pytest.mark.process, pytest.mark.usefixtures("ros_domain")]


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The run log of the embedded graph, once a test has recorded it."""
    return tmp_path_factory.mktemp("run") / "ours.jsonl"


def test_a_run_has_the_same_messages_and_the_same_log_on_both_graphs(log: Path, tmp_path: Path) -> None:
    real_log = tmp_path / "real.jsonl"
    ours = _messages(EMBEDDED, "record", log)
    _compare(ours, _messages(REAL, "record", real_log))
    assert log.read_bytes() == real_log.read_bytes()
    heard = {_word(topic) for topic, messages in ours.items() if messages}
    assert {_word(topic) for topic in ours} == heard, "each topic of a robot or the world has a message"


@pytest.mark.slow
def test_its_replay_has_the_same_messages_on_both_graphs(log: Path) -> None:
    if not log.exists():
        _messages(EMBEDDED, "record", log)
    shown = _messages(EMBEDDED, "replay", log)
    _compare(shown, _messages(REAL, "replay", log))
    assert shown["/late/odom"], "the robot that came in the recorded run"


def _messages(graph: tuple[str, ...], action: str, log: Path) -> Messages:
    """The messages of a run in a process of its own."""
    command = [sys.executable, *graph, str(SCRIPT), action, str(log)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PROGRAM_S)
    assert done.returncode == 0, done.stderr
    found: Messages = {}
    for topic, one in json.loads(done.stdout).items():
        messages = [cdr.deserialize(bytes.fromhex(data), message_type(one["type"])) for data in one["messages"]]
        found[topic] = [(repr(message), cdr.serialize(message)) for message in _comparable(topic, messages)]
    return found


def _comparable(topic: str, messages: list[Any]) -> list[Any]:
    """The messages without what differs from run to run."""
    if topic in (LOG, EVENTS):
        for message in messages:
            message.stamp = type(message.stamp)()  # the time of day
    if topic == NETWORK:
        for message in messages:
            message.layout.dim[-1].label = ""  # a random name of the runtime
    # rcl publishes the lines of each node by a publisher of its own, and promises no order among several
    return sorted(messages, key=lambda line: line.name) if topic == LOG else messages


def _compare(ours: Messages, real: Messages) -> None:
    assert ours.keys() == real.keys()
    for topic, messages in ours.items():
        assert messages == real[topic], topic


def _word(topic: str) -> str:
    """A topic without the name of its robot."""
    robot, _, word = topic.removeprefix("/").partition("/")
    return word if robot in ROBOTS else topic
