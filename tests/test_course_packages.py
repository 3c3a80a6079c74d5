"""Packages that course files import, where no wheels of them exist: in every way in which a node of a student runs."""

from __future__ import annotations

import csv
import importlib
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from thymio_sim_ros import course_packages

pytest.importorskip("rclpy")

NODE = """\
import rclpy
import tf2_geometry_msgs
from geometry_msgs.msg import PointStamped, TransformStamped
from rclpy.node import Node
from rclpy.time import Time
from std_msgs.msg import Float64
from tf2_msgs.msg import TFMessage
from tf2_py import BufferCore, LookupException
from tf2_ros import TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from tf2_ros.transform_broadcaster import TransformBroadcaster
from tf2_ros.transform_listener import TransformListener
from tf_transformations import euler_from_quaternion, quaternion_from_euler


class Seeker(Node):
    def __init__(self):
        super().__init__("seeker")
        assert issubclass(LookupException, TransformException)
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.out = self.create_publisher(Float64, "turned", 10)
        self.moved = 0
        self.create_subscription(TFMessage, "/tf", self.count, 10)
        self.create_timer(0.1, self.look)

    def count(self, message):
        self.moved += sum(one.child_frame_id == "base_link" for one in message.transforms)

    def look(self):
        try:
            q = self.buffer.lookup_transform("map", "base_link", Time()).transform.rotation
        except TransformException:
            return
        if self.moved:
            self.out.publish(Float64(data=euler_from_quaternion([q.x, q.y, q.z, q.w])[2] + 10.0))


def main():
    rclpy.init()
    rclpy.spin(Seeker())


if __name__ == "__main__":
    main()
"""


@pytest.mark.process
@pytest.mark.parametrize("way", ["start", "run"])
def test_a_node_imports_them_in_a_test(ros, simulation, tmp_path, way):
    from std_msgs.msg import Float64

    sim = simulation()
    path = tmp_path / "seeker.py"
    path.write_text(NODE)
    getattr(ros, way)(path)
    turned = ros.collect(Float64, "turned")
    sim.until(lambda: turned.latest.data == pytest.approx(10.0), 5.0)


def _prints(folder: Path, statement: str, *places: Path) -> str:
    """What a program prints that is in a folder, in a terminal that `thymio-sim env` has prepared."""
    program = folder / "program.py"
    program.write_text(statement)
    path = os.pathsep.join(map(str, [course_packages.STARTUP, *places]))
    environment = {**os.environ, "PYTHONPATH": path}
    done = subprocess.run([sys.executable, program], env=environment, capture_output=True, text=True, cwd="/")
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.process
def test_a_prepared_terminal_has_them(tmp_path):
    assert _prints(tmp_path, NODE.partition("class")[0] + "print(TFMessage.__module__)") == "tf2_msgs.msg._tf_message"


@pytest.mark.process
def test_a_program_on_the_embedded_graph_has_them(tmp_path):
    (tmp_path / "node.py").write_text(
        NODE.partition("class")[0]
        + "from tf2_ros.buffer_client import BufferClient\n"
        + "import tf2_ros\n"
        + "assert tf2_ros.BufferClient is BufferClient and not hasattr(tf2_ros, 'Nothing')\n"
        + "print(TFMessage.__module__)\n"
    )
    command = [sys.executable, "-m", "thymio_sim_ros.portable_ros", "node.py"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert done.stdout == "tf2_msgs.msg._tf_message\n", done.stderr


@pytest.mark.process
def test_installed_packages_and_files_beside_the_node_have_priority(tmp_path):
    real, beside = tmp_path / "lib" / "site-packages", tmp_path / "beside"
    for place, answer in ((real, "real"), (beside, "own")):
        place.mkdir(parents=True)
        (place / "tf_transformations.py").write_text(f"answer = {answer!r}\n")
    statement = "import tf_transformations\nprint(tf_transformations.answer)\n"
    assert _prints(tmp_path, statement, real) == "real"
    assert _prints(beside, statement, real) == "own"


@pytest.mark.process
def test_a_file_of_the_same_name_beside_the_node_is_not_imported_by_this_package(tmp_path):
    """It is half loaded when it imports from this package itself, and need not have all names."""
    for name in ("tf_transformations", "tf2_ros", "tf2_geometry_msgs", "tf2_msgs"):
        (tmp_path / f"{name}.py").write_text("from thymio_sim_ros.tf import Buffer, euler_from_quaternion\n")
    statement = (
        "import tf_transformations\nimport thymio_sim_ros.tf as tf\nprint(tf.quaternion_from_euler.__module__)\n"
    )
    assert _prints(tmp_path, statement) == "thymio_sim_ros.tf.transformations"


HALF = """\
import math
from thymio_sim_ros.tf import Buffer, TransformListener, quaternion_from_euler


def euler_from_quaternion(q):
    return 0.0, 0.0, 4.0
"""

OWN_NODE = NODE.replace(
    "from tf_transformations import euler_from_quaternion, quaternion_from_euler",
    "from tf_transformations import euler_from_quaternion",
)

OWN_TEST = """\
import pytest
from std_msgs.msg import Float64


def test_turned(ros, simulation):
    sim = simulation()
    ros.start("node.py")
    turned = ros.collect(Float64, "turned")
    sim.until(lambda: turned.latest.data == pytest.approx(14.0), 5.0)
"""


@pytest.mark.process
@pytest.mark.parametrize("way", ["start", "run"])
def test_a_node_uses_an_own_half_of_tf_transformations_in_a_test(ros, simulation, tmp_path, way):
    """Its file imports from this package while it is itself half loaded, and lacks most names of the original."""
    from std_msgs.msg import Float64

    (tmp_path / "tf_transformations.py").write_text(HALF)
    (tmp_path / "node.py").write_text(OWN_NODE)
    sim = simulation()
    getattr(ros, way)(tmp_path / "node.py")
    turned = ros.collect(Float64, "turned")
    sim.until(lambda: turned.latest.data == pytest.approx(14.0), 5.0)
    loaded = sys.modules.get("tf_transformations")
    assert loaded is None or loaded.__file__ != str(tmp_path / "tf_transformations.py")


@pytest.mark.slow
@pytest.mark.process
def test_a_submission_with_an_own_half_of_tf_transformations_is_graded(tmp_path):
    assignment, submission = tmp_path / "assignment", tmp_path / "submissions" / "ada"
    for folder, name, text in (
        (assignment, "test_turned.py", OWN_TEST),
        (submission, "tf_transformations.py", HALF),
        (submission, "node.py", OWN_NODE),
    ):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    command = [sys.executable, "-m", "thymio_sim_ros", "grade", submission.parent, "--assignment"]
    out = tmp_path / "out"
    done = subprocess.run([*command, assignment / "test_turned.py", "-o", out], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    with (out / "marks.csv").open(newline="") as file:
        assert [(row["name"], row["points"], row["verdict"]) for row in csv.DictReader(file)] == [
            ("ada", "1", "passed")
        ]


@pytest.mark.process
def test_a_program_in_a_prepared_terminal_uses_its_own_half_of_tf_transformations(tmp_path):
    (tmp_path / "tf_transformations.py").write_text(HALF)
    statement = OWN_NODE.partition("class")[0] + "print(euler_from_quaternion([0.0, 0.0, 0.0, 1.0])[2])\n"
    assert _prints(tmp_path, statement) == "4.0"


@pytest.mark.process
def test_the_startup_module_that_it_hides_runs_too(tmp_path):
    (tmp_path / "sitecustomize.py").write_text("import sys\nsys.answer = 42\n")
    path = os.pathsep.join(map(str, [course_packages.STARTUP, tmp_path]))
    command = [sys.executable, "-c", "import sys, tf2_py; print(sys.answer)"]
    environment = {**os.environ, "PYTHONPATH": path}
    assert subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout == "42\n"


IMPORTS_TYPES = """\
import rclpy
from example_interfaces.action import Fibonacci
from example_interfaces.msg import Int64, String
from example_interfaces.srv import AddTwoInts, Trigger
from rclpy.action import ActionServer
from rclpy.node import Node


class Adder(Node):
    def __init__(self):
        super().__init__("adder")
        {}


def main():
    rclpy.init()
    rclpy.spin(Adder())


if __name__ == "__main__":
    main()
"""

USES = {
    "pass": "",
    "self.create_service(AddTwoInts, 'add', print)": "example_interfaces.srv.AddTwoInts is not installed",
    "self.create_client(Trigger, 'go')": "use std_srvs.srv.Trigger",
    "AddTwoInts.Request()": "example_interfaces.srv.AddTwoInts is not installed",
    "self.create_publisher(String, 'said', 10)": "use std_msgs.msg.String",
    "self.create_subscription(Int64, 'n', print, 10)": "use std_msgs.msg.Int64",
    "Int64(data=1)": "ros-<distribution>-example-interfaces",
    "ActionServer(self, Fibonacci, 'count', print)": "example_interfaces.action.Fibonacci is not installed",
}

needs_absence = pytest.mark.skipif(
    course_packages.is_installed("example_interfaces"), reason="this ROS has the package example_interfaces"
)


@needs_absence
@pytest.mark.parametrize("use", USES)
def test_example_interfaces_can_be_imported_and_says_what_to_do_when_it_is_used(ros, tmp_path, use):
    path = tmp_path / "adder.py"
    path.write_text(IMPORTS_TYPES.replace("{}", use))
    if not USES[use]:
        ros.start(path)
        return
    with pytest.raises(RuntimeError, match=re.escape(USES[use])):
        ros.start(path)


@needs_absence
@pytest.mark.process
def test_programs_and_a_prepared_terminal_have_it_too(ros, simulation, tmp_path):
    simulation()
    path = tmp_path / "adder.py"
    path.write_text(IMPORTS_TYPES.replace("{}", "AddTwoInts.Request()"))
    program = ros.run(path, check=False)
    program.wait()
    assert "example_interfaces.srv.AddTwoInts is not installed" in program.errors
    head = IMPORTS_TYPES.partition("class")[0]
    assert _prints(tmp_path, head + "print(AddTwoInts.__module__)") == "example_interfaces.srv"


@needs_absence
def test_its_messages_with_a_twin_name_one_that_exists(monkeypatch):
    monkeypatch.syspath_prepend(Path(course_packages.__file__).parent / "packages")
    messages = importlib.import_module("example_interfaces.msg")
    std = importlib.import_module("std_msgs.msg")
    assert [name for name in messages.__all__ if not hasattr(std, name)] == ["WString"]
