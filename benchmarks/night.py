"""Many simulated hours as fast as possible, without ROS: does the runner keep memory, and does it become slower?

One robot follows the line, and four robots explore between boxes, each with its program; each scene in a process of its
own. After each part of the time, the process is measured: memory (PSS), objects of Python, and how many times real time
the part took (processor time). The change is the median slope (Theil and Sen) times the duration, without the first
part, in which programs and kernels are compiled. Needs Linux.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import os
import statistics
import time
from collections.abc import Callable

from benchmarks.lib import rounds
from benchmarks.lib.report import ROOT, Cell, Goal, Report, Table
from benchmarks.lib.scenes import dense_scene
from benchmarks.lib.soak_samples import change, sample
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground, read_program

QUICK = {"hours": 0.01, "parts": 4}
BEHAVIORS = ROOT / "thymio_sim_ros" / "device" / "firmware" / "behaviors"
LINE = ROOT / "playgrounds" / "line.json"
LINE_FOLLOWER, EXPLORERS = "one robot follows the line", "four robots explore"
MOST_PERCENT = 5.0
"""Growth of memory, and loss of speed, that counts as flat."""
HOUR_S = 3600.0


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--hours", type=float, default=8.0, help="simulated hours of each scene")
    parser.add_argument("--parts", type=int, default=8, help="parts after which the process is measured")


def runner_of(scene: str, seconds: float) -> Callable[[], tuple[float, float, int]]:
    """Return what runs a scene for so long and measures speed, memory in MB, and objects (for a worker)."""
    if scene == EXPLORERS:
        engine = Engine(dense_scene(4), read_program(str(BEHAVIORS / "explorer.aesl")))
    else:
        engine = Engine(load_playground(str(LINE))[1], read_program(str(BEHAVIORS / "line_follower.aesl")))

    def run() -> tuple[float, float, int]:
        begun = time.process_time()
        engine.run(seconds)
        speed = seconds / (time.process_time() - begun)
        gc.collect()
        return speed, sample(os.getpid(), 0.0).pss_mb, len(gc.get_objects())

    return run


def measure(options: argparse.Namespace) -> Report:
    """Run both scenes part by part."""
    hours = [options.hours * part / options.parts for part in range(1, options.parts + 1)]
    seconds = options.hours * HOUR_S / options.parts
    tables, goals = [], []
    for scene in (LINE_FOLLOWER, EXPLORERS):
        with contextlib.ExitStack() as stack:
            run = rounds.started(stack, ROOT, "night:runner_of", scene, seconds)
            parts = [run() for _ in hours]
        rows: list[list[Cell]] = [[hour, *part] for hour, part in zip(hours, parts, strict=True)]
        tables.append(Table(["simulated hours", "× real time", "PSS, MB", "objects of Python"], rows, scene))
        speed, memory, objects = (percent(hours[1:], [part[at] for part in parts[1:]]) for at in range(3))
        goals += [
            Goal(f"{scene}: growth of memory (PSS)", MOST_PERCENT, memory, "%"),
            Goal(f"{scene}: growth of objects of Python", MOST_PERCENT, objects, "%"),
            Goal(f"{scene}: loss of speed", MOST_PERCENT, -speed, "%"),
        ]
    return Report(tables, goals)


def percent(hours: list[float], values: list[float]) -> float:
    """A change as a part of the median."""
    return 100 * change(hours, values) / statistics.median(values)
