"""`thymio-sim ros2` as a process beside a suite on the embedded graph, with stand-ins of the tools.

They use what the tools use: the graph, the index of packages, and `lib/PACKAGE/NAME`. The tools themselves are tried in
tests/platforms/test_student_nodes.py, where they are installed.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cli.ros.test_workspace import SETUP, make_package
from tests.patience import PATIENCE_S, until
from tests.processes import PYTHON, Process, free_port, wait_for_port
from tests.syntax import ROOT
from thymio_sim_ros.portable_ros.rosbridge.server_kind import is_embedded

pytestmark = pytest.mark.process

FAKE_TOOLS = {
    "ros2cli/__init__.py": "",
    "ros2cli/cli.py": """\
import argparse, sys

def main(*, extension=None):
    parser = argparse.ArgumentParser()
    extension.add_arguments(parser, "ros2")
    return extension.main(parser=parser, args=parser.parse_args())
""",
    "ros2cli/command.py": """\
import argparse
import subprocess

def add_subparsers_on_demand(parser, cli_name, dest, group_name, hide_extensions=None, required=True):
    parser.add_argument("words", nargs=argparse.REMAINDER)
    parser.set_defaults(**{dest: Command()})

class Command:
    def main(self, *, parser, args):
        command, *words = args.words
        return getattr(self, command)(args, *words)

    def node(self, args, word):
        import rclpy
        rclpy.init()
        node = rclpy.create_node("_tool")
        print(args.no_daemon, "simulator" in node.get_node_names())
        rclpy.shutdown()
        return "said" if word == "fail" else 0

    def run(self, args, package, name, *words):
        from ament_index_python.packages import get_package_prefix
        return subprocess.run([f"{get_package_prefix(package)}/lib/{package}/{name}", *words]).returncode

    def pkg(self, args, verb, package):
        from ament_index_python.packages import get_package_prefix
        import os
        print(*os.listdir(f"{get_package_prefix(package)}/lib/{package}"))

    def interface(self, args, verb, name):
        from ament_index_python import get_resource
        package, form, short = name.split("/")
        listed, prefix = get_resource("rosidl_interfaces", package)
        print(f"{form}/{short}.{form}" in listed.splitlines())
        with open(f"{prefix}/share/{name}.{form}", encoding="utf-8") as file:
            print(file.read(), end="")

    def launch(self, args, *words):
        return subprocess.run(["ros2", "node", "list"]).returncode or 1
""",
    "ros2interface/__init__.py": "",
    "ros2launch/__init__.py": "",
    "ros2node/__init__.py": "",
    "ros2pkg/__init__.py": "",
    "ros2run/__init__.py": "",
}
DEFINITIONS = {
    "msg/Word.msg": "string text\n",
    "srv/Ask.srv": "string word\n---\nint32 count\n",
    "action/Say.action": "string word\n---\n---\nint32 said\n",
}
"""The interfaces of a package of the workspace, by their files."""
TALKER = """\
import sys
import rclpy
from ament_index_python.packages import get_package_share_directory
from lesson_messages.msg import Word
from rclpy.node import Node

def main():
    rclpy.init()
    node = Node("talker")
    node.declare_parameter("word", "")
    while "simulator" not in node.get_node_names():
        rclpy.spin_once(node, timeout_sec=0.1)
    message = Word(text=node.get_parameter("word").value)
    print(node.get_fully_qualified_name(), message.text, get_package_share_directory("lesson"))
    rclpy.shutdown()
    return 3
"""


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a suite with a robot without a program."""
    port = free_port()
    words = ("--portable", "--no-web", "--playground", "line", "--program", "none", "--foxglove-port", str(port))
    suite = Process(tmp_path_factory.mktemp("suite"), "thymio_sim_ros.cli.main", *words)
    wait_for_port(port)
    made = f"ws://127.0.0.1:{port}"
    until(lambda: is_embedded(made) is not None, lambda: suite.output)
    yield made
    suite.end()


@pytest.fixture(scope="module")
def tools(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the stand-ins."""
    folder = tmp_path_factory.mktemp("tools")
    for name, text in FAKE_TOOLS.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return folder


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A workspace whose folder has a space: two packages in Python, and one that needs CMake."""
    folder = tmp_path / "my workspace"
    lesson = make_package(folder / "src" / "lesson", setup=SETUP % '["talker = lesson.talker:main"]')
    (lesson / "lesson").mkdir()
    (lesson / "lesson" / "__init__.py").touch()
    (lesson / "lesson" / "talker.py").write_text(TALKER, encoding="utf-8")
    messages = make_package(
        folder / "src" / "course" / "lesson_messages", cmake="rosidl_generate_interfaces(lesson_messages msg/wrong.msg)"
    )
    for file, text in DEFINITIONS.items():
        (messages / file).parent.mkdir(exist_ok=True)
        (messages / file).write_text(text, encoding="utf-8")
    make_package(folder / "src" / "fast", cmake="add_executable(fast fast.cpp)")
    return folder


@pytest.fixture
def ros2(url: str, tools: Path, workspace: Path):
    """Run `thymio-sim ros2` in the workspace to its end."""

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        command = [PYTHON, "-m", "thymio_sim_ros", "ros2", *words]
        variables = {"PYTHONPATH": os.pathsep.join((str(tools), str(ROOT))), "THYMIO_SIM_CONNECT": url}
        return subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            timeout=PATIENCE_S,
            cwd=workspace,
            env={**os.environ, **variables},
        )

    return run


@pytest.mark.parametrize(("word", "code", "errors"), [("list", 0, ""), ("fail", 1, "said\n")])
def test_the_tools_run_on_the_graph_without_a_daemon(ros2, word: str, code: int, errors: str) -> None:
    done = ros2("node", word)
    assert (done.returncode, done.stdout, done.stderr) == (code, "True True\n", errors)


def test_run_starts_a_program_of_the_workspace_as_a_member_of_the_graph(ros2, workspace: Path) -> None:
    done = ros2("run", "lesson", "talker", "--ros-args", "-p", "word:=hello", "-r", "__ns:=/lab")
    assert done.stderr == "a line of setup.py\n"
    assert done.stdout == f"/lab/talker hello {workspace / 'src' / 'lesson'}\n"
    assert done.returncode == 3


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("lesson talkr", "src/lesson: found no program talkr, expected one of talker"),
        (
            "fast fast",
            "src/fast: found no program fast, expected a program in Python, but it has none; programs in C++ need an"
            " installed ROS 2",
        ),
    ],
)
def test_a_program_that_there_is_not_is_refused_with_those_that_there_are(
    ros2, workspace: Path, words: str, reason: str
) -> None:
    done = ros2("run", *words.split())
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1] == f"thymio-sim: ros2 run: {workspace}/{reason}"


def test_the_examples_are_programs_and_those_of_the_suite_say_that_it_is_there(ros2) -> None:
    done = ros2("run", "thymio_sim_ros", "simulator")
    assert done.returncode == 1
    assert "thymio-sim: simulator runs on an installed ROS 2 only" in done.stderr
    done = ros2("run", "thymio_sim_ros", "line_follower", "--ros-args", "-p", "speed:=wrong")
    assert "speed" in done.stderr
    assert done.returncode == 1


def test_packages_need_no_server(ros2) -> None:
    done = ros2("--connect", f"ws://127.0.0.1:{free_port()}", "pkg", "executables", "lesson")
    assert (done.returncode, done.stdout, done.stderr) == (0, "talker\n", "a line of setup.py\n")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("lesson_messages/msg/Word", "string text\n"),
        ("lesson_messages/srv/Ask", "string word\n---\nint32 count\n"),
        ("lesson_messages/action/Say", "string word\n---\n---\nint32 said\n"),
        ("std_msgs/msg/Bool", "bool data\n"),
        ("turtlesim/srv/Kill", "string name\n---\n"),
    ],
)
def test_interfaces_of_the_workspace_and_of_the_graph_are_in_the_index(ros2, name: str, text: str) -> None:
    done = ros2("--connect", f"ws://127.0.0.1:{free_port()}", "interface", "show", name)
    assert (done.returncode, done.stdout, done.stderr) == (0, f"True\n{text}", "")


def test_a_package_with_a_wrong_definition_is_left_out_with_the_reason(ros2, workspace: Path) -> None:
    wrong = workspace / "src" / "course" / "lesson_messages" / "msg" / "wrong.msg"
    wrong.write_text("string text\n", encoding="utf-8")
    done = ros2("interface", "show", "std_msgs/msg/Bool")
    assert (done.returncode, done.stdout) == (0, "True\nbool data\n")
    assert done.stderr == (
        f"thymio-sim ros2: {wrong}: found the name 'wrong', expected one such as AddThreeInts; the interfaces of"
        " lesson_messages are left out\n"
    )


def test_launched_processes_find_ros2_and_a_failed_launch_names_packages_that_need_a_build(ros2) -> None:
    done = ros2("launch", "lesson", "some.launch.py")
    assert (done.returncode, done.stdout) == (1, "True True\n")
    assert done.stderr.splitlines()[-1] == (
        "thymio-sim ros2 launch: without ROS 2, programs run in Python only; there are others in fast"
    )


@pytest.mark.parametrize(
    ("name", "code", "reason"),
    [
        ("turtle_teleop_key", 2, "turtle_teleop_key: found no terminal"),
        ("turtlesim_node", 1, "turtlesim_node: found no turtles, since nothing serves /spawn"),
    ],
)
def test_programs_of_a_package_that_a_profile_stands_for_are_there(ros2, name: str, code: int, reason: str) -> None:
    done = ros2("run", "turtlesim", name)
    assert done.stderr.splitlines()[-1].startswith(reason)
    assert done.returncode == code
