"""The state of a world that a suite publishes as JSON, checked. Pure.

Any node of a pupil can publish on these topics too, and what one pupil sends must not break the page of the teacher.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["MissionTry", "Overview", "SuiteState", "SuiteStateError", "read_overview", "read_state", "read_try"]

Overview = Mapping[str, Mapping[str, list[float] | None]]
"""`robots` and `objects` by name: [x, y, yaw, red, green, blue] and [x, y, yaw], None for one that has fallen."""
_LENGTHS = {"robots": 6, "objects": 3}
_LONGEST_NAME, _MOST_STARS = 200, 3


class SuiteStateError(ThymioSimError, ValueError):
    """A text that no suite publishes."""


@dataclass(frozen=True, slots=True)
class SuiteState:
    """The part of `/simulator/_state` that the class needs; `achieved` is the real-time factor."""

    paused: bool
    achieved: float
    fallen: tuple[str, ...]
    """Names of the robots that fell off an edge."""


@dataclass(frozen=True, slots=True)
class MissionTry:
    """The present try of the mission that is open."""

    mission: str
    """Name of the mission: that of its file without the ending."""
    tries: int
    """Number of the try since the mission was opened."""
    has_passed: bool
    stars: int
    at_s: float
    """Simulated time of the try."""
    trouble: str
    """fallen, stuck, idle (the program has done nothing yet), or ""."""
    done: int = 0
    """Lines of the checklist that are done."""
    is_over: bool = False
    file: str = ""
    """SHA-256 of the file that the pupil has opened; "" is a mission of the simulator."""


def read_state(text: str) -> SuiteState:
    """The state in a message of `/simulator/_state`. Raises SuiteStateError."""
    match _object(text):
        case {"paused": bool(paused), "achieved": int() | float() as achieved, "robots": list(robots)}:
            return SuiteState(paused, _finite(achieved), tuple(name for robot in robots for name in _fallen(robot)))
    raise SuiteStateError("expected the fields paused, achieved and robots")


def read_overview(text: str) -> Overview:
    """The poses in a message of `/simulator/_overview`. Raises SuiteStateError."""
    data = _object(text)
    overview: dict[str, dict[str, list[float] | None]] = {}
    for kind, length in _LENGTHS.items():
        items = data.get(kind)
        if not isinstance(items, dict):
            raise SuiteStateError(f"{kind}: expected an object")
        overview[kind] = {name: _pose(values, length) for name, values in items.items()}
    return overview


def read_try(text: str) -> MissionTry:
    """The try in a message of `/simulator/_mission/try`. Raises SuiteStateError."""
    match _object(text):
        case {
            "mission": str(mission),
            "tries": int(tries),
            "done": list(done),
            "state": str(state),
            "stars": list(stars),
            "at_s": int() | float() as at_s,
            "trouble": str(trouble),
            "file": str(file),
        } if len(mission) <= _LONGEST_NAME and not isinstance(tries, bool):
            return MissionTry(
                mission,
                tries,
                has_passed=state == "passed",
                stars=min(_count(stars), _MOST_STARS),
                at_s=_finite(at_s),
                trouble=trouble[:20],
                done=_count(done),
                is_over=state in ("passed", "failed"),
                file=file,
            )
    raise SuiteStateError("expected the fields mission, tries, done, state, stars, at_s, trouble and file")


def _count(values: list[object]) -> int:
    return sum(value is True for value in values)


def _object(text: str) -> dict[str, Any]:
    try:
        data = json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise SuiteStateError(f"not JSON: {error}") from error
    if not isinstance(data, dict):
        raise SuiteStateError("expected an object")
    return data


def _refuse(word: str) -> NoReturn:
    raise SuiteStateError(f"found {word}, expected a number")


def _fallen(robot: object) -> tuple[str, ...]:
    match robot:
        case {"robot": str(name), "fallen": True}:
            return (name,)
        case {"robot": str(), "fallen": False}:
            return ()
    raise SuiteStateError("robots: expected objects with the fields robot and fallen")


def _pose(values: object, length: int) -> list[float] | None:
    if values is None:
        return None
    if not isinstance(values, list) or len(values) != length:
        raise SuiteStateError(f"expected {length} numbers or null")
    return [_finite(value) for value in values]


def _finite(value: object) -> float:
    try:
        if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
            return value
    except OverflowError:  # an integer above all floats
        pass
    raise SuiteStateError("expected a finite number")
