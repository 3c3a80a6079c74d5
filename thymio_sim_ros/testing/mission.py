"""Missions in tests: the rest of a mission with the robot of a test, for points."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from thymio_sim_ros.missions import Judge, Mission, Verdict, load_mission
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.testing.record import SECOND_NS
from thymio_sim_ros.testing.thymio import Thymio

__all__ = ["check_star", "judged"]


def judged(thymio: Thymio, mission: str | Path) -> Verdict:
    """Let time pass until a mission is passed or has failed; return what it says, as `thymio-sim mission` does.

    Raises MissionError for a file that is wrong, FieldError for names that the playground of the test does not have.
    """
    return _judge(thymio, load_mission(Path(mission))).verdict


def check_star(thymio: Thymio, mission: str | Path, number: int) -> None:
    """Fail the test, with the reason for pupils, if a mission does not give this star; 0 is that of the goal.

    Raises as `judged` does.
    """
    __tracebackhide__ = True
    loaded = load_mission(Path(mission))
    judge = _judge(thymio, loaded)
    verdict = judge.verdict
    if verdict.stars[number]:
        return
    if verdict.is_passed:
        pytest.fail(loaded.star_text(number - 1) or f"star {number + 1}: not reached", pytrace=False)
    broken = ", ".join(loaded.missing_text(fact) for fact in verdict.broken) or "time is over"
    missing = ", ".join(loaded.missing_text(fact) for fact in judge.missing())
    pytest.fail(f"{broken}, after {verdict.at_s:.2f} s; missing: {missing}", pytrace=False)


def _judge(thymio: Thymio, mission: Mission) -> Judge:
    judge = Judge(dataclasses.replace(mission, robot=thymio.name), thymio.stage.engine)
    while not judge.is_over:
        thymio.run(TICK_NS / SECOND_NS)
        judge.tick()
    return judge
