"""The bodies of many robots at once: the computations of `RobotBody` on arrays.

All robots are first integrated as if nothing were in their way. Robots that may reach something soon
(`BroadphaseBatch`) are *active*: their bodies are also in pymunk's space, which detects contacts and moves the robots
in contact. While the driver runs, its arrays are authoritative, and a body calls `write_back` before it is read. Before
a body is changed from outside, `release` makes the body authoritative until the next tick.
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
from thymio_sim_ros.sim.physics.active_bodies import ActiveBodies
from thymio_sim_ros.sim.physics.broadphase_batch import CHECK_INTERVAL_TICKS, BroadphaseBatch
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS, Contact
from thymio_sim_ros.sim.physics.door_body import DoorBody
from thymio_sim_ros.sim.physics.driving_kernel_binding import CompiledActiveBodies, DrivingKernelBinding
from thymio_sim_ros.sim.physics.movable_body import MovableBody
from thymio_sim_ros.sim.physics.pymunk_batch_io import BodyReader, BodyWriter
from thymio_sim_ros.sim.physics.robot_body import RobotBody

__all__ = ["BatchDriver"]

Values = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]

_NONE: Indices = np.zeros(0, dtype=np.intp)
_CHECKS_TO_DEACTIVATE = 4
"""Robots are activated at every check, but deactivated only at every fourth."""
_PLACE, _SPEED, _SPIN, _COVERED = slice(0, 3), 3, 4, slice(5, 7)
"""Rows of the state of the robots: x, y, yaw; speed, rate of turn; speed over ground at each wheel (m, rad, s)."""


class BatchDriver:
    """Moves a fixed set of robots of one space; the calls of a tick are those of `ScalarDriver`.

    Two flags say where the state after the last tick is. `is_written_back` is False: only in the arrays. `_is_released`
    is True: the bodies are authoritative, and `_load` reads them before the arrays are used again. Otherwise arrays and
    bodies agree.
    """

    def __init__(
        self,
        space: pymunk.Space,
        bodies: Sequence[RobotBody],
        movables: Sequence[MovableBody],
        doors: Sequence[DoorBody],
        broadphase: BroadphaseBatch,
        *,
        is_compiled: bool | None = None,
    ) -> None:
        """`is_compiled`: use kernels, or numpy; None: kernels if available. The results are the same."""
        compiled = is_available() if is_compiled is None else is_compiled
        self._space, self._bodies, self._broadphase = space, tuple(bodies), broadphase
        self._movables, self._doors = tuple(movables), tuple(doors)
        count = len(self._bodies)
        self.driven = np.zeros((2, count))
        """Speed over ground that each wheel gives, m/s: left, then right."""
        self.changed: set[RobotBody] = set(self._bodies)
        """Robots with a contact that began or ended; filled by the contact tracker."""
        self._begun: set[RobotBody] = set()
        """Robots that may have a new contact."""
        self._contacts: tuple[Contact, ...] | None = None
        """The contacts of all robots; None if they may have changed."""
        self._index = {body: index for index, body in enumerate(self._bodies)}
        self._is_touching = np.zeros(count, dtype=bool)
        self._touching = self._held = self._fallen = _NONE
        self._stands = np.ones(count, dtype=bool)
        self._now = np.zeros((7, count))
        self._rolling = np.zeros((4, count))
        """Speed and rate of turn that the wheels give in this tick, and the turn in half a sub-step and in a whole."""
        self._is_active = np.zeros(count, dtype=bool)
        self._binding = (
            DrivingKernelBinding(count, len(self._bodies) + len(movables) + len(doors) + 1) if compiled else None
        )
        self._setter, self._reader = BodyWriter(), BodyReader(space)
        self._active = self._make_active(_NONE)
        self._ticks_to_check = self._checks = 0
        self._was_unpredictable = False
        self._loads: list[MovableBody] = []
        """Movable objects that have not fallen."""
        self._objects = np.zeros((3, 0))
        """Their x, y and reach in m, shape (3, objects)."""
        self._load_rows, self._load_order = _NONE, 0
        """Their rows in `BodyReader.state`, and the `order` of the reader for which these are valid."""
        self._load_state = np.zeros((0, 6))
        self._is_load_moving = self._is_load_fast = False
        self._is_released = True
        self.is_written_back = True
        """Whether the bodies have the state after the last tick."""
        for body in self._bodies:
            body.batch_driver = self

    def dissolve(self) -> None:
        """End the batch: the bodies become authoritative, and the driver must not be used any more."""
        self.write_back()
        for body in self._bodies:
            body.batch_driver = None

    @property
    def poses(self) -> Values:
        """Poses of the robots, shape (robots, 3): x, y in m, yaw in rad. Read only; each tick makes a new array."""
        if self._is_released:
            self._load()
        return self._now[_PLACE].T

    @property
    def covered(self) -> Values:
        """Speed over ground at the left and right wheel, mean of the last tick, in m/s, shape (2, robots)."""
        return self._now[_COVERED]

    @property
    def motion(self) -> tuple[Values, Values]:
        """Speeds along the headings in m/s and rates of turn in rad/s, shape (robots,) each."""
        if self._is_released:
            self._load()
        return self._now[_SPEED], self._now[_SPIN]

    @property
    def fallen(self) -> Indices:
        """Numbers of the robots that have fallen."""
        if self._is_released:
            self._load()
        return self._fallen

    @property
    def needs_engine(self) -> bool:
        """Whether pymunk has to step in this tick."""
        return len(self._active) > 0 or self._is_load_moving or self._was_unpredictable

    def write_back(self) -> None:
        """Write the state after the last tick to the bodies."""
        if self.is_written_back:
            return
        self.is_written_back = True
        is_free = np.ones(len(self._bodies), dtype=bool)
        is_free[self._held] = False
        for body, row, free in zip(self._bodies, self._now[:5].T.tolist(), is_free.tolist(), strict=True):
            body.set_state(Pose(row[0], row[1], row[2]), row[3], row[4], is_free=free)

    def release(self) -> None:
        """Make the bodies authoritative until the next tick, so that they can be changed."""
        self.write_back()
        self._is_released = True
        self.changed.update(self._bodies)

    def begin_tick(self, *, do_doors_move: bool) -> None:
        """Start a tick: clear the flags of new contacts, update the active robots, integrate all robots freely."""
        if self._is_released:
            self._load()
        self._update_contacts()
        # The broadphase assumes doors at rest and slow objects; otherwise all robots are active.
        is_unpredictable = do_doors_move or self._is_load_fast
        if self._ticks_to_check == 0 or is_unpredictable != self._was_unpredictable:
            self._update_active(is_unpredictable=is_unpredictable)
        self._ticks_to_check -= 1
        if self._begun:
            self._contacts = None
        for body in self._begun:
            for key, contact in body.touching.items():
                if contact.is_new:
                    body.touching[key] = replace(contact, is_new=False)
        self._begun.clear()
        before = self._move_freely()
        if len(self._active):
            touching = self._is_touching if len(self._touching) else None
            self._active.begin_tick(self.driven, self._rolling, before, touching)
        self._held = _NONE
        self.is_written_back = False

    def push(self) -> None:
        """Before a sub-step: write speeds or forces of the active robots to pymunk."""
        if len(self._active):
            self._active.push()

    def finish_sub_step(self, earlier: int) -> None:
        """After a sub-step, which follows `earlier` ones of this tick: read back the robots in contact."""
        touching = None
        if self.changed:
            self._update_contacts()
            touching = self._is_touching
        if len(self._active):
            self._active.finish_sub_step(earlier, self._reader, touching)

    def end_tick(self) -> None:
        """Update the state of robots in contact and of objects that move."""
        if self._active.is_any_held:
            self._held = self._active.write_held(self._now)
        elif self._is_load_moving or self._was_unpredictable:
            self._reader.read()
        else:
            return
        if self._loads:
            self._update_loads()

    def contacts(self) -> tuple[Contact, ...]:
        """All contacts, by robot and in the order in which they began."""
        if self._contacts is None or self.changed:
            touching = [self._bodies[index].touching.values() for index in self._touching.tolist()]
            self._contacts = tuple(chain.from_iterable(touching))
        return self._contacts

    def _move_freely(self) -> Values:
        """Integrate all robots as if nothing were in their way; returns the yaws before, shape (robots,)."""
        # Robots in contact are integrated as well; `end_tick` overwrites them with what pymunk computed. The operations
        # are those of `RobotBody.move_freely`, in its order, so that all paths give the same bits.
        if self._binding is not None:
            self._binding.driven[:] = self.driven
            self._binding.start_tick()
            yaws: Values = self._now[2]
            self._now = self._binding.now.copy()
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
        # First the headings in the middle of each sub-step, then the displacements along them: x, y by sub-step and
        # robot, computed in place.
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

    def _update_contacts(self) -> None:
        if self.changed:
            self._contacts = None
            self._begun.update(self.changed)
            for body in self.changed:
                self._is_touching[self._index[body]] = bool(body.touching)
            self.changed.clear()
            self._touching = self._is_touching.nonzero()[0]
            if self._binding is not None:
                self._binding.is_touching[:] = self._is_touching

    def _update_active(self, *, is_unpredictable: bool) -> None:
        """Activate the robots that may reach something, or all; deactivate the others at every fourth check."""
        self._ticks_to_check = CHECK_INTERVAL_TICKS
        is_active, self._checks = self._is_active, self._checks + 1
        may_go = self._checks % _CHECKS_TO_DEACTIVATE == 0 or is_unpredictable != self._was_unpredictable
        self._was_unpredictable = is_unpredictable
        if is_unpredictable:
            is_wanted = self._stands
        else:
            objects = self._objects
            if self._doors:
                doors = [(door.pose.x_m, door.pose.y_m, door.reach_m) for door in self._doors]
                objects = np.concatenate((objects, np.array(doors).T), axis=1)
            is_wanted = self._broadphase.near(self._now[_PLACE], self._stands, objects) | self._is_touching
            if not may_go:
                is_wanted |= is_active
        differs = np.flatnonzero(is_wanted != is_active).tolist()
        if not differs:
            return
        for number in differs:
            body = self._bodies[number]
            # A robot that is activated takes its state from the arrays; the body may be many ticks old.
            if is_active[number]:
                body.deactivate(self._space)
            else:
                x_m, y_m, yaw, speed, spin = self._now[:5, number].tolist()
                body.set_state(Pose(x_m, y_m, yaw), speed, spin, is_free=True)
                body.activate(self._space)
        self._is_active = is_wanted
        self._active = self._make_active(np.flatnonzero(is_wanted))

    def _load(self) -> None:
        """Read the state of all bodies into the arrays: the arrays are authoritative again."""
        self._is_released = False
        self._ticks_to_check = 0
        self._stands = np.array([not body.is_fallen for body in self._bodies], dtype=bool)
        self._fallen = np.flatnonzero(~self._stands)
        poses = [body.pose for body in self._bodies]
        self._now = np.zeros_like(self._now)
        self._now[_PLACE] = np.array([(pose.x_m, pose.y_m, pose.yaw_rad) for pose in poses]).reshape(-1, 3).T
        self._now[_SPEED] = [body.speed_m_s for body in self._bodies]
        self._now[_SPIN] = [body.spin_rad_s for body in self._bodies]
        self._is_active = np.array([body.is_active for body in self._bodies], dtype=bool)
        self._active = self._make_active(np.flatnonzero(self._is_active))
        if self._binding is not None:
            self._binding.now[:], self._binding.stands[:] = self._now, self._stands
        self._loads = loads = [movable for movable in self._movables if not movable.is_fallen]
        objects = [(load.pose.x_m, load.pose.y_m, load.reach_m) for load in loads]
        self._objects = np.array(objects).reshape(-1, 3).T
        self._load_order = 0
        self._load_state = np.full((len(self._loads), 6), np.nan)  # NaN equals nothing: all count as changed
        self._is_load_moving = any(load.is_moving for load in self._loads)
        self._is_load_fast = any(load.is_fast for load in self._loads)

    def _make_active(self, numbers: Indices) -> ActiveBodies | CompiledActiveBodies:
        """Return the active bodies with these numbers, by kernels if there are any."""
        if self._binding is not None:
            return CompiledActiveBodies(self._binding, self._bodies, numbers, self._setter)
        return ActiveBodies(self._bodies, numbers, self._setter)

    def _update_loads(self) -> None:
        """Update the objects that have moved."""
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
            load.finish_sub_step(*loads[index].tolist())
            self._is_load_moving |= load.is_moving
            self._is_load_fast |= load.is_fast
        self._objects[:2] = loads[:, :2].T
        self._load_state = loads
