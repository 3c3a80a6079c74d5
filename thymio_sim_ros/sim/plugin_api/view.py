"""What a plug-in sees of its robot and the world: sensors read, actuators also act."""

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
from thymio_sim_ros.sim.plugin_api.column_state import Notes
from thymio_sim_ros.sim.raycast.batch import Fan, Indices, Values
from thymio_sim_ros.sim.raycast.scalar import Surroundings

__all__ = ["ActuatorView", "GroupActuatorView", "GroupView", "OtherRobot", "SensorView"]

S = TypeVar("S")


class OtherRobot(Protocol):
    """Another robot as a sensor notices it; nothing of it may be changed."""

    @property
    def name(self) -> str:
        """Its name."""
        ...

    @property
    def pose(self) -> Pose:
        """Where it really is."""
        ...

    @property
    def is_fallen(self) -> bool:
        """Whether it lies below the floor, out of everybody's sight."""
        ...

    def state(self, kind: type[S]) -> S:
        """The state of its actuator whose state is a `kind`; KeyError when there is none."""
        ...


class SensorView(Protocol):
    """A robot as one of its sensors sees it; nothing here can be changed but the sensor's own `memory`."""

    @property
    def now_ns(self) -> int:
        """Simulated time."""
        ...

    @property
    def pose(self) -> Pose:
        """Where the robot really is."""
        ...

    @property
    def twist(self) -> Twist:
        """How its body really moves."""
        ...

    @property
    def tilt(self) -> Tilt:
        """How the robot leans: as the operator's hand holds it, or as it falls off an edge and lies there."""
        ...

    @property
    def is_falling(self) -> bool:
        """Whether it is in the air, on its way down from an edge."""
        ...

    @property
    def wheels(self) -> Wheels:
        """Angles and speeds of the wheels, and the odometry."""
        ...

    @property
    def is_fallen(self) -> bool:
        """Whether it has fallen off an edge, falling still or not, and is out of everybody's sight."""
        ...

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """What the robot touches."""
        ...

    @property
    def noise(self) -> Noise:
        """The sensor's own generator."""
        ...

    @property
    def memory(self) -> dict[str, Any]:
        """The sensor's own notes on this robot, empty at the start."""
        ...

    @property
    def proximity_model(self) -> str:
        """One of `thymio2.PROXIMITY_MODELS`."""
        ...

    @property
    def others(self) -> Sequence[OtherRobot]:
        """All other robots, in the order of the world."""
        ...

    @property
    def sounds(self) -> Sequence[Sound]:
        """All that sounds in the world now, this robot's own included."""
        ...

    def surroundings(self, reach_m: float, height_m: float) -> Surroundings:
        """What rays may meet within `reach_m` of the robot's origin, at least `height_m` high."""
        ...

    def ground_at(self, x_m: float, y_m: float) -> GroundSample:
        """The ground under a point of the robot's frame."""
        ...

    def state(self, kind: type[S]) -> S:
        """The state of the actuator whose state is a `kind`; KeyError when there is none."""
        ...


class GroupView(Protocol):
    """All robots of a world as one sensor of theirs sees them at once; robots are counted in the world's order."""

    def __len__(self) -> int:
        """How many robots there are."""
        ...

    @property
    def now_ns(self) -> int:
        """Simulated time."""
        ...

    @property
    def noise(self) -> NormalBank:
        """The sensor's own generators for normal numbers; users are robots. A sensor uses this or `evens`, not both."""
        ...

    @property
    def evens(self) -> UniformBank:
        """The sensor's own generators for even numbers."""
        ...

    @property
    def memory(self) -> dict[str, Any]:
        """What the sensor keeps for as long as these robots are together, empty at the start; it is not given back."""
        ...

    @property
    def notes(self) -> Notes:
        """The sensor's own notes on all robots."""
        ...

    @property
    def proximity_model(self) -> str:
        """As in `SensorView`."""
        ...

    @property
    def poses(self) -> Values:
        """Where the robots really are now: rows x, y, yaw."""
        ...

    @property
    def motion(self) -> tuple[Values, Values]:
        """How their bodies really move now: speeds along the headings, m/s, and rates of turn, rad/s."""
        ...

    @property
    def tilts(self) -> Sequence[Tilt]:
        """How they lean."""
        ...

    @property
    def fallen(self) -> Sequence[int]:
        """Who has fallen off an edge, falling still or not."""
        ...

    @property
    def falling(self) -> Sequence[int]:
        """Who is in the air, on the way down from an edge."""
        ...

    @property
    def wheels(self) -> WheelArrays:
        """Angles and speeds of the wheels, and the odometry."""
        ...

    @property
    def contacts(self) -> Mapping[int, tuple[Contact, ...]]:
        """What those touch that touch anything."""
        ...

    @property
    def sounds(self) -> Sequence[Sound]:
        """All that sounds in the world now."""
        ...

    def states(self, kind: type[S]) -> Sequence[S]:
        """The state of one actuator of every robot."""
        ...

    def cast(self, fan: Fan) -> tuple[Indices, Values]:
        """Rays of all robots: the numbers of the sensors that see anything, and how far their rays go (`Raycaster`)."""
        ...

    def ground_at(self, places: Values) -> tuple[Values, Values]:
        """Reflectance and floor under points of the robots' frames, by robot and point; rows of `places` are x, y."""
        ...


class GroupActuatorView(Protocol):
    """All robots of a world as one actuator of theirs sees them at once."""

    @property
    def now_ns(self) -> int:
        """Simulated time."""
        ...

    @property
    def memory(self) -> dict[str, Any]:
        """The actuator's own notes on all robots, empty at the start."""
        ...

    @property
    def noise(self) -> UniformBank:
        """The actuator's own generators; users are robots."""
        ...

    @property
    def wheels(self) -> WheelArrays:
        """The wheels of all robots, to be driven."""
        ...


class ActuatorView(Protocol):
    """A robot as one of its actuators sees it."""

    @property
    def now_ns(self) -> int:
        """Simulated time."""
        ...

    @property
    def noise(self) -> Noise:
        """The actuator's own generator."""
        ...

    @property
    def wheels(self) -> Wheels:
        """The wheels, to be driven."""
        ...

    @property
    def pose(self) -> Pose:
        """Where the robot really is."""
        ...

    def draw(self, start: Point, end: Point, width_m: float, color: Color | None) -> Color | None:
        """Draw on the ground, or erase with None; the color that is now seen at the end, None where no floor is."""
        ...

    def wake(self, kind: type[Any]) -> None:
        """Let the sensors that wake on this type measure at the end of the tick."""
        ...

    def place(self, pose: Pose) -> None:
        """Put the robot somewhere, at rest."""
        ...
