"""The pen in the pen hole: it draws on the ground where the robot goes, or takes drawings away (`SetPen`).

The hole is on the wheel axis (docs/spec/thymio-robot.md section 1), so turning on the spot draws a dot. The robot
itself has no way to move the pen: an operator, ROS or the playground puts it in.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import DrawJumps, SetPen
from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Color, Stroke
from thymio_sim_ros.sim.plugin_api.view import ActuatorView

__all__ = ["ACTUATOR", "PEN_WIDTHS_M", "PenState"]

PEN_WIDTHS_M = (0.001, 0.1)
"""Thinnest and broadest pen."""
_STEP_M = 0.0005
"""The pen draws whenever it has moved so far: half a pixel of the ground."""
_JUMP_M = 0.02
"""A longer way within a tick was not driven: a hand moved the robot."""
_STRAIGHT_M = 0.0003
_LONGEST_M = 0.05
"""Points of a stroke are left out when a line, at most so long, passes them so closely."""
MOST_POINTS = 20_000
"""Points that a robot's strokes keep; the oldest are forgotten by viewers, not by the ground."""


@dataclass(slots=True)
class _Line:
    color: Color
    width_m: float
    points: list[Point]
    _passed: list[Point] = field(default_factory=list)

    def go_to(self, point: Point) -> None:
        """Add a point; the last one goes when a straight line passes it, and those that went before it, closely."""
        if len(self.points) >= 2:
            self._passed.append(self.points[-1])
            if _is_straight(self.points[-2], point, self._passed):
                self.points.pop()
            else:
                self._passed.clear()
        self.points.append(point)


@dataclass(slots=True)
class PenState:
    """The pen and what it has drawn; `changes` counts what a viewer should know."""

    down: bool = False
    color: Color = (0.0, 0.0, 0.0)
    width_m: float = 0.003
    erase: bool = False
    joins: bool = False
    changes: int = 0
    _at: Point | None = None
    _line: _Line | None = None
    _lines: list[_Line] = field(default_factory=list)

    @property
    def strokes(self) -> tuple[Stroke, ...]:
        """All strokes so far, the oldest first."""
        return tuple(Stroke(line.color, line.width_m, tuple(line.points)) for line in self._lines)

    def lift(self) -> None:
        """End the stroke; the next one begins at the position of the pen then."""
        self._at = self._line = None

    def forget(self) -> None:
        """Forget all strokes: the ground has none of them any more."""
        self._lines.clear()
        self._line = None
        self.changes += 1

    def draw(self, view: ActuatorView) -> None:
        """Draw from where the pen was to where it is."""
        pose = view.pose
        here = (pose.x_m, pose.y_m)
        way_m = math.dist(self._at, here) if self._at is not None else math.inf
        if way_m < _STEP_M:
            return
        if way_m > _JUMP_M and not self.joins:
            self.lift()
        start = self._at or here
        seen = view.draw(start, here, self.width_m, None if self.erase else self.color)
        self._at = here
        if seen is None:
            self._line = None
            return
        if self._line is None or self._line.color != seen:
            self._line = _Line(seen, self.width_m, [start])
            self._lines.append(self._line)
        self._line.go_to(here)
        self.changes += 1
        while len(self._lines) > 1 and sum(len(line.points) for line in self._lines) > MOST_POINTS:
            del self._lines[0]


def _is_straight(start: Point, end: Point, passed: list[Point]) -> bool:
    """Whether the line from start to end is short and passes all these points closely."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    if not 0.0 < length < _LONGEST_M:
        return False
    return all(abs(dx * (y - start[1]) - dy * (x - start[0])) <= _STRAIGHT_M * length for x, y in passed)


def _apply(state: PenState, command: SetPen | DrawJumps, _now_ns: int) -> None:
    if isinstance(command, DrawJumps):
        state.joins = command.is_on
        return
    low, high = PEN_WIDTHS_M
    if command.width_m is not None and not low <= command.width_m <= high:
        raise ValueError(f"SetPen: found a width of {command.width_m} m, expected {low} to {high}")
    state.lift()
    state.down = state.down if command.down is None else command.down
    state.color = state.color if command.color is None else command.color
    state.width_m = state.width_m if command.width_m is None else command.width_m
    state.erase = state.erase if command.erase is None else command.erase
    state.changes += 1


def _update(state: PenState, view: ActuatorView, _dt_s: float) -> None:
    if state.down:
        state.draw(view)


ACTUATOR = Actuator(
    name="pen",
    accepts=(SetPen, DrawJumps),
    begin=PenState,
    apply=_apply,
    update=_update,
    is_idle=lambda state: not state.down,
    shows=lambda state: {"strokes": state.strokes},
)
