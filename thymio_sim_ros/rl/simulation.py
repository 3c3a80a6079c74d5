"""Robots in one world that act together: what the environments of Gymnasium and PettingZoo have in common.

An action is held for one step of the task. An episode begins with a step at rest, so that the first observation is
measured where the robot starts.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.rl.errors import TaskError
from thymio_sim_ros.rl.observations import SENSORS, Observations, observe
from thymio_sim_ros.rl.starts import Starts
from thymio_sim_ros.rl.tasks import Rewards, Task
from thymio_sim_ros.rl.tiling import tiled
from thymio_sim_ros.sim.commands import MotorTargets, MoveRobot
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.robot_constants import FULL_TARGET
from thymio_sim_ros.sim.model.units import GROUND_FULL
from thymio_sim_ros.sim.playground.model import RobotStart

__all__ = ["Outcome", "Simulation"]

_DARK = GROUND_FULL // 2
"""Counts of a ground sensor below this are something dark."""
_SEEDS = 2**31

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]


class Outcome(NamedTuple):
    """The effect of a step on each robot.

    `poses` are true poses in the frame of the playground, shape (robots, 3): x, y in m and heading in rad.
    """

    observations: Observations
    rewards: Floats
    terminated: Bools
    truncated: Bools
    poses: Floats


class Simulation:
    """Robots with a task. Invariant: time passes only in `begin` and `act`."""

    def __init__(self, task: Task, *, copies: int = 1, robots: int = 1) -> None:
        """Prepare `copies` copies of the playground in one world, with this many robots in each.

        Raises TaskError if the playground does not fit, and the exceptions of `load_playground`.
        """
        for name, number in (("copies", copies), ("robots", robots)):
            if number < 1:
                raise TaskError(f"{name}: found {number}, expected at least 1")
        self.task = task
        _, playground = load_playground(task.playground)
        self._starts = Starts(playground, task.start)
        self._playground, self._offsets = tiled(playground, copies)
        self._robots_per_copy = robots
        self._origins = np.array([(x, y, 0.0) for x, y in self._offsets for _ in range(robots)])
        """Pose of each robot's copy, shape (robots, 3)."""
        self.names = tuple(f"robot_{number}" for number in range(copies * robots))
        self._read = dict.fromkeys((*task.observed, *(["ground"] if task.follows_line else [])))
        """Names of the sensors that are read, in order."""
        self._steps = np.zeros(len(self.names), np.int64)
        """Steps of the episode so far, by robot."""
        self._lost_steps = np.zeros(len(self.names), np.int64)
        """Steps since a ground sensor was above something dark, by robot."""
        self._engine: Engine | None = None

    def begin(self, random: np.random.Generator) -> Outcome:
        """Begin an episode of every robot, in a new world. The same random numbers give the same bits."""
        starts = [
            RobotStart(name, pose.x_m, pose.y_m, pose.yaw_rad)
            for name, pose in zip(self.names, self._draw(random, self._offsets), strict=True)
        ]
        self._engine = Engine(
            replace(self._playground, robots=tuple(starts)),
            seed=int(random.integers(_SEEDS)),
            noise=self.task.noise,
            motor_model=self.task.motor_model,
            proximity_model=self.task.proximity_model,
        )
        everyone = range(len(self.names))
        return self._step(self._engine, np.zeros((len(self.names), 2)), everyone)

    def act(
        self, actions: npt.NDArray[np.floating], *, restarted: Collection[int] = (), random: np.random.Generator
    ) -> Outcome:
        """Let all robots act for one step.

        Args:
            actions: targets of the left and right wheel, shape (robots, 2), -1…1; beyond that they are limited.
            restarted: numbers of robots, each alone in its copy, that begin an episode instead, elsewhere.
            random: the start poses of these.

        Raises RuntimeError before the first `begin`, ValueError for actions of another shape or not finite.
        """
        if self._engine is None:
            raise RuntimeError("the environment has no episode yet: call reset() before step()")
        expected = (len(self.names), 2)
        values = np.asarray(actions, np.float64)
        if values.shape != expected or not np.isfinite(values).all():
            raise ValueError(f"actions: found {actions!r}, expected finite numbers of shape {expected}")
        values = np.clip(values, -1.0, 1.0)
        for number in restarted:
            (pose,) = self._draw(random, (self._offsets[number],))
            self._engine.post(self.names[number], MoveRobot(pose.x_m, pose.y_m, pose.yaw_rad))
            values[number] = 0.0
        return self._step(self._engine, values, restarted)

    def _draw(self, random: np.random.Generator, offsets: Collection[tuple[float, float]]) -> list[Pose]:
        """Start poses of the robots in the copies with these offsets."""
        return [
            Pose(pose.x_m + x, pose.y_m + y, pose.yaw_rad)
            for x, y in offsets
            for pose in self._starts.draw(random, self._robots_per_copy)
        ]

    def _step(self, engine: Engine, actions: Floats, beginning: Collection[int]) -> Outcome:
        for name, (left, right) in zip(self.names, np.rint(actions * FULL_TARGET).astype(int).tolist(), strict=True):
            engine.post(name, MotorTargets(left, right))
        before = self._poses(engine)
        touching: set[str] = set()
        for result in engine.steps(self.task.step_s, ()):
            touching.update(contact.robot for contact in result.contacts)
        poses = self._poses(engine)
        words = {sensor: self._words(engine, sensor) for sensor in self._read}

        contact = np.array([name in touching for name in self.names])
        is_dark: Bools = np.ones(len(self.names), np.bool_)
        if self.task.follows_line:
            deltas = np.array([reading[SENSORS["ground"].words] for reading in words["ground"]])
            is_dark = np.any(deltas < _DARK, axis=1)
        rewards = self._rewards(before, poses, contact, is_dark)
        self._steps += 1
        self._lost_steps = np.where(is_dark, 0, self._lost_steps + 1)
        terminated = np.array([engine.world.robots[name].is_fallen for name in self.names])
        terminated |= self._lost_steps * self.task.step_s >= self.task.line_lost_s
        if self.task.ends_at_contact:
            terminated |= contact
        new = list(beginning)
        self._steps[new] = self._lost_steps[new] = 0
        rewards[new], terminated[new] = 0.0, False
        observations = observe(self.task.observed, [words[sensor] for sensor in self.task.observed])
        return Outcome(observations, rewards, terminated, self._steps >= self.task.steps, poses - self._origins)

    def _rewards(self, before: Floats, after: Floats, contact: Bools, is_dark: Bools) -> Floats:
        moved = after - before
        turned = np.remainder(moved[:, 2] + math.pi, math.tau) - math.pi
        heading = before[:, 2] + turned / 2
        forward = moved[:, 0] * np.cos(heading) + moved[:, 1] * np.sin(heading)
        quantities = {
            "forward_m": forward,
            "turned_rad": np.abs(turned),
            "contact": contact.astype(np.float64),
            "line_m": np.where(is_dark, forward, 0.0),
        }
        weights = self.task.rewards
        rewards = np.zeros(len(self.names))
        for field in fields(Rewards):
            rewards += getattr(weights, field.name) * quantities[field.name]
        return rewards

    def _poses(self, engine: Engine) -> Floats:
        poses = [engine.world.robots[name].pose for name in self.names]
        return np.array([(pose.x_m, pose.y_m, pose.yaw_rad) for pose in poses])

    def _words(self, engine: Engine, sensor: str) -> list[tuple[int, ...]]:
        """The words of the present reading of a sensor, by robot."""
        readings = [engine.world.read(name, sensor) for name in self.names]
        return [reading.words for reading in readings if reading is not None]
