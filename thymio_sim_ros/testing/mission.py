"""Missions in tests: the rest of a mission with the robot of a test, for points."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from thymio_sim_ros.missions import Judge, Verdict, load_mission
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.testing.record import SECOND_NS
from thymio_sim_ros.testing.thymio import Thymio

__all__ = ["judged"]


def judged(thymio: Thymio, mission: str | Path) -> Verdict:
    """Let time pass until a mission is passed or has failed; return what it says, as `thymio-sim mission` does.

    Raises MissionError for a file that is wrong, FieldError for names that the playground of the test does not have.
    """
    judge = Judge(dataclasses.replace(load_mission(Path(mission)), robot=thymio.name), thymio.stage.engine)
    while not judge.is_over:
        thymio.run(TICK_NS / SECOND_NS)
        judge.tick()
    return judge.verdict
