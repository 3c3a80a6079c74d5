"""A ROS node in a mission, outside of a test: a program in a process of its own, in simulated time."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from thymio_sim_ros.missions import Judge, Mission
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
from thymio_sim_ros.suite_config import SuiteConfig
from thymio_sim_ros.testing.ros.domain import reserved
from thymio_sim_ros.testing.ros.graph import Ros
from thymio_sim_ros.testing.ros.simulation import Simulation
from thymio_sim_ros.testing.ros.student_errors import StudentError

__all__ = ["judged_node"]


def judged_node(mission: Mission, program: Path, *, seed: int = 0) -> Judge:
    """Run a node until the mission is passed or has failed; return its judge.

    Raises StudentError for a program that ends with an error or uses too much time of the processor, FieldError for
    names that the playground does not have.
    """
    with reserved(shared_memory=False) as domain:
        ros = Ros(domain, folder=program.parent)
        try:
            return _judged(ros, mission, program, seed)
        except pytest.fail.Exception as error:
            raise StudentError(f"{program}: {error}") from error
        finally:
            ros.close()


def _judged(ros: Ros, mission: Mission, program: Path, seed: int) -> Judge:
    timeout_s = SuiteConfig().cmd_vel_timeout_s  # as under `thymio-sim`
    defaults = replace(
        SimulatorParams(start_paused=True), playground=mission.playground, cmd_vel_timeout=timeout_s, seed=seed
    )
    simulation = Simulation(ros, ros.live(Simulator(ros.context, defaults, is_closed=True)))
    ros.settle()
    judge = Judge(mission, simulation.engine)
    ros.run(program.name)
    while not judge.is_over:
        simulation.tick()
        judge.tick()
    return judge
