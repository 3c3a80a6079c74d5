"""The bodies of many robots at once: the sums of `RobotBody` on arrays.

pymunk hands over all bodies in one call (`pymunk.batch`), and takes their speeds back in one. While a fleet drives, its
arrays are the truth, and a body asks it to `tell` when somebody looks; before a body is changed from outside, `release`
makes the body the truth until the next tick. Setting speeds wakes what sleeps in the same call, therefore robots are
set one by one where there are things that sleep.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pymunk
from pymunk import batch

from thymio_sim_ros.sim import thymio2
from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS
from thymio_sim_ros.sim.physics.movables import MovableBody
from thymio_sim_ros.sim.physics.one_by_one import Setter
from thymio_sim_ros.sim.physics.robots import MOMENT_KG_M2, PUSH_N_S_M, RobotBody

__all__ = ["Fleet"]

Values = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]

_Fields = batch.BodyFields
_SPEEDS = _Fields.VELOCITY | _Fields.ANGULAR_VELOCITY
_FORCES = _SPEEDS | _Fields.FORCE | _Fields.TORQUE
_STATE = _Fields.BODY_ID | _Fields.POSITION | _Fields.ANGLE | _SPEEDS
_X, _Y, _ANGLE, _VX, _VY, _TURNING = range(6)
"""Columns of the state."""


class Fleet:
    """Robots of one space, always the same. Between ticks their state lies in arrays, or in bodies, or in both."""

    def __init__(
        self, space: pymunk.Space, bodies: Sequence[RobotBody], movables: Sequence[MovableBody], *, is_alone: bool
    ) -> None:
        """`is_alone` when nothing but robots moves in the space."""
        self._space, self._bodies, self._is_alone = space, tuple(bodies), is_alone
        self._movables = tuple(movables)
        self._loads: list[MovableBody] = []
        self._load_slots = np.zeros(0, dtype=np.intp)
        self._load_state = np.zeros((0, 6))
        self._setter = Setter([])
        count = len(self._bodies)
        self.driven = np.zeros((2, count))
        """Speed over ground that each wheel gives, m/s: left, then right."""
        self.covered = np.zeros((2, count))
        """Speed over ground at each wheel, mean of the last tick, m/s."""
        self.changed: set[RobotBody] = set(self._bodies)
        """To be filled with those for whom a contact begins or ends."""
        self._begun: set[RobotBody] = set()
        """Who may have a contact that is new."""
        self._index = {body: index for index, body in enumerate(self._bodies)}
        self._touching, self._is_free = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
        self._angle = self._speed = self._spin = self._heading = np.zeros(count)
        self._state = np.zeros((count, 6))
        self._stands = np.ones(count, dtype=bool)
        self._all = np.zeros((0, 6))
        self._ids: npt.NDArray[np.uintp] = np.zeros(0, dtype=np.uintp)
        self._slots = np.zeros(0, dtype=np.intp)
        self._read = batch.Buffer()
        self._written = batch.Buffer()
        self._is_released = True
        self.is_told = True
        """Whether the bodies know what the last tick has made of them."""
        for body in self._bodies:
            body.fleet = self

    def disband(self) -> None:
        """Let every body drive alone again."""
        self.tell()
        for body in self._bodies:
            body.fleet = None

    @property
    def poses(self) -> Values:
        """Where the robots are: rows x, y, yaw."""
        if self._is_released:
            self._take()
        return self._state[:, :3]

    @property
    def fallen(self) -> Indices:
        """The numbers of those who have fallen."""
        if self._is_released:
            self._take()
        return np.flatnonzero(~self._stands)

    def tell(self) -> None:
        """Write to the bodies what the last tick has made of them."""
        if self.is_told:
            return
        self.is_told = True
        columns = (self._state[:, :3], self._speed, self._spin, self._is_free)
        values = zip(self._bodies, *(column.tolist() for column in columns), strict=True)
        for body, (x_m, y_m, angle), speed, spin, is_free in values:
            body.take_over(Pose(x_m, y_m, angle), speed, spin, is_free=is_free)

    def release(self) -> None:
        """Let the bodies be changed until the next tick."""
        self.tell()
        self._is_released = True
        self.changed.update(self._bodies)

    def begin_tick(self) -> None:
        """As `RobotBody.begin_tick`."""
        if self._is_released:
            self._take()
        self._look_at_contacts()
        self._is_free = ~self._touching
        self.covered = self.driven.copy()
        touching = np.flatnonzero(self._touching)
        self.covered[:, touching] = 0.0
        for body in self._begun:
            for key, contact in body.touching.items():
                if contact.is_new:
                    body.touching[key] = replace(contact, is_new=False)
        self._begun.clear()

    def push(self) -> None:
        """As `RobotBody.push`."""
        left, right = self.driven
        speed, spin = (left + right) / 2, (right - left) / thymio2.WHEEL_TRACK_M
        if not self._stands.all():
            speed, spin = speed * self._stands, spin * self._stands
        heading = self._angle + spin * (SUB_STEP_S / 2)
        touching = np.flatnonzero(self._touching)
        if len(touching) == 0:
            self._heading, self._speed, self._spin = heading, speed, spin
            self._set(_SPEEDS, np.stack((speed * np.cos(heading), speed * np.sin(heading), spin), axis=1))
            return
        state = self._state[touching]
        turning = state[:, _TURNING]
        heading[touching] += turning * SUB_STEP_S
        cos, sin = np.cos(heading), np.sin(heading)
        motion = np.zeros((len(self._bodies), 6))
        motion[:, 0], motion[:, 1], motion[:, 2] = speed * cos, speed * sin, spin
        push = (motion[touching, :2] - state[:, _VX:_TURNING]) * PUSH_N_S_M
        force = np.hypot(push[:, 0], push[:, 1])
        push *= (thymio2.DRIVE_FORCE_N / np.maximum(thymio2.DRIVE_FORCE_N, force))[:, None]
        motion[touching, 3:5] = push
        motion[touching, 5] = (spin[touching] - turning) * (MOMENT_KG_M2 / SUB_STEP_S)
        motion[touching, :3] = state[:, _VX:]
        speed[touching], spin[touching] = self._speed[touching], self._spin[touching]
        self._heading, self._speed, self._spin = heading, speed, spin
        self._set(_FORCES, motion)

    def settle(self, earlier: int) -> None:
        """As `RobotBody.settle`."""
        self._look_at_contacts()
        self._angle = self._angle + self._spin * SUB_STEP_S
        held = np.flatnonzero(self._touching | ~self._is_free)
        if len(held) == 0:
            if earlier == SUB_STEPS - 1:
                self._get()
            return
        self._get()
        begun = held[self._is_free[held]]
        self.covered[:, begun] = self.driven[:, begun] * (earlier / SUB_STEPS)
        self._is_free[held] = False
        state, heading = self._state[held], self._heading[held]
        self._angle[held] = state[:, _ANGLE]
        self._spin[held] = spin = state[:, _TURNING]
        self._speed[held] = speed = state[:, _VX] * np.cos(heading) + state[:, _VY] * np.sin(heading)
        half = spin * (thymio2.WHEEL_TRACK_M / 2)
        self.covered[0, held] += (speed - half) / SUB_STEPS
        self.covered[1, held] += (speed + half) / SUB_STEPS

    def end_tick(self) -> None:
        """As `RobotBody.end_tick`."""
        self._angle = self._state[:, _ANGLE].copy()
        self.is_told = False
        loads = self._all[self._load_slots]
        for index in np.flatnonzero((loads != self._load_state).any(axis=1)).tolist():
            self._loads[index].settle(*loads[index].tolist())
        self._load_state = loads

    def touching(self) -> list[RobotBody]:
        """Robots that touch something."""
        return [self._bodies[index] for index in np.flatnonzero(self._touching).tolist()]

    def _look_at_contacts(self) -> None:
        self._begun.update(self.changed)
        for body in self.changed:
            self._touching[self._index[body]] = bool(body.touching)
        self.changed.clear()

    def _take(self) -> None:
        """Read what the bodies are."""
        self._is_released = False
        self._stands = np.array([not body.is_fallen for body in self._bodies], dtype=bool)
        self._speed = np.array([body.speed_m_s for body in self._bodies])
        self._spin = np.array([body.spin_rad_s for body in self._bodies])
        poses = [(body.pose.x_m, body.pose.y_m, body.pose.yaw_rad) for body in self._bodies]
        self._state[:, :3] = np.array(poses).reshape(-1, 3)
        self._angle = self._state[:, _ANGLE].copy()
        self._get()

    def _get(self) -> None:
        """The state of all that stand, from the space."""
        self._read.clear()
        batch.get_space_bodies(self._space, _STATE, self._read)
        ids = np.frombuffer(self._read.int_buf(), dtype=np.uintp)
        if not np.array_equal(ids, self._ids):
            self._ids = ids.copy()
            slots = {number: slot for slot, number in enumerate(ids.tolist())}
            bodies = [body.body for body in self._bodies if not body.is_fallen]
            self._slots = np.array([slots[body.id] for body in bodies], dtype=np.intp)
            self._setter = Setter(bodies)
            self._loads = [movable for movable in self._movables if not movable.is_fallen]
            self._load_slots = np.array([slots[movable.body.id] for movable in self._loads], dtype=np.intp)
            self._load_state = np.full((len(self._loads), 6), np.nan)
        self._all = state = np.frombuffer(self._read.float_buf()).reshape(-1, 6)
        if len(self._slots) == len(self._bodies):
            self._state = state[self._slots]
        else:
            self._state[self._stands] = state[self._slots]

    def _set(self, fields: batch.BodyFields, motion: Values) -> None:
        """Write speeds, and forces if the fields have them, of all that stand."""
        motion = motion if self._stands.all() else motion[self._stands]
        if not self._is_alone:
            self._setter.set(fields, motion)
            return
        rows = np.zeros((len(self._ids), motion.shape[1]))
        rows[self._slots] = motion
        self._written.set_float_buf(rows)
        batch.set_space_bodies(self._space, fields, self._written)
