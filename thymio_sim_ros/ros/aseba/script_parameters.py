"""Determines the program of each robot from the script parameters (docs/spec/ros-interface.md section 6.2)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from thymio_sim_ros.device.programs.program import load_file
from thymio_sim_ros.device.programs.program_assignment import Assignment, RobotId, assign_programs
from thymio_sim_ros.files.loading import read_text, text_of

__all__ = ["Script", "named", "named_robots", "script_of", "shares"]

_CONSTANTS = "script.constants."
_NAME = "script.name"
_SOURCE = "script.source"


@dataclass(frozen=True, slots=True)
class Script:
    """The program parameters of a robot: a path or a text, with constants. `is_own`: for this robot only."""

    path: str
    source: str
    name: str
    constants: tuple[tuple[str, int], ...]
    is_own: bool

    @property
    def is_empty(self) -> bool:
        """Whether neither path nor text is set."""
        return not (self.path or self.source)


def script_of(values: Mapping[str, Any], robot: str) -> Script:
    """Return the script of a robot; empty values of the robot default to the common ones."""
    prefix = f"robots.{robot}."
    is_own = bool(values.get(f"{prefix}script.path") or values.get(f"{prefix}script.source"))
    own = prefix if is_own else ""
    return Script(
        values.get(f"{own}script.path") or "",
        values.get(f"{own}script.source") or "",
        values.get(f"{own}script.name") or "",
        tuple(sorted((_constants(values, "") | _constants(values, prefix)).items())),
        is_own,
    )


def shares(values: Mapping[str, Any], robots: Sequence[RobotId], layout: str) -> dict[str, Assignment | None]:
    """Return programs by robot name; None for a robot without a script.

    Raises ProgramError, ResourceError, OSError.
    """
    scripts = {robot.name: script_of(values, robot.name) for robot in robots}
    pool = [robot for robot in robots if not scripts[robot.name].is_own]
    found: dict[Script, dict[str, Assignment]] = {}
    result: dict[str, Assignment | None] = {}
    for robot in robots:
        script = scripts[robot.name]
        if script.is_empty:
            result[robot.name] = None
            continue
        if script not in found or script.is_own:
            found[script] = _load(script, [robot] if script.is_own else pool, layout)
        result[robot.name] = found[script][robot.name]
    return result


def named(changes: Mapping[str, Any], waiting: Callable[[str], Any]) -> dict[str, Any]:
    """Return parameter changes in which a script's name appears only together with its text.

    A name that is set before its text is held back, so that a rejected text does not change the name of the running
    program. `waiting` returns the name set last.
    """
    names = {name: value for name, value in changes.items() if name.endswith(_NAME)}
    result = {name: value for name, value in changes.items() if name not in names}
    for text in [name for name in result if name.endswith(_SOURCE)]:
        name = text.removesuffix(_SOURCE) + _NAME
        result[name] = names[name] if name in names else waiting(name)
    return result


def named_robots(names: Iterable[str]) -> list[str]:
    """Return the robots that appear in parameter names."""
    return list(dict.fromkeys(name.split(".")[1] for name in names if name.startswith("robots.")))


def _constants(values: Mapping[str, Any], prefix: str) -> dict[str, int]:
    start = prefix + _CONSTANTS
    return {
        name.removeprefix(start): value
        for name, value in values.items()
        if name.startswith(start) and value is not None
    }


def _load(script: Script, robots: Sequence[RobotId], layout: str) -> dict[str, Assignment]:
    name = script.name or "program"
    text, name = (text_of(script.source, name), name) if script.source else read_text(script.path)
    file = load_file(
        text, name, layout, constants=dict(script.constants), robots=[robot.name for robot in robots if robot.name]
    )
    return assign_programs(file, robots)
