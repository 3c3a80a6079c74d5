"""From what a user names to what the core takes: playgrounds and programs by name, path or text."""

from __future__ import annotations

from thymio_sim_ros import resources
from thymio_sim_ros.device.program import ThymioProgram, load_program
from thymio_sim_ros.sim import playground as playgrounds
from thymio_sim_ros.sim.playground import Playground

NO_PROGRAM = "none"
"""In place of a program's name: the robot does nothing by itself."""


def load_playground(value: str) -> tuple[str, Playground]:
    """(name, playground) from a shipped name, a path or the JSON text itself.

    Raises PlaygroundError for what the file says, ResourceError for a file that is not there, OSError.
    """
    if value.lstrip().startswith("{"):
        loaded = playgrounds.loads(value, "uploaded playground")
        return loaded.title, loaded
    path = resources.find_playground(value)
    return path.stem, playgrounds.load(path)


def read_program(path: str) -> ThymioProgram:
    """The program of a built-in behaviour's name or a file; "none" is the empty one.

    Raises ProgramError for what the text says, ResourceError for a file that is not there or no text, OSError.
    """
    if path == NO_PROGRAM:
        return load_program("", NO_PROGRAM)
    found = resources.find_program(path)
    try:
        text = found.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise resources.ResourceError(f"{found}: byte {error.start} is not UTF-8 text") from error
    return load_program(text, found.name)
