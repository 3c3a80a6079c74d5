"""Views of plug-ins on their robot and on the world: read-only for sensors, with actions for actuators.

Views of a batch give arrays with one entry per robot, in the order of the world.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Kernel
from thymio_sim_ros.sim.audio.propagation import Sound
from thymio_sim_ros.sim.ground.sampling import Ground, GroundSample
from thymio_sim_ros.sim.kernel.memory import Argument, KernelMemory
from thymio_sim_ros.sim.mechanics.wheels import Wheels
from thymio_sim_ros.sim.model.geometry import Point, Pose, Tilt, Twist
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.model.noise import Noise, NoiseKeys
from thymio_sim_ros.sim.model.primitives import Color
from thymio_sim_ros.sim.model.robot_state import RobotState, WheelState
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.raycast.raycaster import Fan, Values
from thymio_sim_ros.sim.raycast.scalar import Surroundings

__all__ = ["ActuatorView", "BatchSensorView", "OtherRobot", "SensorView"]

S = TypeVar("S")
R = TypeVar("R", bound=Record)
IntArray = npt.NDArray[np.int32]


class OtherRobot(Protocol):
    """Another robot as a sensor sees it; read-only."""

    @property
    def name(self) -> str:
        """Name of the robot."""
        ...

    @property
    def pose(self) -> Pose:
        """Its true pose."""
        ...

    @property
    def is_standing(self) -> bool:
        """Whether it stands on the floor. Sensors do not see a robot that is lifted or has fallen off an edge."""
        ...

    def state(self, kind: type[S]) -> S:
        """The state of type `kind` of one of its actuators or stimuli; raises KeyError if there is none."""
        ...


class SensorView(Protocol):
    """A robot as one of its sensors sees it; read-only except for the sensor's own `memory`."""

    @property
    def now_ns(self) -> int:
        """Simulated time in ns."""
        ...

    @property
    def pose(self) -> Pose:
        """True pose of the robot."""
        ...

    @property
    def twist(self) -> Twist:
        """True velocity of the body, in its own frame."""
        ...

    @property
    def tilt(self) -> Tilt:
        """Tilt of the robot: held by an operator, or falling off an edge and lying there."""
        ...

    @property
    def is_falling(self) -> bool:
        """Whether the robot is in the air after an edge."""
        ...

    @property
    def wheels(self) -> Wheels:
        """Angles and speeds of the wheels, and the odometry."""
        ...

    @property
    def is_standing(self) -> bool:
        """Whether it stands on the floor; it is invisible to others while it is lifted or has fallen off an edge."""
        ...

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """Present contacts of the robot."""
        ...

    @property
    def noise(self) -> Noise:
        """Random numbers of this sensor on this robot."""
        ...

    @property
    def memory(self) -> dict[str, Any]:
        """Data that the sensor stores for this robot; empty after a reset."""
        ...

    @property
    def proximity_model(self) -> str:
        """One of `robot_constants.PROXIMITY_MODELS`."""
        ...

    @property
    def others(self) -> Sequence[OtherRobot]:
        """All other robots, in the order of the world."""
        ...

    @property
    def sounds(self) -> Sequence[Sound]:
        """All sounds in the world now, including those of this robot."""
        ...

    def surroundings(self, reach_m: float, height_m: float) -> Surroundings:
        """Obstacles, other robots included, within `reach_m` of the robot's origin and at least `height_m` high."""
        ...

    def ground_at(self, x_m: float, y_m: float) -> GroundSample:
        """The ground under a point in the robot's frame, in m."""
        ...

    def state(self, kind: type[S]) -> S:
        """The state of type `kind` of an actuator or stimulus; raises KeyError if there is none."""
        ...


class BatchSensorView(Protocol):
    """All robots as one sensor sees them, for kernels; robots are numbered in the order of the world."""

    def __len__(self) -> int:
        """Number of robots. Records may have further elements, for robots to come."""
        ...

    @property
    def now_ns(self) -> int:
        """Simulated time in ns."""
        ...

    @property
    def tick(self) -> IntArray:
        """The number of the present tick, one element."""
        ...

    @property
    def memory(self) -> KernelMemory:
        """The memory of the records."""
        ...

    @property
    def robots(self) -> RobotState:
        """Their motion."""
        ...

    @property
    def wheels(self) -> WheelState:
        """The motion of their wheels."""
        ...

    @property
    def noise_keys(self) -> NoiseKeys:
        """The keys of the random numbers of this sensor on each robot."""
        ...

    @property
    def proximity_model(self) -> str:
        """One of `robot_constants.PROXIMITY_MODELS`."""
        ...

    @property
    def lidar(self) -> Lidar | None:
        """The lidar of the robots, if they have one."""
        ...

    @property
    def ground(self) -> Ground:
        """The ground of the world."""
        ...

    @property
    def tilts(self) -> Sequence[Tilt]:
        """Tilts by robot."""
        ...

    @property
    def heights_m(self) -> Sequence[float]:
        """Height of every robot over the floor."""
        ...

    @property
    def falling(self) -> Sequence[int]:
        """Numbers of the robots that are in the air after an edge."""
        ...

    @property
    def sounds(self) -> Sequence[Sound]:
        """All sounds in the world now."""
        ...

    @property
    def memories(self) -> Sequence[dict[str, Any]]:
        """The `SensorView.memory` of this sensor on each robot, to which `on_wake` writes."""
        ...

    def states(self, kind: type[S]) -> Sequence[S]:
        """The state of type `kind` of every robot."""
        ...

    def array(self, shape: int | tuple[int, ...], kind: str) -> npt.NDArray[Any]:
        """Allocate an array of zeros of a type of `aseba_vm.kernel.types.DTYPES` in the memory."""
        ...

    def record(self, kind: type[R]) -> R:
        """A record of this sensor with an element for each robot; robots keep theirs when others come or go."""
        ...

    def bind(self, kernel: Kernel, *arguments: Argument) -> Callable[[], Any]:
        """A function that calls a kernel with these arguments; see `KernelMemory.bind`."""
        ...

    def bind_rays(self, fan: Fan) -> tuple[Callable[[], None], Values]:
        """A function that casts the rays of all robots, and their lengths; see `Raycaster.bind`."""
        ...


class ActuatorView(Protocol):
    """A robot as one of its actuators or stimuli sees it."""

    @property
    def now_ns(self) -> int:
        """Simulated time in ns."""
        ...

    @property
    def noise(self) -> Noise:
        """Random numbers of this actuator on this robot."""
        ...

    @property
    def wheels(self) -> Wheels:
        """The wheels of the robot."""
        ...

    @property
    def pose(self) -> Pose:
        """True pose of the robot."""
        ...

    def draw(self, start: Point, end: Point, width_m: float, color: Color | None) -> Color | None:
        """Draw a line on the ground, or erase it if `color` is None.

        Returns the color that is now at `end`; None if there is no floor.
        """
        ...

    def wake(self, kind: type[Any]) -> None:
        """Wake the sensors that have this type in `wakes_on`; they measure at the end of the tick."""
        ...

    def lift(self, *, is_lifted: bool) -> None:
        """Lift the robot off the floor, or put it down where it is."""
        ...

    def place(self, pose: Pose) -> None:
        """Place the robot at a pose, at rest."""
        ...
