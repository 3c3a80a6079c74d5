"""Actions by which a robot turns, drives and goes to a pose, with the types of Create 3 (`irobot_create_msgs`).

Each robot without a profile has `OWN_ACTIONS` where the types are installed; profiles may have them, too. The laws are
those of `engine/motions.py`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeVar

from thymio_sim_ros.engine.motions import (
    MAX_TURN_RAD_S,
    Arc,
    Distance,
    Law,
    StallDetector,
    ToPose,
    Turn,
    Velocity,
)
from thymio_sim_ros.ros.profiles import ActionRow, Ended, Profile, ProfileRobot
from thymio_sim_ros.sim.actuators.motors import MotorState, wheel_speeds
from thymio_sim_ros.sim.commands import BodyTwist
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.geometry import Pose, wrap_angle
from thymio_sim_ros.sim.model.robot_constants import MAX_SPEED_M_S

__all__ = ["DRIVE_ARC", "OWN_ACTIONS", "PLAIN", "LawMotion", "MotorGuard", "check_number", "pose_by_odometry"]

L = TypeVar("L", bound=Law)

MOST_M, MOST_RAD = 100.0, 100 * math.tau
"""Largest distance and angle of a goal: more is a mistake, such as millimeters or degrees."""
TAKEN = "another command drives the wheels"


class MotorGuard:
    """Drives the wheels for a motion, and notices what ends it: a hand, another command, or an obstacle."""

    def __init__(self, robot: ProfileRobot, *, yields: bool = True) -> None:
        """`yields`: whether another command ends the motion; otherwise the motion goes on, and the command is lost."""
        self._robot, self._yields = robot, yields
        self._stall = StallDetector(robot.odometry)
        self._last: BodyTwist | None = None
        """The velocity of the last tick."""
        self._is_taken = False

    def check(self) -> Ended | None:
        """Return why the motion has ended; None if it goes on. Called once after each tick."""
        robot, last = self._robot, self._last
        if last is None:
            return None
        if robot.is_lifted:
            return Ended("the robot was lifted")
        if self._yields and robot.state(MotorState).speeds_m_s != wheel_speeds(last):
            self._is_taken = True
            return Ended(TAKEN)
        if self._stall.update(robot.odometry, Velocity(last.linear_m_s, last.angular_rad_s)):
            touched = ", ".join(dict.fromkeys(f"'{contact.other}'" for contact in robot.contacts))
            return Ended(f"the robot is blocked by {touched}" if touched else "the robot cannot move")
        return None

    def drive(self, twist: BodyTwist) -> None:
        """Set the velocity of the next tick."""
        self._last = twist
        self._robot.post(twist)

    def stop(self) -> None:
        """Stop the wheels, unless another command drives them. The targets of a program apply again."""
        if not self._is_taken:
            self._robot.post(BodyTwist(0.0, 0.0, TICK_NS))


class LawMotion:
    """Drives a robot by a law until the goal is reached, or the guard ends it."""

    def __init__(
        self,
        robot: ProfileRobot,
        law: L,
        feedback: Callable[[type[Any], L], Any],
        *,
        result: Callable[[type[Any]], Any] | None = None,
        by_truth: bool = False,
        yields: bool = True,
    ) -> None:
        """Prepare the motion.

        Args:
            robot: The robot.
            law: Gets the pose after each tick.
            feedback: Makes the feedback of a class from the law.
            result: Makes the result of a class; None: the pose by odometry.
            by_truth: Whether the law gets the true pose, not that by odometry.
            yields: Whether another command for the wheels ends the motion.
        """
        self._robot, self._law, self._feedback = robot, law, feedback
        self._result, self._by_truth = result or self._place, by_truth
        self._guard = MotorGuard(robot, yields=yields)

    def step(self) -> Ended | None:
        """See `Motion`."""
        if (ended := self._guard.check()) is not None:
            return ended
        wanted = self._law.velocity(self._robot.pose if self._by_truth else self._robot.odometry)
        if wanted is None:
            return Ended()
        self._guard.drive(BodyTwist(wanted.linear_m_s, wanted.angular_rad_s))
        return None

    def feedback(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        return self._feedback(kind, self._law)

    def result(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        return self._result(kind)

    def stop(self) -> None:
        """See `Motion`."""
        self._guard.stop()

    def _place(self, kind: type[Any]) -> Any:
        """A result with the pose by odometry."""
        from thymio_sim_ros.ros.interface.convert_readings import quaternion
        from thymio_sim_ros.ros.interface.headers import stamped

        message, robot = kind(), self._robot
        pose = robot.odometry
        place = message.pose.pose
        place.position.x, place.position.y, place.orientation = pose.x_m, pose.y_m, quaternion(pose.yaw_rad)
        stamped(message.pose, robot.world.now_ns, robot.names.frame("odom"))
        return message


def check_number(value: float, what: str, *, most: float = math.inf, is_positive: bool = False) -> float:
    """Return a number of a goal. Raises CommandError unless it is finite, at most `most` and above 0 if it must be."""
    from thymio_sim_ros.ros.interface.command_checks import CommandError, finite

    finite(value, what)
    if abs(value) > most:
        raise CommandError(f"{what} is {value:g}, expected at most {most:g}")
    if is_positive and value <= 0.0:
        raise CommandError(f"{what} is {value:g}, expected a number above 0")
    return float(value)


def _rotate(goal: Any, robot: ProfileRobot) -> LawMotion:
    angle_rad = check_number(goal.angle, "angle (rad)", most=MOST_RAD)
    largest_rad_s = check_number(goal.max_rotation_speed, "max_rotation_speed (rad/s)", is_positive=True)
    return LawMotion(
        robot,
        Turn(robot.odometry, angle_rad, largest_rad_s),
        lambda kind, law: kind(remaining_angle_travel=law.remaining.angle_rad),
    )


def _drive(goal: Any, robot: ProfileRobot) -> LawMotion:
    distance_m = check_number(goal.distance, "distance (m)", most=MOST_M)
    largest_m_s = check_number(goal.max_translation_speed, "max_translation_speed (m/s)", is_positive=True)
    return LawMotion(
        robot,
        Distance(robot.odometry, distance_m, largest_m_s),
        lambda kind, law: kind(remaining_travel_distance=law.remaining.distance_m),
    )


def _drive_arc(goal: Any, robot: ProfileRobot) -> LawMotion:
    from thymio_sim_ros.ros.interface.command_checks import CommandError

    angle_rad = check_number(goal.angle, "angle (rad)", most=MOST_RAD)
    radius_m = check_number(goal.radius, "radius (m)", most=MOST_M)
    if radius_m < 0.0:
        raise CommandError(f"radius (m) is {radius_m:g}, expected at least 0: the sign of the angle is the side")
    if goal.translate_direction not in (1, -1):
        raise CommandError(f"translate_direction is {goal.translate_direction}, expected 1 (forward) or -1 (backward)")
    largest_m_s = check_number(goal.max_translation_speed, "max_translation_speed (m/s)", is_positive=True)
    return LawMotion(
        robot,
        Arc(robot.odometry, angle_rad, radius_m, backward=goal.translate_direction < 0, largest_m_s=largest_m_s),
        lambda kind, law: kind(remaining_angle_travel=law.remaining.angle_rad),
    )


def _navigate(goal: Any, robot: ProfileRobot) -> LawMotion:
    largest_m_s = check_number(goal.max_translation_speed, "max_translation_speed (m/s)", is_positive=True)
    largest_rad_s = check_number(goal.max_rotation_speed, "max_rotation_speed (rad/s)", is_positive=True)
    law = ToPose(
        robot.odometry,
        pose_by_odometry(goal.goal_pose, robot),
        with_heading=bool(goal.achieve_goal_heading),
        largest_m_s=largest_m_s,
        largest_rad_s=largest_rad_s,
    )
    return LawMotion(
        robot,
        law,
        lambda kind, law: kind(
            navigate_state=law.part,
            remaining_angle_travel=law.remaining.angle_rad,
            remaining_travel_distance=law.remaining.distance_m,
        ),
    )


def pose_by_odometry(message: Any, robot: ProfileRobot) -> Pose:
    """Return a PoseStamped as a pose by odometry.

    Its frame may be that of the odometry (or empty), of the robot, or of the world. Raises CommandError for another
    frame, and for values that are not finite or far away.
    """
    from thymio_sim_ros.ros.interface.command_checks import CommandError
    from thymio_sim_ros.ros.interface.convert_readings import yaw_of
    from thymio_sim_ros.ros.interface.names import MAP_FRAME

    place, frame, names = message.pose, message.header.frame_id, robot.names
    x_m = check_number(place.position.x, "goal_pose: position.x (m)", most=MOST_M)
    y_m = check_number(place.position.y, "goal_pose: position.y (m)", most=MOST_M)
    yaw_rad = check_number(yaw_of(place.orientation), "goal_pose: yaw (rad)")
    goal = Pose(x_m, y_m, yaw_rad)
    if frame in ("", names.frame("odom")):
        return goal
    if frame == names.frame("base_link"):
        return _placed(robot.odometry, goal)
    if frame == names.frame(MAP_FRAME):
        return _placed(robot.odometry, _seen_from(robot.pose, goal))
    known = " or ".join(names.frame(word) for word in ("odom", "base_link", MAP_FRAME))
    raise CommandError(f"goal_pose: found frame '{frame}', expected {known}")


def _placed(frame: Pose, pose: Pose) -> Pose:
    """A pose in a frame as a pose in the frame of that frame."""
    return Pose(*frame.place((pose.x_m, pose.y_m)), wrap_angle(frame.yaw_rad + pose.yaw_rad))


def _seen_from(frame: Pose, pose: Pose) -> Pose:
    """A pose as a pose in a frame, both given in the same one."""
    dx, dy = pose.x_m - frame.x_m, pose.y_m - frame.y_m
    cos, sin = math.cos(frame.yaw_rad), math.sin(frame.yaw_rad)
    return Pose(cos * dx + sin * dy, cos * dy - sin * dx, wrap_angle(pose.yaw_rad - frame.yaw_rad))


_LIMITS = f"speeds above {MAX_SPEED_M_S:g} m/s and {MAX_TURN_RAD_S:.2g} rad/s are limited to these"

OWN_ACTIONS = (
    ActionRow(
        "rotate_angle",
        "irobot_create_msgs/action/RotateAngle",
        _rotate,
        f"turn on the spot by an angle in rad, counter-clockwise if positive; {_LIMITS}",
    ),
    ActionRow(
        "drive_distance",
        "irobot_create_msgs/action/DriveDistance",
        _drive,
        "drive a distance in m straight ahead, backward if negative",
    ),
    ActionRow(
        "navigate_to_position",
        "irobot_create_msgs/action/NavigateToPosition",
        _navigate,
        "turn to a position, drive there in a straight line, and turn to the heading if `achieve_goal_heading`; the"
        " frame is `odom` (or empty), `map` or `base_link`",
    ),
)
"""The actions of every robot."""

DRIVE_ARC = ActionRow(
    "drive_arc", "irobot_create_msgs/action/DriveArc", _drive_arc, "drive an arc of a radius in m and an angle in rad"
)

PLAIN = Profile("", "a robot as it is", actions=OWN_ACTIONS, is_optional=True)
"""The profile of robots without one."""
