"""All topics that a simulated robot subscribes to.

Most are rows of `command_topics`, `operator_topics` and `plugin_topics`. This module adds topics that need more than
the message, or that produce several commands (docs/spec/ros-interface.md section 4.2).
"""

from __future__ import annotations

import builtins
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
from geometry_msgs.msg import Twist as TwistMsg
from rclpy.qos import QoSProfile
from std_msgs.msg import Bool, Empty, Float64MultiArray

from thymio_sim_ros.ros.interface import (
    command_checks,
    command_topics,
    convert_readings,
    operator_topics,
    plugin_topics,
    qos,
    saturation,
)
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.command_row import CommandRow
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.saturation import LimitCheck
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.model.geometry import Pose, wrap_angle

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["InputContext", "RobotInput", "robot_inputs"]


M = TypeVar("M", bound="Message")

WORLD = Pose(0.0, 0.0, 0.0)
"""Pose of the world frame in the world."""


@dataclass(frozen=True, slots=True)
class InputContext:
    """The context in which a message is decoded: simulated time and time-out of velocities (0: none), in ns.

    `frames` returns the poses of the robot's frames in the world.
    """

    now_ns: int
    timeout_ns: int
    frames: Callable[[], Mapping[str, Pose]] = dict


@dataclass(frozen=True, slots=True)
class RobotInput:
    """One topic. `commands` returns the commands of a message or raises CommandError; `about` is for docs/ros.md.

    `limit_check` describes the part of an accepted message that is clamped, or returns an empty text.
    """

    topic: str
    type: type[Message]
    commands: Callable[[Any, InputContext], Sequence[Command]]
    about: str
    profile: QoSProfile
    limit_check: LimitCheck = saturation.nothing

    if TYPE_CHECKING:  # the parts fit each other; a generic class would not be checked within a tuple of rows

        def __init__(
            self,
            topic: str,
            type: builtins.type[M],  # noqa: A002  # the name of the field
            commands: Callable[[M, InputContext], Sequence[Command]],
            about: str,
            profile: QoSProfile,
            limit_check: Callable[[M], str] = ...,
        ) -> None: ...

    @property
    def is_of_operator(self) -> bool:
        """Whether an operator acts on the robot by it: programs of a real robot cannot."""
        return self.topic == "initialpose" or self.topic.startswith(("_press/", "stimulus/"))


def robot_inputs(*, stamped_cmd_vel: bool = False) -> tuple[RobotInput, ...]:
    """Return all inputs of a robot; `stamped_cmd_vel`: `cmd_vel` is TwistStamped, as in newer versions of Nav2."""
    plain, stamped = ("cmd_vel_unstamped", "cmd_vel") if stamped_cmd_vel else ("cmd_vel", "cmd_vel_stamped")
    speeds = "linear.x in m/s and angular.z in rad/s; scaled down together above the limit of the wheels"
    return (
        RobotInput(plain, TwistMsg, _twist, speeds, qos.COMMAND, saturation.twist),
        RobotInput(
            stamped,
            TwistStamped,
            _stamped_twist,
            f"{speeds}; rejected if older than `cmd_vel_timeout`",
            qos.COMMAND,
            saturation.stamped_twist,
        ),
        RobotInput(
            "_wheels/command", Float64MultiArray, _wheels, "left, right in rad/s", qos.COMMAND, saturation.wheels
        ),
        *map(_of_row, command_topics.ROWS),
        RobotInput("_led/off", Empty, _leds_off, "all lights off", qos.LEDS),
        RobotInput(
            "shutdown",
            Empty,
            _shutdown,
            "wheels, lights, sound and alarm off; the program stops until `aseba/run` or a reset; later commands work",
            qos.EVENTS,
        ),
        RobotInput(
            "initialpose",
            PoseWithCovarianceStamped,
            _pose,
            "move the robot, m in the frame of the header: that of the world (or empty), `odom` or `base_link`; "
            "odometry is unchanged. Rejected if the place is occupied, or outside of every ground",
            qos.COMMAND,
        ),
        *(
            RobotInput(
                f"_press/{button}", Bool, partial(_press, button), "press (true) or release the button", qos.EVENTS
            )
            for button in commands.BUTTONS
        ),
        *map(_of_row, (*operator_topics.ROWS, *plugin_topics.rows())),
    )


def _of_row(row: CommandRow) -> RobotInput:
    return RobotInput(
        row.topic,
        row.type,
        lambda message, _input_context: (row.decode(message),),
        row.about,
        row.profile,
        row.limit_check,
    )


def _twist(message: TwistMsg, input_context: InputContext) -> Sequence[Command]:
    return (command_checks.body_twist(message, input_context.timeout_ns),)


def _stamped_twist(message: TwistStamped, input_context: InputContext) -> Sequence[Command]:
    sent_ns = message.header.stamp.sec * SECOND_NS + message.header.stamp.nanosec
    age_ns = input_context.now_ns - sent_ns
    if input_context.timeout_ns and sent_ns and age_ns > input_context.timeout_ns:
        raise CommandError(
            f"stamp: found an age of {age_ns / 1e9:.3f} s, expected at most {input_context.timeout_ns / 1e9:.3f} s"
        )
    return (command_checks.body_twist(message.twist, input_context.timeout_ns),)


def _wheels(message: Float64MultiArray, input_context: InputContext) -> Sequence[Command]:
    return (command_checks.wheel_velocities(message.data, input_context.timeout_ns),)


def _leds_off(_message: Empty, _input_context: InputContext) -> Sequence[Command]:
    return tuple(commands.SetLeds(group, (0,) * size) for group, size in commands.LED_GROUPS.items())


def _shutdown(message: Empty, input_context: InputContext) -> Sequence[Command]:
    quiet = (commands.SetAlarm(False), commands.StopSound())
    return (commands.MotorTargets(0, 0), *quiet, *_leds_off(message, input_context))


def _pose(message: PoseWithCovarianceStamped, input_context: InputContext) -> Sequence[Command]:
    """Viewers send the pose in the frame that they display or follow."""
    pose, frame, frames = message.pose.pose, message.header.frame_id, input_context.frames()
    if frame and frame not in frames:
        raise CommandError(f"found frame '{frame}', expected {' or '.join(frames)}")
    origin = frames[frame] if frame else WORLD
    x, y = origin.place((pose.position.x, pose.position.y))
    yaw = origin.yaw_rad + convert_readings.yaw_of(pose.orientation)
    if not all(map(math.isfinite, (x, y, yaw))):
        raise CommandError("pose has a value that is not finite")
    return (commands.MoveRobot(x, y, wrap_angle(yaw)),)


def _press(button: str, message: Bool, _input_context: InputContext) -> Sequence[Command]:
    return (commands.PressButton(button, bool(message.data)),)
