"""`thymio-sim topic`, `record`, `play`, `doctor` and others as processes beside a suite on the embedded graph."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from rosbags.highlevel import AnyReader

from tests.patience import PATIENCE_S, until
from tests.processes import PYTHON, Process, free_port, wait_for_port
from tests.systems import posix
from thymio_sim_ros import examples
from thymio_sim_ros.cli import main
from thymio_sim_ros.portable_ros.rosbridge.server_kind import is_embedded

pytestmark = pytest.mark.process

MAIN = "thymio_sim_ros.cli.main"


@pytest.fixture(scope="module")
def port(tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    """The port of a suite with a robot without a program."""
    made = free_port()
    words = ("--portable", "--no-web", "--playground", "line", "--program", "none", "--foxglove-port", str(made))
    suite = Process(tmp_path_factory.mktemp("suite"), MAIN, *words)
    wait_for_port(made)
    until(lambda: is_embedded(f"ws://127.0.0.1:{made}") is not None, lambda: suite.output)
    yield made
    suite.end()


def run(port: int, *words: str) -> subprocess.CompletedProcess[str]:
    """Run a command to its end."""
    command = [PYTHON, "-m", "thymio_sim_ros", *words, "--connect", f"ws://127.0.0.1:{port}"]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE_S)


def test_a_command_is_a_member_of_the_graph_of_the_suite(port: int) -> None:
    assert is_embedded(f"ws://127.0.0.1:{port}")
    done = run(port, "topic", "echo", "--once", "/odom", "--field", "child_frame_id")
    assert (done.returncode, done.stdout, done.stderr) == (0, "base_link\n---\n", "")
    done = run(port, "node", "list")
    assert (done.stdout.splitlines(), done.stderr) == (["/aseba_runtime", "/foxglove_bridge", "/simulator"], "")
    done = run(port, "topic", "info", "/odm")
    assert (done.returncode, done.stderr) == (
        1,
        "thymio-sim topic info: found no topic /odm; did you mean /odom?\n",
    )


@posix
@pytest.mark.parametrize("verb", ["echo", "hz", "bw"])
def test_ctrl_c_ends_a_command_silently(port: int, verb: str, tmp_path: Path) -> None:
    words = ("topic", verb, "/odom", "--connect", f"ws://127.0.0.1:{port}")
    command = Process(tmp_path, MAIN, *words)
    until(lambda: command.output.count("\n") > 2, lambda: command.output)
    command.interrupt()
    assert command.wait() == 0
    assert not {"Traceback", "thymio-sim", "Interrupt"} & set(command.output.split())


@posix
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_bag_is_recorded_until_a_signal_and_played(port: int, number: int, tmp_path: Path) -> None:
    url = f"ws://127.0.0.1:{port}"
    recorder = Process(tmp_path, MAIN, "record", "-o", str(tmp_path / "drive"), "/odom", "--connect", url)
    until(lambda: "Recording to" in recorder.output and _subscribers(port, "/odom"), lambda: recorder.output)
    run(port, "topic", "echo", "--once", "/odom")
    recorder.signal(number)
    recorder.signal(number)
    assert recorder.wait() == 0, recorder.output
    with AnyReader([tmp_path / "drive"]) as reader:
        assert [one.topic for one in reader.connections] == ["/odom"]
        count = reader.message_count
    assert f"Recorded {count} messages of 1 topics" in recorder.output
    done = run(port, "play", str(tmp_path / "drive"), "--rate", "100", "--delay", "0")
    assert (done.stdout.splitlines()[-1], done.stderr) == (f"Played {count} messages.", "")


def _subscribers(port: int, topic: str) -> bool:
    return "Subscription count: 1" in run(port, "topic", "info", topic).stdout


def test_the_doctor_sees_nodes_of_other_programs(port: int, tmp_path: Path) -> None:
    url = f"ws://127.0.0.1:{port}"
    follower = Path(examples.__file__).with_name("line_follower.py")
    student = Process(tmp_path, MAIN, "node", str(follower), "--connect", url)
    try:
        until(lambda: "/line_follower" in run(port, "node", "list").stdout, lambda: student.output)
        done = run(port, "doctor")
    finally:
        student.end()
    assert f"robots: one without a name; the embedded graph of {url}" in done.stdout
    assert "    from /line_follower to /simulator; " in done.stdout


@pytest.mark.parametrize("words", ["topic list", "doctor", "node info /simulator"])
def test_without_a_server_a_command_says_so_at_once(words: str, capsys: pytest.CaptureFixture[str]) -> None:
    url = f"ws://127.0.0.1:{free_port()}"
    command = [sys.executable, "-m", "thymio_sim_ros", *words.split(), "--connect", url]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE_S)
    assert (done.returncode, done.stdout) == (2, "")
    assert f": found no server at {url} (" in done.stderr
    assert done.stderr.endswith("expected one: start `thymio-sim`, or give its address\n")


def test_wrong_words_are_refused_with_the_verbs(capsys: pytest.CaptureFixture[str]) -> None:
    for words in (["topic", "lst"], ["param"], ["topic", "hz", "/odom", "--window", "0"]):
        with pytest.raises(SystemExit) as end:
            main.main(words)
        assert end.value.code == 2
    errors = capsys.readouterr().err
    assert "invalid choice: 'lst'" in errors
    assert "found 0, expected a number above 0" in errors
