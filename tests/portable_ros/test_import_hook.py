"""The import hook, each time in a process of its own: what is imported cannot be undone."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S
from tests.syntax import ROOT

NEEDED = ("numpy", "numpy.libs", "rosbags", "yaml", "_yaml", "typing_extensions.py")
HAS_ROS = importlib.util.find_spec("rclpy") is not None

pytestmark = pytest.mark.process


def _run(program: str, *options: str, folder: Path | None = None) -> str:
    """What a program prints; `folder`: the only place of installed packages. Fails if the program fails."""
    paths = [str(ROOT), *([] if folder is None else [str(folder)])]
    words = [sys.executable, *options, "-c", f"import sys; sys.path[:0] = {paths!r}\n{program}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.fixture
def without_ros(tmp_path: Path) -> Path:
    """A folder with the packages that the room needs, and no others."""
    site = Path(importlib.util.find_spec("numpy").origin).parent.parent  # type: ignore[union-attr,arg-type]
    for name in NEEDED:
        if (site / name).exists():
            (tmp_path / name).symlink_to(site / name)
    return tmp_path


def test_it_serves_all_where_there_is_no_ros(without_ros: Path) -> None:
    program = (
        "from thymio_sim_ros.portable_ros.import_hook import install, is_served\n"
        "assert install() and is_served('rclpy') and is_served('std_msgs') and not is_served('json')\n"
        "import rclpy, std_msgs.msg, std_srvs.srv\n"
        "from rclpy.node import Node\n"
        "from std_msgs.msg import *\n"
        "import rclpy.node\n"
        "from std_msgs.msg._string import String as Same\n"
        "assert Same is String\n"
        "assert rclpy.node.Node is Node and String is std_msgs.msg.String\n"
        "print(rclpy.__spec__.name, String.__module__, std_srvs.srv.Trigger.Request())"
    )
    found = _run(program, "-I", "-S", folder=without_ros)
    assert found == "thymio_sim_ros.portable_ros.rclpy std_msgs.msg._string std_srvs.srv.Trigger_Request()"


def test_no_folder_is_searched_for_modules_that_are_no_messages(without_ros: Path) -> None:
    """A process imports hundreds of them, and each search looks into all folders of `sys.path` and above."""
    program = (
        "from thymio_sim_ros.portable_ros.import_hook import install\n"
        "from thymio_sim_ros.portable_ros.messages import own_packages\n"
        "searched = []\n"
        "own_packages.source_folders = lambda name: searched.append(name) or ()\n"
        "install()\n"
        "import email.mime.text, rclpy.node, std_msgs.msg\n"
        "print({'email', 'thymio_sim_ros'}.intersection(searched))"
    )
    assert _run(program, "-I", "-S", folder=without_ros) == "set()"


def test_modules_have_names_from_others_as_those_of_rclpy_do(without_ros: Path) -> None:
    program = (
        "import importlib, warnings\n"
        "from thymio_sim_ros.portable_ros.import_hook import install\n"
        "from thymio_sim_ros.portable_ros.rclpy_parts.borrowed_names import BORROWED\n"
        "install()\n"
        "for module, places in BORROWED.items():\n"
        "    for name in ' '.join(places.values()).split(): getattr(importlib.import_module(module), name)\n"
        "from rclpy.node import MsgType, Node, Optional, Publisher\n"
        "from rclpy.publisher import Publisher as Same\n"
        "warnings.simplefilter('ignore')\n"
        "from rclpy.qos_event import QoSEventHandler, SubscriptionEventCallbacks\n"
        "print(Publisher is Same)\n"
        "import rclpy.node\n"
        "print(hasattr(rclpy.node, 'nonsense'), hasattr(rclpy, 'nonsense'))"
    )
    assert _run(program, "-I", "-S", folder=without_ros).split() == ["True", "False", "False"]


def test_unknown_names_are_the_usual_errors(without_ros: Path) -> None:
    program = (
        "from thymio_sim_ros.portable_ros.import_hook import install\n"
        "install()\n"
        "for line in ('import rclpy.nonsense', 'from std_msgs.msg import Nonsense', 'import std_msgs.srv_nonsense'):\n"
        "    try: exec(line)\n"
        "    except ImportError as error: print(type(error).__name__)\n"
    )
    assert _run(program, "-I", "-S", folder=without_ros).split() == [
        "ModuleNotFoundError",
        "ImportError",
        "ModuleNotFoundError",
    ]


def test_half_an_installation_is_refused(without_ros: Path) -> None:
    (without_ros / "std_msgs").mkdir()
    (without_ros / "std_msgs" / "__init__.py").touch()
    program = (
        "from thymio_sim_ros.portable_ros.import_hook import MixedInstallationError, install\n"
        "try: install()\n"
        "except MixedInstallationError as error: print(error)\n"
    )
    assert "found std_msgs without rclpy, expected both or neither" in _run(program, "-I", "-S", folder=without_ros)


def test_what_is_imported_already_is_not_mixed(without_ros: Path) -> None:
    (without_ros / "std_msgs").mkdir()
    (without_ros / "std_msgs" / "__init__.py").touch()
    program = (
        "import std_msgs\n"
        "from thymio_sim_ros.portable_ros.import_hook import MixedInstallationError, install\n"
        "try: install(is_forced=True)\n"
        "except MixedInstallationError as error: print(error)\n"
    )
    assert "found std_msgs of another ROS imported already" in _run(program, "-I", "-S", folder=without_ros)


@pytest.mark.skipif(not HAS_ROS, reason="no ROS")
def test_it_shadows_no_installed_ros_unless_it_is_forced() -> None:
    program = (
        "from thymio_sim_ros.portable_ros.import_hook import install, is_served\n"
        "print(install(), is_served('rclpy'), install(is_forced=True), is_served('rclpy'))"
    )
    assert _run(program) == "False False True True"


def test_the_command_runs_files_with_their_arguments(tmp_path: Path) -> None:
    file = tmp_path / "program.py"
    file.write_text("import sys, rclpy\nprint(rclpy.get_rmw_implementation_identifier(), sys.argv[1:], __name__)\n")
    command = [sys.executable, "-m", "thymio_sim_ros.portable_ros", str(file), "-m", "x"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, timeout=PATIENCE_S)
    assert done.stdout.strip() == "portable_ros ['-m', 'x'] __main__", done.stderr


def test_the_command_without_a_program_is_wrong_usage() -> None:
    command = [sys.executable, "-m", "thymio_sim_ros.portable_ros"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, timeout=PATIENCE_S)
    assert done.returncode == 2
    assert done.stderr.startswith("usage: ")
