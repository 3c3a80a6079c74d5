"""Nodes of courses by `thymio-sim node`, unchanged, beside a suite: each one drives, or answers, a robot.

They are the examples, the node of the course, and typical ones of others. A client of rosbridge observes the robot.
"""

from __future__ import annotations

import json
import math
import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from websockets.sync.client import ClientConnection, connect

from tests.cli.ros.test_workspace import SETUP, make_package
from tests.patience import PATIENCE_S, PROGRAM_S, Deadline
from tests.processes import PYTHON, SUITE, Process, free_port, wait_for_port
from tests.syntax import ROOT
from thymio_sim_ros import examples

pytestmark = [pytest.mark.process, pytest.mark.slow]

EXAMPLES = Path(examples.__file__).parent
COURSE = ROOT / "docs" / "course" / "6-node"
OTHERS = ROOT / "tests" / "data" / "student_nodes"
GOAL = (0.2, 0.15)
TO_GOAL = ("--ros-args", "-p", f"goal_x:={GOAL[0]}", "-p", f"goal_y:={GOAL[1]}")
LAUNCH = {
    "py": """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("speed", default_value="0.0"),
        Node(package="lesson", executable="eight", parameters=[{"speed": LaunchConfiguration("speed")}],
             remappings=[("cmd_vel", "/lab/wish")]),
        Node(package="lesson", executable="relay", namespace="lab", output="screen"),
    ])
""",
    "xml": """
<launch>
  <arg name="speed" default="0.0"/>
  <node pkg="lesson" exec="eight">
    <param name="speed" value="$(var speed)"/>
    <remap from="cmd_vel" to="/lab/wish"/>
  </node>
  <node pkg="lesson" exec="relay" namespace="lab" output="screen"/>
</launch>
""",
    "yaml": """
launch:
- arg: {name: speed, default: "0.0"}
- node:
    pkg: lesson
    exec: eight
    param: [{name: speed, value: $(var speed)}]
    remap: [{from: cmd_vel, to: /lab/wish}]
- node: {pkg: lesson, exec: relay, namespace: lab, output: screen}
""",
}
"""The same launch file in each language, by the ending of its name."""
RELAY = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

def main():
    rclpy.init()
    node = Node("relay")
    wheels = node.create_publisher(Twist, "/cmd_vel", 10)
    node.create_subscription(Twist, "wish", wheels.publish, 10)
    rclpy.spin(node)
"""


class Client:
    """A client of rosbridge, which keeps the last message of each topic."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self.last: dict[str, Any] = {}
        self.poses: list[tuple[float, float, float]] = []
        self._answers: dict[str, Any] = {}
        self.send(op="subscribe", topic="/odom", type="nav_msgs/msg/Odometry")

    def send(self, **operation: Any) -> None:
        """Send an operation."""
        self._socket.send(json.dumps(operation))

    def call(self, service: str, **args: Any) -> Any:
        """The response of a service."""
        self.send(op="call_service", id=service, service=service, args=args)
        self._answers.pop(service, None)
        self.until(lambda: service in self._answers)
        return self._answers[service]

    def set(self, node: str, parameter: str, value: str) -> None:
        """Set a parameter that is a text."""
        values = {"name": parameter, "value": {"type": 4, "string_value": value}}
        answer = self.call(f"{node}/set_parameters", parameters=[values])
        assert answer["results"][0]["successful"], answer

    def until(self, holds: Callable[[], object], what: Callable[[], str] = lambda: "") -> None:
        """Receive until a condition holds; fails after `PATIENCE_S`."""
        deadline = Deadline()
        while not holds():
            assert not deadline.is_over, f"{what()} {self.last} {self._answers} {self.poses[-1:]}"
            try:
                received = json.loads(self._socket.recv(timeout=deadline.left_s / 100))
            except TimeoutError:
                continue
            if received["op"] == "service_response":
                self._answers[received["id"]] = received["values"]
            elif received["op"] == "publish":
                self.last[received["topic"]] = received["msg"]
                if received["topic"] == "/odom":
                    self.poses.append(_pose(received["msg"]))


def _pose(odometry: Any) -> tuple[float, float, float]:
    place, turn = odometry["pose"]["pose"]["position"], odometry["pose"]["pose"]["orientation"]
    return place["x"], place["y"], 2.0 * math.atan2(turn["z"], turn["w"])


@pytest.fixture(scope="module")
def port(tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    """The port of the bridge of a suite, with a robot without a program."""
    made = free_port()
    words = ("--no-web", "--program", "none", "--foxglove-port", str(made))
    suite = Process(tmp_path_factory.mktemp("suite"), SUITE, *words)
    try:
        wait_for_port(made)
        yield made
    finally:
        suite.end()


@pytest.fixture
def client(port: int) -> Iterator[Client]:
    with connect(f"ws://127.0.0.1:{port}/", open_timeout=PATIENCE_S, ping_interval=None, max_size=None) as socket:
        yield Client(socket)


@pytest.fixture
def start(port: int, tmp_path: Path) -> Iterator[Callable[..., Process]]:
    """Start `thymio-sim` with words, a member of the graph of the suite; at the end it is ended."""
    started: list[Process] = []

    def run(*words: str) -> Process:
        folder = tmp_path / str(len(started))
        folder.mkdir()
        started.append(Process(folder, SUITE, *words, variables={"THYMIO_SIM_CONNECT": f"ws://127.0.0.1:{port}"}))
        return started[-1]

    yield run
    for process in started:
        process.end()
        assert "Traceback" not in process.output.replace("KeyboardInterrupt", ""), process.output


def _in_world(client: Client, playground: str) -> None:
    """Begin with a new world, in which the robot has not moved."""
    client.set("/simulator", "playground", "desk")
    client.set("/simulator", "playground", playground)
    client.poses.clear()


def _moved(client: Client) -> bool:
    return any(math.hypot(x, y) > 0.1 for x, y, _ in client.poses)


def _at_goal(client: Client) -> bool:
    return any(math.dist((x, y), GOAL) < 0.03 for x, y, _ in client.poses)


def _drew_an_eight(client: Client) -> bool:
    return max(y for _, y, _ in client.poses) > 0.1 and min(y for _, y, _ in client.poses) < -0.1


@pytest.mark.parametrize(
    ("file", "words", "playground", "is_done"),
    [
        (EXAMPLES / "line_follower.py", (), "line", _moved),
        (EXAMPLES / "wall_follower.py", (), "base", _moved),
        (EXAMPLES / "go_to_goal_odom.py", TO_GOAL, "borderless", _at_goal),
        (EXAMPLES / "go_to_goal_tf.py", TO_GOAL, "borderless", _at_goal),
        (COURSE / "programs" / "solution.py", (), "line", _moved),
        (OTHERS / "eight.py", ("--ros-args", "-p", "radius:=0.06"), "borderless", _drew_an_eight),
    ],
    ids=lambda one: one.stem if isinstance(one, Path) else "",
)
def test_a_node_drives_the_robot(
    client: Client,
    start: Callable[..., Process],
    file: Path,
    words: tuple[str, ...],
    playground: str,
    is_done: Callable[[Client], bool],
) -> None:
    _in_world(client, playground)
    node = start("node", str(file), *words)
    client.until(lambda: client.poses and is_done(client), lambda: node.output)
    assert node.is_running


def test_an_action_server_turns_the_robot(client: Client, start: Callable[..., Process]) -> None:
    _in_world(client, "borderless")
    server = start("node", str(OTHERS / "turn_server.py"))
    asking = start("node", str(OTHERS / "turn_client.py"), "1.5")
    client.until(lambda: client.poses and client.poses[-1][2] > 1.4, lambda: server.output + asking.output)
    assert asking.wait() == 0
    assert asking.output.splitlines() == ["status 4, feedback True"]


@pytest.mark.parametrize(
    ("node", "sent", "message", "answered", "expected"),
    [
        (
            "button_lights",
            "/buttons/left std_msgs/msg/Bool",
            {"data": True},
            "/led/circle std_msgs/msg/Float32MultiArray",
            [0, 0, 0, 0, 0, 0, 1, 0],
        ),
        (
            "event_answer",
            "/aseba/events/where std_msgs/msg/Int16MultiArray",
            {"data": []},
            "/aseba/emit/here std_msgs/msg/Int16MultiArray",
            [0, 0],
        ),
    ],
)
def test_a_node_answers(
    client: Client,
    start: Callable[..., Process],
    node: str,
    sent: str,
    message: Any,
    answered: str,
    expected: list[float],
) -> None:
    _in_world(client, "base")
    topic, kind = sent.split()
    answer, answer_kind = answered.split()
    client.send(op="subscribe", topic=answer, type=answer_kind)
    client.send(op="advertise", topic=topic, type=kind)
    process = start("node", str(EXAMPLES / f"{node}.py"))

    def has_answered() -> bool:
        client.send(op="publish", topic=topic, msg=message)
        return answer in client.last

    client.until(has_answered, lambda: process.output)
    assert client.last[answer]["data"] == expected


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package with two programs and launch files; it is the current folder."""
    scripts = '["eight = lesson.eight:main", "relay = lesson.relay:main"]'
    lesson = make_package(tmp_path / "my workspace" / "src" / "lesson", setup=SETUP % scripts)
    (lesson / "lesson").mkdir()
    (lesson / "lesson" / "__init__.py").touch()
    shutil.copy(OTHERS / "eight.py", lesson / "lesson")
    (lesson / "lesson" / "relay.py").write_text(RELAY, encoding="utf-8")
    (lesson / "launch").mkdir()
    for ending, text in LAUNCH.items():
        (lesson / "launch" / f"both.launch.{ending}").write_text(text.lstrip(), encoding="utf-8")
    monkeypatch.chdir(lesson.parents[1])
    return lesson.parents[1]


def _has_tools() -> bool:
    command = [PYTHON, "-c", "import sys; from importlib.util import find_spec; sys.exit(not find_spec('ros2launch'))"]
    return subprocess.run(command, capture_output=True, timeout=PROGRAM_S, check=False).returncode == 0


@pytest.mark.parametrize("ending", LAUNCH)
def test_a_launch_file_drives_the_robot(
    client: Client, start: Callable[..., Process], workspace: Path, ending: str
) -> None:
    if not _has_tools():
        pytest.skip("the tools of ROS 2 are not installed there (thymio-sim ros2 --install)")
    _in_world(client, "borderless")
    launch = start("ros2", "launch", "lesson", f"both.launch.{ending}", "speed:=0.1")
    client.until(lambda: client.poses and _moved(client), lambda: launch.output)
    names = client.call("/rosapi/nodes")["nodes"]
    assert {"/eight", "/lab/relay"} <= set(names)
    launch.interrupt()
    launch.wait()
    client.until(lambda: not {"/eight", "/lab/relay"} & set(client.call("/rosapi/nodes")["nodes"]))
