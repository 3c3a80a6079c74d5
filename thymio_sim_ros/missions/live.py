"""A mission on an engine that runs live: begins tries, judges them, and notices a robot in trouble.

A try begins with a reset, at tick 0, as a run of `thymio-sim mission` does: the same program gets the same verdict, bit
for bit. A program that is loaded into the robot or run from its beginning begins a try, and a reset of the world does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.inputs import Controlled, Input, Loaded, Posted, Reset
from thymio_sim_ros.missions.judge import Judge, Verdict
from thymio_sim_ros.missions.mission import Mission
from thymio_sim_ros.sim.actuators.leds import LedState
from thymio_sim_ros.sim.actuators.loudspeaker import LoudspeakerState
from thymio_sim_ros.sim.commands import COLORED_GROUPS, Lift, MoveObject, MoveRobot
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.robot.robot import Robot

__all__ = ["LiveMission", "Trouble", "check_fits"]

_CHECK_TICKS = 50
"""Ticks between two looks at the robot."""
_STUCK_CHECKS, _IDLE_CHECKS = 4, 16
"""Number of looks after which a robot is stuck, or its program has never reacted."""
_STUCK_M, _STUCK_RAD, _WANTED_M_S = 0.002, 0.02, 0.005
_LIGHTS = (*COLORED_GROUPS, "circle")
"""The lights that the firmware leaves to programs."""
_HANDS = (MoveRobot, MoveObject, Lift)
"""Commands by which a hand does what the program should do."""
_ENDS = ("reset", "stop", "switch_off")


class Trouble(Enum):
    """What hinders a robot: it fell, its wheels drive and it does not move, its program never did anything."""

    NONE = ""
    FALLEN = "fallen"
    STUCK = "stuck"
    IDLE = "idle"


@dataclass(slots=True)
class _Watcher:
    """What was seen of a robot in a try."""

    place: tuple[float, float, float] | None = None
    has_acted: bool = False
    checks: int = 0
    held: int = 0

    def check(self, robot: Robot) -> Trouble:
        """Call every `_CHECK_TICKS` ticks."""
        pose, levels = robot.pose, robot.state(LedState).levels
        is_driving = any(abs(speed) > _WANTED_M_S for speed in robot.wheels.wanted_m_s)
        x, y, yaw = self.place or (pose.x_m + 1.0, pose.y_m, pose.yaw_rad)
        has_moved = abs(pose.x_m - x) > _STUCK_M or abs(pose.y_m - y) > _STUCK_M or abs(pose.yaw_rad - yaw) > _STUCK_RAD
        self.place = (pose.x_m, pose.y_m, pose.yaw_rad)
        self.checks += 1
        self.held = self.held + 1 if is_driving and not has_moved else 0
        is_lit = any(level for group in _LIGHTS for level in levels[group])
        self.has_acted = self.has_acted or is_driving or is_lit or robot.state(LoudspeakerState).changes > 0
        if robot.is_fallen:
            return Trouble.FALLEN
        if self.held >= _STUCK_CHECKS:
            return Trouble.STUCK
        return Trouble.IDLE if not self.has_acted and self.checks >= _IDLE_CHECKS else Trouble.NONE


def check_fits(mission: Mission, playground: Playground) -> None:
    """Raise FieldError for a name that the playground lacks, and for a zone that no robot can reach."""
    _before_a_try(mission, Engine(playground))


def _before_a_try(mission: Mission, engine: Engine) -> Judge:
    """A judge that changes nothing in the engine: what happens at the beginning comes later."""
    return Judge(replace(mission, happens=tuple(replace(one, at_s=1.0) for one in mission.happens)), engine)


class LiveMission:
    """The mission of an engine. Call `before_tick` and `after_tick` around each step; `close` when it ends.

    `verdict` is None before the first try and after the program was stopped.
    """

    def __init__(self, mission: Mission, engine: Engine, reset: Callable[[], None]) -> None:
        """`reset` resets the engine and whatever shows it. Raises FieldError for a name that the playground lacks."""
        self.mission, self.engine = mission, engine
        judge = _before_a_try(mission, engine)
        self.robot = judge.robot
        """The robot that the pupil programs."""
        self.checklist = judge.verdict.checklist
        """Its lines before a try."""
        self.tries = 0
        self.trouble = Trouble.NONE
        self.is_helped = False
        """Whether a hand has moved or lifted something, which ended the try."""
        self._reset = reset
        self._judge: Judge | None = None
        self._watcher = _Watcher()
        self._needs_reset = self._is_begun = False
        self._is_acting = False
        engine.recorders.append(self)

    def close(self) -> None:
        """Watch the engine no more."""
        self.engine.recorders.remove(self)

    @property
    def verdict(self) -> Verdict | None:
        """What the present try has reached; None if there is none."""
        return None if self._judge is None else self._judge.verdict

    @property
    def judge(self) -> Judge | None:
        """The judge of the present try."""
        return self._judge

    @property
    def is_running(self) -> bool:
        """Whether a try goes on."""
        return self._judge is not None and not self._judge.is_over and not self.is_helped

    def before_tick(self) -> None:
        """Begin a try if one is due."""
        if self._needs_reset:
            self._needs_reset = False
            self._reset()
        if self._is_begun:
            self._is_begun = False
            self._begin()

    def after_tick(self) -> None:
        """Judge the tick that the engine has executed."""
        if not self.is_running or self._judge is None:
            return
        self._is_acting = True
        self._judge.tick()
        self._is_acting = False
        if self.engine.tick % _CHECK_TICKS == 0:
            robot = self.engine.world.robots.get(self.robot)
            self.trouble = Trouble.NONE if robot is None else self._watcher.check(robot)

    def record(self, tick: int, happened: Input) -> None:
        """Take an input of the engine: it may begin or end a try. The next tick does what follows from it."""
        match happened:
            case Reset():
                self._is_begun, self._needs_reset = True, False
            case Loaded(robot=self.robot):
                self._needs_reset = True
            case Controlled(robot=self.robot, action=action) if action in _ENDS:
                self._judge, self._needs_reset, self._is_begun = None, False, False
            case Controlled(robot=self.robot, action="run") if self._judge is None:
                self._needs_reset = True
            case Posted(command=command) if isinstance(command, _HANDS) and not self._is_acting and self.is_running:
                self.is_helped = True

    def record_digest(self, tick: int, digest: str) -> None:
        """Take a digest of the state: it is not needed."""

    def _begin(self) -> None:
        self.tries += 1
        self.is_helped, self.trouble, self._watcher = False, Trouble.NONE, _Watcher()
        self._is_acting = True
        self._judge = Judge(self.mission, self.engine)
        self._is_acting = False
