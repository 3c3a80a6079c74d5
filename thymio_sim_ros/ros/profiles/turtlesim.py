"""turtlesim, with which the official tutorials of ROS 2 begin: a Thymio is the turtle.

A unit is 4 cm: the tutorials drive at 2 units/s with 1.8 rad/s, for which the outer wheel needs 0.165 m/s. The field
has 11.09 × 11.09 units, as the window of turtlesim; its walls are so far outside that the middle of a robot reaches the
border of the field from each direction.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.engine.motions import Turn
from thymio_sim_ros.ros.profiles import (
    ActionRow,
    InputRow,
    Missing,
    ParameterRow,
    Profile,
    ProfileRobot,
    ProfileWorld,
    ServiceRow,
    TopicRow,
)
from thymio_sim_ros.ros.profiles._actions import LawMotion
from thymio_sim_ros.sim.actuators.motors import wanted_speeds
from thymio_sim_ros.sim.actuators.pen import PEN_WIDTHS_M
from thymio_sim_ros.sim.commands import BodyTwist, Command, DrawJumps, MoveRobot, SetPen
from thymio_sim_ros.sim.model.geometry import wrap_angle
from thymio_sim_ros.sim.model.robot_constants import MAX_SPEED_M_S
from thymio_sim_ros.sim.playground.reader import RobotStart

if TYPE_CHECKING:
    from thymio_sim_ros.ros.interface.robot_inputs import InputContext
    from thymio_sim_ros.sim.model.readings import PoseReading

UNIT_M = 0.04
PIXELS = 45.0
"""Pixels of turtlesim's window in a unit; widths of its pen are in pixels."""

BACKGROUND = (69, 86, 255)
PEN = SetPen(down=True, color=(0xB3 / 255, 0xB8 / 255, 1.0), width_m=3 / PIXELS * UNIT_M)
"""The pen of a new turtle. It draws a line to where the turtle is teleported, too."""

MOST_TURTLES = 100
"""More are refused: each is a robot with all its topics, and a node that spawns without end would stop the suite."""

SPEED_RAD_S = 1.0
"""Of a turn to a heading."""


def _pose(kind: Any, reading: PoseReading, _robot: ProfileRobot) -> Any:
    pose, speeds = reading.truth, reading.truth_twist
    return kind(
        x=pose.x_m / UNIT_M,
        y=pose.y_m / UNIT_M,
        theta=wrap_angle(pose.yaw_rad),
        linear_velocity=speeds.linear_m_s / UNIT_M,
        angular_velocity=speeds.angular_rad_s,
    )


def _color(kind: Any, _reading: PoseReading, robot: ProfileRobot) -> Any:
    color = robot.floor_color
    if color is None:
        return None
    red, green, blue = (round(255 * part) for part in color)
    return kind(r=red, g=green, b=blue)


def _drive(message: Any, context: InputContext, _robot: ProfileRobot) -> Sequence[Command]:
    from thymio_sim_ros.ros.interface.command_checks import finite

    for value, name in ((message.linear.x, "linear.x"), (message.angular.z, "angular.z")):
        finite(value, name)
    return (BodyTwist(message.linear.x * UNIT_M, message.angular.z, context.timeout_ns),)


def _too_fast(message: Any) -> str:
    fastest = max(map(abs, wanted_speeds(BodyTwist(message.linear.x * UNIT_M, message.angular.z))))
    if fastest <= MAX_SPEED_M_S:
        return ""
    found, driven = (
        f"{part * message.linear.x:.3g} units/s and {part * message.angular.z:.3g} rad/s"
        for part in (1.0, MAX_SPEED_M_S / fastest)
    )
    return "" if found == driven else f"found {found}, the robot drives the same curve with {driven}"


def _finite(**values: float) -> None:
    for name, value in values.items():
        if not math.isfinite(value):
            raise ValueError(f"{name} is {value}, expected a finite number")


def _spawn(request: Any, response: Any, world: ProfileWorld) -> None:
    _finite(x=request.x, y=request.y, theta=request.theta)
    if len(world.robots) >= MOST_TURTLES:
        raise ValueError(f"found {MOST_TURTLES} turtles, expected at most so many: kill one first")
    name = request.name or next(
        name for number in range(1, len(world.robots) + 2) if (name := f"turtle{number}") not in world.robots
    )
    world.spawn(RobotStart(name, request.x * UNIT_M, request.y * UNIT_M, wrap_angle(request.theta)))
    response.name = name


def _kill(request: Any, _response: Any, world: ProfileWorld) -> None:
    if request.name not in world.robots:
        raise ValueError(f"found no turtle '{request.name}', expected one of {', '.join(world.robots) or 'none'}")
    world.remove(request.name)


def _clear(_request: Any, _response: Any, world: ProfileWorld) -> None:
    world.clear()


def _reset(_request: Any, _response: Any, world: ProfileWorld) -> None:
    world.reset()


def _set_pen(request: Any, _response: Any, robot: ProfileRobot) -> None:
    low, high = PEN_WIDTHS_M
    width_m = min(max(request.width / PIXELS * UNIT_M, low), high)
    color = (request.r / 255, request.g / 255, request.b / 255)
    robot.post(SetPen(down=not request.off, color=color, width_m=width_m))


def _teleport(request: Any, _response: Any, robot: ProfileRobot) -> None:
    _finite(x=request.x, y=request.y, theta=request.theta)
    robot.post(MoveRobot(request.x * UNIT_M, request.y * UNIT_M, wrap_angle(request.theta)))


def _teleport_by(request: Any, _response: Any, robot: ProfileRobot) -> None:
    _finite(linear=request.linear, angular=request.angular)
    pose, way_m = robot.pose, request.linear * UNIT_M
    yaw = wrap_angle(pose.yaw_rad + request.angular)
    robot.post(MoveRobot(pose.x_m + way_m * math.cos(yaw), pose.y_m + way_m * math.sin(yaw), yaw))


def _turn(goal: Any, robot: ProfileRobot) -> LawMotion:
    """Turn on the spot to a heading by the shorter way, whatever velocities are commanded meanwhile."""
    from thymio_sim_ros.ros.interface.command_checks import finite

    finite(goal.theta, "theta")
    start = robot.pose
    return LawMotion(
        robot,
        Turn(start, wrap_angle(goal.theta - start.yaw_rad), SPEED_RAD_S),
        lambda kind, law: kind(remaining=law.remaining.angle_rad),
        result=lambda kind: kind(delta=wrap_angle(start.yaw_rad - robot.pose.yaw_rad)),
        by_truth=True,
        yields=False,
    )


def _begin(_robot: ProfileRobot) -> Sequence[Command]:
    return (PEN, DrawJumps(True))


def _watch_walls(world: ProfileWorld) -> None:
    """Warn when a turtle meets a wall, or another turtle."""
    for robot in world.robots.values():
        is_touching = robot.is_touching
        if is_touching and not robot.memory.get("is_touching"):
            pose = robot.pose
            world.warn(f"{robot.name} hit something at x={pose.x_m / UNIT_M:.2f}, y={pose.y_m / UNIT_M:.2f}")
        robot.memory["is_touching"] = is_touching


def _paint(world: ProfileWorld, values: Mapping[str, Any]) -> None:
    red, green, blue = (values[f"background_{part}"] / 255 for part in "rgb")
    world.paint((red, green, blue))


PROFILE = Profile(
    "turtlesim",
    "the turtle of the official tutorials, in a field of 11 × 11 units",
    node="turtlesim",
    playground="turtlesim",
    program="none",
    robots=("turtle1",),
    parameters={"cmd_vel_timeout": 1.0, "odom_max_rate": 50.0, "solid_robots": False},
    replaces=frozenset({"cmd_vel"}),
    topics=(
        TopicRow("pose", "turtlesim/msg/Pose", "pose", _pose, "x, y and speed in units of 4 cm, theta in rad"),
        TopicRow("color_sensor", "turtlesim/msg/Color", "pose", _color, "the color of the ground below the pen"),
    ),
    inputs=(
        InputRow(
            "cmd_vel",
            "geometry_msgs/msg/Twist",
            _drive,
            "linear.x in units/s and angular.z in rad/s; they end after a second",
            limit_check=_too_fast,
        ),
    ),
    services=(
        ServiceRow("spawn", "turtlesim/srv/Spawn", _spawn, "add a turtle", is_of_world=True),
        ServiceRow("kill", "turtlesim/srv/Kill", _kill, "remove a turtle", is_of_world=True),
        ServiceRow("clear", "std_srvs/srv/Empty", _clear, "erase all drawings", is_of_world=True),
        ServiceRow("reset", "std_srvs/srv/Empty", _reset, "begin anew with one turtle", is_of_world=True),
        ServiceRow("set_pen", "turtlesim/srv/SetPen", _set_pen, "color, width in pixels, and whether the pen is off"),
        ServiceRow("teleport_absolute", "turtlesim/srv/TeleportAbsolute", _teleport, "move to a pose"),
        ServiceRow("teleport_relative", "turtlesim/srv/TeleportRelative", _teleport_by, "turn, then move ahead"),
    ),
    actions=(ActionRow("rotate_absolute", "turtlesim/action/RotateAbsolute", _turn, "turn to a heading in rad"),),
    node_parameters=tuple(
        ParameterRow(f"background_{part}", value, f"{color} of the field, 0…255", 0, 255, _paint)
        for part, color, value in zip("rgb", ("Red", "Green", "Blue"), BACKGROUND, strict=True)
    ),
    missing_parameters=(
        Missing("holonomic", "A Thymio cannot drive sideways: linear.y of cmd_vel has no effect, turn and drive."),
    ),
    begin=_begin,
    each_tick=_watch_walls,
    programs={
        "turtlesim": {
            name: f"thymio_sim_ros.turtlesim.{name}" for name in ("mimic", "turtle_teleop_key", "turtlesim_node")
        }
    },
)
