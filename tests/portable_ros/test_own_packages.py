"""Packages of users on the embedded graph: messages from source folders, and the index of packages."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from thymio_sim_ros.portable_ros.messages.definition_text import DefinitionError, Section, Shape, parsed
from thymio_sim_ros.portable_ros.messages.definitions import definition
from thymio_sim_ros.portable_ros.messages.interface_files import PACKAGES, interfaces, messages
from thymio_sim_ros.portable_ros.messages.own_packages import read

MANIFEST = "<package format='3'>\n  <name> {} </name>\n</package>\n"


def _run(file: Path, *options: str, **variables: str) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-m", "thymio_sim_ros.portable_ros", *(options or (str(file),))]
    environment = {**os.environ, **variables}
    return subprocess.run(words, capture_output=True, text=True, check=False, env=environment, cwd=file.parent)


def _prints(file: Path, text: str, *options: str, **variables: str) -> str:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
    done = _run(file, *options, **variables)
    assert done.returncode == 0, done.stderr
    return done.stdout


def _add(package: Path, **definitions: str) -> Path:
    """A package of a workspace; `Name_form` is the name of a definition."""
    for name, text in definitions.items():
        short, _, form = name.partition("_")
        file = package / form / f"{short}.{form}"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    package.mkdir(parents=True, exist_ok=True)
    (package / "package.xml").write_text(MANIFEST.format(package.name), encoding="utf-8")
    return package


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """The sources of a workspace with a package of messages, as that of the tutorials."""
    _add(
        tmp_path / "tutorial_interfaces",
        Num_msg="int64 num\n",
        Sphere_msg="# A comment\ngeometry_msgs/Point at\nfloat64 radius 2.5  # m\n\nNum[<=2] nums\nuint8 BIG=0x10\n",
        AddThreeInts_srv="int64 a\nint64 b\nint64 c\n---\nint64 sum\n",
        Count_action="int32 order\n---\nint32[] sequence\n---\nint32[] partial\n",
    )
    return tmp_path


USES = """\
import rclpy
from rclpy.action import ActionClient
from tutorial_interfaces.action import Count
from tutorial_interfaces.msg import Num, Sphere
from tutorial_interfaces.srv import AddThreeInts

rclpy.init()
node = rclpy.create_node("three")


def add(request, response):
    response.sum = request.a + request.b + request.c
    return response


heard = []
node.create_service(AddThreeInts, "add", add)
node.create_subscription(Sphere, "spheres", heard.append, 10)
node.create_publisher(Sphere, "spheres", 10).publish(Sphere(nums=[Num(num=7)]))
ActionClient(node, Count, "count").destroy()
future = node.create_client(AddThreeInts, "add").call_async(AddThreeInts.Request(a=1, b=2, c=3))
rclpy.spin_until_future_complete(node, future)
while not heard:
    rclpy.spin_once(node)
print(future.result().sum, heard[0].radius, heard[0].nums[0].num, Sphere.BIG, Count.Goal(order=4))
"""


@pytest.mark.process
@pytest.mark.parametrize("place", ["py_pubsub/py_pubsub", "tutorial_interfaces/tutorial_interfaces", "."])
def test_a_program_of_a_workspace_imports_its_messages(workspace: Path, place: str) -> None:
    """Beside the package, within it, and in the folder that has it, where Python sees a package of its own."""
    found = _prints(workspace / place / "node.py", USES)
    assert found == "6 2.5 7 16 tutorial_interfaces.action.Count_Goal(order=4)\n"


@pytest.mark.process
def test_a_python_package_of_the_same_name_keeps_its_modules(workspace: Path) -> None:
    folder = workspace / "tutorial_interfaces" / "tutorial_interfaces"
    folder.mkdir()
    (folder / "__init__.py").touch()
    (folder / "helper.py").write_text("from tutorial_interfaces.msg import Num\n")
    program = "from tutorial_interfaces.helper import Num\nprint(Num(num=3))\n"
    found = _prints(workspace / "tutorial_interfaces" / "node.py", program, "-m", "node")
    assert found == "tutorial_interfaces.msg.Num(num=3)\n"


@pytest.mark.process
def test_a_package_is_found_by_its_manifest_or_where_it_is_installed(tmp_path: Path) -> None:
    named = _add(tmp_path / "mine-main", One_msg="bool one\n")
    (named / "package.xml").write_text(MANIFEST.format("mine"), encoding="utf-8")
    _add(tmp_path / "install" / "share" / "theirs", Two_msg="mine/One one\n")
    program = "from theirs.msg import Two\nfrom mine.msg import One\nprint(Two(one=One(one=True)).one.one)\n"
    found = _prints(named / "scripts" / "node.py", program, AMENT_PREFIX_PATH=str(tmp_path / "install"))
    assert found == "True\n"


@pytest.mark.process
def test_a_program_without_a_package_of_types_says_where_to_put_it(tmp_path: Path) -> None:
    file = tmp_path / "lost.py"
    for module, is_of_types in (("nav2_msgs.action", True), ("cv2_nowhere", False)):
        file.write_text(f"import {module}\n", encoding="utf-8")
        said = _run(file).stderr
        assert "ModuleNotFoundError: No module named" in said
        assert ("no types of nav2_msgs: copy the folder of that package" in said) == is_of_types


@pytest.mark.process
def test_a_wrong_definition_names_its_file_and_line(workspace: Path) -> None:
    _add(
        workspace / "wrong",
        A_msg="int32 fine\n",
        B_msg="int32 x\n\nint wheels\n",
        Loop_msg="Loop x\n",
        C_srv="int32 a\nint32 b\n",
    )
    program = "from wrong.msg import A\nprint(A())\nfrom wrong.msg import B\n"
    (workspace / "node.py").write_text(program)
    done = _run(workspace / "node.py")
    assert done.stdout == "wrong.msg.A(fine=0)\n"
    file = workspace / "wrong" / "msg" / "B.msg"
    assert f"DefinitionError: {file}:3: found the type 'int', expected one of bool, byte" in done.stderr
    (workspace / "node.py").write_text("from wrong.msg import Loop\n")
    assert "Loop.msg:1: found the type 'Loop'" in _run(workspace / "node.py").stderr
    (workspace / "node.py").write_text("import wrong.srv\n")
    file = workspace / "wrong" / "srv" / "C.srv"
    assert (
        f"{file}: found 0 lines '---', expected 1: between Request and Response" in _run(workspace / "node.py").stderr
    )


def test_a_file_that_the_build_does_not_list_may_have_any_name(tmp_path: Path) -> None:
    package = _add(tmp_path / "games", Turtle_msg="float64 x\n", turtle_msg="float64 old\n")
    with pytest.raises(DefinitionError, match=r"turtle.msg: found the name 'turtle', expected one such as"):
        read(package)
    (package / "CMakeLists.txt").write_text('rosidl_generate_interfaces(${PROJECT_NAME}\n  "msg/Turtle.msg"\n)\n')
    assert read(package) == {"msg/Turtle": "float64 x\n"}


WRONG = {
    "int32": "found 'int32', expected a field such as",
    "int32[ x": "found 'int32[ x', expected a field",
    "int32[0] x": "found 'int32[0]', expected a size above 0",
    "int32<=3 x": "expected a limit only of string and wstring",
    "int32 Speed": "found the name 'Speed', expected lower case",
    "int32 a__b": "found the name 'a__b'",
    "int32 a_": "found the name 'a_'",
    "int32 max=3": "found the name 'max', expected upper case",
    "nothing/Here x": "found the type 'nothing/Here', expected one of bool",
    "geometry_msgs/Point p 3": "found the default '3' of a message, expected none",
    "geometry_msgs/Point P=3": "found a constant of type 'geometry_msgs/Point'",
    "int8 x 128": "found the value 128, expected -128…127 for int8",
    "byte x 256": "found the value 256, expected 0…255 for byte",
    "int8 x 1.5": "found the value '1.5', expected one of type int8",
    "bool x maybe": "found the value 'maybe', expected one of type bool",
    "float32 x fast": "found the value 'fast', expected one of type float32",
    "string x 'a": "expected one of type string",
    "string<=2 x abc": "found the default abc, expected at most 2 characters",
    "int8[2] x 1, 2": "expected a list such as [1, 2]",
    "int8[2] x [1]": "found a default with 1 values, expected 2",
    "int8[<=2] x [1, 2, 3]": "found a default with 3 values, expected at most 2",
    "int8 x\nint8 x": "found a second 'x', expected each name once",
}


@pytest.mark.parametrize("text", WRONG)
def test_what_is_wrong_in_a_line_is_said(text: str) -> None:
    with pytest.raises(DefinitionError) as found:
        parsed(Section(f"bool fine  # {text}\n{text}\n", "A.msg", 5), "mine", lambda name: "geometry_msgs" in name)
    assert str(found.value).startswith(f"A.msg:{6 + text.count(chr(10))}: ")
    assert WRONG[text] in str(found.value)


def test_all_ways_to_write_a_line_are_read() -> None:
    lines = (
        "\tuint8\tA = 0x10\r\n  string GREETING=say 'hi'\nint8[] list [1, -2]\nbyte b 7\nchar c 65\n"
        "geometry_msgs/msg/Point p\nHeader header\nOther[3] others\nwstring<=4[<=2] texts\nstring quoted ' x '\n"
    )
    fields, constants = parsed(Section(lines, "A.msg"), "mine", lambda name: True)
    assert [(one.name, one.value) for one in constants] == [("A", 16), ("GREETING", "say 'hi'")]
    assert {one.name: one.default for one in fields if one.default is not None} == {
        "list": (1, -2), "b": b"\x07", "c": 65, "quoted": " x "
    }  # fmt: skip
    types = {one.name: one.type for one in fields}
    assert [types[name].base for name in ("p", "header", "others")] == [
        "geometry_msgs/msg/Point", "std_msgs/msg/Header", "mine/msg/Other"
    ]  # fmt: skip
    assert (types["texts"].shape, types["texts"].size, types["texts"].text_bound) == (Shape.SEQUENCE, 2, 4)


@pytest.mark.parametrize("package", sorted(PACKAGES))
def test_the_definitions_of_the_room_are_right(package: str) -> None:
    for name in interfaces(package):
        for message in messages(f"{package}/{name}"):
            assert definition(message).name == message


INDEX = """\
from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from ament_index_python import get_package_prefix, get_packages_with_prefixes, get_resource, has_resource

print(get_package_share_directory("mine"), get_package_prefix("mine"))
print(get_package_share_directory("theirs"), get_package_prefix("theirs"))
print(get_packages_with_prefixes()["theirs"], *get_resource("packages", "theirs"), has_resource("packages", "mine"))
for name, kind in (("nothing", PackageNotFoundError), ("../mine", ValueError)):
    try:
        get_package_share_directory(name)
    except kind as error:
        print(error)
"""


@pytest.mark.process
def test_the_index_has_source_folders_and_installed_packages(tmp_path: Path) -> None:
    mine, prefix = _add(tmp_path / "src" / "mine"), tmp_path / "install"
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "theirs").write_text("content")
    lines = _prints(mine / "mine" / "node.py", INDEX, AMENT_PREFIX_PATH=str(prefix)).splitlines()
    assert lines[0].split() == [str(mine), str(mine)]
    assert lines[1].split() == [str(prefix / "share" / "theirs"), str(prefix)]
    assert lines[2].split() == [str(prefix), "content", str(prefix), "False"]
    assert "package 'nothing' not found, searching:" in lines[3]
    assert lines[4] == "'../mine' is not a valid package name"


@pytest.mark.process
def test_stubs_of_own_packages_are_written(workspace: Path) -> None:
    words = [sys.executable, "-m", "thymio_sim_ros.portable_ros.type_stubs", "typings"]
    done = subprocess.run([*words, "tutorial_interfaces"], cwd=workspace, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "class AddThreeInts(Service[" in (workspace / "typings" / "tutorial_interfaces" / "srv.pyi").read_text()
    done = subprocess.run([*words, "nothing"], cwd=workspace, check=False, capture_output=True, text=True)
    assert "found no package nothing with definitions" in done.stderr
