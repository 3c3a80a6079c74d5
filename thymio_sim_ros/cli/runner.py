"""The command `thymio-sim runner`: world and programs in lock-step without ROS, as fast as possible."""

from __future__ import annotations

import argparse
import sys
import time
from collections import deque
from collections.abc import Mapping, Sequence

from aseba_vm.cli.output import exit_by_signal
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.options import (
    EXAMPLE,
    add_world_options,
    check_files,
    device_options,
    number_argument,
    path_argument,
    program_option,
)
from thymio_sim_ros.cli.output import print_json
from thymio_sim_ros.cli.runner_sound import SOUND_SENSOR, run_with_sound
from thymio_sim_ros.cli.signal_handling import StopSignal
from thymio_sim_ros.device.programs.program_assignment import Assignment, note_lines
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.faults import ProgramFaults
from thymio_sim_ros.engine.run_log import RunLog

__all__ = ["run"]

EXIT_CODES = """\
exit code: 0 done; 1 a program stopped with a fault (reported on stderr and in the result); 2 rejected input
"""

FAULT_FOUND = 1


def run(argv: Sequence[str]) -> int:
    """Run the programs and print the final poses; return the exit code. Raises UsageError for rejected input."""
    options = _parser().parse_args(argv)
    device = device_options(options)
    playground, assignments = check_files(options.playground, program_option(options), options.behaviour, device.layout)
    for note in playground.notes:
        _print_error(f"{options.playground}: {note}")
    _print_assignment_notes(assignments)
    try:
        log = None if options.log is None else RunLog(options.log.open("w", encoding="utf-8", newline="\n"))
        engine = Engine(
            playground,
            {name: assignment.program for name, assignment in assignments.items() if assignment.program is not None},
            behaviour=options.behaviour,
            options=device,
            motor_model=options.motors,
            proximity_model=options.proximity,
            seed=options.seed,
        )
        if log is not None:
            log.begin(playground.name, engine)
        faults = ProgramFaults(engine, _print_error)
        started = time.perf_counter()
        with StopSignal() as stop:
            sensors = () if options.sound is None else (SOUND_SENSOR,)
            steps = faults.checked(stop.until_signal(engine.steps(options.seconds, sensors)))
            if options.sound is None:
                deque(steps, maxlen=0)
            else:
                run_with_sound(engine, steps, options.sound)
        if log is not None:
            log.close()
    except OSError as error:
        file = error.filename or options.log or options.sound
        raise UsageError(f"{file}: {error.strerror}; expected a file that can be written") from error
    print_json(_result(engine, faults, time.perf_counter() - started))
    if stop.number is not None:
        _print_error(f"stopped after {engine.now_ns / 1e9:g} of {options.seconds:g} seconds")
        exit_by_signal(stop.number)
    return FAULT_FOUND if faults.first else 0


def _result(engine: Engine, faults: ProgramFaults, elapsed_s: float) -> Mapping[str, object]:
    """Simulated seconds, real-time factor, and pose and first fault of each robot."""
    seconds = engine.now_ns / 1e9
    robots: dict[str, dict[str, float | str]] = {
        name: {"x_m": robot.pose.x_m, "y_m": robot.pose.y_m, "yaw_rad": robot.pose.yaw_rad}
        for name, robot in engine.world.robots.items()
    }
    for name, fault in faults.first.items():
        robots[name]["fault"] = fault
    return {"seconds": seconds, "real_time_factor": round(seconds / max(elapsed_s, 1e-9), 1), "robots": robots}


def _print_assignment_notes(assignments: Mapping[str, Assignment]) -> None:
    """Print each note once, with the robots that it concerns."""
    for line in note_lines((name, assignment.notes) for name, assignment in assignments.items()):
        _print_error(line)


def _print_error(text: str) -> None:
    print(f"thymio-sim: {text}", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim runner",
        description="Run programs in a playground without ROS, as fast as possible. The same seed gives the same run.",
        epilog=f"{EXIT_CODES}\n{EXAMPLE}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add_world_options(parser)
    parser.add_argument(
        "--seconds", type=_seconds_argument, default=60.0, help="simulated seconds (default: %(default)g)"
    )
    parser.add_argument(
        "--sound", type=path_argument, metavar="FILE.wav", help="write the mixed sound of all loudspeakers to a file"
    )
    return parser


def _seconds_argument(text: str) -> float:
    return number_argument(text, 0.0, 1e7)
