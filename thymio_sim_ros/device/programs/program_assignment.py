"""Assigns the programs of a file to robots: by name, then by number, then in order (docs/aseba_ros.md, "Programs")."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from aseba_vm.messages import format_message
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.programs.program import ThymioFile, ThymioProgram, node_label

__all__ = ["Assignment", "RobotId", "assign_programs"]


@dataclass(frozen=True, slots=True)
class RobotId:
    """A robot: its name (empty if it is alone) and its number on the network."""

    name: str
    number: int


@dataclass(frozen=True, slots=True)
class Assignment:
    """The program of a robot, or None, and messages for the user about what does not match."""

    program: ThymioProgram | None
    notes: tuple[str, ...] = ()


def assign_programs(file: ThymioFile, robots: Sequence[RobotId]) -> dict[str, Assignment]:
    """Return the assignment of each robot by name. A single program is for all robots, unless it is named after one."""
    common = [*file.notes, *(f"not for a Thymio, left out: node '{other}'" for other in file.others)]
    names = {robot.name for robot in robots}
    only = file.programs[0]
    if len(file.programs) == 1 and (only.node.name not in names or _is_general(only)):
        if not _is_general(only):
            common.insert(0, format_message("note-only-node", (only.node.name,)))
        return {robot.name: Assignment(only, tuple(common)) for robot in robots}
    assigned, left = _match(file.programs, robots)
    common += [f"no robot is left for {node_label(program.node)}" for program in left]
    return {robot.name: _assignment(robot, assigned.get(robot.name), common) for robot in robots}


def _is_general(program: ThymioProgram) -> bool:
    """Whether the node of the program has no name, or that of the kind of robot."""
    return program.node.name in ("", target().name)


def _match(
    programs: Sequence[ThymioProgram], robots: Sequence[RobotId]
) -> tuple[dict[str, ThymioProgram], list[ThymioProgram]]:
    left = list(programs)
    assigned: dict[str, ThymioProgram] = {}
    names = {robot.name for robot in robots}

    def assign(robot: RobotId, fits: list[ThymioProgram]) -> None:
        if robot.name not in assigned and fits:
            assigned[robot.name] = fits[0]
            left.remove(fits[0])

    for robot in robots:
        assign(robot, [program for program in left if program.node.name == robot.name])
    for robot in robots:
        assign(robot, [program for program in left if program.node.node_id == robot.number])
    for robot in robots:
        assign(robot, [program for program in left if program.node.name not in names])
    return assigned, left


def _assignment(robot: RobotId, program: ThymioProgram | None, common: Sequence[str]) -> Assignment:
    if program is None:
        return Assignment(None, (*common, "the file has no program left for this robot: it runs nothing"))
    node = program.node
    if node.name != robot.name and not _is_general(program):
        return Assignment(program, (format_message("note-next-node", (node.name,)), *common))
    if node.name != robot.name and node.node_id not in (0, robot.number):
        return Assignment(
            program, (*common, f"{node_label(node)} runs here, on number {robot.number}, as it was next in order")
        )
    return Assignment(program, tuple(common))
