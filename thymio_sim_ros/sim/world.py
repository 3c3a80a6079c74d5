"""The world: owns clock, bodies, ground and robots, and is the only owner of simulated time.

Commands may be posted at any time and take effect in the next step. The same playground, seed and commands
give the same readings bit for bit. One thread may use a world; nothing here locks.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

from thymio_sim_ros.sim.actuators import all_actuators
from thymio_sim_ros.sim.actuators.pen import PenState
from thymio_sim_ros.sim.batch.robot_batch import RobotBatch
from thymio_sim_ros.sim.commands import MOTOR_MODELS, Command, Lift, MoveObject, MoveRobot, SetMotorModel, SetPen
from thymio_sim_ros.sim.ground.floor_support import FloorSupport, nearest_floor
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model.clock import TICK_NS, Schedule, SimClock
from thymio_sim_ros.sim.model.fields import FieldError, as_color, read, write
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.model.primitives import Color
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS
from thymio_sim_ros.sim.physics import Contact, MovableBody, Physics
from thymio_sim_ros.sim.playground.placement import (
    Footprint,
    Occupied,
    PlacementError,
    footprint_of,
    footprint_of_robot,
)
from thymio_sim_ros.sim.playground.reader import Playground, RobotStart
from thymio_sim_ros.sim.playground.scene import ObjectSnapshot, Scene, Snapshot
from thymio_sim_ros.sim.robot.robot import Robot, SharedState
from thymio_sim_ros.sim.sensors import chosen_sensors
from thymio_sim_ros.sim.stimuli import all_stimuli

__all__ = ["TICK_NS", "StepResult", "World", "WorldOptions"]

_TICK_S = TICK_NS * 1e-9
_NO_CLEARANCE = (0.0, 0.0, 0.0)
_ON_EDGE_M = 1e-9
"""Positions so little outside of a ground are on its edge."""


@dataclass(frozen=True, slots=True)
class WorldOptions:
    """The options of a world besides its playground; `periods_ns` as pairs, None for the periods of the sensors.

    `lidar`: that of each robot, None for robots without one. `solid_robots`: whether robots touch each other.
    """

    seed: int
    noise: bool
    proximity_model: str
    motor_model: str
    periods_ns: tuple[tuple[str, int], ...] | None = None
    lidar: Lidar | None = None
    solid_robots: bool = True


class StepResult(NamedTuple):
    """Result of one step: readings as (robot, sensor, reading), by robot and then by sensor name; contacts."""

    now_ns: int
    readings: Sequence[tuple[str, str, Reading]]
    contacts: tuple[Contact, ...]


class World:
    """A running playground. Invariant: it changes only by methods that say so: they are the inputs of an engine."""

    def __init__(
        self,
        playground: Playground,
        *,
        seed: int = 0,
        noise: bool = True,
        proximity_model: str = PROXIMITY_MODELS[0],
        motor_model: str = MOTOR_MODELS[0],
        periods_ns: Mapping[str, int] | None = None,
        lidar: Lidar | None = None,
        solid_robots: bool = True,
        ground: Ground | None = None,
    ) -> None:
        """Create the world at time 0.

        Args:
            playground: What the world contains.
            seed: Seed of all random numbers.
            noise: Whether sensors and motors are noisy.
            proximity_model: One of `robot_constants.PROXIMITY_MODELS`.
            motor_model: One of `commands.MOTOR_MODELS`.
            periods_ns: The sensors that measure, and their periods; None: all, with their own periods. A lidar
                measures also if it is not among them.
            lidar: The lidar of each robot; None: they have none.
            solid_robots: Whether robots push each other; otherwise they drive through each other.
            ground: The ground of the playground if it exists already; the world owns it from now on.

        Raises:
            ValueError: A model or sensor is unknown, or a period is not above 0.
        """
        if proximity_model not in PROXIMITY_MODELS:
            raise ValueError(
                f"proximity model: found {proximity_model!r}, expected one of {', '.join(PROXIMITY_MODELS)}"
            )
        self._motor_model = SetMotorModel(motor_model)
        self._sensors = chosen_sensors(lidar, periods_ns)
        self.playground = playground
        self.scene = Scene.of(playground)
        periods = None if periods_ns is None else tuple(periods_ns.items())
        self.options = WorldOptions(seed, noise, proximity_model, motor_model, periods, lidar, solid_robots)
        self.robot_changes = 0
        """Number of robots added and removed so far."""
        self._ground = Ground(playground.floors, playground.paints) if ground is None else ground
        self._floor_support = FloorSupport(playground.floors)
        self._fixed = Occupied(footprint_of(solid) for solid in playground.solids if solid.is_fixed)
        self._begin()

    def reset(self) -> None:
        """Restore the initial state: time 0, robots at their start poses, the same noise, no pending commands."""
        self._begin()

    def _begin(self) -> None:
        self._clock = SimClock()
        self._ground.restore()
        self._ground.paint(None)
        self.painted: Color | None = None
        """The color that the first floor has got, None if it has its own."""
        playground = self.playground
        self._physics = Physics(
            playground.solids,
            playground.triggers,
            len(playground.robots),
            solid_robots=self.options.solid_robots,
        )
        self._movables = self._physics.movables
        self._robots: dict[str, Robot] = {}
        self._shared = SharedState(
            self._clock,
            self._ground,
            self._physics,
            self._robots,
            proximity_model=self.options.proximity_model,
            seed=self.options.seed,
            is_noisy=self.options.noise,
            lidar=self.options.lidar,
        )
        self._plugins = sorted((*all_actuators(), *all_stimuli()), key=lambda plugin: plugin.name)
        self._schedule = Schedule((sensor.period_ns, sensor.phase_ns) for sensor in self._sensors)
        self._wanted: Collection[str] | None = None
        """The sensors wanted in the last step."""
        for start in self.playground.robots:
            self._add(start)
        self._posted: list[tuple[str, Command]] = []
        self._clearances: dict[str, tuple[float, float, float]] = {}
        """Last position at which the distance to an edge was computed for an object, and that distance."""
        for movable in self._physics.movables.values():
            self._drop_over_edge(movable)
        self._batch = RobotBatch(self._robots.values(), self._shared)

    @property
    def now_ns(self) -> int:
        """Simulated time."""
        return self._clock.now_ns

    @property
    def robots(self) -> Mapping[str, Robot]:
        """The robots by name: those of the playground in its order, then in the order in which they were added."""
        return MappingProxyType(self._robots)

    @property
    def objects(self) -> tuple[ObjectSnapshot, ...]:
        """Poses of objects, then doors, in the order of the playground."""
        return tuple(ObjectSnapshot(body.name, body.pose, body.is_fallen) for body in self._physics.objects)

    @property
    def movables(self) -> tuple[str, ...]:
        """Names of the objects that can be moved, in the order of the playground."""
        return tuple(self._physics.movables)

    def post(self, name: str, command: Command) -> None:
        """Post a command to a robot or an object; it takes effect in the next step.

        Raises KeyError for an unknown name, TypeError for a command that is not accepted, ValueError for a pose that is
        not finite, and PlacementError if the target position is occupied now.
        """
        robot = self._robots.get(name)
        if robot is not None:
            if not robot.accepts(command):
                raise TypeError(f"no actuator or stimulus accepts a {type(command).__name__}")
            if isinstance(command, MoveRobot):
                pose = _finite(name, Pose(command.x_m, command.y_m, command.yaw_rad))
                if not self._will_be_lifted(robot):
                    self._check_place(footprint_of_robot(name, pose))
            elif isinstance(command, Lift) and not command.is_lifted and self._will_be_lifted(robot):
                self._check_place(footprint_of_robot(name, self._moving_to().get(name, robot.pose)))
        else:
            movable = self._movables[name]
            if not isinstance(command, MoveObject):
                raise TypeError(f"an object accepts no {type(command).__name__}")
            pose = _finite(name, Pose(command.x_m, command.y_m, command.yaw_rad))
            self._check_place(footprint_of(movable.solid.at(pose)))
        self._posted.append((name, command))

    def check_ground(self, name: str, x_m: float, y_m: float) -> None:
        """Raise PlacementError for a position outside of every ground; without a ground no position is.

        `post` and `spawn` do not check it: what is placed there falls. This is for people, who mistake coordinates.
        """
        is_finite = math.isfinite(x_m) and math.isfinite(y_m)  # `post` reports what is not
        if is_finite and self._floor_support.clearance_m(x_m, y_m) < -_ON_EDGE_M:
            floor, (x, y) = nearest_floor(self.playground.floors, (x_m, y_m))
            raise PlacementError(
                name, Pose(x_m, y_m, 0.0), f"there is no ground; the nearest is '{floor.name}' at {x:.3f}, {y:.3f} m"
            )

    def spawn(self, start: RobotStart) -> None:
        """Add a robot at once.

        Raises PlacementError if its position is occupied, and ValueError if its name is taken or a value is not valid
        in a playground file.
        """
        if start.name in self._names():
            raise ValueError(f"the name '{start.name}' is taken")
        try:
            read(RobotStart, write(start), "")
        except FieldError as error:
            raise ValueError(str(error)) from error
        self._check_place(footprint_of_robot(start.name, start.pose))
        rows = self._batch.rows
        self._add(start)
        self._batch = RobotBatch(self._robots.values(), self._shared, rows)

    def remove(self, robot: str) -> None:
        """Remove a robot at once; raises KeyError for an unknown name."""
        gone = self._robots.pop(robot)
        self.robot_changes += 1
        rows = self._batch.rows
        self._physics.remove_robot(gone.body)
        self._shared.forget(gone)
        self._posted = [(name, command) for name, command in self._posted if name != robot]
        self._batch = RobotBatch(self._robots.values(), self._shared, rows)

    def erase_drawings(self) -> None:
        """Erase everything that pens drew, at once."""
        self._ground.restore()
        for robot in self._robots.values():
            robot.states[PenState].forget()

    def paint_ground(self, color: Color) -> None:
        """Give the first floor of the playground another color, 0…1 each, at once, until the next reset.

        Raises ValueError for a color out of range, or without a floor.
        """
        if not self.playground.floors:
            raise ValueError("found no ground that could be painted")
        if not all(0.0 <= part <= 1.0 for part in color):
            raise ValueError(f"found the color {color}, expected three numbers from 0 to 1")
        self._ground.paint(color)
        self.painted = color

    def step(self, sensors: Collection[str] | None = None) -> StepResult:
        """Advance the world by one tick.

        `sensors`: names of the sensors whose readings are wanted; None: all. Of the others, those that are stateless do
        not measure. The run is the same, and so are all readings, whatever is wanted.
        """
        if sensors is not self._wanted:
            self._select(sensors)
        if self._posted:
            self._apply_commands()
        self._batch.act(_TICK_S)
        contacts = self._move_bodies()
        now_ns = self._clock.advance()
        return StepResult(now_ns, self._batch.measure(self._schedule.due(now_ns)), contacts)

    def read(self, robot: str, sensor: str) -> Reading | None:
        """The present reading of a stateless sensor. Raises KeyError for an unknown robot or sensor."""
        return self._batch.read(self._robots[robot], sensor)

    def color_at(self, x_m: float, y_m: float) -> Color | None:
        """The color of the ground at a point, drawings included; None where there is none."""
        return self._ground.color_at(x_m, y_m)

    def _select(self, wanted: Collection[str] | None) -> None:
        self._wanted = wanted
        self._schedule.select(
            None
            if wanted is None
            else {
                number
                for number, sensor in enumerate(self._sensors)
                if sensor.name in wanted or not sensor.is_stateless
            }
        )

    def snapshot(self) -> Snapshot:
        """The visible state of the world now."""
        return Snapshot(
            self._clock.now_ns,
            tuple(robot.snapshot() for robot in self._robots.values()),
            self.objects,
        )

    def _add(self, start: RobotStart) -> None:
        robot = Robot(start, self._shared, self._plugins, self._sensors)
        self._robots[start.name] = robot
        self.robot_changes += 1
        robot.apply(self._motor_model)
        if start.pen is not None:
            pen = start.pen
            robot.apply(SetPen(pen.down, as_color(pen.color), pen.width_m))

    def _names(self) -> set[str]:
        """All names in use."""
        return {*self._robots, *(shape.name for shape in self.playground.shapes)}

    def _check_place(self, wanted: Footprint) -> None:
        """Raise PlacementError if a position is occupied now or by a pending command."""
        soon = self._moving_to()
        standing = [
            footprint_of(body.solid.at(soon.get(body.name, body.pose)))
            for body in self._physics.objects
            if body.name in soon or not body.is_fallen
        ]
        standing += [
            footprint_of_robot(robot.name, soon.get(robot.name, robot.pose))
            for robot in self._robots.values()
            if (self.options.solid_robots or wanted.name in self._movables)
            and not self._will_be_lifted(robot)
            and (robot.name in soon or robot.is_standing)
        ]
        here = (there.name for there in standing if there.name != wanted.name and there.overlaps(wanted))
        blocker = self._fixed.blocker(wanted) or next(here, None)
        if blocker is not None:
            raise PlacementError(wanted.name, Pose(*wanted.middle, 0.0), f"occupied by '{blocker}'")

    def _moving_to(self) -> dict[str, Pose]:
        """Poses at which pending commands place robots and objects, by name."""
        return {
            name: Pose(command.x_m, command.y_m, command.yaw_rad)
            for name, command in self._posted
            if isinstance(command, MoveObject | MoveRobot)
        }

    def _will_be_lifted(self, robot: Robot) -> bool:
        """Whether a robot is lifted after the pending commands."""
        lifts = [command for name, command in self._posted if name == robot.name and isinstance(command, Lift)]
        return lifts[-1].is_lifted if lifts else robot.is_lifted

    def _apply_commands(self) -> None:
        posted, self._posted = self._posted, []
        for name, command in posted:
            if isinstance(command, MoveObject):
                movable = self._physics.movables[name]
                self._physics.place(movable, Pose(command.x_m, command.y_m, command.yaw_rad))
                self._drop_over_edge(movable)
            else:
                self._robots[name].apply(command)

    def _move_bodies(self) -> tuple[Contact, ...]:
        contacts = self._batch.move(self._floor_support)
        for movable in self._movables.values():
            if movable.is_moving:
                self._drop_over_edge(movable)
        for contact in contacts:
            if contact.is_new:
                self._robots[contact.robot].wake(Contact)
        return contacts

    def _drop_over_edge(self, movable: MovableBody) -> None:
        x, y = movable.pose.x_m, movable.pose.y_m
        sure_x, sure_y, safe_m = self._clearances.get(movable.name, _NO_CLEARANCE)
        if math.hypot(x - sure_x, y - sure_y) < safe_m:
            return
        clearance_m = self._floor_support.clearance_m(x, y)
        self._clearances[movable.name] = (x, y, clearance_m)
        if clearance_m < 0.0:
            self._physics.drop_movable(movable)


def _finite(name: str, pose: Pose) -> Pose:
    """The same pose. Raises ValueError if it is not finite."""
    if not all(map(math.isfinite, (pose.x_m, pose.y_m, pose.yaw_rad))):
        at = f"{pose.x_m}, {pose.y_m} m, {pose.yaw_rad} rad"
        raise ValueError(f"'{name}' cannot be placed at {at}: expected finite numbers")
    return pose
