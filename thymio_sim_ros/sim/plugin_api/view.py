"""What a plug-in sees of its robot and of the world. The views of sensors are read-only; those of actuators also act.

Views of a batch give arrays with one entry per robot, in the order of the world.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeVar

from thymio_sim_ros.sim.audio.propagation import Sound
from thymio_sim_ros.sim.ground.sampling import GroundSample
from thymio_sim_ros.sim.mechanics.wheels import WheelArrays, Wheels
from thymio_sim_ros.sim.model.geometry import Point, Pose, Tilt, Twist
from thymio_sim_ros.sim.model.noise import Noise, NormalBank, UniformBank
from thymio_sim_ros.sim.model.primitives import Color
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.plugin_api.column_state import ColumnState
from thymio_sim_ros.sim.raycast.batch import Fan, Indices, Values
from thymio_sim_ros.sim.raycast.scalar import Surroundings

__all__ = ["ActuatorView", "BatchActuatorView", "BatchSensorView", "OtherRobot", "SensorView"]

S = TypeVar("S")


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
    def is_fallen(self) -> bool:
        """Whether it has fallen off an edge; it is then invisible to sensors."""
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
    def is_fallen(self) -> bool:
        """Whether it has fallen off an edge, still falling or not; it is then invisible to others."""
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
        """What the sensor stores for this robot; empty after a reset."""
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
    """All robots of a batch as one sensor sees them; robots are numbered in the order of the world."""

    def __len__(self) -> int:
        """Number of robots."""
        ...

    @property
    def now_ns(self) -> int:
        """Simulated time in ns."""
        ...

    @property
    def noise(self) -> NormalBank:
        """Normal random numbers of this sensor, one stream per robot. A sensor uses this or `uniforms`, not both."""
        ...

    @property
    def uniforms(self) -> UniformBank:
        """Uniform random numbers of this sensor, one stream per robot."""
        ...

    @property
    def memory(self) -> dict[str, Any]:
        """What the sensor stores while the batch exists, empty at the start; it is not copied to the robots."""
        ...

    @property
    def column_state(self) -> ColumnState:
        """What the sensor stores per robot, as columns; the same values as `SensorView.memory`."""
        ...

    @property
    def proximity_model(self) -> str:
        """One of `robot_constants.PROXIMITY_MODELS`."""
        ...

    @property
    def poses(self) -> Values:
        """True poses, shape (robots, 3): x and y in m, yaw in rad."""
        ...

    @property
    def motion(self) -> tuple[Values, Values]:
        """True speeds along the headings in m/s and turn rates in rad/s, each of shape (robots,)."""
        ...

    @property
    def tilts(self) -> Sequence[Tilt]:
        """Tilts by robot."""
        ...

    @property
    def fallen(self) -> Sequence[int]:
        """Numbers of the robots that have fallen off an edge, still falling or not."""
        ...

    @property
    def falling(self) -> Sequence[int]:
        """Numbers of the robots that are in the air after an edge."""
        ...

    @property
    def wheels(self) -> WheelArrays:
        """Angles and speeds of the wheels, and the odometry."""
        ...

    @property
    def contacts(self) -> Mapping[int, tuple[Contact, ...]]:
        """Contacts of the robots that have any, by robot number."""
        ...

    @property
    def sounds(self) -> Sequence[Sound]:
        """All sounds in the world now."""
        ...

    def states(self, kind: type[S]) -> Sequence[S]:
        """The state of type `kind` of every robot."""
        ...

    def cast(self, fan: Fan) -> tuple[Indices, Values]:
        """Casts the rays of all robots; returns what `BatchRaycaster.cast` returns."""
        ...

    def ground_at(self, places: Values) -> tuple[Values, Values]:
        """Reflectance and share of floor under points, each of shape (robots, points).

        `places` has shape (points, 2): x and y in the robots' frames, in m.
        """
        ...


class BatchActuatorView(Protocol):
    """All robots of a batch as one actuator sees them."""

    @property
    def now_ns(self) -> int:
        """Simulated time in ns."""
        ...

    @property
    def memory(self) -> dict[str, Any]:
        """What the actuator stores while the batch exists, empty at the start."""
        ...

    @property
    def noise(self) -> UniformBank:
        """Uniform random numbers of this actuator, one stream per robot."""
        ...

    @property
    def wheels(self) -> WheelArrays:
        """The wheels of all robots."""
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

    def place(self, pose: Pose) -> None:
        """Place the robot at a pose, at rest."""
        ...
