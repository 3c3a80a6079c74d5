"""Robot-steps a second, ours and Enki's, on the same scene in turn.

    python benchmarks/simulator.py [--rounds 5] [--robots 1 10 100 400] [--json FILE]

A robot-step is 30 ms of one robot, as Aseba Playground has it: three steps of physics, seven proximity and two ground
sensors. "every step" senses every 30 ms as Enki does, "10 Hz" at the rate of the robot's firmware; "all" runs all
sensors of the robot at their rates and looks at every reading. Processor time of one thread, median of the rounds.
Without Debian's `libenki-dev` or g++ only ours is measured.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

from simulator_enki import Enki, driver
from simulator_scene import dense_scene, targets

from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.world import World

TICKS = 3
"""Ticks of our world in a step of 30 ms."""
SENSED = ("proximity", "ground")
MODES: dict[str, dict[str, object]] = {
    "every step": {"periods_ns": dict.fromkeys(SENSED, TICKS * TICK_NS)},
    "9 rays": {"periods_ns": dict.fromkeys(SENSED, TICKS * TICK_NS), "proximity_model": "cone"},
    "10 Hz": {"periods_ns": dict.fromkeys(SENSED, 100_000_000)},
    "all": {},
}


def ours(scene: Playground, mode: str) -> Callable[[int], float]:
    """Runs new targets and so many steps of 30 ms; gives the seconds of processor time."""
    world = World(scene, **MODES[mode])  # type: ignore[arg-type]  # the table's values are of several types
    dice = targets()

    def run(steps: int) -> float:
        for robot in world.robots:
            world.post(robot, MotorTargets(next(dice), next(dice)))
        begun = time.process_time()
        for _ in range(steps * TICKS):
            result = world.step()
            if mode == "all":
                for _reading in result.readings:
                    pass
        return time.process_time() - begun

    return run


def measure(count: int, rounds: int) -> dict[str, float]:
    """Microseconds per robot-step, by mode and for Enki."""
    scene = dense_scene(count)
    runs = {mode: ours(scene, mode) for mode in MODES}
    program = driver()
    peer = Enki(program, scene) if program is not None else None
    if peer is not None:
        runs["Enki"] = peer.run
    steps = max(33, 6600 // count)
    spent: dict[str, list[float]] = {name: [] for name in runs}
    for turn in range(rounds + 1):
        for name, run in runs.items():
            # fresh targets every second, so that no robot leans on a wall for long
            seconds = sum(run(33) for _ in range(steps // 33))
            if turn > 0:  # the first warms up
                spent[name].append(seconds / (steps // 33 * 33) / count * 1e6)
    if peer is not None:
        peer.close()
    return {name: statistics.median(values) for name, values in spent.items()}


def table(report: dict[str, dict[str, float]]) -> str:
    """For people."""
    lines = [f"{'robots':>6}  {'mode':<12}{'us per robot-step':>18}{'x real time':>12}{'x Enki':>8}"]
    for count, row in report.items():
        for name, micros in row.items():
            ratio = f"{row['Enki'] / micros:8.2f}" if "Enki" in row else ""
            lines.append(f"{count:>6}  {name:<12}{micros:18.2f}{30_000 / micros / int(count):12.1f}{ratio}")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--robots", type=int, nargs="+", default=[1, 10, 100, 400])
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there")
    arguments = parser.parse_args()
    report = {str(count): measure(count, arguments.rounds) for count in arguments.robots}
    sys.stdout.write(table(report))
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
