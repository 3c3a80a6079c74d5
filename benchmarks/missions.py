"""Missions: what judging a try adds to a tick of the engine.

Each shipped mission runs with a solution twice, in turns of some ticks: judged as on the page, and not judged. The
figures are processor time per tick, the least of all rounds. A tick is 10 ms of simulated time, which is the time that
a live suite has for it; a tick of the engine alone, without messages, takes a small part of that.
"""

from __future__ import annotations

import argparse
import time

from benchmarks.lib.report import Goal, Report, Table
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.inputs import Input
from thymio_sim_ros.files.loading import load_playground, read_program
from thymio_sim_ros.missions.live import LiveMission
from thymio_sim_ros.missions.shipped import ShippedMission, shipped
from thymio_sim_ros.missions.trial import programs_of_others
from thymio_sim_ros.sim.model.clock import TICK_NS

QUICK = {"rounds": 2, "ticks": 20}

US_PER_S = 1e6
TICK_US = TICK_NS / 1000
LIMIT_PERCENT = 2.0
NODE = "ros"
"""The language of solutions that are no programs of a robot."""


class _Recorder:
    """Keeps nothing. With a recorder, as in every live suite, the engine makes a digest each second."""

    def record(self, tick: int, happened: Input) -> None:
        """Drop an input."""

    def record_digest(self, tick: int, digest: str) -> None:
        """Drop a digest."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--rounds", type=int, default=40, help="turns of each side")
    parser.add_argument("--ticks", type=int, default=20, help="ticks of a turn")


def measure(options: argparse.Namespace) -> Report:
    """Measure all missions with a program of a robot."""
    missions = [each for step in shipped() for each in step.missions if _solution(each)]
    rows = [[each.name, *_costs(each, options.rounds, options.ticks)] for each in missions]
    columns = ["mission", "tick of the engine, µs", "judging it, µs", "of 10 ms, %"]
    most = max(float(row[-1]) for row in rows)
    return Report([Table(columns, rows)], [Goal("judging a mission, of a tick in real time", LIMIT_PERCENT, most, "%")])


def _solution(each: ShippedMission) -> str:
    return next((path for language, path in each.mission.solutions.items() if language != NODE), "")


def _costs(each: ShippedMission, rounds: int, ticks: int) -> tuple[float, float, float]:
    """Time of a tick, of judging it, in µs, and the latter in % of a tick in real time."""
    mission = each.mission
    playground = load_playground(mission.playground)[1]
    name = mission.robot or playground.robots[0].name
    programs = programs_of_others(mission, playground) | {name: read_program(_solution(each))}
    plain, judged = Engine(playground, programs), Engine(playground, programs)
    plain.recorders.append(_Recorder())
    live = LiveMission(mission, judged, judged.reset)
    alone_s, with_judge_s = [], []
    for _ in range(rounds):
        if not live.is_running:  # another try, on both sides
            plain.reset()
            judged.reset()
        begin_s = time.process_time()
        for _ in range(ticks):
            plain.step()
        between_s = time.process_time()
        for _ in range(ticks):
            live.before_tick()
            judged.step()
            live.after_tick()
        alone_s.append(between_s - begin_s)
        with_judge_s.append(time.process_time() - between_s)
    tick_us = min(alone_s) / ticks * US_PER_S
    judging_us = max(0.0, min(with_judge_s) / ticks * US_PER_S - tick_us)
    return tick_us, judging_us, 100.0 * judging_us / TICK_US
