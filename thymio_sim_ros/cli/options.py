"""Options that the suite and the headless run share, types of arguments, and checks of the files that they name."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.device.event_queue import FIRMWARE, POLICIES
from thymio_sim_ros.device.firmware.sd_card import SdCard, SdCardError
from thymio_sim_ros.device.firmware.settings import Settings, SettingsError
from thymio_sim_ros.device.layout import LAYOUTS, THYMIO, described
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.program import ProgramError
from thymio_sim_ros.device.programs.program_assignment import Assignment
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import NO_PROGRAM, check_behaviour, load_playground, read_assignments, read_program
from thymio_sim_ros.network.robot_target import TargetError, parse_target
from thymio_sim_ros.sim.commands import MOTOR_MODELS
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError
from thymio_sim_ros.suite_config import SuiteConfig

__all__ = [
    "EXAMPLE",
    "add_world_options",
    "check_files",
    "check_robot_program",
    "describe_lidar",
    "device_options",
    "lidar_argument",
    "number_argument",
    "path_argument",
    "program_option",
]

_WITHOUT_ROBOT = (NO_PROGRAM, SuiteConfig.program)
"""Programs that need no robot: none, and the default."""

EXAMPLE = """\
example:
  thymio-sim --playground obstacle --program my_robot.aesl
  thymio-sim --behaviour menu                                (arrows choose, the center button starts)
  thymio-sim runner --program my_robot.aesl --seconds 60     (without ROS, as fast as possible)
  thymio-sim runner --log run.jsonl; thymio-sim replay run.jsonl   (repeats the run, bit for bit)
  thymio-sim convert maze.playground -o maze.json            (from Aseba and others; without ROS)
  thymio-sim class --pupils names.csv --folder 5b            (a world and a link for each pupil, a page for the teacher)
  thymio-sim topic list; thymio-sim record                   (as ros2, also without ROS 2; docs/ros-commands.md)
  thymio-sim foxglove-layout -o thymio.json                  (panels for Foxglove and Lichtblick)
  thymio-sim --robot ser:/dev/ttyACM0 --program my_robot.aesl  (a real robot, without simulator)
  thymio-sim --ros-args -r __ns:=/lab1                       (ROS arguments come last; here a namespace)
"""


def add_world_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of playground, program, seed, run log and robot."""
    shipped, behaviours = ", ".join(resources.playgrounds()), ", ".join(resources.behaviours())
    parser.add_argument(
        "--playground",
        default=SuiteConfig.playground,
        metavar="NAME|FILE",
        help=f"{shipped}, or a file (default: %(default)s)",
    )
    parser.add_argument(
        "--program",
        metavar="FILE.aesl",
        help=f"{behaviours}, {NO_PROGRAM}, or a file"
        f" (default: {SuiteConfig.program}, or {NO_PROGRAM} with --behaviour)",
    )
    parser.add_argument(
        "--behaviour",
        default=SuiteConfig.behaviour,
        metavar="NAME",
        help="built-in behavior that runs after switching on, such as menu; the program can then be started from there",
    )
    parser.add_argument("--seed", type=int, default=SuiteConfig.seed, help="seed of all noise (default: %(default)s)")
    parser.add_argument(
        "--log", type=path_argument, metavar="FILE", help="write a run log that `thymio-sim replay` can repeat"
    )
    robot = parser.add_argument_group("robot")
    robot.add_argument(
        "--card",
        type=path_argument,
        metavar="DIR",
        help="folder used as the memory card; with several robots, each uses the subfolder of its name",
    )
    robot.add_argument(
        "--settings",
        type=path_argument,
        metavar="DIR",
        help="folder in which settings are kept; with several robots, each uses the subfolder of its name",
    )
    robot.add_argument(
        "--layout",
        choices=LAYOUTS,
        default=THYMIO,
        help="order of variables and native functions: firmware 14, or the reference playground (default: %(default)s)",
    )
    robot.add_argument(
        "--events",
        choices=POLICIES,
        default=FIRMWARE,
        help="whether an event waits for the running handler, as on the robot, or ends it (default: %(default)s)",
    )
    robot.add_argument(
        "--motors",
        choices=MOTOR_MODELS,
        default=SuiteConfig.motor_model,
        help="whether motors reach their target at once, or as by the robot's control loop (default: %(default)s)",
    )
    robot.add_argument(
        "--proximity",
        choices=PROXIMITY_MODELS,
        default=SuiteConfig.proximity_model,
        help="how proximity sensors detect thin objects, see docs/robot.md (default: %(default)s)",
    )


def device_options(options: argparse.Namespace) -> DeviceOptions:
    """Options of the robots. Raises UsageError for a folder that cannot be used."""
    device = DeviceOptions(options.layout, options.events, options.card, options.settings)
    try:
        if device.card is not None:
            SdCard(device.card)
        Settings(device.settings_file)
    except (SdCardError, SettingsError) as error:
        raise UsageError(str(error)) from error
    return device


def program_option(options: argparse.Namespace) -> str:
    """Name or path of the program; the default depends on whether a behavior is given."""
    if options.program is not None:
        return str(options.program)
    return NO_PROGRAM if options.behaviour else SuiteConfig.program


def check_files(playground: str, program: str, behaviour: str, layout: str) -> tuple[Playground, dict[str, Assignment]]:
    """Load the playground and compile the programs of its robots, by name of the robot.

    Raises UsageError that says where, what was found and what was expected.
    """
    try:
        check_behaviour(behaviour, layout)
        loaded = load_playground(playground)[1]
        if program not in _WITHOUT_ROBOT and not loaded.robots:
            raise UsageError("; ".join((f"{playground}: found no robot, expected one for {program}", *loaded.notes)))
        return loaded, read_assignments(program, [robot.name for robot in loaded.robots], layout)
    except (PlaygroundError, ProgramError, resources.ResourceError, OSError) as error:
        raise UsageError(str(error)) from error


def check_robot_program(robot: str, program: str) -> None:
    """Compile the program of a real robot for a Thymio II; the robot may lack something that it uses.

    Raises UsageError for a wrong address or program.
    """
    try:
        parse_target(robot)
        read_program(program, described(THYMIO_II))
    except (TargetError, ProgramError, resources.ResourceError, OSError) as error:
        raise UsageError(str(error)) from error


def path_argument(text: str) -> Path:
    """A path, with `~` expanded."""
    return resources.expanded(text)


def number_argument(text: str, low: float, high: float) -> float:
    """A number in a range. Raises ArgumentTypeError."""
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not low <= value <= high:
        raise argparse.ArgumentTypeError(f"'{text}' found, expected a number from {low:g} to {high:g}")
    return value


_LIDAR_WORDS = {"beams": "beams", "range": "range_m", "rate": "rate_hz", "noise": "noise_m"}
"""Words of the option `--lidar`, and the fields of `Lidar` that they set."""


def lidar_argument(text: str) -> Lidar:
    """A lidar from text such as `beams=180,range=2`. Raises ArgumentTypeError."""
    values: dict[str, Any] = {}
    for part in text.split(","):
        word, _, value = part.strip().partition("=")
        if word not in _LIDAR_WORDS or word in values:
            found = "was given twice" if word in values else "is no option of a lidar"
            raise argparse.ArgumentTypeError(
                f"'{word}' {found}, expected {', '.join(f'{known}=…' for known in _LIDAR_WORDS)}, each at most once"
            )
        try:
            values[word] = int(value) if word == "beams" else float(value)
        except ValueError:
            expected = "an integer" if word == "beams" else "a number"
            raise argparse.ArgumentTypeError(f"{word}: found '{value}', expected {expected}") from None
    try:
        return Lidar(**{_LIDAR_WORDS[word]: value for word, value in values.items()})
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def describe_lidar(lidar: Lidar) -> str:
    """The text from which `lidar_argument` makes this lidar."""
    return ",".join(f"{word}={getattr(lidar, name):g}" for word, name in _LIDAR_WORDS.items())
