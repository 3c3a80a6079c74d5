"""The bodies of all robots: kernels push them, pymunk moves them, kernels read what became of them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pymunk

from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.physics import driving
from thymio_sim_ros.sim.physics.contact import Contact
from thymio_sim_ros.sim.physics.pymunk_batch_io import BodyReader, BodyWriter
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.physics.robot_state import RobotState

__all__ = ["RobotBodies"]

_VALUES = 6
"""Values of a body that pymunk reads and writes."""


class RobotBodies:
    """The robots of a space. pymunk owns poses and velocities; `state` is what the last tick ended with.

    A robot that has fallen is not in the space.
    """

    def __init__(self, space: pymunk.Space, others: int) -> None:
        """`others`: the number of other bodies that may be in the space."""
        self._space, self._others = space, others
        self._robots: list[RobotBody] = []
        self._held: dict[RobotBody, None] = {}
        """Robots that are in contact or were in this tick."""
        self.reader = BodyReader(space)
        self._order = -1
        self._allocate(1)

    def __iter__(self) -> Iterator[RobotBody]:
        return iter(self._robots)

    def add(self, name: str, pose: Pose) -> RobotBody:
        """Add a robot at rest at a pose."""
        if len(self._robots) == self.state.count:
            before = self.state
            self._allocate(2 * before.count)
            self.state.copy_from(before)
            for index, other in enumerate(self._robots):
                other.attach(self.state.view, index)
        robot = RobotBody(name, pose, self._held)
        robot.attach(self.state.view, len(self._robots))
        self._robots.append(robot)
        self._space.add(robot.body, robot.shape)
        robot.place(pose)
        self._choose()
        return robot

    def remove(self, robot: RobotBody) -> None:
        """Remove a robot; those behind it move up."""
        if not robot.is_fallen:
            self._space.remove(robot.shape, robot.body)
        self._held.pop(robot, None)
        del self._robots[robot.index]
        self.state.remove(robot.index)
        for index, other in enumerate(self._robots):
            other.attach(self.state.view, index)
        self._choose()

    def drop(self, robot: RobotBody) -> None:
        """Make a robot fall."""
        self._space.remove(robot.shape, robot.body)
        self._held.pop(robot, None)
        robot.fall()
        self._choose()

    def place(self, robot: RobotBody, pose: Pose) -> None:
        """Place a robot at a pose, at rest; a fallen one stands on the floor again."""
        was_fallen = robot.is_fallen
        robot.place(pose)
        if was_fallen:
            self._space.add(robot.body, robot.shape)
            self._choose()

    def begin_tick(self) -> None:
        """Contacts are no longer new, and robots in contact have covered nothing yet."""
        for robot in tuple(self._held):
            robot.update_touching()
            robot.begin_tick()
            if not robot.touching:
                del self._held[robot]

    def push(self) -> None:
        """Before a sub-step: write speeds, or in contact forces, to the bodies."""
        self._push()
        self._writer.write()

    def finish_sub_step(self, earlier: int) -> None:
        """After a sub-step, which follows `earlier` ones of this tick: read back the robots in contact."""
        if self._held:
            for robot in self._held:
                robot.update_touching()
            self._read()
            self._earlier[0] = earlier
            self._read_motion()

    def end_tick(self) -> None:
        """Read back all poses."""
        if not self._held:
            self._read()
        self._read_poses()

    def contacts(self) -> tuple[Contact, ...]:
        """All contacts, by robot and in the order in which they began."""
        if not self._held:
            return ()
        touching = sorted((robot for robot in self._held if robot.touching), key=lambda robot: robot.index)
        return tuple(contact for robot in touching for contact in robot.touching.values())

    def _read(self) -> None:
        reader = self.reader
        reader.read()
        if reader.order != self._order:
            self._order = reader.order
            standing = [robot for robot in self._robots if not robot.is_fallen]
            rows = reader.rows([robot.body for robot in standing])
            self._rows[[robot.index for robot in standing]] = rows
        self._bodies[: len(reader.state)] = reader.state

    def _choose(self) -> None:
        """Note which bodies are in the space."""
        self._order = -1
        self._writer.choose([robot.body for robot in self._robots if not robot.is_fallen])

    def _allocate(self, count: int) -> None:
        """Arrays for so many robots, and the kernels bound to them."""
        bodies = count + self._others + 1
        shapes = ((count, _VALUES), np.float64), ((bodies, _VALUES), np.float64), (count, np.int32), (1, np.int32)
        memory = KernelMemory(RobotState.size(count) + sum(KernelMemory.room(*shape) for shape in shapes))
        self.state = RobotState(memory, count)
        orders, self._bodies, self._rows, self._earlier = (memory.array(*shape) for shape in shapes)
        self._writer = BodyWriter(orders)
        self._order = -1
        self._push = memory.bind(driving.push, self.state, orders)
        self._read_motion = memory.bind(driving.read_motion, self.state, self._rows, self._bodies, self._earlier)
        self._read_poses = memory.bind(driving.read_poses, self.state, self._rows, self._bodies)
