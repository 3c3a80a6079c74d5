"""The bodies of many robots at once: the sums of `RobotBody` on arrays.

All robots glide; those that may reach something soon (`Lookout`) are engaged: their bodies are in the space as well,
which tells who touches anything, and moves who does. While a fleet drives, its arrays are the truth, and a body asks it
to `tell` when somebody looks; before a body is changed from outside, `release` makes the body the truth until the next
tick.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

import numpy as np
import numpy.typing as npt
import pymunk

from thymio_sim_ros.sim.kernel.memory import is_available
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.physics.active_bodies import Engaged
from thymio_sim_ros.sim.physics.broadphase_batch import LOOK_ROUND_TICKS, Lookout
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS, Contact
from thymio_sim_ros.sim.physics.door_body import DoorBody
from thymio_sim_ros.sim.physics.driving_kernel_binding import CompiledEngaged, Driving
from thymio_sim_ros.sim.physics.movable_body import MovableBody
from thymio_sim_ros.sim.physics.pymunk_batch_io import Reader, Setter
from thymio_sim_ros.sim.physics.robot_body import RobotBody

__all__ = ["Fleet"]

Values = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]

_NOBODY: Indices = np.zeros(0, dtype=np.intp)
_LOOKS_TO_GO = 4
"""So many times robots look round before some of them may leave the engine."""
_PLACE, _SPEED, _SPIN, _COVERED = slice(0, 3), 3, 4, slice(5, 7)
"""Rows of what is known of the robots: x, y, yaw; speed, rate of turn; speed over ground at each wheel."""


class Fleet:
    """Robots of one space, always the same. Between ticks their state lies in arrays, or in bodies, or in both."""

    def __init__(
        self,
        space: pymunk.Space,
        bodies: Sequence[RobotBody],
        movables: Sequence[MovableBody],
        doors: Sequence[DoorBody],
        lookout: Lookout,
        *,
        is_compiled: bool | None = None,
    ) -> None:
        """`is_compiled`: by kernels, or with numpy; None: by kernels where they are available. Nothing else differs."""
        compiled = is_available() if is_compiled is None else is_compiled
        self._space, self._bodies, self._lookout = space, tuple(bodies), lookout
        self._movables, self._doors = tuple(movables), tuple(doors)
        count = len(self._bodies)
        self.driven = np.zeros((2, count))
        """Speed over ground that each wheel gives, m/s: left, then right."""
        self.changed: set[RobotBody] = set(self._bodies)
        """To be filled with those for whom a contact begins or ends."""
        self._begun: set[RobotBody] = set()
        """Who may have a contact that is new."""
        self._contacts: tuple[Contact, ...] | None = None
        """None when they may have changed."""
        self._index = {body: index for index, body in enumerate(self._bodies)}
        self._is_touching = np.zeros(count, dtype=bool)
        self._touching = self._held = self._fallen = _NOBODY
        self._stands = np.ones(count, dtype=bool)
        self._now = np.zeros((7, count))
        self._rolling = np.zeros((4, count))
        """Speed and rate of turn that the wheels give in this tick, and the turn in half a sub-step and in a whole."""
        self._is_engaged = np.zeros(count, dtype=bool)
        self._driving = Driving(count, len(self._bodies) + len(movables) + len(doors) + 1) if compiled else None
        self._setter, self._reader = Setter(), Reader(space)
        self._engaged = self._engage(_NOBODY)
        self._look_round_in = self._looks = 0
        self._was_restless = False
        self._loads: list[MovableBody] = []
        """Things that have not fallen."""
        self._things = np.zeros((3, 0))
        """Their x, y and reach."""
        self._load_rows, self._load_order = _NOBODY, 0
        """Where the reader has them, and in which order of its own."""
        self._load_state = np.zeros((0, 6))
        self._is_load_moving = self._is_load_fast = False
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
        return self._now[_PLACE].T

    @property
    def covered(self) -> Values:
        """Speed over ground at each wheel, mean of the last tick, m/s: left, then right."""
        return self._now[_COVERED]

    @property
    def motion(self) -> tuple[Values, Values]:
        """Speeds along the headings, m/s, and rates of turn, rad/s."""
        if self._is_released:
            self._take()
        return self._now[_SPEED], self._now[_SPIN]

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
        is_free = np.ones(len(self._bodies), dtype=bool)
        is_free[self._held] = False
        for body, row, free in zip(self._bodies, self._now[:5].T.tolist(), is_free.tolist(), strict=True):
            body.take_over(Pose(row[0], row[1], row[2]), row[3], row[4], is_free=free)

    def release(self) -> None:
        """Let the bodies be changed until the next tick."""
        self.tell()
        self._is_released = True
        self.changed.update(self._bodies)

    def begin_tick(self, *, do_doors_move: bool) -> None:
        """As `RobotBody.begin_tick`; and let all glide."""
        if self._is_released:
            self._take()
        self._look_at_contacts()
        is_restless = do_doors_move or self._is_load_fast
        if self._look_round_in == 0 or is_restless != self._was_restless:
            self._look_round(is_restless=is_restless)
        self._look_round_in -= 1
        if self._begun:
            self._contacts = None
        for body in self._begun:
            for key, contact in body.touching.items():
                if contact.is_new:
                    body.touching[key] = replace(contact, is_new=False)
        self._begun.clear()
        before = self._glide()
        if len(self._engaged):
            touching = self._is_touching if len(self._touching) else None
            self._engaged.begin_tick(self.driven, self._rolling, before, touching)
        self._held = _NOBODY
        self.is_told = False

    def push(self) -> None:
        """As `RobotBody.push`."""
        if len(self._engaged):
            self._engaged.push()

    def settle(self, earlier: int) -> None:
        """As `RobotBody.settle`."""
        touching = None
        if self.changed:
            self._look_at_contacts()
            touching = self._is_touching
        if len(self._engaged):
            self._engaged.settle(earlier, self._reader, touching)

    def end_tick(self) -> None:
        """As `RobotBody.end_tick`, and of everything that was pushed or slides."""
        if self._engaged.is_anybody_held:
            self._held = self._engaged.note(self._now)
        elif self._is_load_moving or self._was_restless:
            self._reader.read()
        else:
            return
        if self._loads:
            self._settle_loads()

    def contacts(self) -> tuple[Contact, ...]:
        """All contacts, by robot and in the order in which they began."""
        if self._contacts is None or self.changed:
            touching = [self._bodies[index].touching.values() for index in self._touching.tolist()]
            self._contacts = tuple(chain.from_iterable(touching))
        return self._contacts

    def _glide(self) -> Values:
        """As `RobotBody.glide`, whatever else may happen to them; the yaws before it."""
        if self._driving is not None:
            self._driving.driven[:] = self.driven
            self._driving.go()
            yaws: Values = self._now[2]
            self._now = self._driving.now.copy()
            return yaws
        left, right = self.driven
        self._rolling = rolling = np.empty_like(self._rolling)
        speed, spin, half_turn, turn = rolling
        np.add(left, right, out=speed)
        speed /= 2
        np.subtract(right, left, out=spin)
        spin /= robot_constants.WHEEL_TRACK_M
        if len(self._fallen):
            rolling[:2, self._fallen] = 0.0
        np.multiply(spin, SUB_STEP_S / 2, out=half_turn)
        np.multiply(spin, SUB_STEP_S, out=turn)
        before, self._now = self._now, np.empty_like(self._now)
        start: Values = before[2]
        yaw = start
        ways = np.empty((2, SUB_STEPS, len(self._bodies)))
        for sub_step in range(SUB_STEPS):
            np.add(yaw, half_turn, out=ways[0, sub_step])
            yaw = yaw + turn
        np.sin(ways[0], out=ways[1])
        np.cos(ways[0], out=ways[0])
        ways *= speed
        ways *= SUB_STEP_S
        places = before[:2]
        for sub_step in range(SUB_STEPS):
            places = places + ways[:, sub_step]
        self._now[:2], self._now[2] = places, yaw
        self._now[_SPEED : _SPIN + 1] = rolling[:2]
        self._now[_COVERED] = self.driven
        return start

    def _look_at_contacts(self) -> None:
        if self.changed:
            self._contacts = None
            self._begun.update(self.changed)
            for body in self.changed:
                self._is_touching[self._index[body]] = bool(body.touching)
            self.changed.clear()
            self._touching = self._is_touching.nonzero()[0]
            if self._driving is not None:
                self._driving.is_touching[:] = self._is_touching

    def _look_round(self, *, is_restless: bool) -> None:
        """Engage those who may reach something; all when there is no telling. Let others go, though not every time."""
        self._look_round_in = LOOK_ROUND_TICKS
        is_engaged, self._looks = self._is_engaged, self._looks + 1
        may_go = self._looks % _LOOKS_TO_GO == 0 or is_restless != self._was_restless
        self._was_restless = is_restless
        if is_restless:
            is_wanted = self._stands
        else:
            things = self._things
            if self._doors:
                doors = [(door.pose.x_m, door.pose.y_m, door.reach_m) for door in self._doors]
                things = np.concatenate((things, np.array(doors).T), axis=1)
            is_wanted = self._lookout.near(self._now[_PLACE], self._stands, things) | self._is_touching
            if not may_go:
                is_wanted |= is_engaged
        differs = np.flatnonzero(is_wanted != is_engaged).tolist()
        if not differs:
            return
        for number in differs:
            body = self._bodies[number]
            if is_engaged[number]:
                body.disengage(self._space)
            else:
                x_m, y_m, yaw, speed, spin = self._now[:5, number].tolist()
                body.take_over(Pose(x_m, y_m, yaw), speed, spin, is_free=True)
                body.engage(self._space)
        self._is_engaged = is_wanted
        self._engaged = self._engage(np.flatnonzero(is_wanted))

    def _take(self) -> None:
        """Read what the bodies are."""
        self._is_released = False
        self._look_round_in = 0
        self._stands = np.array([not body.is_fallen for body in self._bodies], dtype=bool)
        self._fallen = np.flatnonzero(~self._stands)
        poses = [body.pose for body in self._bodies]
        self._now = np.zeros_like(self._now)
        self._now[_PLACE] = np.array([(pose.x_m, pose.y_m, pose.yaw_rad) for pose in poses]).reshape(-1, 3).T
        self._now[_SPEED] = [body.speed_m_s for body in self._bodies]
        self._now[_SPIN] = [body.spin_rad_s for body in self._bodies]
        self._is_engaged = np.array([body.is_engaged for body in self._bodies], dtype=bool)
        self._engaged = self._engage(np.flatnonzero(self._is_engaged))
        if self._driving is not None:
            self._driving.now[:], self._driving.stands[:] = self._now, self._stands
        self._loads = loads = [movable for movable in self._movables if not movable.is_fallen]
        things = [(load.pose.x_m, load.pose.y_m, load.reach_m) for load in loads]
        self._things = np.array(things).reshape(-1, 3).T
        self._load_order = 0
        self._load_state = np.full((len(self._loads), 6), np.nan)
        self._is_load_moving = any(load.is_moving for load in self._loads)
        self._is_load_fast = any(load.is_fast for load in self._loads)

    def _engage(self, numbers: Indices) -> Engaged | CompiledEngaged:
        """Those with these numbers."""
        if self._driving is not None:
            return CompiledEngaged(self._driving, self._bodies, numbers, self._setter)
        return Engaged(self._bodies, numbers, self._setter)

    def _settle_loads(self) -> None:
        """Tell things that have moved."""
        if self._load_order != self._reader.order:
            self._load_order = self._reader.order
            self._load_rows = self._reader.rows([movable.body for movable in self._loads])
        loads = self._reader.state[self._load_rows]
        self._is_load_moving = self._is_load_fast = False
        columns = loads.shape[1]
        changed = dict.fromkeys(place // columns for place in (loads != self._load_state).ravel().nonzero()[0].tolist())
        if not changed:
            return
        for index in changed:
            load = self._loads[index]
            load.settle(*loads[index].tolist())
            self._is_load_moving |= load.is_moving
            self._is_load_fast |= load.is_fast
        self._things[:2] = loads[:, :2].T
        self._load_state = loads
