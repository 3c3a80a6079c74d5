"""The parameters of the simulator node (docs/spec/ros-interface.md section 10)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from thymio_sim_ros.ros.interface.convert_readings import (
    PROXIMITY_FOV_RAD,
    PROXIMITY_MAX_M,
    PROXIMITY_MIN_M,
    ConvertOptions,
    RangeFields,
)
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.names import FrameNames, Naming
from thymio_sim_ros.ros.interface.sensor_topics import JOINTS, SCAN, TRUTH
from thymio_sim_ros.ros.profiles import Profile
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.rclpy_ext.parameters import group, param
from thymio_sim_ros.ros.simulator.robot_endpoints import DESCRIPTION, EndpointOptions
from thymio_sim_ros.ros.simulator.visualization.transforms import TransformOptions
from thymio_sim_ros.sim.commands import MOTOR_MODELS
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.model.lidar import LIDAR, MOST_BEAMS, Lidar
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS
from thymio_sim_ros.sim.playground.reader import Playground, RobotStart
from thymio_sim_ros.sim.sensors import NEVER_NS, all_sensors
from thymio_sim_ros.sim.sensors.proximity import SENSOR as SCANNER
from thymio_sim_ros.suite_config import OUT_OF_RANGE, REPLAY_FROM_S

__all__ = ["CurrentParams", "SimulatorParams"]

_POSE_VARIANCES = [1e-4, 1e-4, 0.0, 0.0, 0.0, 1e-3]
_TWIST_VARIANCES = [1e-5, 1e-5, 0.0, 0.0, 0.0, 1e-4]


ODOM_RATE = 20.0


@dataclass(frozen=True)
class RangeParams:
    """Fields of the Range messages of one proximity sensor."""

    range_min: float = param(PROXIMITY_MIN_M, "min_range in m; nearer obstacles are too close", low=0.0, high=0.14)
    range_max: float = param(PROXIMITY_MAX_M, "max_range in m", low=0.0, high=0.14)
    fov: float = param(PROXIMITY_FOV_RAD, "field_of_view in rad", low=0.0, high=3.2)


_RANGE = RangeParams()
_LIDAR = Lidar()


@dataclass(frozen=True)
class ProximityParams:
    """Range fields of each proximity sensor, in Thymio's order."""

    left: RangeParams = group(_RANGE, "left")
    center_left: RangeParams = group(_RANGE, "center_left")
    center: RangeParams = group(_RANGE, "center")
    center_right: RangeParams = group(_RANGE, "center_right")
    right: RangeParams = group(_RANGE, "right")
    rear_left: RangeParams = group(_RANGE, "rear_left")
    rear_right: RangeParams = group(_RANGE, "rear_right")

    @property
    def fields(self) -> tuple[RangeFields, ...]:
        """Range fields of the seven sensors in Thymio's order."""
        front = (self.left, self.center_left, self.center, self.center_right, self.right)
        every: Sequence[RangeParams] = (*front, self.rear_left, self.rear_right)
        return tuple(RangeFields(sensor.range_min, sensor.range_max, sensor.fov) for sensor in every)


@dataclass(frozen=True)
class LidarParams:
    """The lidar of the robots; a real Thymio has none."""

    enabled: bool = param(False, "Whether the robots have a lidar, on the topic scan", fixed=True)
    beams: int = param(_LIDAR.beams, "Beams over the full circle", low=1, high=MOST_BEAMS, fixed=True)
    range: float = param(_LIDAR.range_m, "Longest range in m", low=0.1, high=10.0, fixed=True)
    rate: float = param(_LIDAR.rate_hz, "Scans per second", low=0.1, high=100.0, fixed=True)
    noise: float = param(_LIDAR.noise_m, "Standard deviation of a range in m", low=0.0, high=1.0, fixed=True)

    @classmethod
    def of(cls, lidar: Lidar | None) -> LidarParams:
        """Return the parameters of a lidar, or of none."""
        if lidar is None:
            return cls()
        return cls(True, lidar.beams, lidar.range_m, lidar.rate_hz, lidar.noise_m)

    @property
    def lidar(self) -> Lidar | None:
        """The lidar of the robots, None for none."""
        return Lidar(self.beams, self.range, self.rate, self.noise) if self.enabled else None


@dataclass(frozen=True)
class SimulatorParams:
    """Parameters of the simulator node."""

    playground: str = param("desk", "Playground: a shipped name, a file, or the JSON text itself")
    seed: int = param(
        0, "Seed of all noise; the same seed gives the same run. A new seed restarts the world", low=0, high=2**31 - 1
    )
    noise: bool = param(True, "Whether wheels and sensors are noisy as on the robot", fixed=True)
    motor_model: str = param(
        MOTOR_MODELS[0],
        "Motor model: ideal (no lag) or firmware (the robot's control loop and its lag)",
        fixed=True,
        choices=MOTOR_MODELS,
    )
    proximity_model: str = param(
        PROXIMITY_MODELS[0], "Proximity sensor model, see docs/robot.md", fixed=True, choices=PROXIMITY_MODELS
    )
    lidar: LidarParams = group(LidarParams(), "lidar")
    solid_robots: bool = param(
        True, "Whether robots push each other; otherwise they drive through each other", fixed=True
    )
    real_time_factor: float = param(1.0, "Simulated seconds per second; 0 is as fast as possible", low=0.0, high=1000.0)
    start_paused: bool = param(False, "Whether the world starts paused, until ~/pause or ~/step", fixed=True)
    step_ticks: int = param(1, "Ticks of 10 ms per ~/step", low=1, high=100_000)
    batch_ticks: int = param(
        1,
        "Ticks executed together although subscribers see each: less load, messages up to 10 ms later per tick",
        low=1,
        high=10,
        fixed=True,
    )
    publish_clock: bool = param(True, "Whether /clock is published", fixed=True)
    clock_rate: float = param(50.0, "Maximum rate of /clock in Hz of wall time", low=1.0, high=100.0, fixed=True)
    log: str = param("", "File for the run log, for thymio-sim replay; empty: none", fixed=True)
    replay: str = param("", "Run log whose last run is shown, in place of a playground; empty: none", fixed=True)
    replay_from: float = param(
        REPLAY_FROM_S, "Time in s at which a replay is paused at first; negative: before its end", fixed=True
    )

    robot_names: list[str] = param(
        [""],
        "Names (and namespaces) of the playground's robots, in order; '' keeps the name of the playground",
        fixed=True,
    )
    namespaced_tf: bool = param(
        False, "Whether frames are published without prefix on tf and tf_static in each robot's namespace", fixed=True
    )
    tf_prefix: str = param("", "Prefix of the frames of all robots, before the robot's name", fixed=True)
    odom_frame: str = param("odom", "Name of the odometry frame", fixed=True)
    robot_frame: str = param("base_link", "Name of the robot frame", fixed=True)
    map_frame: str = param("map", "Name of the world frame", fixed=True)
    left_wheel_joint: str = param("left_wheel_joint", "Name of the left wheel's joint", fixed=True)
    right_wheel_joint: str = param("right_wheel_joint", "Name of the right wheel's joint", fixed=True)

    odom_max_rate: float = param(
        20.0, "Rate of odometry and transforms in Hz; -1: every tick", low=-1.0, high=100.0, fixed=True
    )
    sensor_rate: float = param(
        0.0,
        "Rate of all periodic sensors in Hz, also for programs; 0: as on the robot",
        low=0.0,
        high=100.0,
        fixed=True,
    )
    out_of_range: str = param(
        OUT_OF_RANGE[0],
        "Range without obstacle and too close: rep117 (+inf, -inf) or driver (-1, minimum)",
        choices=OUT_OF_RANGE,
    )
    ground_threshold: int = param(
        200, "Ground counts below this value mean «not reflecting»", name="ground.threshold", low=0, high=1023
    )
    proximity: ProximityParams = group(ProximityParams(), "proximity")
    pose_covariance_diagonal: list[float] = param(
        _POSE_VARIANCES, "Variances of the odometry pose: x y z roll pitch yaw", low=0.0, size=6
    )
    twist_covariance_diagonal: list[float] = param(
        _TWIST_VARIANCES, "Variances of the odometry twist: x y z roll pitch yaw", low=0.0, size=6
    )

    cmd_vel_timeout: float = param(
        0.0, "Seconds after which a velocity command expires; 0: never", low=0.0, high=3600.0
    )
    stamped_cmd_vel: bool = param(
        False,
        "Whether cmd_vel is TwistStamped (and cmd_vel_unstamped Twist) instead of Twist (and cmd_vel_stamped stamped)",
        fixed=True,
    )

    driver_topics: bool = param(
        False,
        "Whether driver topics with hidden names (docs/ros.md) are also available under the driver's names",
        fixed=True,
    )
    publish_map_tf: bool = param(True, "Whether map -> odom is published: perfect localization", fixed=True)
    publish_static_tf: bool = param(True, "Whether the fixed frames are published on /tf_static", fixed=True)
    publish_wheel_tf: bool = param(True, "Whether the wheel frames are published on /tf", fixed=True)
    publish_description: bool = param(True, "Whether robot_description is published", fixed=True)
    publish_ground_truth: bool = param(True, "Whether _ground_truth/odom is published", fixed=True)
    publish_map: bool = param(False, "Whether /map is published, for Nav2", fixed=True)

    @property
    def naming(self) -> Naming:
        """ROS names of robots and frames."""
        frames = FrameNames(
            self.map_frame, self.odom_frame, self.robot_frame, self.left_wheel_joint, self.right_wheel_joint
        )
        return Naming(self.tf_prefix, self.namespaced_tf, any(self.robot_names), frames)

    @property
    def convert_options(self) -> ConvertOptions:
        """Options for the content of messages."""
        return ConvertOptions(
            driver_ranges=self.out_of_range == "driver",
            ground_threshold=self.ground_threshold,
            proximity=self.proximity.fields,
            pose_covariance=tuple(self.pose_covariance_diagonal),
            twist_covariance=tuple(self.twist_covariance_diagonal),
            scan_ns=(self.periods_ns or {}).get(SCANNER.name, SCANNER.period_ns),
        )

    @property
    def switched_off(self) -> Mapping[str, str]:
        """Topics that are not published, with the parameters that would switch them on."""
        parameters = {
            DESCRIPTION: "publish_description",
            TRUTH: "publish_ground_truth",
            "map": "publish_map",
            "clock": "publish_clock",
        }
        lidar = {} if self.lidar.enabled else {SCAN: "lidar.enabled"}
        return {topic: name for topic, name in parameters.items() if not getattr(self, name)} | lidar

    @property
    def endpoint_options(self) -> EndpointOptions:
        """Options for the topics of all robots."""
        return EndpointOptions(
            stamped_cmd_vel=self.stamped_cmd_vel,
            left_out=frozenset(self.switched_off),
            every_ns={JOINTS: _period_ns(self.odom_max_rate)},
        )

    @property
    def periods_ns(self) -> Mapping[str, int] | None:
        """Sensor periods by sensor name; None: as on the robot."""
        if self.sensor_rate == 0.0 and self.odom_max_rate == ODOM_RATE:
            return None
        periods = {sensor.name: sensor.period_ns for sensor in all_sensors() if not sensor.is_add_on}
        if self.sensor_rate > 0.0:
            common = _period_ns(self.sensor_rate)
            periods = {name: period if period == NEVER_NS else common for name, period in periods.items()}
        return periods | {"pose": _period_ns(self.odom_max_rate)}

    @property
    def published_periods_ns(self) -> Mapping[str, int]:
        """Sensor periods that differ from those that the sensors declare."""
        lidar = self.lidar.lidar
        return {**(self.periods_ns or {}), **({} if lidar is None else {LIDAR: lidar.period_ns})}

    def like(self, profile: Profile) -> SimulatorParams:
        """Return the parameters with those that a profile needs."""
        names: Mapping[str, Any] = {"robot_names": list(profile.robots)} if profile.robots else {}
        has_other = profile.lidar is not None and not self.lidar.enabled
        lidar: Mapping[str, Any] = {"lidar": LidarParams.of(profile.lidar)} if has_other else {}
        return replace(self, **names, **lidar, **profile.parameters)

    def renamed(self, playground: Playground) -> Playground:
        """Return the playground with robots renamed as in `robot_names`. Raises StartError for an invalid name."""
        wanted = [name for name in self.robot_names if name]
        names = [*wanted, *(robot.name for robot in playground.robots[len(wanted) :])][: len(playground.robots)]
        try:
            robots = tuple(
                fields.read(RobotStart, fields.write(robot) | {"name": name}, "robot_names")
                for robot, name in zip(playground.robots, names, strict=True)
            )
        except FieldError as error:
            raise StartError(str(error)) from error
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise StartError(f"robot_names: found '{twice}' twice, expected unique names")
        return replace(playground, robots=robots) if wanted else playground

    @property
    def transform_options(self) -> TransformOptions:
        """Options for transforms."""
        return TransformOptions(
            self.publish_map_tf, self.publish_wheel_tf, self.publish_static_tf, self.namespaced_tf, self.lidar.enabled
        )


class CurrentParams:
    """The current values of the parameters, for objects that use a value when they need it."""

    def __init__(self, values: SimulatorParams) -> None:
        self.values = values

    @property
    def values(self) -> SimulatorParams:
        """All parameters."""
        return self._values

    @values.setter
    def values(self, values: SimulatorParams) -> None:
        self._values = values
        self._convert_options = values.convert_options

    @property
    def convert_options(self) -> ConvertOptions:
        """The options for the content of messages: the same object until a parameter changes.

        Templates of messages are valid for one object of options.
        """
        return self._convert_options


def _period_ns(rate_hz: float) -> int:
    """Return the period in ns, at least one tick; rates of 0 and below mean every tick."""
    return TICK_NS if rate_hz <= 0.0 else max(TICK_NS, round(SECOND_NS / rate_hz))
