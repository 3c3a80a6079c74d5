"""The command `thymio-sim env`: variables for other ROS processes on this computer, and stubs for editors."""

from __future__ import annotations

import argparse
import os
import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from aseba_vm.cli.output import standard_output
from thymio_sim_ros import course_packages
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.ros.graph_choice import check_ros
from thymio_sim_ros.course_packages import field_checks

__all__ = ["run", "variables"]

PATH = "PYTHONPATH"

EXAMPLE = """\
In each terminal, before `ros2` or a node of your own is started:
  eval "$(thymio-sim env)"

Discovery is limited to this computer, as that of `thymio-sim`, and every process announces itself to new ones four
times a second, so that they find it at once. Where ROS comes from Python wheels, `ros2 run` and `ros2 interface` find
its packages. Nodes in Python report a value of the wrong type, such as `linear.x = 1`. `tf2_ros`, `tf2_msgs`,
`tf2_geometry_msgs` and `tf_transformations` can be imported, also where they are not installed. Variables that are set
already are not printed; PYTHONPATH keeps its folders and gets one more.

In the folder of your nodes, for completion and checks of types in an editor, also without ROS:
  thymio-sim env --stubs
"""

_WRITTEN = """\
The stubs are in {folder}. VS Code and pyright find them in the folder typings of a workspace; select the Python of
thymio-sim as interpreter. For another folder, set "python.analysis.stubPath" or "stubPath". For mypy, set
mypy_path = {folder}"""


def run(argv: Sequence[str]) -> int:
    """Print the commands that set the variables, or write stubs; return the exit code. Raises UsageError."""
    parser = argparse.ArgumentParser(
        prog="thymio-sim env",
        description="Print shell commands that prepare a terminal for nodes beside the simulator.",
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "--stubs",
        nargs="?",
        type=Path,
        const=Path("typings"),
        metavar="FOLDER",
        help="write stubs of rclpy, messages and tf2 into a folder (typings), where VS Code and pyright find them",
    )
    parser.add_argument(
        "--package", action="append", default=[], help="with --stubs: a package of messages of your own; repeatable"
    )
    options = parser.parse_args(argv)
    if options.stubs is not None:
        _write_stubs(options.stubs, options.package)
        return 0
    if options.package:
        raise UsageError("--package: found no --stubs, expected it too")
    check_ros()
    with standard_output():
        sys.stdout.write("".join(f"export {name}={shlex.quote(value)}\n" for name, value in variables().items()))
    return 0


def _write_stubs(folder: Path, packages: Sequence[str]) -> None:
    """Write the stubs and say how they are used. Raises UsageError."""
    from thymio_sim_ros.course_packages import stubs as course_stubs
    from thymio_sim_ros.portable_ros import type_stubs
    from thymio_sim_ros.portable_ros.messages.definition_text import DefinitionError
    from thymio_sim_ros.portable_ros.messages.interface_files import is_package

    sys.path.insert(0, str(Path.cwd()))  # packages of users are found from here
    if unknown := [package for package in packages if not is_package(package)]:
        raise UsageError(f"--package: found no {unknown[0]} with definitions here or in a folder above, expected one")
    try:
        type_stubs.write(folder, {**type_stubs.stubs(packages), **course_stubs.stubs()})
    except (DefinitionError, OSError) as error:
        raise UsageError(f"--stubs: {error}") from error
    with standard_output():
        print(_WRITTEN.format(folder=folder))


def variables() -> Mapping[str, str]:
    """The variables that a terminal needs and does not have, with their values; ROS 2 has to be installed."""
    from thymio_sim_ros.ros.compat import dds_profile

    values = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    field_checks.switch_on(values)
    if not dds_profile.has_own_profile():
        values[dds_profile.VARIABLE] = str(dds_profile.ANNOUNCING)
    if Path(sys.prefix, "share", "ament_index").is_dir():  # the wheels leave this variable unset
        values["AMENT_PREFIX_PATH"] = sys.prefix
    new = {name: value for name, value in values.items() if name not in os.environ}
    places = list(filter(None, os.environ.get(PATH, "").split(os.pathsep)))
    first = str(course_packages.STARTUP)
    return new if first in places else {**new, PATH: os.pathsep.join([first, *places])}
