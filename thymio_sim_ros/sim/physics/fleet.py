"""The bodies of many robots at once: the sums of `RobotBody` on arrays.

All robots glide; those that may reach something soon (`Lookout`) are engaged: their bodies are in the space as well,
which tells who touches anything, and moves who does. pymunk hands over all bodies in one call (`pymunk.batch`). While a
fleet drives, its arrays are the truth, and a body asks it to `tell` when somebody looks; before a body is changed from
outside, `release` makes the body the truth until the next tick.
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
from thymio_sim_ros.sim.nearby import Mover
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS
from thymio_sim_ros.sim.physics.doors import DoorBody
from thymio_sim_ros.sim.physics.lookout import LOOK_ROUND_TICKS, Lookout
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
"""Columns x, y, angle, vx, vy, rate of turn."""
_NOBODY: Indices = np.zeros(0, dtype=np.intp)


class Fleet:
    """Robots of one space, always the same. Between ticks their state lies in arrays, or in bodies, or in both."""

    def __init__(
        self,
        space: pymunk.Space,
        bodies: Sequence[RobotBody],
        movables: Sequence[MovableBody],
        doors: Sequence[DoorBody],
        lookout: Lookout,
    ) -> None:
        self._space, self._bodies, self._lookout = space, tuple(bodies), lookout
        self._movables, self._doors = tuple(movables), tuple(doors)
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
        self._is_touching, self._is_free = np.zeros(count, dtype=bool), np.ones(count, dtype=bool)
        self._touching = self._held = _NOBODY
        self._places = np.zeros((3, count))
        """Rows x, y, yaw."""
        self._motion = np.zeros((3, count))
        """Rows vx, vy, rate of turn; of those who were touching when the engine was asked last."""
        self._target = np.zeros((3, count))
        """The same as the wheels want it."""
        self._rolling = (np.zeros(count),) * 4
        """Speed and rate of turn that the wheels give in this tick, and the turn in half a sub-step and in a whole."""
        self._speed = self._spin = self._cos = self._sin = np.zeros(count)
        self._stands, self._fallen = np.ones(count, dtype=bool), _NOBODY
        self._engaged = _NOBODY
        self._row = np.zeros(count, dtype=np.intp)
        """Where in `_engaged` each of them is."""
        self._setter = Setter([])
        self._look_round_in = 0
        self._was_restless = False
        self._loads: list[MovableBody] = []
        """Things that have not fallen."""
        self._load_slots = np.zeros(0, dtype=np.intp)
        self._load_state = np.zeros((0, 6))
        self._is_load_moving = self._is_load_fast = False
        self._all = np.zeros((0, 6))
        """The state of all bodies of the space, when it was asked last."""
        self._ids = b""
        self._slots = np.zeros(count, dtype=np.intp)
        """Where in `_all` each engaged robot is."""
        self._read = batch.Buffer()
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
        """Where the robots are: rows x, y, yaw. Not to be changed; the next tick makes a new one."""
        if self._is_released:
            self._take()
        return self._places.T

    @property
    def motion(self) -> tuple[Values, Values]:
        """Speeds along the headings, m/s, and rates of turn, rad/s."""
        if self._is_released:
            self._take()
        return self._speed, self._spin

    @property
    def fallen(self) -> Indices:
        """The numbers of those who have fallen."""
        if self._is_released:
            self._take()
        return self._fallen

    @property
    def needs_engine(self) -> bool:
        """Whether there is anything for the engine to do in this tick."""
        return len(self._engaged) > 0 or self._is_load_moving or self._was_restless

    def tell(self) -> None:
        """Write to the bodies what the last tick has made of them."""
        if self.is_told:
            return
        self.is_told = True
        columns = (self._places.T, self._speed, self._spin, self._is_free)
        values = zip(self._bodies, *(column.tolist() for column in columns), strict=True)
        for body, (x_m, y_m, angle), speed, spin, is_free in values:
            body.take_over(Pose(x_m, y_m, angle), speed, spin, is_free=is_free)

    def release(self) -> None:
        """Let the bodies be changed until the next tick."""
        self.tell()
        self._is_released = True
        self.changed.update(self._bodies)

    def begin_tick(self, *, do_doors_move: bool) -> None:
        """As `RobotBody.begin_tick`."""
        if self._is_released:
            self._take()
        self._look_at_contacts()
        is_restless = do_doors_move or self._is_load_fast
        if self._look_round_in == 0 or is_restless != self._was_restless:
            self._look_round(is_restless=is_restless)
        self._look_round_in -= 1
        self._is_free = ~self._is_touching
        self._held = self._touching
        self.covered = self.driven.copy()
        if len(self._touching):
            self.covered[:, self._touching] = 0.0
        for body in self._begun:
            for key, contact in body.touching.items():
                if contact.is_new:
                    body.touching[key] = replace(contact, is_new=False)
        self._begun.clear()
        left, right = self.driven
        speed, spin = (left + right) / 2, (right - left) / thymio2.WHEEL_TRACK_M
        if len(self._fallen):
            speed[self._fallen] = spin[self._fallen] = 0.0
        self._rolling = speed, spin, spin * (SUB_STEP_S / 2), spin * SUB_STEP_S
        self.is_told = False

    def push(self) -> None:
        """As `RobotBody.push`; and let all glide."""
        x, y, angle = self._places
        speed, spin, half_turn, turn = self._rolling
        heading = angle + half_turn
        touching = self._touching
        if len(touching):
            heading[touching] += self._motion[2, touching] * SUB_STEP_S
        self._cos, self._sin = np.cos(heading), np.sin(heading)
        target = self._target
        np.multiply(speed, self._cos, out=target[0])
        np.multiply(speed, self._sin, out=target[1])
        target[2] = spin
        self._places = places = np.empty_like(self._places)
        np.add(x, target[0] * SUB_STEP_S, out=places[0])
        np.add(y, target[1] * SUB_STEP_S, out=places[1])
        np.add(angle, turn, out=places[2])
        if len(self._engaged) == 0:
            return
        if len(touching) == 0:
            self._setter.set(_SPEEDS, target[:, self._engaged].T)
            return
        rows = np.zeros((6, len(self._engaged)))
        rows[:3] = target[:, self._engaged]
        motion = self._motion[:, touching]
        lack = target[:, touching] - motion
        push = lack[:2] * PUSH_N_S_M
        push *= thymio2.DRIVE_FORCE_N / np.maximum(thymio2.DRIVE_FORCE_N, np.hypot(push[0], push[1]))
        lack[2] *= MOMENT_KG_M2 / SUB_STEP_S
        where = self._row[touching]
        rows[:3, where], rows[3:5, where], rows[5, where] = motion, push, lack[2]
        self._setter.set(_FORCES, rows.T)

    def settle(self, earlier: int) -> None:
        """As `RobotBody.settle`."""
        if self.changed:
            self._look_at_contacts()
            self._held = np.flatnonzero(self._is_touching | ~self._is_free)
        if earlier == 0:
            self._speed, self._spin = self._rolling[:2]
            if len(self._held):
                self._speed, self._spin = self._speed.copy(), self._spin.copy()
        held = self._held
        if len(held) == 0:
            return
        self._get()
        begun = held[self._is_free[held]]
        if len(begun):
            self.covered[:, begun] = self.driven[:, begun] * (earlier / SUB_STEPS)
            self._is_free[begun] = False
        state = self._all[self._slots[held]].T
        self._places[:, held] = state[:3]
        self._motion[:, held] = state[3:]
        spin = state[5]
        speed = state[3] * self._cos[held] + state[4] * self._sin[held]
        self._speed[held], self._spin[held] = speed, spin
        half = spin * (thymio2.WHEEL_TRACK_M / 2)
        self.covered[0, held] += (speed - half) / SUB_STEPS
        self.covered[1, held] += (speed + half) / SUB_STEPS

    def end_tick(self) -> None:
        """As `RobotBody.end_tick`, and of everything that was pushed or slides."""
        if not self._loads:
            return
        if len(self._held) == 0:
            if not (self._is_load_moving or self._was_restless):
                return
            self._get()
        loads = self._all[self._load_slots]
        self._is_load_moving = self._is_load_fast = False
        for index in np.flatnonzero((loads != self._load_state).any(axis=1)).tolist():
            load = self._loads[index]
            load.settle(*loads[index].tolist())
            self._is_load_moving |= load.is_moving
            self._is_load_fast |= load.is_fast
        self._load_state = loads

    def touching(self) -> list[RobotBody]:
        """Robots that touch something."""
        return [self._bodies[index] for index in self._touching.tolist()]

    def _look_at_contacts(self) -> None:
        if self.changed:
            self._begun.update(self.changed)
            for body in self.changed:
                self._is_touching[self._index[body]] = bool(body.touching)
            self.changed.clear()
            self._touching = np.flatnonzero(self._is_touching)

    def _look_round(self, *, is_restless: bool) -> None:
        """Engage those who may reach something, and nobody else; all when there is no telling."""
        self._was_restless = is_restless
        self._look_round_in = LOOK_ROUND_TICKS
        if is_restless:
            is_engaged = self._stands.copy()
        else:
            movers: tuple[Mover, ...] = (*self._loads, *self._doors)
            things = [(mover.pose.x_m, mover.pose.y_m, mover.reach_m) for mover in movers]
            is_engaged = self._lookout.near(self._places, self._stands, np.array(things).reshape(-1, 3).T)
            is_engaged |= self._is_touching
        engaged = np.flatnonzero(is_engaged)
        if np.array_equal(engaged, self._engaged):
            return
        self.tell()
        for body, is_wanted in zip(self._bodies, is_engaged.tolist(), strict=True):
            if is_wanted:
                body.engage(self._space)
            else:
                body.disengage(self._space)
        self._list_engaged(engaged)

    def _list_engaged(self, engaged: Indices) -> None:
        self._engaged = engaged
        self._row[engaged] = np.arange(len(engaged))
        self._setter = Setter([self._bodies[index].body for index in engaged.tolist()])
        self._ids = b""

    def _take(self) -> None:
        """Read what the bodies are."""
        self._is_released = False
        self._look_round_in = 0
        self._stands = np.array([not body.is_fallen for body in self._bodies], dtype=bool)
        self._fallen = np.flatnonzero(~self._stands)
        self._speed = np.array([body.speed_m_s for body in self._bodies])
        self._spin = np.array([body.spin_rad_s for body in self._bodies])
        places = [(body.pose.x_m, body.pose.y_m, body.pose.yaw_rad) for body in self._bodies]
        self._places = np.ascontiguousarray(np.array(places).reshape(-1, 3).T)
        motion = [(*body.body.velocity, body.body.angular_velocity) for body in self._bodies]
        self._motion = np.ascontiguousarray(np.array(motion).reshape(-1, 3).T)
        self._list_engaged(np.flatnonzero([body.is_engaged for body in self._bodies]))
        self._loads = [movable for movable in self._movables if not movable.is_fallen]
        self._load_state = np.full((len(self._loads), 6), np.nan)
        self._is_load_moving = any(load.is_moving for load in self._loads)
        self._is_load_fast = any(load.is_fast for load in self._loads)

    def _get(self) -> None:
        """The state of all bodies in the space."""
        self._read.clear()
        batch.get_space_bodies(self._space, _STATE, self._read)
        ids = bytes(self._read.int_buf())
        if ids != self._ids:
            self._ids = ids
            slots = {number: slot for slot, number in enumerate(np.frombuffer(ids, dtype=np.uintp).tolist())}
            bodies = [self._bodies[index].body for index in self._engaged.tolist()]
            self._slots[self._engaged] = [slots[body.id] for body in bodies]
            self._load_slots = np.array([slots[movable.body.id] for movable in self._loads], dtype=np.intp)
        self._all = np.frombuffer(self._read.float_buf()).reshape(-1, 6)
