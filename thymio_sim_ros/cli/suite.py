"""The command `thymio-sim` without a subcommand: simulator, Aseba runtime, Foxglove bridge and page until Ctrl-C."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import thymio_sim_ros
from thymio_sim_ros.access.hosts import is_loopback
from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.cli.banner import banner, qr_code, startup_notice
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.options import (
    EXAMPLE,
    add_world_options,
    check_files,
    check_robot_program,
    describe_lidar,
    device_options,
    lidar_argument,
    number_argument,
    path_argument,
    program_option,
)
from thymio_sim_ros.cli.output import print_text
from thymio_sim_ros.cli.page_options import (
    add_page_options,
    check_port,
    given_certificate,
    given_nodes,
    given_tokens,
)
from thymio_sim_ros.cli.ros.graph_choice import add_graph_options, choose_graph, describe_graph
from thymio_sim_ros.cli.servers import Servers, select_servers
from thymio_sim_ros.engine.replay import LoggedRun, last_run
from thymio_sim_ros.engine.run_log import RunLogError
from thymio_sim_ros.files.loading import NO_PROGRAM
from thymio_sim_ros.network.robot_target import TcpTarget, parse_target
from thymio_sim_ros.network.settings import OFF
from thymio_sim_ros.ros import profiles
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.suite_config import OUT_OF_RANGE, SuiteConfig

__all__ = ["run"]

ROS_ARGS = "--ros-args"

_OF_WORLD = ("playground", "behaviour", "like", "seed", "motors", "proximity", "lidar")
_SIMULATOR_ONLY = (
    *_OF_WORLD,
    "log",
    "card",
    "settings",
    "layout",
    "events",
    "real_time_factor",
    "replay",
    "out_of_range",
)
"""Options that a real robot does not have."""


def run(argv: Sequence[str]) -> int:
    """Start the suite; return the exit code. Raises UsageError before anything starts."""
    own, of_ros = _split_ros_args(argv)
    options = _parser().parse_args(own)
    suite = _suite_config(options)
    if options.log is not None and (os.path.isdir(options.log) or not os.path.isdir(options.log.parent)):
        raise UsageError(f"{options.log}: expected a file in a folder that exists")
    robots = _check_robots(suite)
    if suite.web:
        check_port(suite.address, suite.port, "the page", "--port")
    if suite.foxglove and suite.foxglove_port != OFF:
        check_port(suite.address, suite.foxglove_port, "the Foxglove bridge", "--foxglove-port")
    chosen = select_servers(options, len(robots), suite.tokens or Tokens())
    servers = _without_port_of_robot(chosen, options, suite.robot)
    suite = replace(suite, network=servers.settings)
    # Robots of a classroom stay separate unless the environment says otherwise (docs/spec/ros-packaging.md section 4).
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    from thymio_sim_ros.ros.compat import shm_cleanup

    before = shm_cleanup.present()
    try:
        is_embedded = choose_graph(portable=options.portable, ros=options.ros)
        print_text(describe_graph(os.environ, is_embedded=is_embedded))
        if (notice := startup_notice(len(robots))) is not None:
            print_text(notice)
        from thymio_sim_ros.ros import combined

        return combined.run(
            suite, of_ros, on_ready=lambda: None if options.quiet else _print_banner(suite, robots, servers.lines)
        )
    finally:
        shm_cleanup.remove_new(before)


def _check_robots(suite: SuiteConfig) -> list[str]:
    """Check the files of the suite and return the names of its robots. Raises UsageError."""
    if suite.robot:
        check_robot_program(suite.robot, suite.program)
        return ["thymio"]
    if suite.replay:
        return [robot.name for robot in _run_of(suite.replay).start.playground.robots]
    playground, _ = check_files(suite.playground, suite.program, suite.behaviour, suite.device.layout)
    return [robot.name for robot in playground.robots]


def _run_of(file: str) -> LoggedRun:
    try:
        return last_run(Path(file))
    except OSError as error:
        raise UsageError(f"{file}: {error.strerror}; expected a run log") from error
    except RunLogError as error:
        raise UsageError(str(error)) from error


def _without_port_of_robot(servers: Servers, options: argparse.Namespace, robot: str) -> Servers:
    """Keep the suite from serving the port of its own robot, to which it would connect. Raises UsageError."""
    target = parse_target(robot) if robot else None
    settings = servers.settings
    if not (isinstance(target, TcpTarget) and is_loopback(target.host) and target.port == settings.aseba_port):
        return servers
    if options.aseba_port is not None:
        raise UsageError(f"Aseba port {target.port}: this is the port of the robot; choose another with --aseba-port")
    line = f"Aseba     none: {target.port} is the port of the robot; another port: --aseba-port"
    others = tuple(text for text in servers.lines if not text.startswith("Aseba "))
    return Servers(replace(settings, aseba_port=OFF), (line, *others))


def _split_ros_args(argv: Sequence[str]) -> tuple[list[str], list[str]]:
    """Split the arguments into those of this command and those of ROS, from `--ros-args` on."""
    words = list(argv)
    place = words.index(ROS_ARGS) if ROS_ARGS in words else len(words)
    return words[:place], words[place:]


def _suite_config(options: argparse.Namespace) -> SuiteConfig:
    """The configuration. Raises UsageError for options that exclude each other."""
    if options.robot and (excluded := _chosen(options, _SIMULATOR_ONLY)):
        raise UsageError(f"--robot: found {excluded}; a real robot has no simulator, expected none of its options")
    if options.replay is not None and (excluded := _chosen(options, (*_OF_WORLD, "program"))):
        raise UsageError(f"--replay: found {excluded}; these come from the run log, expected none of them")
    if options.no_foxglove_port and options.no_web:
        raise UsageError("--no-foxglove-port: found --no-web, expected the port of the page for the bridge")
    given_certificate(options)
    profile = _profile(options.like)
    if profile is not None:
        if profile.playground and not _chosen(options, ("playground",)):
            options.playground = profile.playground
        options.program = options.program or profile.program or None
    has_none = options.robot or options.replay is not None
    return SuiteConfig(
        playground=options.playground,
        program=NO_PROGRAM if has_none and options.program is None else program_option(options),
        behaviour=options.behaviour,
        device=device_options(options),
        motor_model=options.motors,
        proximity_model=options.proximity,
        lidar=options.lidar,
        out_of_range=options.out_of_range,
        like="" if profile is None else profile.name,
        robot=options.robot,
        address=options.address,
        port=options.port,
        foxglove_port=OFF if options.no_foxglove_port else options.foxglove_port,
        certificate=options.certificate,
        key=options.key,
        web=not (options.no_web or options.headless),
        foxglove=not options.headless,
        seed=options.seed,
        real_time_factor=options.real_time_factor,
        log="" if options.log is None else str(options.log),
        replay="" if options.replay is None else str(options.replay),
        replay_from_s=options.replay_from,
        tokens=given_tokens(options),
        trusted_proxies=tuple(options.trusted_proxy),
        nodes=given_nodes(options),
    )


def _profile(names: Sequence[str]) -> profiles.Profile | None:
    """The profile that was asked for. Raises UsageError for several, and for an unknown one."""
    if not names:
        return None
    if len(names) > 1:
        raise UsageError(f"--like: found {' and '.join(names)}, expected one robot: its names would meet the other's")
    try:
        return profiles.named(names[0])
    except profiles.ProfileError as error:
        raise UsageError(f"--like: {error}") from error


def _chosen(options: argparse.Namespace, names: Sequence[str]) -> str:
    """The options of a list that differ from their defaults, for the user; empty: none."""
    defaults = _parser().parse_args([])
    chosen = [name for name in names if getattr(options, name) != getattr(defaults, name)]
    return ", ".join(f"--{name.replace('_', '-')}" for name in chosen)


def _print_banner(suite: SuiteConfig, robots: Sequence[str], servers: Sequence[str]) -> None:
    print_text(banner(suite, robots, servers))
    if sys.stdout is not None and sys.stdout.isatty():
        with contextlib.suppress(UnicodeEncodeError):  # a terminal without these characters
            if drawn := qr_code(suite):
                print_text(drawn)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim",
        description="A simulated Thymio II: ROS 2 nodes, Foxglove bridge and a web page. Ctrl-C ends everything.",
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add_world_options(parser)
    parser.add_argument(
        "--like",
        action="append",
        default=[],
        metavar="NAME",
        help="names and types of another robot, so that its courses run here: "
        f"{', '.join(profiles.own_names())} (docs/from-turtlesim.md)",
    )
    parser.add_argument(
        "--robot",
        default=SuiteConfig.robot,
        metavar="ADDRESS",
        help="a real robot in place of the simulator: tcp:host:port, or ser:device, where ser is the first Thymio that "
        "is plugged in (default program: none)",
    )
    add_page_options(parser)
    parser.add_argument(
        "--replay",
        type=path_argument,
        metavar="FILE",
        help="show the last run of a run log in place of a playground, paused shortly before its end; Reset on the "
        "page goes to its start",
    )
    parser.add_argument(
        "--replay-from",
        type=_time_argument,
        default=SuiteConfig.replay_from_s,
        metavar="S",
        help="time at which the replay is paused at first; negative: before its end (default: %(default)g)",
    )
    parser.add_argument(
        "--real-time-factor",
        type=_factor_argument,
        default=SuiteConfig.real_time_factor,
        metavar="F",
        help="simulated seconds per second, 0 is as fast as possible (default: %(default)g)",
    )
    parser.add_argument(
        "--out-of-range",
        choices=OUT_OF_RANGE,
        default=SuiteConfig.out_of_range,
        help="range without an obstacle: +inf, or -1 as code written for the ROS driver expects (default: %(default)s)",
    )
    parser.add_argument(
        "--lidar",
        type=lidar_argument,
        nargs="?",
        const=Lidar(),
        metavar="beams=N,range=M,rate=HZ,noise=M",
        help="give each robot a laser scanner, topic scan; a real Thymio has none (without values: "
        f"{describe_lidar(Lidar())})",
    )
    add_graph_options(parser)
    parser.add_argument(
        "--quiet",
        action="store_true",
        help="print no addresses: they have tokens, which do not belong in the log of a service",
    )
    parser.add_argument("--version", action="version", version=f"thymio-sim {thymio_sim_ros.__version__}")
    return parser


def _factor_argument(text: str) -> float:
    return number_argument(text, 0.0, 1000.0)


def _time_argument(text: str) -> float:
    return number_argument(text, -1e6, 1e6)
