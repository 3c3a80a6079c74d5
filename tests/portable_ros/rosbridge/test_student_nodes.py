"""`thymio-sim node` beside a suite: nodes of students in a process of their own, as members of its graph."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.patience import until
from tests.portable_ros.rosbridge.memory_server import Program
from tests.processes import Process, free_port, wait_for_port
from thymio_sim_ros import examples
from thymio_sim_ros.portable_ros.messages.action_class import action_type
from thymio_sim_ros.portable_ros.messages.message_class import message_type
from thymio_sim_ros.portable_ros.rclpy.action import ActionClient
from thymio_sim_ros.portable_ros.rclpy.parameter import Parameter
from thymio_sim_ros.portable_ros.rclpy.parameter_client import AsyncParameterClient
from thymio_sim_ros.portable_ros.rosbridge.transport import RosbridgeTransport
from thymio_sim_ros.ros.foxglove import json_messages

pytestmark = pytest.mark.process

EXAMPLES = Path(examples.__file__).parent
COURSE = Path(__file__).parents[3] / "docs/course"
COURSE_NODES = sorted(path for path in COURSE.rglob("*.py") if "rclpy.spin" in path.read_text(encoding="utf-8"))
Bool, Int16MultiArray, Odometry, Twist, ColorRGBA = (
    message_type(name)
    for name in (
        "std_msgs/msg/Bool",
        "std_msgs/msg/Int16MultiArray",
        "nav_msgs/msg/Odometry",
        "geometry_msgs/msg/Twist",
        "std_msgs/msg/ColorRGBA",
    )
)
Fibonacci = action_type("test_msgs/action/Fibonacci")

ACTION_SERVER = """
import rclpy
from rclpy.action import ActionServer
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from test_msgs.action import Fibonacci

def execute(goal):
    sequence = [0, 1]
    for _ in range(goal.request.order):
        sequence.append(sequence[-1] + sequence[-2])
        goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
    goal.succeed()
    return Fibonacci.Result(sequence=sequence)

rclpy.init()
node = Node("counter")
ActionServer(node, Fibonacci, "fibonacci", execute)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
"""


class Lab:
    """A suite, nodes beside it, and an observer in this process."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.port = folder, free_port()
        self.processes: list[Process] = []
        self.observer = Program()
        self.transport = RosbridgeTransport(self.observer.graph, self.url, json_messages, print)
        self.node = self.observer.node("observer")

    @property
    def url(self) -> str:
        """The address of the suite."""
        return f"ws://127.0.0.1:{self.port}"

    def suite(self, playground: str) -> Process:
        """Start the suite with a robot without a program, and connect the observer."""
        words = ("--portable", "--no-web", "--playground", playground, "--program", "none")
        made = self._start("suite", *words, "--foxglove-port", str(self.port))
        wait_for_port(self.port)
        return made

    def program(self, file: Path, *words: str) -> Process:
        """Start a program of a student."""
        return self._start(file.stem, "node", str(file), "--connect", self.url, *words)

    def until(self, condition: Callable[[], Any]) -> None:
        """Execute callbacks of the observer until a condition is true."""

        def is_true() -> Any:
            self.observer.executor.spin_once(timeout_sec=0.01)
            return condition()

        until(is_true, lambda: [one.output for one in self.processes], every_s=0)

    def observe(self, kind: Any, topic: str) -> list[Any]:
        """The messages of a topic from now on."""
        found: list[Any] = []
        self.node.create_subscription(kind, topic, found.append, 10)
        return found

    def end(self) -> None:
        """End all processes."""
        if self.transport._thread.is_alive():
            self.transport.close()
        for one in self.processes:
            one.end()

    def _start(self, name: str, *words: str) -> Process:
        folder = self.folder / f"{len(self.processes)}-{name}"
        folder.mkdir()
        self.processes.append(Process(folder, "thymio_sim_ros.cli.main", *words))
        return self.processes[-1]


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Lab]:
    made = Lab(tmp_path)
    yield made
    made.end()


def _ends_cleanly(program: Process) -> None:
    program.interrupt()
    assert program.wait() == 0, program.output
    assert "Traceback" not in program.output
    assert "thymio-sim node:" not in program.output


DRIVERS = [
    pytest.param(EXAMPLES / "line_follower.py", "line"),
    *(
        pytest.param(EXAMPLES / f"{name}.py", "base", marks=pytest.mark.slow)
        for name in ("wall_follower", "go_to_goal_odom", "go_to_goal_tf")
    ),
    *(
        pytest.param(path, str(COURSE / "6-node/town.json"), marks=pytest.mark.slow, id=f"course-{path.stem}")
        for path in COURSE_NODES
    ),
]


def test_all_examples_and_nodes_of_the_course_are_tried() -> None:
    tried = {one.values[0] for one in DRIVERS} | {EXAMPLES / "button_lights.py", EXAMPLES / "event_answer.py"}
    assert tried == {*(path for path in EXAMPLES.glob("*.py") if path.stem != "__init__"), *COURSE_NODES}
    assert len(COURSE_NODES) >= 3


@pytest.mark.parametrize(("file", "playground"), DRIVERS)
def test_a_node_drives_the_robot_with_parameters_that_others_change(lab: Lab, file: Path, playground: str) -> None:
    lab.suite(playground)
    lab.transport.start()
    poses, commands = lab.observe(Odometry, "/odom"), lab.observe(Twist, "/cmd_vel")
    program = lab.program(file)
    lab.until(lambda: commands and poses and abs(poses[-1].pose.pose.position.x - poses[0].pose.pose.position.x) > 0.02)
    name = next(name for name in lab.node.get_node_names() if name not in ("observer", "simulator"))
    names = set(lab.node.get_node_names())
    assert names > {"observer", "simulator"}, name
    assert len(lab.node.get_publishers_info_by_topic("/cmd_vel")) == 1, "the node's own publisher only"
    _ends_cleanly(program)
    lab.until(lambda: len(lab.node.get_node_names()) == len(names) - 1)


@pytest.mark.slow
def test_an_example_answers_topics_of_other_nodes(lab: Lab) -> None:
    lab.suite("line")
    lab.transport.start()
    lights = lab.observe(ColorRGBA, "/led/body/top")
    buttons = lab.node.create_publisher(Bool, "/buttons/center", 10)
    program = lab.program(EXAMPLES / "button_lights.py")
    lab.until(lambda: "button_lights" in lab.node.get_node_names())

    def press() -> bool:
        buttons.publish(Bool(data=True))
        return bool(lights)

    lab.until(press)
    _ends_cleanly(program)


@pytest.mark.slow
def test_an_example_answers_events_of_programs(lab: Lab) -> None:
    lab.suite("line")
    lab.transport.start()
    answers = lab.observe(Int16MultiArray, "/aseba/emit/here")
    events = lab.node.create_publisher(Int16MultiArray, "/aseba/events/where", 10)
    program = lab.program(EXAMPLES / "event_answer.py")

    def ask() -> bool:
        events.publish(Int16MultiArray())
        return bool(answers)

    lab.until(ask)
    assert len(answers[0].data) == 2
    _ends_cleanly(program)


def test_parameters_and_actions_of_a_node_are_used_from_another_process(lab: Lab) -> None:
    lab.suite("line")
    lab.transport.start()
    (lab.folder / "counter.py").write_text(ACTION_SERVER, encoding="utf-8")
    program = lab.program(lab.folder / "counter.py", "--ros-args", "-r", "__node:=tally")
    parameters, action = AsyncParameterClient(lab.node, "/tally"), ActionClient(lab.node, Fibonacci, "/fibonacci")
    lab.until(lambda: parameters.services_are_ready() and action.server_is_ready())
    setting = parameters.set_parameters([Parameter("use_sim_time", value=True)])
    lab.until(setting.done)
    assert setting.result().results[0].successful
    feedback: list[Any] = []
    goal = action.send_goal_async(Fibonacci.Goal(order=3), feedback.append)
    lab.until(goal.done)
    result = goal.result().get_result_async()
    lab.until(result.done)
    assert list(result.result().result.sequence) == [0, 1, 1, 2, 3]
    lab.until(lambda: len(feedback) == 3)
    action.destroy()
    _ends_cleanly(program)


def test_a_node_drives_again_after_the_suite_was_started_again(lab: Lab) -> None:
    program = lab.program(EXAMPLES / "line_follower.py")
    until(lambda: "no server at" in program.output)
    for turn in range(2):
        suite = lab.suite("line")
        if turn == 0:
            lab.transport.start()
        lab.until(lambda: lab.transport.is_connected)
        commands = lab.observe(Twist, "/cmd_vel")
        lab.until(lambda commands=commands: commands)  # type: ignore[misc]
        suite.end()
        lab.until(lambda: not lab.transport.is_connected)
    assert program.is_running
    assert program.output.count("no server at") == 1
    assert program.output.count("connected to") == 2
    until(lambda: program.output.count("lost") == 2)
    program.interrupt()
    assert program.wait() == 0


def test_ctrl_c_ends_the_wait_for_a_server_at_once(lab: Lab) -> None:
    program = lab.program(EXAMPLES / "line_follower.py")
    until(lambda: "no server at" in program.output)
    program.interrupt()
    assert program.wait() != 0
    assert "Traceback" not in program.output
