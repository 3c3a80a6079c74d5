"""What a page sends: a program, and where its names are."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["MAX_BYTES", "NodeProgram", "ProgramRefusedError", "program_of"]

MAX_BYTES = 100_000
"""Size of the largest program."""
_NAME = re.compile(r"[\w][\w .-]{0,99}\.py")
_NAMESPACE = re.compile(r"(?:/[A-Za-z_][A-Za-z0-9_]{0,99}){0,5}")
_DEFAULT_NAME = "program.py"


class ProgramRefusedError(ThymioSimError, ValueError):
    """A message that is no program; the text says what was found and expected."""


@dataclass(frozen=True, slots=True)
class NodeProgram:
    """A program in Python. `namespace`: that of the robot, to which its relative names belong; or empty."""

    name: str
    text: str
    namespace: str = ""
    has_sim_time: bool = False
    """Whether its nodes have the time of the simulator: a pause, steps and its pace hold for them, too."""

    @property
    def arguments(self) -> tuple[str, ...]:
        """The arguments of the program, as those of `ros2 run`."""
        namespace = ("-r", f"__ns:={self.namespace}") if self.namespace else ()
        time = ("-p", "use_sim_time:=true") if self.has_sim_time else ()
        return ("--ros-args", *namespace, *time) if namespace or time else ()


def program_of(message: Mapping[Any, Any]) -> NodeProgram:
    """The program of a message: `text`, perhaps `name`, `namespace` and `sim_time`. Raises ProgramRefusedError."""
    text, name, namespace = message.get("text"), message.get("name", _DEFAULT_NAME), message.get("namespace", "")
    if not isinstance(text, str):
        raise ProgramRefusedError("found no text, expected a program in Python")
    try:
        size = len(text.encode())
    except UnicodeEncodeError as error:
        line = text.count("\n", 0, error.start) + 1
        raise ProgramRefusedError(f"line {line}: found half of a character, expected text") from None
    if size > MAX_BYTES:
        raise ProgramRefusedError(f"found {size} bytes, expected a program of at most {MAX_BYTES // 1000} kB")
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise ProgramRefusedError(f"line {line}: found the character NUL, expected text")
    if not isinstance(namespace, str) or not _NAMESPACE.fullmatch(namespace):
        raise ProgramRefusedError(f"found namespace {str(namespace)[:40]!r}, expected one such as /thymio_1")
    is_name = isinstance(name, str) and _NAME.fullmatch(name)
    return NodeProgram(name if is_name else _DEFAULT_NAME, text, namespace, message.get("sim_time") is True)
