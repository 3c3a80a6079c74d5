"""A robot for sensors and actuators: what they see is set by the test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from thymio_sim_ros.sim.audio.propagation import Sound
from thymio_sim_ros.sim.ground.sampling import GroundSample
from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.mechanics.wheels import Wheels
from thymio_sim_ros.sim.model.geometry import LEVEL, Point, Pose, Tilt, Twist
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.model.noise import Noise, NoiseKeys
from thymio_sim_ros.sim.model.primitives import Color
from thymio_sim_ros.sim.model.robot_state import RobotState, WheelState
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.raycast.raycaster import Fan, Raycaster
from thymio_sim_ros.sim.raycast.scalar import Obstacle, Surroundings
from thymio_sim_ros.sim.sensors import Sensor

S = TypeVar("S")
ORIGIN, AT_REST = Pose(0.0, 0.0, 0.0), Twist(0.0, 0.0)
QUIET = Noise(0, "thymio", "test", enabled=False)


class FakeBody:
    """The records of one robot, as `RobotBody` has them."""

    def __init__(self) -> None:
        self.memory = KernelMemory(1 << 20)
        self.robots, self.wheel_state = RobotState(self.memory, 1), WheelState(self.memory, 2)
        self.state, self.wheels, self.index = self.robots.view, self.wheel_state.view, 0


@dataclass
class FakeView:
    """Satisfies `SensorView` and `ActuatorView`."""

    now_ns: int = 100_000_000
    pose: Pose = ORIGIN
    twist: Twist = AT_REST
    tilt: Tilt = LEVEL
    is_falling: bool = False
    is_standing: bool = True
    wheels: Wheels = field(default_factory=lambda: Wheels(FakeBody()))
    contacts: tuple[Contact, ...] = ()
    noise: Noise = QUIET
    memory: dict[str, Any] = field(default_factory=dict)
    proximity_model: str = "default"
    lidar: Lidar | None = None
    obstacles: tuple[Obstacle, ...] = ()
    grounds: dict[float, GroundSample] = field(default_factory=dict)
    states: tuple[Any, ...] = ()
    drawn: list[tuple[Point, Point, float, Color | None]] = field(default_factory=list)
    woken: list[type[Any]] = field(default_factory=list)
    others: tuple[Any, ...] = ()
    sounds: tuple[Sound, ...] = ()

    def surroundings(self, reach_m: float, height_m: float) -> Surroundings:
        return Surroundings(obstacle for obstacle in self.obstacles if obstacle.height_m >= height_m)

    def ground_at(self, x_m: float, y_m: float) -> GroundSample:
        return self.grounds.get(y_m, GroundSample(1.0, 1.0))

    def state(self, kind: type[S]) -> S:
        return next((state for state in self.states if isinstance(state, kind)), None) or kind()

    def draw(self, start: Point, end: Point, width_m: float, color: Color | None) -> Color | None:
        self.drawn.append((start, end, width_m, color))
        return color

    def wake(self, kind: type[Any]) -> None:
        self.woken.append(kind)

    def lift(self, *, is_lifted: bool) -> None:
        self.is_standing = not is_lifted

    def place(self, pose: Pose) -> None:
        self.pose = pose


class FakeGround:
    """Satisfies what a batch needs of `Ground`: the samples of a `FakeView`, left and right."""

    def __init__(self, view: FakeView) -> None:
        self._view = view

    def sample_all(self, _xs_m: Any, ys_m: Any, reflectances: Any, floors: Any) -> None:
        for index, y in enumerate(ys_m.tolist()):
            sample = self._view.ground_at(0.0, round(y, 9))
            reflectances[index], floors[index] = sample.reflectance, sample.floor


class FakeBatch(FakeBody):
    """Satisfies `BatchSensorView`: the robot of a `FakeView`."""

    def __init__(self, view: FakeView) -> None:
        super().__init__()
        self._view = view
        self.tick = self.memory.array(1, "int32")
        self.noise_keys = NoiseKeys(self.memory, 1)
        self.memories = [view.memory]
        self.ground = FakeGround(view)
        self.array, self.bind = self.memory.array, self.memory.bind
        self.wheels = self.wheel_state

    def __len__(self) -> int:
        return 1

    def begin(self, tick: int) -> None:
        """Write what the view says."""
        view, robots = self._view, self.robots
        self.tick[0] = tick
        self.noise_keys.key_1[0], self.noise_keys.key_2[0] = view.noise._keys
        self.noise_keys.is_on[0] = view.noise.enabled
        robots.is_standing[0] = view.is_standing
        robots.x[0], robots.y[0], robots.yaw[0] = view.pose.x_m, view.pose.y_m, view.pose.yaw_rad
        robots.speed[0], robots.turn_rate[0] = view.twist.linear_m_s, view.twist.angular_rad_s

    @property
    def now_ns(self) -> int:
        return self._view.now_ns

    @property
    def proximity_model(self) -> str:
        return self._view.proximity_model

    @property
    def lidar(self) -> Lidar | None:
        return self._view.lidar

    @property
    def tilts(self) -> list[Tilt]:
        return [self._view.tilt]

    @property
    def heights_m(self) -> list[float]:
        return [0.0]

    @property
    def falling(self) -> list[int]:
        return [0] if self._view.is_falling else []

    def states(self, kind: type[S]) -> list[S]:
        return [self._view.state(kind)]

    def record(self, kind: Any) -> Any:
        return kind(self.memory, 1)

    def bind_rays(self, fan: Fan) -> tuple[Callable[[], None], Any]:
        return Raycaster(self.memory, self.robots, 1, self._view.obstacles).bind(fan)


class Measurement:
    """The readings of a sensor for a view, one after the other; random numbers differ, as ticks do."""

    def __init__(self, sensor: Sensor, view: FakeView, tick: int = 0) -> None:
        assert sensor.prepare_all is not None
        self._batch, self._tick, self._view = FakeBatch(view), tick, view
        self._batch.begin(tick)
        self._measure = sensor.prepare_all(self._batch)

    def next(self) -> Any:
        """The next reading."""
        self._tick += 1
        self._batch.begin(self._tick)
        return self._measure()[0]


def measure(sensor: Sensor, view: FakeView, tick: int = 0) -> Any:
    """The reading of a sensor; the memory of the sensor is new."""
    return Measurement(sensor, view, tick).next()
