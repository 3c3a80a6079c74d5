"""A whole run of a program in a mission, without ROS, as fast as possible."""

from __future__ import annotations

from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import NO_PROGRAM, load_playground, read_assignments, read_program
from thymio_sim_ros.missions.judge import Judge
from thymio_sim_ros.missions.mission import Mission
from thymio_sim_ros.sim.model.fields import FieldError, nearest
from thymio_sim_ros.sim.playground.reader import Playground

__all__ = ["judged_run", "programs_of_others", "robot_of"]


def robot_of(mission: Mission, playground: Playground) -> str:
    """The robot that a pupil programs; "" in a playground without robots."""
    return mission.robot or next((start.name for start in playground.robots), "")


def programs_of_others(mission: Mission, playground: Playground) -> dict[str, ThymioProgram]:
    """The programs of the other robots.

    Raises FieldError for a robot that is not there or is that of the pupil, ProgramError, ResourceError.
    """
    names = [start.name for start in playground.robots if start.name != robot_of(mission, playground)]
    for robot in mission.robots:
        if robot not in names:
            raise FieldError(f"robots.{robot}", f"'{robot}'", f"another robot: {nearest(robot, names)}")
    return {robot: read_program(path) for robot, path in mission.robots.items()}


def judged_run(mission: Mission, program: str = NO_PROGRAM, *, seed: int = 0) -> Judge:
    """Run a program until the mission is passed or has failed; return its judge.

    Raises FieldError for names that the playground does not have, and the errors of `load_playground` and
    `read_program`.
    """
    _, playground = load_playground(mission.playground)
    names = [start.name for start in playground.robots]
    programs = dict.fromkeys(names, load_program("", NO_PROGRAM)) | programs_of_others(mission, playground)
    robot = robot_of(mission, playground)
    own = read_assignments(program, names).get(robot)
    if own is not None and own.program is not None:
        programs[robot] = own.program
    return run_to_end(mission, Engine(playground, programs, seed=seed))


def run_to_end(mission: Mission, engine: Engine) -> Judge:
    """Judge an engine until the mission is over."""
    judge = Judge(mission, engine)
    while not judge.is_over:
        engine.step(())
        judge.tick()
    return judge
