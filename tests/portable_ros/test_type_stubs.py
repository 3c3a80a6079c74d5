"""The stubs for mypy have the fields, values and modules that programs find at run time."""

from __future__ import annotations

import array
import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.patience import PATIENCE_S
from tests.syntax import ROOT
from thymio_sim_ros.portable_ros.messages.interface_files import PACKAGES, interfaces, messages
from thymio_sim_ros.portable_ros.messages.message_class import message_type
from thymio_sim_ros.portable_ros.type_stubs import stubs, write

KINDS = {"NDArray": np.ndarray, "array": array.array, "list": list, "int": int, "float": float, "bool": bool}
KINDS |= {"str": str, "bytes": bytes}

PROGRAM = """
import rclpy
from example_interfaces.action import Fibonacci
from geometry_msgs.msg import Twist, Vector3
from rclpy.action import ActionClient, ActionServer
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node
from std_msgs.msg import Bool, String
from std_srvs.srv import SetBool

def on_text(message: String) -> None: ...

def on_text_with_info(message: String, info: dict[str, int | None]) -> None: ...

def answer(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
    response.success = request.data
    return response

FibonacciGoal = ServerGoalHandle[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]

def execute(goal: FibonacciGoal) -> Fibonacci.Result:
    goal.publish_feedback(Fibonacci.Feedback(sequence=[goal.request.order]))
    goal.publish_feedback(Fibonacci.Result())  # wrong
    return Fibonacci.Result()

async def execute_later(goal: FibonacciGoal) -> Fibonacci.Result:
    return execute(goal)

def execute_without_result(goal: FibonacciGoal) -> None: ...

rclpy.init()
node = Node("checked")
ActionServer(node, Fibonacci, "right", execute)
ActionServer(node, Fibonacci, "right", execute_later)
ActionServer(node, Fibonacci, "wrong", execute_without_result)  # wrong
client = ActionClient(node, Fibonacci, "right")
client.send_goal_async(Fibonacci.Goal(order=3)).add_done_callback(lambda future: print(future.result()))
client.send_goal_async(Fibonacci.Result())  # wrong
node.create_subscription(String, "right", on_text, 10)
node.create_subscription(String, "right", on_text_with_info, 10)
node.create_service(SetBool, "right", answer)
twist = Twist()
twist.linear.x = 1.0
node.create_publisher(Twist, "right", 10).publish(twist)
node.create_subscription(Bool, "wrong", on_text, 10)  # wrong
node.create_subscription(Bool, "wrong", on_text_with_info, 10)  # wrong
node.create_subscription(String, "wrong", lambda message: message.dat, 10)  # wrong
node.create_publisher(Twist, "wrong", 10).publish(String())  # wrong
twist.linear.x = "fast"  # wrong
twist.linear.x = 1  # wrong
twist.linear = Vector3(x=1, y=0.0)  # wrong
twist.speed = 1.0  # wrong
"""


def _classes(package: str) -> Iterator[tuple[str, ast.ClassDef]]:
    """The stubs of all messages of a package, by their full names."""
    for path, text in stubs().items():
        folder, _, module = path.removesuffix(".pyi").partition("/")
        for node in ast.parse(text).body if folder == package else ():
            if isinstance(node, ast.ClassDef) and ast.unparse(node.bases[0]) == "Message":
                yield f"{package}/{module}/{node.name}", node


def _messages(package: str) -> Iterator[str]:
    for name in interfaces(package):
        yield from messages(f"{package}/{name}")


@pytest.mark.parametrize("package", sorted(PACKAGES))
def test_a_stub_has_the_fields_and_constants_of_its_class(package: str) -> None:
    for name, stub in _classes(package):
        message = message_type(name)()
        attributes = [one for one in stub.body if isinstance(one, ast.FunctionDef) and one.name != "__init__"]
        getters = [one for one in attributes if ast.unparse(one.decorator_list[0]) == "property"]
        assert [one.name for one in getters] == list(message.get_fields_and_field_types()), name
        for getter in getters:
            kind, value = ast.unparse(getter.returns), getattr(message, getter.name)
            base = kind.partition("[")[0]
            assert type(value) is (message_type(kind.replace(".", "/")) if "." in base else KINDS[base]), name
        for constant in (one for one in stub.body if isinstance(one, ast.AnnAssign)):
            expected = ast.literal_eval(ast.unparse(constant.value))
            assert getattr(message, ast.unparse(constant.target)) == expected, name


def test_there_is_a_stub_for_each_class() -> None:
    for package in PACKAGES:
        assert {name for name, _ in _classes(package)} == set(_messages(package))


def test_a_folder_gets_the_stubs_of_all_packages(tmp_path: Path) -> None:
    write(tmp_path, stubs())
    found = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.pyi")}
    assert found == stubs().keys()
    expected = {"rclpy/node.pyi", "rclpy/__init__.pyi", "std_msgs/msg.pyi", "std_srvs/srv.pyi"}
    assert expected | {"test_msgs/message_fixtures.pyi"} < found


def test_a_stub_of_rclpy_has_the_names_that_its_module_has_from_others() -> None:
    lines = stubs()["rclpy/node.pyi"].splitlines()
    place = "thymio_sim_ros.portable_ros.rclpy"
    assert {f"from {place}.node import *", f"from {place}.publisher import Publisher as Publisher"} < set(lines)
    assert "from rcl_interfaces.msg import ParameterDescriptor as ParameterDescriptor" in lines


@pytest.mark.process
def test_mypy_finds_wrong_messages(tmp_path: Path) -> None:
    pytest.importorskip("mypy", reason="mypy is installed by `make lint`")
    write(tmp_path / "typings", stubs())
    (tmp_path / "program.py").write_text(PROGRAM, encoding="utf-8")
    words = [
        "--strict",
        "--no-error-summary",
        "--hide-error-codes",
        "--cache-dir",
        str(tmp_path / "cache"),
        "program.py",
    ]
    environment = {**os.environ, "MYPYPATH": os.pathsep.join((str(tmp_path / "typings"), str(ROOT)))}
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *words],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=PATIENCE_S,
    )
    found = {int(line.split(":")[1]) for line in done.stdout.splitlines() if ": error: " in line}
    expected = {number for number, line in enumerate(PROGRAM.splitlines(), 1) if line.endswith("# wrong")}
    assert found == expected, done.stdout + done.stderr
