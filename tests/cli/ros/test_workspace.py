"""The packages and programs of a workspace that has not been built."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests import ros_graph
from thymio_sim_ros.cli.ros import console_scripts
from thymio_sim_ros.cli.ros.workspace import Program, add_to_path, packages, programs
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, load_type

SETUP = """\
from setuptools import setup

print("a line of setup.py")
setup(name="lesson", packages=["lesson"], tests_require=["pytest"], entry_points={"console_scripts": %s})
"""


def make_package(folder: Path, name: str = "", setup: str = "", cmake: str = "") -> Path:
    """A package; its name is that of the folder, unless one is given."""
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{name or folder.name}</name></package>", encoding="utf-8")
    for file, text in (("setup.py", setup), ("CMakeLists.txt", cmake)):
        if text:
            (folder / file).write_text(text, encoding="utf-8")
    return folder


def names(folder: Path) -> list[str]:
    return [one.name for one in packages(folder)]


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """Packages at several places of `src`, and folders without packages for colcon."""
    make_package(tmp_path / "src" / "lesson")
    make_package(tmp_path / "src" / "course" / "week_2" / "other_folder", name="homework")
    make_package(tmp_path / "src" / "lesson" / "inner")
    make_package(tmp_path / "src" / "build" / "copy")
    make_package(tmp_path / "src" / ".hidden" / "copy")
    make_package(tmp_path / "install" / "lesson" / "share" / "lesson")
    make_package(tmp_path / "src" / "off" / "old")
    (tmp_path / "src" / "off" / "COLCON_IGNORE").touch()
    return tmp_path


@pytest.mark.parametrize("place", [".", "src", "src/lesson", "src/course/week_2/other_folder"])
def test_all_packages_of_a_workspace_are_found_from_each_of_its_folders(workspace: Path, place: str) -> None:
    assert names(workspace / place) == ["homework", "lesson"]


def test_a_package_without_a_workspace_is_found_with_those_beside_it(tmp_path: Path) -> None:
    make_package(tmp_path / "lesson")
    make_package(tmp_path / "messages")
    (tmp_path / "lesson" / "launch").mkdir()
    assert names(tmp_path / "lesson" / "launch") == names(tmp_path) == ["lesson", "messages"]


def test_there_may_be_no_package(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    assert names(tmp_path) == []


@pytest.mark.parametrize(
    "scripts",
    [
        '["talker = lesson.talker:main", "listener=lesson.listener:Listener.main"]',
        '"talker = lesson.talker:main\\nlistener=lesson.listener:Listener.main"',
    ],
)
def test_console_scripts_are_those_of_setup_py(
    tmp_path: Path, scripts: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    make_package(tmp_path / "lesson", setup=SETUP % scripts)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.path", ["", *sys.path])
    console_scripts.main([str(tmp_path / "lesson")])
    printed = capsys.readouterr()
    assert printed.out == (
        '[{"scripts": [["talker", "lesson.talker:main"], ["listener", "lesson.listener:Listener.main"]]}]'
    )
    assert printed.err == "a line of setup.py\n", (
        "a warning about `tests_require`, which `ros2 pkg create` writes, is none"
    )


@pytest.mark.process
def test_a_setup_py_that_fails_is_reported_and_the_others_are_read(tmp_path: Path) -> None:
    make_package(tmp_path / "src" / "good", setup=SETUP % '["run = good.node:main"]')
    make_package(tmp_path / "src" / "bad", setup="1 / 0")
    make_package(tmp_path / "src" / "none")
    found, errors = programs(packages(tmp_path))
    assert found == {"good": [Program("run", entry_point="good.node:main")], "bad": [], "none": []}
    assert errors == {"bad": f"{tmp_path / 'src' / 'bad' / 'setup.py'}: ZeroDivisionError: division by zero"}


def test_programs_in_python_that_cmake_installs_are_programs(tmp_path: Path) -> None:
    cmake = """
    # install(PROGRAMS old.py DESTINATION lib/x)
    add_executable(fast src/fast.cpp)
    install(TARGETS fast DESTINATION lib/${PROJECT_NAME})
    install(PROGRAMS
      "nodes/slow.py" missing.py data.txt
      DESTINATION lib/${PROJECT_NAME})
    """
    folder = make_package(tmp_path / "mixed", cmake=cmake)
    (folder / "nodes").mkdir()
    for name in ("nodes/slow.py", "data.txt", "old.py"):
        (folder / name).touch()
    found, errors = programs(packages(tmp_path))
    assert (found, errors) == ({"mixed": [Program("slow.py", file=folder / "nodes" / "slow.py")]}, {})
    assert packages(tmp_path)[0].has_compiled_programs


def test_a_command_finds_the_types_of_its_workspace(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    messages = make_package(workspace / "src" / "course" / "week_2" / "tower_messages") / "msg"
    messages.mkdir()
    (messages / "Height.msg").write_text("float64 meters\n", encoding="utf-8")
    monkeypatch.setattr("sys.path", [*sys.path])
    monkeypatch.chdir(workspace / "src" / "lesson")
    add_to_path()
    if ros_graph.IS_EMBEDDED:
        assert load_type("tower_messages/msg/Height")(meters=1.5).meters == 1.5
    else:
        with pytest.raises(MissingTypeError, match="there is no package tower_messages with msg types"):
            load_type("tower_messages/msg/Height")
    before = list(sys.path)
    add_to_path()
    assert sys.path == before
