"""Create 3, the robot of iRobot for courses: a Thymio is the robot.

It has the actions that courses use, and hazards, buttons and intensities from the sensors of a Thymio. Lights and notes
are played on those of the Thymio. Speeds above 0.166 m/s of a wheel are clamped on their curve.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
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
from thymio_sim_ros.ros.profiles._body import battery, imu
from thymio_sim_ros.ros.profiles._wall_follow import WALL_FOLLOW
from thymio_sim_ros.sim.commands import (
    BUTTONS,
    COLORED_GROUPS,
    LED_FULL,
    BodyTwist,
    Command,
    PlayTone,
    ReleaseLeds,
    SetLeds,
    SetOdometry,
    ShowOnLeds,
    StopSound,
)
from thymio_sim_ros.sim.model.geometry import wrap_angle

if TYPE_CHECKING:
    from thymio_sim_ros.ros.interface.robot_inputs import InputContext
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
_NOTES = "create3.notes"
_PRESSED = "create3.pressed"


def _headed(message: Any, stamp_ns: int, frame: str, robot: ProfileRobot) -> Any:
    from thymio_sim_ros.ros.interface.headers import stamped

    return stamped(message, stamp_ns, robot.names.fixed_frame(frame))


# --- published ---


def _hazards(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    message = _headed(kind(), reading.stamp_ns, "base_link", robot)
    message.detections = [
        _headed(_part(kind, "HazardDetection")(type=number), reading.stamp_ns, frame, robot)
        for number, frame in _found_hazards(robot)
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
    message = _headed(kind(), reading.stamp_ns, "base_link", robot)
    one = _part(kind, "IrIntensity")
    message.readings = [
        _headed(one(value=0 if at is None else reading.words[at]), reading.stamp_ns, f"ir_intensity_{place}", robot)
        for place, at in _INTENSITIES
    ]
    return message


def _cliffs(kind: Any, reading: GroundReading, robot: ProfileRobot) -> Any:
    message = _headed(kind(), reading.stamp_ns, "base_link", robot)
    one = _part(kind, "IrIntensity")
    message.readings = [
        _headed(one(value=count), reading.stamp_ns, f"cliff_front_{side}", robot)
        for side, count in zip(_SIDES, reading.words[4:6], strict=True)
    ]
    return message


def _buttons(kind: Any, reading: ButtonsReading, robot: ProfileRobot) -> Any:
    from thymio_sim_ros.ros.interface.headers import stamp

    message = _headed(kind(), reading.stamp_ns, "base_link", robot)
    memory: dict[str, tuple[bool, int, int]] = robot.memory.setdefault(_PRESSED, {})
    for field, button in _BUTTONS.items():
        is_pressed = bool(reading.words[BUTTONS.index(button)])
        was_pressed, since_ns, lasted_ns = memory.get(field, (False, 0, 0))
        if is_pressed and not was_pressed:
            since_ns = reading.stamp_ns
        elif was_pressed and not is_pressed:
            lasted_ns = reading.stamp_ns - since_ns
        memory[field] = is_pressed, since_ns, lasted_ns
        one = _headed(getattr(message, field), reading.stamp_ns, field, robot)
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
    return _headed(kind(velocity_left=left, velocity_right=right), reading.stamp_ns, "base_link", robot)


def _ticks(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    left, right = (round(angle / math.tau * _TICKS_PER_TURN) for angle in reading.angles_rad)
    return _headed(kind(ticks_left=left, ticks_right=right), reading.stamp_ns, "base_link", robot)


def _wheels(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    left, right = reading.words[2:4]
    message = kind(pwm_left=left, pwm_right=right, wheels_enabled=True)
    return _headed(message, reading.stamp_ns, "base_link", robot)


def _stopped(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    is_stopped = not any(reading.velocities_rad_s)
    return _headed(kind(is_stopped=is_stopped), reading.stamp_ns, "base_link", robot)


def _kidnapped(kind: Any, reading: PoseReading, robot: ProfileRobot) -> Any:
    return _headed(kind(is_kidnapped=robot.is_lifted), reading.stamp_ns, "base_link", robot)


def _dock(kind: Any, reading: BatteryReading, robot: ProfileRobot) -> Any:
    return _headed(kind(), reading.stamp_ns, "base_link", robot)


# --- subscribed ---


def _lights(message: Any, _context: InputContext, _robot: ProfileRobot) -> Sequence[Command]:
    """Front and back of the ring are the top of a Thymio, its left and right side the sides."""
    if not message.override_system:
        return _no_lights()
    return _colors(message.leds)


def _no_lights() -> list[Command]:
    """Return the colors to the firmware, which shows none."""
    return [
        *(ShowOnLeds(group, (0, 0, 0)) for group in COLORED_GROUPS),
        *(ReleaseLeds(group) for group in COLORED_GROUPS),
    ]


def _colors(leds: Sequence[Any]) -> list[SetLeds]:
    pairs = {"top": (2, 5), "bottom_left": (3, 4), "bottom_right": (0, 1)}
    return [
        SetLeds(
            group,
            tuple(
                round(sum(getattr(leds[at], shade) for at in pair) / 510 * LED_FULL)
                for shade in ("red", "green", "blue")
            ),
        )
        for group, pair in pairs.items()
    ]


def _notes(message: Any, _context: InputContext, robot: ProfileRobot) -> Sequence[Command]:
    """Queue notes, which `_play_notes` plays one after the other."""
    notes = [(note.frequency, _nanoseconds(note.max_runtime)) for note in message.notes]
    now_ns = robot.world.now_ns
    waiting = robot.memory.get(_NOTES, [])
    if not message.append or not waiting:
        waiting = []
    at_ns = max([now_ns, *(end_ns for _, _, end_ns in waiting)])
    for frequency, length_ns in notes:
        waiting.append((at_ns, frequency, at_ns + length_ns))
        at_ns += length_ns
    robot.memory[_NOTES] = waiting
    return () if notes else (StopSound(),)


def _nanoseconds(duration: Any) -> int:
    return int(duration.sec * _SECOND_NS + duration.nanosec)


def _play_notes(world: ProfileWorld) -> None:
    """Begin the notes that are due; called after each tick."""
    for robot in world.robots.values():
        waiting = robot.memory.get(_NOTES)
        while waiting and waiting[0][0] <= world.now_ns:
            _, frequency, end_ns = waiting.pop(0)
            if end_ns > world.now_ns:
                robot.post(PlayTone(float(frequency), end_ns - world.now_ns) if frequency else StopSound())


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


class _Melody:
    """Plays a sequence of notes some times, or until it is canceled."""

    def __init__(self, goal: Any, robot: ProfileRobot) -> None:
        self._robot, self._notes, self._wanted = robot, goal.note_sequence, goal.iterations
        self._length_ns = sum(_nanoseconds(note.max_runtime) for note in self._notes.notes)
        if self._length_ns <= 0:
            raise ValueError("note_sequence has no notes with a max_runtime above 0")
        if self._wanted < -1:
            raise ValueError(f"iterations is {self._wanted}, expected -1 (without end) or more")
        self._start_ns, self._begun = robot.world.now_ns, 0

    @property
    def _passed_ns(self) -> int:
        return self._robot.world.now_ns - self._start_ns

    @property
    def _played(self) -> int:
        return min(self._passed_ns // self._length_ns, self._begun)

    def step(self) -> Ended | None:
        """See `Motion`."""
        if self._wanted != -1 and self._played >= self._wanted:
            return Ended()
        if self._passed_ns >= self._begun * self._length_ns:
            self._begun += 1
            _notes(_Sequence(self._notes.notes), None, self._robot)  # type: ignore[arg-type]
        return None

    def feedback(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        message = kind(iterations_played=self._played)
        runtime = message.current_runtime
        runtime.sec, runtime.nanosec = divmod(self._passed_ns, _SECOND_NS)
        return message

    def result(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        message = kind(complete=self._wanted != -1 and self._played >= self._wanted, iterations_played=self._played)
        message.runtime.sec, message.runtime.nanosec = divmod(self._passed_ns, _SECOND_NS)
        return message

    def stop(self) -> None:
        """See `Motion`."""
        self._robot.memory.pop(_NOTES, None)
        self._robot.post(StopSound())


class _Sequence:
    """Notes that replace those that are playing."""

    append = False

    def __init__(self, notes: Sequence[Any]) -> None:
        self.notes = notes


class _Animation:
    """Blinks or spins the colors of a ring of lights for a time."""

    _STEP_NS = 250_000_000

    def __init__(self, goal: Any, robot: ProfileRobot) -> None:
        self._robot, self._leds = robot, list(goal.lightring.leds)
        self._is_spinning = goal.animation_type == 2
        self._runtime_ns = _nanoseconds(goal.max_runtime)
        if goal.animation_type not in (1, 2):
            raise ValueError(f"animation_type is {goal.animation_type}, expected 1 (blink) or 2 (spin)")
        if self._runtime_ns <= 0:
            raise ValueError(f"max_runtime is {self._runtime_ns / _SECOND_NS:g} s, expected a time above 0")
        self._start_ns, self._shown = robot.world.now_ns, -1

    @property
    def _passed_ns(self) -> int:
        return self._robot.world.now_ns - self._start_ns

    def step(self) -> Ended | None:
        """See `Motion`."""
        if self._passed_ns >= self._runtime_ns:
            return Ended()
        number = self._passed_ns // self._STEP_NS
        if number != self._shown:
            self._shown = number
            turned = number % len(self._leds)
            for command in _colors(self._leds[turned:] + self._leds[:turned] if self._is_spinning else self._leds):
                is_dark = not self._is_spinning and number % 2 == 1
                self._robot.post(SetLeds(command.group, (0, 0, 0)) if is_dark else command)
        return None

    def feedback(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        message = kind()
        left_ns = max(0, self._runtime_ns - self._passed_ns)
        message.remaining_runtime.sec, message.remaining_runtime.nanosec = divmod(left_ns, _SECOND_NS)
        return message

    def result(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        message = kind()
        message.runtime.sec, message.runtime.nanosec = divmod(self._passed_ns, _SECOND_NS)
        return message

    def stop(self) -> None:
        """See `Motion`. The firmware shows the sensors again."""
        for command in _no_lights():
            self._robot.post(command)


def _no_reflexes(_world: ProfileWorld, _values: Mapping[str, Any]) -> None:
    """The parameter is accepted, and has no effect."""


_PACKAGE = "irobot_create_msgs"

PROFILE = Profile(
    "create3",
    "a Create 3 with its actions, hazards, lights and notes",
    node="motion_control",
    playground="turtlebot3",
    program="none",
    replaces=frozenset({"imu"}),
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
            "cmd_lightring",
            f"{_PACKAGE}/msg/LightringLeds",
            _lights,
            "front and back of the ring on the top of a Thymio, its sides on the sides",
            kind="lights",
        ),
        InputRow(
            "cmd_audio", f"{_PACKAGE}/msg/AudioNoteVector", _notes, "notes in Hz, one after the other", kind="event"
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
            _Melody,
            "play notes some times; -1: without end",
        ),
        ActionRow(
            "led_animation", f"{_PACKAGE}/action/LedAnimation", _Animation, "blink or spin the lights for a time"
        ),
    ),
    node_parameters=(
        ParameterRow(
            "safety_override",
            "none",
            "none, backup_only or full; no effect: the robot has no reflexes",
            act=_no_reflexes,
        ),
    ),
    each_tick=_play_notes,
    missing=(
        Missing("ir_opcode", "The simulated robot has no receiver of a dock's infrared; use ir_intensity."),
        Missing("mouse", "The simulated robot has no optical mouse sensor; use odom."),
        Missing("slip_status", "The simulated robot does not detect that its wheels slip; compare odom and imu."),
        Missing("robot_power", "The simulated robot cannot be switched off by ROS; end thymio-sim."),
    ),
)
