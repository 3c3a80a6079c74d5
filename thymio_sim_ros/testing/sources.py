"""Playgrounds and programs that a test names: by name, by path beside the test, or as text."""

from __future__ import annotations

import logging
import os
from collections.abc import Mapping
from pathlib import Path

from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.programs.program_assignment import RobotId, note_lines
from thymio_sim_ros.files import loading, resources
from thymio_sim_ros.sim.playground.reader import Playground

__all__ = ["beside", "is_name", "playground_of", "playground_source", "program_source", "programs_of"]


def beside(value: str | Path, folder: Path | None) -> str:
    """The path of a file that lies in the folder, else the value as it is: a name, a text, a path."""
    text = str(value)
    if folder is not None:
        # with the name of one of several playgrounds, too; unlike a Path's, isfile takes texts that are no paths
        names = (text, text.partition("#")[0])
        if any(name and os.path.isfile(folder / name) for name in names):
            return str(folder / text)
    return text


def playground_source(value: str | Path, folder: Path | None) -> str:
    """A playground as `loading.load_playground` reads it: a shipped name, else a file beside the test, else the value.

    Shipped names come first, so that no file beside the test can replace one.
    """
    return str(value) if value in resources.playgrounds() else beside(value, folder)


def program_source(value: str | Path, folder: Path | None) -> str:
    """A program by the same rule: a shipped name, else a file beside the test, else the value."""
    is_shipped = value == loading.NO_PROGRAM or value in resources.behaviours()
    return str(value) if is_shipped else beside(value, folder)


def playground_of(value: str | Path | Playground, folder: Path | None = None) -> Playground:
    """A shipped name, a path (relative ones begin in the folder) or a text as a playground.

    Raises PlaygroundError for what the file says, ResourceError for a file that is not there, OSError.
    """
    if isinstance(value, Playground):
        return value
    return loading.load_playground(playground_source(value, folder))[1]


def programs_of(
    value: str | Path | ThymioProgram, robots: Mapping[str, RobotId], folder: Path | None = None
) -> dict[str, ThymioProgram]:
    """The program of each robot: a built-in behaviour's name, a path (relative ones begin in the folder) or a text.

    A single word is a name or a path, and so is a line that ends in .aesl; anything else that is no file is a text.
    The nodes of a file go to robots as everywhere else; notes about them are logged. A robot without a node runs the
    empty program. Raises ProgramError for what the text says, ResourceError for a file that is not there, OSError.
    """
    if isinstance(value, ThymioProgram):
        return dict.fromkeys(robots, value)
    found = program_source(value, folder)
    is_file = isinstance(value, Path) or is_name(found)
    text, name = loading.read_text(found) if is_file else (loading.text_of(found, "program"), "program")
    assigned = loading.assigned_to(text, name, robots)
    for line in note_lines((robot, assignment.notes) for robot, assignment in assigned.items()):
        logging.getLogger(__name__).warning("%s: %s", name, line)
    return {robot: assignment.program or load_program("", "none") for robot, assignment in assigned.items()}


def is_name(text: str) -> bool:
    """Whether a text that stands for a program is the name of one, not the program itself."""
    is_path = text.endswith(".aesl") and len(text.splitlines()) == 1
    return bool(text) and (is_path or os.path.isfile(text) or len(text.split()) == 1)
