"""Fields and limits of a mission file: the reader and the schema are derived from them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated

from thymio_sim_ros.missions.facts import Label, Loudness
from thymio_sim_ros.sim.commands import BUTTONS
from thymio_sim_ros.sim.model.fields import Angle, Coordinate, Number, Pattern, Text

__all__ = [
    "FORMAT",
    "MAX_FACTS",
    "MAX_HAPPENINGS",
    "MAX_HINTS",
    "MAX_STARS",
    "MAX_TOOLS",
    "MAX_ZONES",
    "NAME",
    "NO_HAND",
    "PROXIMITY",
    "FactHead",
    "HappeningFields",
    "Head",
    "StarFields",
    "TextFields",
]

FORMAT = 1
MAX_ZONES, MAX_FACTS, MAX_HINTS, MAX_HAPPENINGS, MAX_STARS = 50, 50, 10, 200, 2
MAX_TOOLS = 300
NAME = re.compile(r"[A-Za-z](_?[A-Za-z0-9])*")

Seconds = Annotated[float, Number("s", 0.1, 3600.0)]
Time = Annotated[float, Number("s", 0.0, 3600.0)]
Length = Annotated[float, Number("rows, blocks or lines", 1.0, 1000.0)]
FileName = Annotated[str, Pattern(r"[^\x00-\x1f\x7f]*", "the name of a file or of a shipped playground", 300)]
RobotName = Annotated[str, Pattern(r"|[A-Za-z](_?[A-Za-z0-9])*", "the name of a robot", 60)]
Button = Annotated[str, Pattern("|".join(BUTTONS), f"one of {', '.join(BUTTONS)}", 20)]
NO_HAND = "away"
PROXIMITY = ("left", "center_left", "center", "center_right", "right", "rear_left", "rear_right")
"""The seven proximity sensors, in the order of prox.horizontal."""
_HANDS = (*PROXIMITY, NO_HAND)
Hand = Annotated[str, Pattern("|".join(_HANDS), f"one of {', '.join(_HANDS)}", 20)]


@dataclass(frozen=True, slots=True)
class Head:
    """The fields of one value."""

    title: Text
    playground: FileName
    story: Text = ""
    picture: FileName = ""
    robot: RobotName = ""
    time_s: Seconds = 120.0
    next: FileName = ""


@dataclass(frozen=True, slots=True)
class FactHead:
    robot: RobotName = ""
    text: Text = ""
    missing: Text = ""


@dataclass(frozen=True, slots=True)
class HappeningFields:
    at_s: Time
    robot: RobotName = ""
    press: Button | None = None
    release: Button | None = None
    tap: bool = False
    clap: Loudness | None = None
    hand: Hand | None = None
    move: Label | None = None
    x_m: Coordinate | None = None
    y_m: Coordinate | None = None
    yaw_rad: Angle = 0.0


@dataclass(frozen=True, slots=True)
class StarFields:
    within_s: Seconds | None = None
    length: Length | None = None
    text: Text = ""


@dataclass(frozen=True, slots=True)
class TextFields:
    title: Text = ""
    story: Text = ""
