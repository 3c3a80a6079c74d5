"""The world alone: processor time per robot-step, beside Enki and beside an earlier checkout.

A robot-step is 30 ms of one robot: three steps of physics, then the sensors, of which "every step" and "10 Hz" measure
the seven proximity and two ground sensors every 30 ms, as Enki does, or at the rate of the robot's firmware. "9 rays"
is "every step" with the proximity model `cone`. "all" runs every sensor of the robot at its rate and reads every
reading. Everything runs in turn on the same scene, each in a process of its own; the figure is the median of the
rounds.

Enki is measured where Debian's `libenki-dev` and g++ are installed. `--against PATH` measures another checkout, too.
"""

from __future__ import annotations

import argparse
import contextlib
import time
from collections.abc import Callable
from typing import Any

from benchmarks.lib import rounds
from benchmarks.lib.report import Cell, Goal, Report, Table
from benchmarks.lib.scenes import dense_scene, targets
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.world import World

QUICK = {"rounds": 1, "robots": [1, 14], "steps": 33}
ROBOTS = [1, 2, 4, 8, 10, 13, 14, 20, 50, 100, 400]
TICKS = 3
"""Ticks of the world in a robot-step."""
TICK_NS = 10_000_000
BURST = 33
"""Steps between new targets, a second: no robot leans on a wall for long."""
SENSED = ("proximity", "ground")
MODES: dict[str, dict[str, Any]] = {
    "every step": {"periods_ns": dict.fromkeys(SENSED, TICKS * TICK_NS)},
    "10 Hz": {"periods_ns": dict.fromkeys(SENSED, 100_000_000)},
    "9 rays": {"periods_ns": dict.fromkeys(SENSED, TICKS * TICK_NS), "proximity_model": "cone"},
    "all": {},
}
EACH, FIRMWARE, RAYS, ALL = MODES
ENKI = "Enki"
ENKI_RATIOS = {EACH: 0.8, FIRMWARE: 1.3}
"""Least speed with 100 robots in units of Enki's."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--rounds", type=int, default=5, help="rounds; the figures are their medians")
    parser.add_argument("--robots", type=int, nargs="+", default=ROBOTS, help="numbers of robots")
    parser.add_argument("--steps", type=int, default=6600, help="robot-steps of a round")
    rounds.add_against(parser)


def world_of(count: int, mode: str) -> Callable[[int], float]:
    """Return what runs so many bursts and returns the seconds of processor time (for a worker)."""
    world = World(dense_scene(count), **MODES[mode])
    dice = targets()

    def burst() -> float:
        for robot in world.robots:
            world.post(robot, MotorTargets(next(dice), next(dice)))
        begun = time.process_time()
        for _ in range(BURST * TICKS):
            result = world.step()
            if mode == ALL:
                for _reading in result.readings:
                    pass
        return time.process_time() - begun

    return lambda bursts: sum(burst() for _ in range(bursts))


def measure_count(count: int, options: argparse.Namespace) -> dict[tuple[str, str], float]:
    """Return microseconds per robot-step, by (mode, side) and for (Enki, Enki)."""
    from benchmarks.lib import enki  # other checkouts lack what it imports

    bursts = max(1, options.steps // count // BURST)
    with contextlib.ExitStack() as stack:
        runs: dict[tuple[str, str], Callable[[int], float]] = {
            (mode, side): rounds.started(stack, checkout, "simulator:world_of", count, mode)
            for mode in MODES
            for side, checkout in rounds.sides(options).items()
        }
        driver = enki.driver()
        if driver is not None:
            peer = enki.Enki(driver, dense_scene(count))
            stack.callback(peer.close)
            runs[ENKI, ENKI] = lambda bursts: sum(peer.run(BURST) for _ in range(bursts))

        def per_robot_step(run: Callable[[int], float]) -> Callable[[], float]:
            return lambda: run(bursts) / (bursts * BURST * count) * 1e6

        return rounds.medians(rounds.in_turn({key: per_robot_step(run) for key, run in runs.items()}, options.rounds))


def measure(options: argparse.Namespace) -> Report:
    """Measure every number of robots."""
    found = {count: measure_count(count, options) for count in options.robots}
    heads = [str(count) for count in options.robots]
    tables = [Table(["microseconds per robot-step, robots:", *heads], list(_rows(found)))]
    ratios = [
        [mode, *(_ratio(row, (ENKI, ENKI), (mode, rounds.NOW)) for row in found.values())] for mode in (EACH, FIRMWARE)
    ]
    if any(ratios[0][1:]):
        tables.append(Table(["× the speed of Enki, robots:", *heads], ratios))
    if options.against:
        speedups = [
            [mode, *(_ratio(row, (mode, rounds.BEFORE), (mode, rounds.NOW)) for row in found.values())]
            for mode in MODES
        ]
        tables.append(Table(["× the speed of the other commit, robots:", *heads], speedups))
    return Report(tables, _goals(found))


def _rows(found: dict[int, dict[tuple[str, str], float]]) -> Any:
    for key in next(iter(found.values())):
        mode, side = key
        yield [mode if side != rounds.BEFORE else f"{mode}, {side}", *(row[key] for row in found.values())]


def _ratio(row: dict[tuple[str, str], float], slow: tuple[str, str], fast: tuple[str, str]) -> Cell:
    return row[slow] / row[fast] if slow in row else None


def _goals(found: dict[int, dict[tuple[str, str], float]]) -> list[Goal]:
    row = found.get(100, {})
    ratios = {mode: _ratio(row, (ENKI, ENKI), (mode, rounds.NOW)) for mode in ENKI_RATIOS}
    return [
        Goal(f"100 robots, {mode}, to Enki", ENKI_RATIOS[mode], ratio, "×", is_least=True)
        for mode, ratio in ratios.items()
        if ratio is not None
    ]
