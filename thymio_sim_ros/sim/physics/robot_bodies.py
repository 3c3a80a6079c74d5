"""The bodies of all robots: kernels push them, pymunk moves them, kernels read what became of them."""

from __future__ import annotations

from collections.abc import Iterator

import pymunk

from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.robot_state import RobotState, WheelState
from thymio_sim_ros.sim.physics import driving
from thymio_sim_ros.sim.physics.contact import Contact
from thymio_sim_ros.sim.physics.pymunk_batch_io import BodyReader, BodyWriter
from thymio_sim_ros.sim.physics.robot_body import RobotBody

__all__ = ["RobotBodies"]

_VALUES = 6
"""Values of a body that pymunk reads and writes."""
_SHARED_BYTES, _ROBOT_BYTES = 1 << 20, 1 << 16
"""Room in the memory for the arrays of sensors, for all robots and for each: far more than they need. What is not used
costs only address space."""
_FANS = 2
"""Fans of rays at most: those of the proximity sensors and of a lidar."""


class RobotBodies:
    """The robots of a space. pymunk owns poses and velocities; `state` and `wheels` are what the last tick ended with.

    A robot that does not stand on the floor is not in the space. `memory` holds the records; sensors allocate their
    arrays behind them, from `first_free` on. `moving[0]` is set by what drives the wheels: whether one turns. All these
    are replaced when more robots come than there is room for.
    """

    def __init__(
        self, space: pymunk.Space, bodies: int, obstacles: int, robots: int, *, are_solid: bool = True
    ) -> None:
        """Allocate the memory.

        Args:
            space: where the robots are.
            bodies: number of other bodies that may be in the space.
            obstacles: number of obstacles, fixed and movable.
            robots: number of robots that will be added at once.
            are_solid: whether robots touch each other.
        """
        self._space, self._others, self._obstacles = space, bodies, obstacles
        self._are_solid = are_solid
        self._robots: list[RobotBody] = []
        self.reader = BodyReader(space)
        """All bodies of the space as they were read last."""
        self._order = -1
        self._held: dict[RobotBody, None] = {}
        """Robots that are in contact or were in this tick."""
        self._allocate(max(1, robots))

    def __iter__(self) -> Iterator[RobotBody]:
        return iter(self._robots)

    def add(self, name: str, pose: Pose) -> RobotBody:
        """Add a robot at rest at a pose."""
        if len(self._robots) == self.state.count:
            before = self.state, self.wheels
            self._allocate(2 * self.state.count)
            self.state.copy_from(before[0])
            self.wheels.copy_from(before[1])
            self._attach()
        robot = RobotBody(name, pose, self._held, is_solid=self._are_solid)
        robot.attach(self.state.view, self.wheels.view, len(self._robots))
        self._robots.append(robot)
        self._space.add(robot.body, robot.shape)
        robot.place(pose)
        self._choose()
        return robot

    def remove(self, robot: RobotBody) -> None:
        """Remove a robot; those behind it move up."""
        if robot.is_standing:
            self._space.remove(robot.shape, robot.body)
        self._held.pop(robot, None)
        del self._robots[robot.index]
        self.state.remove(robot.index)
        for _ in range(2):
            self.wheels.remove(2 * robot.index)
        self._attach()
        self._choose()

    def take_off_floor(self, robot: RobotBody) -> None:
        """Take a robot that stands off the floor."""
        self._space.remove(robot.shape, robot.body)
        self._held.pop(robot, None)
        robot.leave_floor()
        self._choose()

    def place(self, robot: RobotBody, pose: Pose) -> None:
        """Place a robot at a pose, at rest; it stands on the floor from now on."""
        was_standing = robot.is_standing
        robot.place(pose)
        if not was_standing:
            self._space.add(robot.body, robot.shape)
            self._choose()

    def begin_tick(self) -> None:
        """Contacts are no longer new, and robots in contact have covered nothing yet."""
        for robot in tuple(self._held):
            robot.update_touching()
            robot.begin_tick()
            if not robot.touching:
                del self._held[robot]

    @property
    def are_still(self) -> bool:
        """Whether no wheel turns and no robot touches anything."""
        return self.moving[0] == 0 and not self._held

    def push(self) -> None:
        """Before a sub-step: write speeds, or in contact forces, to the bodies."""
        self._push()
        self._writer.write()

    def finish_sub_step(self, earlier: int) -> None:
        """After a sub-step, which follows `earlier` ones of this tick: read back the robots in contact."""
        # A robot without contact moves exactly at the speeds that were written, so its pose is read once per tick
        # (`end_tick`). In contact, the motion of each sub-step decides the forces of the next.
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
            standing = [robot for robot in self._robots if robot.is_standing]
            rows = reader.rows([robot.body for robot in standing])
            self._rows[[robot.index for robot in standing]] = rows
        self._poses[: len(reader.state)] = reader.state

    def _attach(self) -> None:
        for index, robot in enumerate(self._robots):
            robot.attach(self.state.view, self.wheels.view, index)

    def _choose(self) -> None:
        """Note which bodies are in the space."""
        self._order = -1
        self._writer.choose([robot.body for robot in self._robots if robot.is_standing])

    def _allocate(self, count: int) -> None:
        """Arrays for so many robots, and the kernels bound to them."""
        bodies = count + self._others + 1
        shapes = ((count, _VALUES), "float64"), ((bodies, _VALUES), "float64"), (count, "int32"), (1, "int32")
        memory = KernelMemory(
            RobotState.size(count)
            + WheelState.size(2 * count)
            + sum(KernelMemory.room(*shape) for shape in shapes)
            + _SHARED_BYTES
            + count * (_ROBOT_BYTES + _FANS * 4 * (self._obstacles + count))  # pairs of a robot and what it may see
        )
        self.memory = memory
        self.state, self.wheels = RobotState(memory, count), WheelState(memory, 2 * count)
        orders, self._poses, self._rows, self._earlier = (memory.array(*shape) for shape in shapes)
        self.moving = memory.array(1, "int32")
        self.first_free = memory.used
        self._writer = BodyWriter(orders)
        self._order = -1
        records = self.state, self.wheels
        self._push = memory.bind(driving.push, *records, orders)
        self._read_motion = memory.bind(driving.read_motion, *records, self._rows, self._poses, self._earlier)
        self._read_poses = memory.bind(driving.read_poses, *records, self._rows, self._poses)
