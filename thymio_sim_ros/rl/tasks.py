"""Tasks as data: playground, start, observations, rewards, and what ends an episode."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Literal, get_args

from thymio_sim_ros.rl.errors import TaskError
from thymio_sim_ros.rl.observations import SENSORS
from thymio_sim_ros.sim.commands import MOTOR_MODELS
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS

__all__ = ["TASKS", "Rewards", "Start", "Task", "task_of"]

_TICK_S = TICK_NS * 1e-9

Start = Literal["anywhere", "line", "playground"]
"""Start of a robot: at a random free place of the floor, with a random heading; at a random place of the only track, in
one of its directions; or at its pose in the playground."""


@dataclass(frozen=True, slots=True)
class Rewards:
    """Weights: the reward of a step is the sum of each weight times its quantity."""

    forward_m: float = 0.0
    """Distance that the robot moved in the direction of its heading, m; negative for backward."""
    turned_rad: float = 0.0
    """Angle by which it turned, in either direction, rad."""
    contact: float = 0.0
    """1 in a step in which it touched something, otherwise 0."""
    line_m: float = 0.0
    """`forward_m` in a step that ends with a ground sensor above something dark, otherwise 0."""


def _expect(field: str, holds: bool, found: object, expected: str) -> None:
    if not holds:
        raise TaskError(f"task: {field}: found {found!r}, expected {expected}")


@dataclass(frozen=True, slots=True)
class Task:
    """A task that robots learn. Raises TaskError for a value that is unknown or out of range.

    `playground` is a shipped name, a path or a text (`loading.load_playground`). A step takes `step_s` of simulated
    time, a multiple of 10 ms; an episode is truncated after `seconds`. It is terminated when the robot has fallen off
    an edge, when it touches something if `ends_at_contact`, and when no ground sensor was above something dark for
    `line_lost_s`.
    """

    playground: str
    start: Start
    observed: tuple[str, ...]
    rewards: Rewards
    ends_at_contact: bool = False
    line_lost_s: float = math.inf
    step_s: float = 0.1
    seconds: float = 30.0
    noise: bool = True
    motor_model: str = MOTOR_MODELS[0]
    proximity_model: str = PROXIMITY_MODELS[0]

    def __post_init__(self) -> None:
        _expect("start", self.start in get_args(Start), self.start, f"one of {', '.join(get_args(Start))}")
        known = bool(self.observed) and set(self.observed) <= SENSORS.keys()
        _expect("observed", known, self.observed, f"some of {', '.join(SENSORS)}")
        ticks = self.step_s / _TICK_S
        whole = math.isfinite(ticks) and ticks > 0.5 and abs(ticks - round(ticks)) < 1e-6
        _expect("step_s", whole, self.step_s, f"a multiple of {_TICK_S:g} s")
        _expect("seconds", self.step_s <= self.seconds < math.inf, self.seconds, "at least one step")
        _expect("line_lost_s", self.line_lost_s > 0.0, self.line_lost_s, "a time above 0 s")
        _expect("motor_model", self.motor_model in MOTOR_MODELS, self.motor_model, f"one of {', '.join(MOTOR_MODELS)}")
        models = f"one of {', '.join(PROXIMITY_MODELS)}"
        _expect("proximity_model", self.proximity_model in PROXIMITY_MODELS, self.proximity_model, models)
        for weight in fields(self.rewards):
            value = getattr(self.rewards, weight.name)
            _expect(f"rewards.{weight.name}", math.isfinite(value), value, "a finite number")

    @property
    def steps(self) -> int:
        """Steps of an episode that is truncated."""
        return round(self.seconds / self.step_s)

    @property
    def follows_line(self) -> bool:
        """Whether reward or end depend on a line."""
        return self.rewards.line_m != 0.0 or self.line_lost_s < math.inf


TASKS = {
    "avoid": Task(
        playground="obstacle",
        start="anywhere",
        observed=("proximity",),
        rewards=Rewards(forward_m=1.0, turned_rad=-0.02, contact=-1.0),
        ends_at_contact=True,
    ),
    "line": Task(
        playground="line",
        start="line",
        observed=("ground",),
        rewards=Rewards(line_m=1.0),
        line_lost_s=1.0,
    ),
}
"""The tasks of the registered environments, by name."""


def task_of(task: str | Task) -> Task:
    """A task by name, or the task itself. Raises TaskError for an unknown name."""
    if isinstance(task, Task):
        return task
    if task not in TASKS:
        raise TaskError(f"task: found {task!r}, expected a Task or one of {', '.join(TASKS)}")
    return TASKS[task]
