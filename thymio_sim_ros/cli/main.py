"""The command `thymio-sim`: start the whole suite, run a program without ROS, replay a run, or convert a playground.

All input is checked before anything starts; an error is one line on stderr, with exit code 2.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import ipaddress
import json
import os
import signal
import sys
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import thymio_sim_ros
from aseba_vm.cli.output import STANDARD_OUTPUT, exit_by_signal, standard_output
from thymio_sim_ros import resources
from thymio_sim_ros.banner import banner, qr_code, startup_notice
from thymio_sim_ros.bridge.access import READ_ONLY_VARIABLE, TOKEN, TOKEN_VARIABLE, Tokens
from thymio_sim_ros.bridge.server_thread import check_free
from thymio_sim_ros.cli import convert, foxglove_layout
from thymio_sim_ros.device.event_queue import FIRMWARE, POLICIES
from thymio_sim_ros.device.firmware.sd_card import SdCard, SdCardError
from thymio_sim_ros.device.firmware.settings import Settings, SettingsError
from thymio_sim_ros.device.layout import LAYOUTS, THYMIO
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.program import ProgramError
from thymio_sim_ros.device.programs.program_assignment import Assignment
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.loading import NO_PROGRAM, check_behaviour, load_playground, read_assignments
from thymio_sim_ros.sim.commands import MOTOR_MODELS
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError
from thymio_sim_ros.suite_config import ADDRESS, SuiteConfig

EXAMPLE = """\
example:
  thymio-sim --playground obstacle --program my_robot.aesl
  thymio-sim --behaviour menu                                (arrows choose, the center button starts)
  thymio-sim runner --program my_robot.aesl --seconds 60     (without ROS, as fast as possible)
  thymio-sim runner --log run.jsonl; thymio-sim replay run.jsonl   (repeats the run, bit for bit)
  thymio-sim convert maze.playground -o maze.json            (from Aseba and others; without ROS)
  thymio-sim foxglove-layout -o thymio.json                  (panels for Foxglove and Lichtblick)
  thymio-sim --ros-args -r __ns:=/lab1                       (ROS arguments come last; here a namespace)
"""

RUNNER_CODES = """\
exit code: 0 done; 1 a program stopped with a fault (reported on stderr and in the result); 2 rejected input
"""

USAGE_ERROR, DIFFERENT, FAULTY = 2, 1, 1

ROS_ARGS = "--ros-args"


class UsageError(ThymioSimError):
    """A request that cannot be executed; the text is one line."""


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point; the exit code."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    commands: dict[str, Callable[[Sequence[str]], int]] = {
        "runner": run_without_ros,
        "convert": convert.run,
        "foxglove-layout": foxglove_layout.run,
        "replay": replay_run,
    }
    command = commands.get(arguments[0], start_suite) if arguments else start_suite
    if command is not start_suite:
        arguments = arguments[1:]
    try:
        return command(arguments)
    except BrokenPipeError:  # the reader has closed the pipe, as `head` does
        return 0
    except OSError as error:
        if error.filename != STANDARD_OUTPUT:
            raise
        print(f"thymio-sim: {STANDARD_OUTPUT}: {error.strerror}", file=sys.stderr)
    except UsageError as error:
        print(f"thymio-sim: {error}", file=sys.stderr)
    except KeyboardInterrupt:
        exit_by_signal(signal.SIGINT)
    return USAGE_ERROR


def start_suite(argv: Sequence[str]) -> int:
    """Run simulator, Aseba runtime, Foxglove bridge and page until Ctrl-C."""
    own, of_ros = _split_ros_args(argv)
    options = _suite_parser().parse_args(own)
    suite = SuiteConfig(
        playground=options.playground,
        program=_program(options),
        behaviour=options.behaviour,
        device=_device(options),
        motor_model=options.motors,
        proximity_model=options.proximity,
        address=options.address,
        port=options.port,
        foxglove_port=options.foxglove_port,
        web=not (options.no_web or options.headless),
        foxglove=not options.headless,
        seed=options.seed,
        real_time_factor=options.real_time_factor,
        log="" if options.log is None else str(options.log),
        tokens=_tokens(options),
    )
    if options.log is not None and (os.path.isdir(options.log) or not os.path.isdir(options.log.parent)):
        raise UsageError(f"{options.log}: expected a file in a folder that exists")
    playground, _ = _check_files(suite.playground, suite.program, suite.behaviour, suite.device.layout)
    robots = [robot.name for robot in playground.robots]
    if suite.web:
        _check_port(suite.address, suite.port, "the page", "--port")
    if suite.foxglove:
        _check_port(suite.address, suite.foxglove_port, "the Foxglove bridge", "--foxglove-port")
    _check_ros()
    if (wait := startup_notice(len(robots))) is not None:
        _tell(wait)
    # Robots of a classroom stay separate unless the environment says otherwise (docs/spec/ros-packaging.md section 4).
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    from thymio_sim_ros.ros.compat import shm_cleanup

    before = shm_cleanup.present()
    from thymio_sim_ros.ros import combined

    try:
        return combined.run(suite, of_ros, on_ready=lambda: _print_banner(suite, robots))
    finally:
        shm_cleanup.remove_new(before)


def _split_ros_args(argv: Sequence[str]) -> tuple[list[str], list[str]]:
    """Split the arguments into those of this command and those of ROS, from `--ros-args` on."""
    words = list(argv)
    place = words.index(ROS_ARGS) if ROS_ARGS in words else len(words)
    return words[:place], words[place:]


def run_without_ros(argv: Sequence[str]) -> int:
    """Run world and programs in lock-step, as fast as possible; print the final poses."""
    options = _runner_parser().parse_args(argv)
    device = _device(options)
    playground, shares = _check_files(options.playground, _program(options), options.behaviour, device.layout)
    from thymio_sim_ros.cli.runner_faults import RunnerFaults
    from thymio_sim_ros.cli.runner_sound import run_with_sound
    from thymio_sim_ros.cli.signal_handling import StopSignal
    from thymio_sim_ros.runlog.run_log import RunLog
    from thymio_sim_ros.runner import Runner

    for note in playground.notes:
        print(f"thymio-sim: {options.playground}: {note}", file=sys.stderr)
    for note in dict.fromkeys(note for share in shares.values() for note in share.notes):
        concerned = ", ".join(robot for robot, share in shares.items() if note in share.notes)
        print(f"thymio-sim: {concerned}: {note}", file=sys.stderr)
    try:
        log = None if options.log is None else RunLog(options.log.open("w", encoding="utf-8", newline="\n"))
        runner = Runner(
            playground,
            {robot: share.program for robot, share in shares.items() if share.program is not None},
            behaviour=options.behaviour,
            options=device,
            motor_model=options.motors,
            proximity_model=options.proximity,
            seed=options.seed,
            log=log,
        )
        faults = RunnerFaults(runner, lambda text: print(f"thymio-sim: {text}", file=sys.stderr))
        started = time.perf_counter()
        with StopSignal() as stop:
            steps = faults.checked(stop.until_signal(runner.steps(options.seconds)))
            if options.sound is None:
                deque(steps, maxlen=0)
            else:
                run_with_sound(runner, steps, options.sound)
        if log is not None:
            log.close()
    except OSError as error:
        where = error.filename or options.log or options.sound
        raise UsageError(f"{where}: {error.strerror}; expected a file that can be written") from error
    seconds = runner.now_ns / 1e9
    factor = seconds / max(time.perf_counter() - started, 1e-9)
    robots: dict[str, dict[str, float | str]] = {
        name: {"x_m": robot.pose.x_m, "y_m": robot.pose.y_m, "yaw_rad": robot.pose.yaw_rad}
        for name, robot in runner.world.robots.items()
    }
    for name, fault in faults.first.items():
        robots[name]["fault"] = fault
    _report({"seconds": seconds, "real_time_factor": round(factor, 1), "robots": robots})
    if stop.number is not None:
        print(f"thymio-sim: stopped after {seconds:g} of {options.seconds:g} seconds", file=sys.stderr)
        exit_by_signal(stop.number)
    return FAULTY if faults.first else 0


def replay_run(argv: Sequence[str]) -> int:
    """Replay a run log; 1 when something differs."""
    options = _replay_parser().parse_args(argv)
    from thymio_sim_ros.cli.replay import replay
    from thymio_sim_ros.runlog.run_log import RunLogError, made_by

    started = time.perf_counter()
    try:
        found = replay(options.file)
    except OSError as error:
        raise UsageError(f"{options.file}: {error.strerror}; expected a run log") from error
    except RunLogError as error:
        raise UsageError(str(error)) from error
    factor = found.seconds / max(time.perf_counter() - started, 1e-9)
    if not found.is_complete:
        print(f"thymio-sim: {options.file}: the log was cut off; replayed as far as it goes", file=sys.stderr)
    if found.differs is not None:
        run, tick = found.differs
        maker = made_by(options.file)
        versions = "" if maker == thymio_sim_ros.__version__ else f" (then {maker}, now {thymio_sim_ros.__version__})"
        told = f"run {run}, tick {tick} gives something else than then{versions}"
        print(f"thymio-sim: {options.file}: {told}", file=sys.stderr)
    report = {"runs": found.runs, "seconds": found.seconds, "identical": found.differs is None}
    _report(report | {"real_time_factor": round(factor, 1)})
    return 0 if found.differs is None else DIFFERENT


def _report(found: Mapping[str, object]) -> None:
    _tell(json.dumps(found, indent=2))


def _tell(text: str) -> None:
    with standard_output():
        print(text)


def _print_banner(suite: SuiteConfig, robots: Sequence[str]) -> None:
    _tell(banner(suite, robots))
    if sys.stdout is not None and sys.stdout.isatty():
        with contextlib.suppress(UnicodeEncodeError):  # a terminal without these characters
            if drawn := qr_code(suite):
                _tell(drawn)


def _replay_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim replay",
        description="Do a run again from its log, and compare every tick bit for bit. Exit code 1: something differs.",
        allow_abbrev=False,
    )
    parser.add_argument("file", type=Path, metavar="FILE", help="a log of `thymio-sim runner --log` or the simulator")
    return parser


def _suite_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim",
        description="A simulated Thymio II: ROS 2 nodes, Foxglove bridge and a web page. Ctrl-C ends everything.",
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    _add_world_options(parser)
    parser.add_argument(
        "--address",
        type=_address,
        default=SuiteConfig.address,
        metavar="IPV4",
        help="where page and bridge listen; 0.0.0.0 is the whole network, which then needs the address with the token "
        "that is printed (default: %(default)s)",
    )
    parser.add_argument(
        "--token",
        type=_token,
        metavar="TEXT",
        help=f"token that clients need, in place of a random one; other users of this computer see it in its list of "
        f"processes, but not in the variable {TOKEN_VARIABLE}",
    )
    parser.add_argument(
        "--read-only-token",
        type=_token,
        metavar="TEXT",
        help=f"token with which clients only watch, in place of a random one; or {READ_ONLY_VARIABLE}",
    )
    parser.add_argument(
        "--no-token", action="store_true", help="let everyone whom the address reaches do everything, without a token"
    )
    parser.add_argument("--port", type=_port, default=SuiteConfig.port, help="port of the page (default: %(default)s)")
    parser.add_argument(
        "--foxglove-port",
        type=_port,
        default=SuiteConfig.foxglove_port,
        help="port of the bridge (default: %(default)s)",
    )
    parser.add_argument("--no-web", action="store_true", help="no web page; Foxglove can still connect")
    parser.add_argument("--headless", action="store_true", help="only the ROS nodes: no page, no Foxglove bridge")
    parser.add_argument(
        "--real-time-factor",
        type=_factor,
        default=SuiteConfig.real_time_factor,
        metavar="F",
        help="simulated seconds per second, 0 is as fast as possible (default: %(default)g)",
    )
    parser.add_argument("--version", action="version", version=f"thymio-sim {thymio_sim_ros.__version__}")
    return parser


def _runner_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim runner",
        description="Run a program in a playground without ROS, as fast as possible; the same seed, the same run.",
        epilog=f"{RUNNER_CODES}\n{EXAMPLE}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    _add_world_options(parser)
    parser.add_argument("--seconds", type=_seconds, default=60.0, help="simulated seconds (default: %(default)g)")
    parser.add_argument("--sound", type=_path, metavar="FILE.wav", help="store what the robots' loudspeakers said")
    return parser


def _add_world_options(parser: argparse.ArgumentParser) -> None:
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
        help="what the robot is switched on with, such as menu; the program then waits in the menu",
    )
    parser.add_argument("--seed", type=int, default=SuiteConfig.seed, help="seed of all noise (default: %(default)s)")
    parser.add_argument("--log", type=_path, metavar="FILE", help="write a run log that `thymio-sim replay` does again")
    robot = parser.add_argument_group("the robot")
    robot.add_argument(
        "--card",
        type=_path,
        metavar="DIR",
        help="folder that stands for the memory card; with several robots each has a folder of its name in it",
    )
    robot.add_argument("--settings", type=_path, metavar="DIR", help="folder that keeps settings, likewise")
    robot.add_argument(
        "--layout",
        choices=LAYOUTS,
        default=THYMIO,
        help="order of variables and natives: firmware 14, or the reference playground (default: %(default)s)",
    )
    robot.add_argument(
        "--events",
        choices=POLICIES,
        default=FIRMWARE,
        help="whether events wait, as on the robot, or end a handler that runs (default: %(default)s)",
    )
    robot.add_argument(
        "--motors",
        choices=MOTOR_MODELS,
        default=SuiteConfig.motor_model,
        help="whether motors follow at once, or as the robot's control loop moves them (default: %(default)s)",
    )
    robot.add_argument(
        "--proximity",
        choices=PROXIMITY_MODELS,
        default=SuiteConfig.proximity_model,
        help="how proximity sensors see thin things: see docs/robot.md (default: %(default)s)",
    )


def _device(options: argparse.Namespace) -> DeviceOptions:
    """What the robot's options say; UsageError for a folder that cannot be used."""
    device = DeviceOptions(options.layout, options.events, options.card, options.settings)
    try:
        if device.card is not None:
            SdCard(device.card)
        Settings(device.settings_file)
    except (SdCardError, SettingsError) as error:
        raise UsageError(str(error)) from error
    return device


def _path(text: str) -> Path:
    return resources.expanded(text)


def _program(options: argparse.Namespace) -> str:
    if options.program is not None:
        return str(options.program)
    return NO_PROGRAM if options.behaviour else SuiteConfig.program


def _address(text: str) -> str:
    try:
        return text if text == ADDRESS else str(ipaddress.IPv4Address(text))
    except ValueError as error:
        raise argparse.ArgumentTypeError(
            f"'{text}' found, expected {ADDRESS}, 0.0.0.0 for the whole network, or an IPv4 number of this computer"
        ) from error


def _token(text: str) -> str:
    if not TOKEN.fullmatch(text):
        raise argparse.ArgumentTypeError("expected 4 to 200 letters, digits, '.', '_', '~' or '-'")
    return text


def _tokens(options: argparse.Namespace) -> Tokens:
    """What clients need; UsageError for what cannot be."""
    given = options.token, options.read_only_token
    if options.no_token:
        if any(given):
            raise UsageError("--no-token: expected no other option for tokens")
        return Tokens()
    full, read_only = given[0] or _from_environment(TOKEN_VARIABLE), given[1] or _from_environment(READ_ONLY_VARIABLE)
    if full and full == read_only:
        raise UsageError("the token and the read-only token are the same; expected two different ones")
    return Tokens.for_address(options.address, full, read_only)


def _from_environment(variable: str) -> str:
    text = os.environ.get(variable, "")
    try:
        return _token(text) if text else ""
    except argparse.ArgumentTypeError as error:
        raise UsageError(f"{variable}: {error}") from error


def _port(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 65535:
        raise argparse.ArgumentTypeError(f"'{text}' is no port; expected a number from 1 to 65535")
    return int(text)


def _factor(text: str) -> float:
    return _number(text, 0.0, 1000.0)


def _seconds(text: str) -> float:
    return _number(text, 0.0, 1e7)


def _number(text: str, low: float, high: float) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not low <= value <= high:
        raise argparse.ArgumentTypeError(f"'{text}' found, expected a number from {low:g} to {high:g}")
    return value


def _check_files(
    playground: str, program: str, behaviour: str, layout: str
) -> tuple[Playground, dict[str, Assignment]]:
    """Playground and its robots' programs, checked; UsageError says where, what was found, what was expected."""
    try:
        check_behaviour(behaviour, layout)
        loaded = load_playground(playground)[1]
        return loaded, read_assignments(program, [robot.name for robot in loaded.robots], layout)
    except (PlaygroundError, ProgramError, resources.ResourceError, OSError) as error:
        raise UsageError(str(error)) from error


def _check_port(address: str, port: int, whose: str, option: str) -> None:
    try:
        check_free(address, port)
    except OSError as error:
        options = option if address == ADDRESS else f"{option} or --address"
        raise UsageError(f"port {port} of {whose}: {error.strerror}; choose another with {options}") from error


def _check_ros() -> None:
    if importlib.util.find_spec("rclpy") is None:
        raise UsageError(
            "ROS 2 is not installed here: on Linux x86-64 run `pip install 'thymio_sim_ros[ros]'`, elsewhere source a "
            "ROS 2 Jazzy installation; `thymio-sim runner` works without"
        )
