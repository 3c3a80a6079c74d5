"""Assigns the programs of a file to robots: by name, then by number, then in order (docs/aseba_ros.md, "Programs")."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from aseba_vm import aesl
from aseba_vm.aesl.network import select
from aseba_vm.messages import format_message
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.programs.program import ThymioFile, ThymioProgram, node_label

__all__ = ["Assignment", "RobotId", "assign_nodes", "assign_programs", "note_lines"]


@dataclass(frozen=True, slots=True)
class RobotId:
    """A robot: its name (empty if it is alone) and its number on the network."""

    name: str
    number: int


@dataclass(frozen=True, slots=True)
class Assignment:
    """The program of a robot, or None, and messages for the user about programs and robots that do not match."""

    program: ThymioProgram | None
    notes: tuple[str, ...] = ()


def assign_programs(file: ThymioFile, robots: Sequence[RobotId]) -> dict[str, Assignment]:
    """Return the assignment of each robot by name. A single program is for all robots, unless it is named after one."""
    common = [*file.notes, *map(_not_run, file.others)]
    shares = _assigned([program.node for program in file.programs], robots, target().name, common)
    programs = [None if index is None else file.programs[index] for index, _ in shares]
    return {
        robot.name: Assignment(program, notes)
        for robot, program, (_, notes) in zip(robots, programs, shares, strict=True)
    }


def assign_nodes(
    network: aesl.Network, devices: Sequence[tuple[str, RobotId]]
) -> list[tuple[aesl.Node | None, tuple[str, ...]]]:
    """Return the node of a file for each device, and notes, as `assign_programs` does for robots.

    Devices are given by the name of their type and their own; those of one type share the nodes for this type.
    """
    found: dict[int, tuple[aesl.Node | None, tuple[str, ...]]] = {}
    types = dict.fromkeys(type_name for type_name, _ in devices)
    for type_name in types:
        members = [(at, robot) for at, (other, robot) in enumerate(devices) if other == type_name]
        robots = [robot for _, robot in members]
        selection = select(network, {"", type_name, *(robot.name for robot in robots)})
        nodes = [node for node in selection.nodes if node.name == type_name or node.name not in types]
        if not nodes:
            found |= {at: (None, (_NOTHING_LEFT,)) for at, _ in members}
            continue
        common = [_not_run(node.name) for node in selection.others if node.name not in types]
        for (at, _), (index, notes) in zip(
            members, _assigned(nodes, robots, type_name, list(dict.fromkeys(common))), strict=True
        ):
            found[at] = (None if index is None else nodes[index], notes)
    return [found[at] for at in range(len(devices))]


def note_lines(notes: Iterable[tuple[str, Sequence[str]]]) -> list[str]:
    """Return each note once, with the robots that it concerns, given the notes of each robot."""
    robots: dict[str, list[str]] = {}
    for robot, texts in notes:
        for text in texts:
            robots.setdefault(text, []).append(robot)
    return [f"{', '.join(names)}: {text}" for text, names in robots.items()]


_NOTHING_LEFT = "the file has no program left for this robot: it runs nothing"


def _not_run(node: str) -> str:
    return f"not for a Thymio, left out: node '{node}'"


def _assigned(
    nodes: Sequence[aesl.Node], robots: Sequence[RobotId], general: str, common: Sequence[str]
) -> list[tuple[int | None, tuple[str, ...]]]:
    """Return the index of each robot's node, and its notes. Nodes without a name, or named `general`, are for any."""
    names = {robot.name for robot in robots}
    general_names = ("", general)
    only = nodes[0]
    if len(nodes) == 1 and (only.name not in names or only.name in general_names):
        first = [] if only.name in general_names else [format_message("note-only-node", (only.name,))]
        return [(0, (*first, *common)) for _ in robots]
    matched, left = _match(nodes, robots)
    all_notes = [*common, *(f"no robot is left for {node_label(nodes[index])}" for index in left)]
    result = []
    for robot, index in zip(robots, matched, strict=True):
        notes = _notes(robot, None if index is None else nodes[index], general_names, all_notes)
        result.append((index, notes))
    return result


def _match(nodes: Sequence[aesl.Node], robots: Sequence[RobotId]) -> tuple[list[int | None], list[int]]:
    """Return the index of the node of each robot, and the nodes that are left."""
    left = list(range(len(nodes)))
    matched: list[int | None] = [None] * len(robots)
    names = {robot.name for robot in robots}

    def assign(at: int, fits: list[int]) -> None:
        if matched[at] is None and fits:
            matched[at] = fits[0]
            left.remove(fits[0])

    for at, robot in enumerate(robots):
        assign(at, [index for index in left if nodes[index].name == robot.name])
    for at, robot in enumerate(robots):
        assign(at, [index for index in left if nodes[index].node_id == robot.number])
    for at in range(len(robots)):
        assign(at, [index for index in left if nodes[index].name not in names])
    return matched, left


def _notes(
    robot: RobotId, node: aesl.Node | None, general_names: Sequence[str], common: Sequence[str]
) -> tuple[str, ...]:
    if node is None:
        return (*common, _NOTHING_LEFT)
    if node.name != robot.name and node.name not in general_names:
        return (format_message("note-next-node", (node.name,)), *common)
    if node.name != robot.name and node.node_id not in (0, robot.number):
        return (*common, f"{node_label(node)} runs here, on number {robot.number}, as it was next in order")
    return tuple(common)
