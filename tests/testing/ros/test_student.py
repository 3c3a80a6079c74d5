"""Node classes that others wrote: found in files and modules, started in the test."""

from __future__ import annotations

import importlib
import sys

import pytest
import rclpy
from rclpy.node import Node

from thymio_sim_ros.testing.ros.student import load_class
from thymio_sim_ros.testing.ros.student_errors import StudentError

HEAD = "import rclpy\nimport rclpy.executors\nfrom rclpy.node import Node\n"
GREETER = HEAD + 'class Greeter(Node):\n    def __init__(self):\n        super().__init__("greeter")\n'
UNGUARDED = GREETER + "rclpy.init()\nnode = Greeter()\ntry:\n    rclpy.spin(node)\nfinally:\n    rclpy.shutdown()\n"
LOOP = GREETER + "rclpy.init()\nnode = Greeter()\nwhile rclpy.ok():\n    rclpy.spin_once(node)\nrclpy.shutdown()\n"

EXECUTOR = GREETER + (
    "def main():\n    rclpy.init()\n    executor = rclpy.executors.{kind}()\n    executor.add_node(Greeter())\n"
    "    executor.{spin}()\n    executor.shutdown()\n    rclpy.shutdown()\nmain()\n"
)
EXITS = "import sys\n" + GREETER + "def main():\n    rclpy.init()\n    rclpy.spin(Greeter())\nsys.exit(main())\n"
WITH = GREETER + "def main():\n    with rclpy.init():\n        rclpy.spin(Greeter())\nmain()\n"


@pytest.fixture
def handed_in(tmp_path):
    """Write what a student hands in."""

    def write(text, name="greeter.py"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


@pytest.mark.parametrize(
    "text",
    [
        GREETER,
        UNGUARDED,
        LOOP,
        WITH,
        EXITS,
        EXECUTOR.format(kind="SingleThreadedExecutor", spin="spin"),
        EXECUTOR.format(kind="MultiThreadedExecutor", spin="spin_once"),
    ],
    ids=["guarded", "spins at once", "loops at once", "with", "exits", "executor", "many threads"],
)
def test_a_file_becomes_a_node(ros, handed_in, text):
    node = ros.start(handed_in(text))
    assert node.get_name() == "greeter"
    assert type(node).__name__ == "Greeter"
    ros.until(lambda: ros.node.get_node_names().count("greeter") == 1)
    assert rclpy.ok()


def test_a_file_beside_the_test_is_found(ros, handed_in):
    node_file = handed_in(GREETER)
    ros._folder = node_file.parent  # the folder of the test, as the fixture gives it
    assert ros.start("greeter.py").get_name() == "greeter"


def test_a_module_is_named_with_dots(ros, handed_in, monkeypatch):
    monkeypatch.syspath_prepend(handed_in(GREETER, "my_greeter.py").parent)
    assert ros.start("my_greeter").get_name() == "greeter"
    sys.modules.pop("my_greeter")


def test_a_file_may_import_its_neighbours(ros, handed_in):
    handed_in("NAME = 'neighbor'\n", "my_names.py")
    text = GREETER.replace('"greeter"', "NAME").replace(HEAD, HEAD + "from my_names import NAME\n")
    assert ros.start(handed_in(text)).get_name() == "neighbor"
    assert "my_names" not in sys.modules


def test_the_neighbours_of_one_student_are_not_those_of_the_next(tmp_path, monkeypatch):
    """Each has a helpers.py and a package parts, as the teacher has, who imported his own first."""
    text = GREETER + "import helpers\nfrom parts import sizes\nGreeter.found = helpers.NAME, sizes.NAME\n"
    for name in ("teacher", "anna", "bert"):
        (tmp_path / name / "parts").mkdir(parents=True)
        for file in ("helpers.py", "parts/__init__.py", "parts/sizes.py"):
            (tmp_path / name / file).write_text(f"NAME = '{name}'\n")
        (tmp_path / name / "greeter.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path / "teacher")
    own = {name: importlib.import_module(name) for name in ("helpers", "parts", "parts.sizes")}
    try:
        monkeypatch.chdir(tmp_path)
        for name in ("anna", "bert", "anna"):
            assert load_class(f"{name}/greeter.py").found == (name, name)
            assert {name: sys.modules[name] for name in own} == own
    finally:
        for name in own:
            del sys.modules[name]


def test_a_file_that_exits_before_its_node_is_reported(handed_in):
    with pytest.raises(SystemExit, match="no robot"):
        load_class(handed_in("import sys\nsys.exit('no robot')\n" + GREETER))


def test_of_several_classes_the_last_heir_or_the_named_one_is_taken(handed_in):
    path = handed_in(GREETER + "class Louder(Greeter):\n    pass\n")
    assert load_class(path).__name__ == "Louder"
    assert load_class(path, "Greeter").__name__ == "Greeter"


@pytest.mark.parametrize(
    ("text", "class_name", "reported"),
    [
        ("x = 1\n", "", "expected one class derived from rclpy.node.Node, found none"),
        (GREETER + GREETER.replace(HEAD, "").replace("Greeter", "Other"), "", "found Greeter, Other"),
        (GREETER, "Greter", "expected a class Greter derived from rclpy.node.Node, found Greeter"),
    ],
)
def test_what_is_no_node_is_refused(handed_in, text, class_name, reported):
    with pytest.raises(StudentError, match=reported):
        load_class(handed_in(text), class_name)


def test_a_missing_or_invalid_file_is_reported(handed_in):
    with pytest.raises(StudentError, match="no such file"):
        load_class("nowhere.py")
    with pytest.raises(SyntaxError):
        load_class(handed_in("class Greeter(:\n"))
    with pytest.raises(ModuleNotFoundError, match="no_such_module"):
        load_class("no_such_module")


def test_a_class_that_does_not_call_super_is_reported(ros):
    class Direct(Node):
        def __init__(self):
            Node.__init__(self, "direct")

    with pytest.raises(StudentError, match=r"Direct calls Node.__init__ itself: expected super\(\).__init__"):
        ros.start(Direct)
    ros.until(lambda: "direct" not in ros.node.get_node_names())
