"""What a tick of the world costs, without ROS and without programs: python benchmarks/sim_step.py [--json]

CPU time of one thread, the best of five rounds of 20 simulated seconds. Robots drive curves all the time; crowds share
a walled square of 0.36 m² each, with one box for every two of them.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from collections.abc import Iterator
from pathlib import Path

from thymio_sim_ros.sim import playground
from thymio_sim_ros.sim.clock import TICK_NS
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.playground import Playground
from thymio_sim_ros.sim.world import World

PLAYGROUNDS = Path(__file__).parents[1] / "playgrounds"
ROUNDS = 5
SECONDS = 20
CELL_M = 0.6


def crowd(count: int) -> Playground:
    """So many robots on a grid, a box beside every second one."""
    columns = math.ceil(math.sqrt(count))
    side = columns * CELL_M
    shapes: list[dict[str, object]] = [
        {"kind": "rectangle", "size_x_m": side, "size_y_m": side, "color": "#c0c0c0", "walls": {}}
    ]
    robots = []
    for index in range(count):
        x = (index % columns + 0.5) * CELL_M - side / 2
        y = (index // columns + 0.5) * CELL_M - side / 2
        robots.append({"name": f"thymio_{index}", "x_m": x, "y_m": y, "yaw_rad": index % 6})
        if index % 2 == 0:
            place = {"x_m": x + 0.22, "y_m": y + 0.22, "size_x_m": 0.08, "size_y_m": 0.05, "height_m": 0.1}
            shapes.append({"kind": "box", "color": "#9fa3bd", **place})
    data = {"format": 1, "title": "crowd", "shapes": shapes, "robots": robots}
    return playground.loads(json.dumps(data), f"{count} robots")


def scenes() -> Iterator[Playground]:
    """The shipped playgrounds that are of interest, then crowds."""
    for name in ("base", "line", "obstacle"):
        yield playground.load(PLAYGROUNDS / f"{name}.json")
    for count in (2, 10, 50):
        yield crowd(count)


def seconds_per_tick(scene: Playground) -> float:
    """The best round."""
    ticks = SECONDS * 1_000_000_000 // TICK_NS // len(scene.robots)
    world = World(scene)
    best = math.inf
    for turn in range(ROUNDS):
        for index, robot in enumerate(world.robots):
            world.post(robot, MotorTargets(300 - 40 * (index % 5), 180 + 50 * turn))
        start = time.process_time()
        for _ in range(ticks):
            world.step()
        best = min(best, (time.process_time() - start) / ticks)
    return best


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")
    arguments = parser.parse_args()
    rows = []
    for scene in scenes():
        seconds = seconds_per_tick(scene)
        per_robot = seconds / len(scene.robots) * 1e6
        rows.append(
            {
                "scene": scene.name,
                "us_per_tick": round(seconds * 1e6, 1),
                "us_per_robot": round(per_robot, 1),
                "times_real_time": round(TICK_NS * 1e-9 / seconds, 1),
            }
        )
    if arguments.json:
        print(json.dumps(rows))
        return
    print(f"{'scene':<12} {'us/tick':>10} {'us/robot':>10} {'x real time':>12}")
    for row in rows:
        print(f"{row['scene']:<12} {row['us_per_tick']:>10} {row['us_per_robot']:>10} {row['times_real_time']:>12}")


if __name__ == "__main__":
    main()
