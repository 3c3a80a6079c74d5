"""How much faster than real time robots run without ROS, with their programs and all their sensors.

    python benchmarks/simulator_runner.py [--rounds 5] [--json FILE]

One robot follows the line with its program, with the optional WebAssembly engine where wasmtime is installed; or it
drives there without a program. Twenty robots explore between boxes, each with a program. Processor time of one
thread, median of the rounds.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import time
from pathlib import Path

from simulator_scene import dense_scene

from thymio_sim_ros.loading import load_playground, read_program
from thymio_sim_ros.runner import Runner
from thymio_sim_ros.sim.commands import MotorTargets

BEHAVIOURS = Path(__file__).parents[1] / "thymio_sim_ros" / "device" / "firmware" / "behaviors"


def runners() -> dict[str, Runner]:
    """What is measured, by what it is called."""
    _, line = load_playground("line")
    driving = Runner(line)
    driving.post("thymio", MotorTargets(200, 150))
    return {
        "one robot, no program": driving,
        "one robot follows the line": Runner(line, read_program(str(BEHAVIOURS / "line_follower.aesl"))),
        "20 robots explore": Runner(dense_scene(20), read_program(str(BEHAVIOURS / "explorer.aesl"))),
    }


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there")
    arguments = parser.parse_args()
    factors: dict[str, list[float]] = {}
    measured = runners()
    for turn in range(arguments.rounds + 1):
        for name, runner in measured.items():
            seconds = 20.0 / len(runner.world.robots)
            begun = time.process_time()
            runner.run(seconds)
            if turn > 0:  # the first warms up
                factors.setdefault(name, []).append(seconds / (time.process_time() - begun))
    report = {name: round(statistics.median(values), 1) for name, values in factors.items()}
    sys.stdout.write("".join(f"{name:<30}{factor:8.1f} x real time\n" for name, factor in report.items()))
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
