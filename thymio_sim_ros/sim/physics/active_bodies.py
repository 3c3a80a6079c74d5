"""The robots of a batch that are in pymunk's space: `RobotBody.push` and `finish_sub_step` on arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS
from thymio_sim_ros.sim.physics.pymunk_batch_io import FORCES, SPEEDS, BodyReader, BodyWriter
from thymio_sim_ros.sim.physics.robot_body import MOMENT_KG_M2, PUSH_N_S_M, RobotBody

__all__ = ["ActiveBodies"]

Values = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]
Flags = npt.NDArray[np.bool_]


class ActiveBodies:
    """A fixed set of robots of a batch; each has a column in the arrays.

    A robot that touches nothing moves as the batch driver computed; pymunk only detects when that ends. A robot is
    *held* if it touches something, or has in this tick: its motion is read from pymunk.
    """

    def __init__(self, bodies: Sequence[RobotBody], numbers: Indices, setter: BodyWriter) -> None:
        """Choose the bodies with these numbers, shape (active,); `setter` writes to them from now on."""
        self.numbers = numbers
        self._bodies = [bodies[number].body for number in numbers.tolist()]
        self._rows: Indices = np.zeros(0, dtype=np.intp)
        self._order = 0
        """Rows of the bodies in `BodyReader.state`, and the `order` of the reader for which these are valid."""
        count = len(numbers)
        self._setter = setter
        setter.choose(self._bodies)
        self._state = np.zeros((6, count))
        """Rows x, y, yaw, vx, vy, turn rate, as in pymunk; valid only for robots in contact."""
        for column, number in enumerate(numbers.tolist()):
            if bodies[number].touching:
                body = bodies[number].body
                self._state[3:, column] = *body.velocity, body.angular_velocity
        self._target, self._wanted = np.zeros((3, count)), np.zeros((6, count))
        self._cos, self._sin, self._speed = np.zeros(count), np.zeros(count), np.zeros(count)
        self._covered = np.zeros((2, count))
        self._touching, self._held = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
        self._is_any_touching = self.is_any_held = False

    def __len__(self) -> int:
        return len(self.numbers)

    def begin_tick(self, driven: Values, rolling: Values, yaw: Values, touching: Flags | None) -> None:
        """Start a tick with the state of all robots of the batch.

        Args:
            driven: speed over ground of the left and right wheel, m/s, shape (2, robots).
            rolling: speed, rate of turn, turn in half a sub-step and in a whole one, shape (4, robots).
            yaw: yaws before the tick, shape (robots,).
            touching: whether each robot is in contact, shape (robots,); None if none is.
        """
        numbers = self.numbers
        self._driven = driven[:, numbers]
        self._rolling = rolling[:, numbers]
        self._target[2] = self._rolling[1]
        self._yaw = yaw[numbers]
        self._is_any_touching = self.is_any_held = touching is not None
        if touching is not None:
            self._touching = touching[numbers]
            self._held = self._touching.copy()
            self._covered[:] = 0.0

    def push(self) -> None:
        """Before a sub-step: write speeds, and in contact forces, to pymunk (`RobotBody.push` on arrays)."""
        speed, _, half_turn, _ = self._rolling
        # In contact, the body turns by its own rate first (see `RobotBody.push`); elsewhere the factor is 0.
        heading = self._yaw + half_turn
        if self._is_any_touching:
            heading += self._touching * self._state[5] * SUB_STEP_S
        target = self._target
        np.cos(heading, out=self._cos)
        np.sin(heading, out=self._sin)
        np.multiply(speed, self._cos, out=target[0])
        np.multiply(speed, self._sin, out=target[1])
        if not self._is_any_touching:
            self._setter.set(SPEEDS, target.T)
            return
        motion, wanted = self._state[3:], self._wanted
        # Force and torque for what is missing to the target velocity, 0 without contact. The force is limited to the
        # grip of the tires: DRIVE_FORCE_N / max(DRIVE_FORCE_N, force).
        lack = (target - motion) * self._touching
        push = lack[:2] * PUSH_N_S_M
        force = np.hypot(push[0], push[1])
        np.maximum(force, robot_constants.DRIVE_FORCE_N, out=force)
        np.multiply(push, robot_constants.DRIVE_FORCE_N / force, out=wanted[3:5])
        np.multiply(lack[2], MOMENT_KG_M2 / SUB_STEP_S, out=wanted[5])
        # Without contact pymunk gets the target velocity; in contact its own velocity, so that nothing changes.
        wanted[:3] = target
        np.copyto(wanted[:3], motion, where=self._touching)
        self._setter.set(FORCES, wanted.T)

    def finish_sub_step(self, earlier: int, reader: BodyReader, touching: Flags | None) -> None:
        """After a sub-step, which follows `earlier` ones of this tick: read back the held robots.

        `touching` is whether each robot of the batch is in contact, shape (robots,), or None if that has not changed.
        """
        if touching is not None:
            self._touching = touching[self.numbers]
            self._is_any_touching = bool(np.count_nonzero(self._touching))
        if not (self._is_any_touching or self.is_any_held):
            self._yaw = self._yaw + self._rolling[3]
            return
        reader.read()
        if reader.order != self._order:
            self._order, self._rows = reader.order, reader.rows(self._bodies)
        if not self.is_any_held:
            self.is_any_held = True
            self._held = np.zeros(len(self), dtype=bool)
        if touching is not None:
            # Contacts that began in this sub-step: the earlier sub-steps were driven freely.
            begun = self._touching & ~self._held
            self._covered[:, begun] = self._driven[:, begun] * (earlier / SUB_STEPS)
            self._held |= begun
        self._state = state = reader.state[self._rows].T
        self._yaw = state[2]
        self._speed = speed = state[3] * self._cos + state[4] * self._sin
        half = state[5] * (robot_constants.WHEEL_TRACK_M / 2)
        self._covered[0] += (speed - half) / SUB_STEPS
        self._covered[1] += (speed + half) / SUB_STEPS

    def write_held(self, now: Values) -> Indices:
        """Write the state of the held robots to their columns of `now`, shape (7, robots); returns their numbers.

        Rows are x, y, yaw, speed along the heading, rate of turn, speed over ground at the left and the right wheel.
        """
        state, held = self._state, self._held.nonzero()[0]
        found = np.concatenate((state[:3], self._speed[None], state[5:], self._covered))
        numbers: Indices = self.numbers[held]
        now[:, numbers] = found[:, held]
        return numbers
