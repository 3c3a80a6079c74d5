"""Create 3, the robot of iRobot for courses: a Thymio is the robot.

It has the actions that courses use, and hazards, buttons and intensities from the sensors of a Thymio. Lights and notes
are played on those of the Thymio. Speeds above 0.166 m/s of a wheel are clamped on their curve.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.ros.profiles import (
    ActionRow,
    Ended,
    InputRow,
    Missing,
    ParameterRow,
    Profile,
    ProfileRobot,
    ProfileWorld,
    ServiceRow,
    TopicRow,
)
from thymio_sim_ros.ros.profiles._actions import DRIVE_ARC, OWN_ACTIONS
from thymio_sim_ros.ros.profiles._body import battery, drive, imu, too_fast
from thymio_sim_ros.ros.profiles._lights_and_notes import Animation, Melody, lights, notes, play_notes
from thymio_sim_ros.ros.profiles._wall_follow import WALL_FOLLOW
from thymio_sim_ros.sim.commands import (
    BUTTONS,
    BodyTwist,
    SetOdometry,
)
from thymio_sim_ros.sim.model.geometry import wrap_angle

if TYPE_CHECKING:
    from thymio_sim_ros.sim.model.readings import (
        BatteryReading,
        ButtonsReading,
        GroundReading,
        MotorReading,
        PoseReading,
        ProximityReading,
    )

_SECOND_NS = 1_000_000_000
_PERIOD_NS = 20_000_000
"""Least time between messages that a Create 3 publishes about 60 times per second."""
_TICKS_PER_TURN = 508.8
"""Counts of an encoder of a Create 3 for each turn of a wheel."""

_BUMP, _CLIFF, _WHEEL_DROP = 1, 2, 4
"""Types of `irobot_create_msgs/msg/HazardDetection`."""
_BUMP_ZONES = ((-0.7, "right"), (-0.2, "front_right"), (0.2, "front_center"), (0.7, "front_left"), (math.inf, "left"))
"""Parts of the bumper, each up to a bearing in rad from the robot's middle; it covers the front half."""
_BUMPER_RAD = 2.0
_NO_FLOOR = 30
"""Ground counts below are no floor: black gives 77."""
_SIDES = ("left", "right")

_INTENSITIES = (
    ("side_left", None),
    ("left", 0),
    ("front_left", 1),
    ("front_center_left", 2),
    ("front_center_right", 2),
    ("front_right", 3),
    ("right", 4),
)
"""The infrared sensors of a Create 3, and the proximity sensors of a Thymio in their places."""

_BUTTONS = {"button_1": "left", "button_power": "center", "button_2": "right"}
_PRESSED = "create3.pressed"


def _headed(message: Any, stamp_ns: int, robot: ProfileRobot) -> Any:
    """Return a message in the frame of the robot."""
    return _placed(message, stamp_ns, robot.names.frame("base_link"))


def _placed(message: Any, stamp_ns: int, place: str) -> Any:
    """Return a message of a part of the robot, whose name has no prefix: programs compare it."""
    from thymio_sim_ros.ros.interface.headers import stamped

    return stamped(message, stamp_ns, place)


# --- published ---


def _hazards(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    message = _headed(kind(), reading.stamp_ns, robot)
    message.detections = [
        _placed(_part(kind, "HazardDetection")(type=number), reading.stamp_ns, place)
        for number, place in _found_hazards(robot)
    ]
    return message


def _found_hazards(robot: ProfileRobot) -> list[tuple[int, str]]:
    if robot.is_lifted or robot.is_fallen:
        return [(_WHEEL_DROP, f"wheel_drop_{side}") for side in _SIDES]
    found = dict.fromkeys((_BUMP, f"bump_{zone}") for zone in map(_bumped_zone, _bearings(robot)) if zone)
    ground: GroundReading | None = robot.read("ground")  # type: ignore[assignment]
    if ground is not None:
        found |= {
            (_CLIFF, f"cliff_front_{side}"): None
            for side, count in zip(_SIDES, ground.words[4:6], strict=True)
            if count < _NO_FLOOR
        }
    return list(found)


def _bearings(robot: ProfileRobot) -> list[float]:
    pose = robot.pose
    return [
        wrap_angle(math.atan2(contact.y_m - pose.y_m, contact.x_m - pose.x_m) - pose.yaw_rad)
        for contact in robot.contacts
    ]


def _bumped_zone(bearing_rad: float) -> str:
    """The part of the bumper at a bearing; empty behind it."""
    if abs(bearing_rad) > _BUMPER_RAD:
        return ""
    return next(zone for limit, zone in _BUMP_ZONES if bearing_rad <= limit)


def _part(kind: type[Any], name: str) -> Any:
    """Another message class of the package that a class is of."""
    import sys

    return getattr(sys.modules[kind.__module__.rpartition(".")[0]], name)


def _intensities(kind: Any, reading: ProximityReading, robot: ProfileRobot) -> Any:
    message = _headed(kind(), reading.stamp_ns, robot)
    one = _part(kind, "IrIntensity")
    message.readings = [
        _placed(one(value=0 if at is None else reading.words[at]), reading.stamp_ns, f"ir_intensity_{place}")
        for place, at in _INTENSITIES
    ]
    return message


def _cliffs(kind: Any, reading: GroundReading, robot: ProfileRobot) -> Any:
    message = _headed(kind(), reading.stamp_ns, robot)
    one = _part(kind, "IrIntensity")
    message.readings = [
        _placed(one(value=count), reading.stamp_ns, f"cliff_front_{side}")
        for side, count in zip(_SIDES, reading.words[4:6], strict=True)
    ]
    return message


def _buttons(kind: Any, reading: ButtonsReading, robot: ProfileRobot) -> Any:
    from thymio_sim_ros.ros.interface.headers import stamp

    message = _headed(kind(), reading.stamp_ns, robot)
    memory: dict[str, tuple[bool, int, int]] = robot.memory.setdefault(_PRESSED, {})
    for field, button in _BUTTONS.items():
        is_pressed = bool(reading.words[BUTTONS.index(button)])
        was_pressed, since_ns, lasted_ns = memory.get(field, (False, 0, 0))
        if is_pressed and not was_pressed:
            since_ns = reading.stamp_ns
        elif was_pressed and not is_pressed:
            lasted_ns = reading.stamp_ns - since_ns
        memory[field] = is_pressed, since_ns, lasted_ns
        one = _placed(getattr(message, field), reading.stamp_ns, field)
        one.is_pressed, one.last_start_pressed_time = is_pressed, stamp(since_ns)
        duration = one.last_pressed_duration
        duration.sec, duration.nanosec = divmod(lasted_ns, _SECOND_NS)
    return message


def _imu(kind: Any, reading: PoseReading, robot: ProfileRobot) -> Any:
    return imu("base_link", reading, robot, kind)


def _battery(_kind: Any, reading: BatteryReading, robot: ProfileRobot) -> Any:
    return battery("base_link", reading, robot)


def _speeds(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    left, right = reading.velocities_rad_s
    return _headed(kind(velocity_left=left, velocity_right=right), reading.stamp_ns, robot)


def _ticks(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    left, right = (round(angle / math.tau * _TICKS_PER_TURN) for angle in reading.angles_rad)
    return _headed(kind(ticks_left=left, ticks_right=right), reading.stamp_ns, robot)


def _wheels(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    left, right = reading.words[2:4]
    message = kind(pwm_left=left, pwm_right=right, wheels_enabled=True)
    return _headed(message, reading.stamp_ns, robot)


def _stopped(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    is_stopped = not any(reading.velocities_rad_s)
    return _headed(kind(is_stopped=is_stopped), reading.stamp_ns, robot)


def _kidnapped(kind: Any, reading: PoseReading, robot: ProfileRobot) -> Any:
    return _headed(kind(is_kidnapped=robot.is_lifted), reading.stamp_ns, robot)


def _dock(kind: Any, reading: BatteryReading, robot: ProfileRobot) -> Any:
    return _headed(kind(), reading.stamp_ns, robot)


# --- subscribed ---


# --- services and actions ---


def _reset_pose(request: Any, _response: Any, robot: ProfileRobot) -> None:
    from thymio_sim_ros.ros.interface.convert_readings import yaw_of

    place = request.pose
    robot.post(SetOdometry(place.position.x, place.position.y, yaw_of(place.orientation)))


def _e_stop(request: Any, response: Any, robot: ProfileRobot) -> None:
    if request.e_stop_on:
        robot.post(BodyTwist(0.0, 0.0))
    response.success = True
    response.message = "wheels stand still until the next command" if request.e_stop_on else "nothing was held"


class _Undock:
    """There is no dock: the robot is undocked."""

    def __init__(self, _goal: Any, _robot: ProfileRobot) -> None:
        pass

    def step(self) -> Ended | None:
        """See `Motion`."""
        return Ended()

    def feedback(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        return kind()

    def result(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        return kind(is_docked=False)

    def stop(self) -> None:
        """See `Motion`."""


def _dock_here(_goal: Any, _robot: ProfileRobot) -> Any:
    raise ValueError("the playground has no dock: drive with navigate_to_position")


def _no_reflexes(_world: ProfileWorld, _values: Mapping[str, Any]) -> None:
    """The parameter is accepted, and has no effect."""


_PACKAGE = "irobot_create_msgs"
_OF_REFLEXES = ("reflexes_enabled", "reflexes")

PROFILE = Profile(
    "create3",
    "a Create 3 with its actions, hazards, lights and notes",
    node="motion_control",
    playground="turtlebot3",
    program="none",
    replaces=frozenset({"imu", "cmd_vel"}),
    topics=(
        TopicRow(
            "hazard_detection",
            f"{_PACKAGE}/msg/HazardDetectionVector",
            "motor",
            _hazards,
            "bumps of the front half, cliffs of the two ground sensors, wheel drops of a robot in a hand or fallen",
            every_ns=_PERIOD_NS,
        ),
        TopicRow(
            "ir_intensity",
            f"{_PACKAGE}/msg/IrIntensityVector",
            "proximity",
            _intensities,
            "seven values from the five front sensors of a Thymio, 0…4505; `side_left` is 0",
        ),
        TopicRow("cliff_intensity", f"{_PACKAGE}/msg/IrIntensityVector", "ground", _cliffs, "the two ground sensors"),
        TopicRow(
            "interface_buttons",
            f"{_PACKAGE}/msg/InterfaceButtons",
            "buttons",
            _buttons,
            "`button_1`, `button_power`, `button_2` are the left, center and right button of a Thymio",
        ),
        TopicRow("imu", "sensor_msgs/msg/Imu", "pose", _imu, "orientation (yaw 0 at the start), rates, accelerations"),
        TopicRow(
            "battery_state", "sensor_msgs/msg/BatteryState", "battery", _battery, "V, charge 0…1, charging or not"
        ),
        TopicRow("wheel_vels", f"{_PACKAGE}/msg/WheelVels", "motor", _speeds, "rad/s", every_ns=_PERIOD_NS),
        TopicRow(
            "wheel_ticks", f"{_PACKAGE}/msg/WheelTicks", "motor", _ticks, "508.8 for each turn", every_ns=_PERIOD_NS
        ),
        TopicRow(
            "wheel_status",
            f"{_PACKAGE}/msg/WheelStatus",
            "motor",
            _wheels,
            "pwm of a Thymio, ±801; currents are 0",
            every_ns=_PERIOD_NS,
        ),
        TopicRow(
            "stop_status",
            f"{_PACKAGE}/msg/StopStatus",
            "motor",
            _stopped,
            "whether no wheel turns",
            every_ns=_PERIOD_NS,
        ),
        TopicRow("kidnap_status", f"{_PACKAGE}/msg/KidnapStatus", "pose", _kidnapped, "whether a hand holds the robot"),
        TopicRow("dock_status", f"{_PACKAGE}/msg/DockStatus", "battery", _dock, "false: there is no dock"),
    ),
    inputs=(
        InputRow(
            "cmd_vel",
            "geometry_msgs/msg/Twist",
            drive,
            "linear.x in m/s and angular.z in rad/s; scaled down together above the limit of the wheels",
            limit_check=too_fast,
            is_best_effort=True,
        ),
        InputRow(
            "cmd_lightring",
            f"{_PACKAGE}/msg/LightringLeds",
            lights,
            "front and back of the ring on the top of a Thymio, its sides on the sides",
            kind="lights",
        ),
        InputRow(
            "cmd_audio", f"{_PACKAGE}/msg/AudioNoteVector", notes, "notes in Hz, one after the other", kind="event"
        ),
    ),
    services=(
        ServiceRow("reset_pose", f"{_PACKAGE}/srv/ResetPose", _reset_pose, "let the odometry go on from a pose"),
        ServiceRow("e_stop", f"{_PACKAGE}/srv/EStop", _e_stop, "stop the wheels, until the next command"),
    ),
    actions=(
        *OWN_ACTIONS,
        DRIVE_ARC,
        WALL_FOLLOW,
        ActionRow("undock", f"{_PACKAGE}/action/Undock", _Undock, "succeeds at once: there is no dock"),
        ActionRow("dock", f"{_PACKAGE}/action/Dock", _dock_here, "rejected: there is no dock"),
        ActionRow(
            "audio_note_sequence",
            f"{_PACKAGE}/action/AudioNoteSequence",
            Melody,
            "play notes some times; -1: without end",
        ),
        ActionRow("led_animation", f"{_PACKAGE}/action/LedAnimation", Animation, "blink or spin the lights for a time"),
    ),
    node_parameters=(
        ParameterRow(
            "safety_override",
            "none",
            "none, backup_only or full; no effect: the robot has no reflexes",
            act=_no_reflexes,
        ),
    ),
    each_tick=play_notes,
    missing=(
        Missing(
            "ir_opcode",
            "The simulated robot has no receiver of a dock's infrared; use ir_intensity.",
            f"{_PACKAGE}/msg/IrOpcode",
        ),
        Missing("mouse", "The simulated robot has no optical mouse sensor; use odom.", f"{_PACKAGE}/msg/Mouse"),
        Missing(
            "slip_status",
            "The simulated robot does not detect that its wheels slip; compare odom and imu.",
            f"{_PACKAGE}/msg/SlipStatus",
        ),
        Missing(
            "robot_power",
            "The simulated robot cannot be switched off by ROS; end thymio-sim.",
            f"{_PACKAGE}/srv/RobotPower",
        ),
        Missing(
            "dock_servo",
            "There is no dock: drive with navigate_to_position. A newer Create 3 has the action dock of the type Dock.",
            f"{_PACKAGE}/action/DockServo",
        ),
        Missing("motion_control/", "The node of all robots is /motion_control, without the name of a robot."),
        *(
            Missing(
                name, "This node of a Create 3 does not exist here; /motion_control and /simulator have parameters."
            )
            for name in ("mobility_monitor/", "robot_state/", "static_transform/", "ui_mgr/")
        ),
    ),
    missing_parameters=(
        *(Missing(name, "The simulated robot has no reflexes: react to hazard_detection.") for name in _OF_REFLEXES),
        *(
            Missing(name, "A wheel drives at most 0.166 m/s: choose less by cmd_vel, or in a goal.")
            for name in ("max_speed", "min_speed")
        ),
        Missing("wheel_accel_limit", "The motors of the robot limit its acceleration: change cmd_vel step by step."),
    ),
)
