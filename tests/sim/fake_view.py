"""A ten-line robot for sensors and actuators: what they see is set by the test."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeVar

from thymio_sim_ros.sim.audio.propagation import Sound
from thymio_sim_ros.sim.ground.sampling import GroundSample
from thymio_sim_ros.sim.mechanics.wheels import Wheels
from thymio_sim_ros.sim.model.geometry import LEVEL, Point, Pose, Tilt, Twist
from thymio_sim_ros.sim.model.noise import Noise
from thymio_sim_ros.sim.model.primitives import Color
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.raycast.scalar import Obstacle, Surroundings

S = TypeVar("S")
ORIGIN, AT_REST = Pose(0.0, 0.0, 0.0), Twist(0.0, 0.0)
QUIET = Noise(0, "thymio", "test", enabled=False)


@dataclass
class FakeView:
    """Satisfies `SensorView` and `ActuatorView`."""

    now_ns: int = 100_000_000
    pose: Pose = ORIGIN
    twist: Twist = AT_REST
    tilt: Tilt = LEVEL
    is_falling: bool = False
    is_fallen: bool = False
    wheels: Wheels = field(default_factory=Wheels)
    contacts: tuple[Contact, ...] = ()
    noise: Noise = QUIET
    memory: dict[str, Any] = field(default_factory=dict)
    proximity_model: str = "default"
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

    def place(self, pose: Pose) -> None:
        self.pose = pose
