"""World, devices and programs without ROS: how many times real time they run, beside an earlier checkout.

One robot drives on the line without a program, or follows it with its program; twenty robots explore between boxes,
each with its program; all sensors run. Processor time of one thread; the checkouts take turns, each scene in a process
of its own, and the figure is the median of the rounds. `--against PATH` measures another checkout, too.
"""

from __future__ import annotations

import argparse
import contextlib
import time
from collections.abc import Callable

from benchmarks.lib import rounds
from benchmarks.lib.report import ROOT, Report, Table
from benchmarks.lib.scenes import dense_scene
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground, read_program
from thymio_sim_ros.sim.commands import MotorTargets

QUICK = {"rounds": 1, "seconds": 1.0}
BEHAVIORS = ROOT / "thymio_sim_ros" / "device" / "firmware" / "behaviors"
LINE = ROOT / "playgrounds" / "line.json"

IDLE, LINE_FOLLOWER, EXPLORERS = "one robot, no program", "one robot follows the line", "20 robots explore"
SCENES = (LINE_FOLLOWER, IDLE, EXPLORERS)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--rounds", type=int, default=7, help="rounds; the figures are their medians")
    parser.add_argument("--seconds", type=float, default=60.0, help="of simulated time, for all robots of a round")
    rounds.add_against(parser)


def runner_of(scene: str, robot_seconds: float) -> Callable[[], float]:
    """Return what runs a scene for so long and returns how many times real time that was (for a worker)."""
    if scene == EXPLORERS:
        engine = Engine(dense_scene(20), read_program(str(BEHAVIORS / "explorer.aesl")))
    elif scene == LINE_FOLLOWER:
        engine = Engine(load_playground(str(LINE))[1], read_program(str(BEHAVIORS / "line_follower.aesl")))
    else:
        engine = Engine(load_playground(str(LINE))[1])
        engine.post("thymio", MotorTargets(200, 150))
    seconds = robot_seconds / len(engine.world.robots)

    def run() -> float:
        begun = time.process_time()
        engine.run(seconds)
        return seconds / (time.process_time() - begun)

    return run


def measure(options: argparse.Namespace) -> Report:
    """Measure all scenes in turn."""
    sides = rounds.sides(options)
    with contextlib.ExitStack() as stack:
        runs = {
            (scene, side): rounds.started(stack, checkout, "simulator_runner:runner_of", scene, options.seconds)
            for scene in SCENES
            for side, checkout in sides.items()
        }
        factors = rounds.medians(rounds.in_turn(runs, options.rounds))
    if rounds.BEFORE not in sides:
        return Report([Table(["", "× real time"], [[scene, factors[scene, rounds.NOW]] for scene in SCENES])])
    ratios = {scene: factors[scene, rounds.NOW] / factors[scene, rounds.BEFORE] for scene in SCENES}
    rows = [[scene, *(factors[scene, side] for side in sides), ratios[scene]] for scene in SCENES]
    return Report([Table(["× real time", *sides, "ratio"], rows)])
