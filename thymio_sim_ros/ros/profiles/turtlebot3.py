"""TurtleBot3, the robot of many courses with a laser scanner: a Thymio with a lidar is the robot.

Names, types, frames and joints are those of a TurtleBot3 Burger. The field has nine columns, as its usual simulation.
A velocity is valid until the next one, and clamped on its curve: a Thymio is slower, 0.166 m/s in place of 0.22.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.ros.profiles import InputRow, Missing, Profile, ProfileRobot, ProfileWorld, ServiceRow, TopicRow
from thymio_sim_ros.ros.profiles._actions import OWN_ACTIONS
from thymio_sim_ros.ros.profiles._body import battery, drive, imu, too_fast
from thymio_sim_ros.sim.commands import BodyTwist, Command, PlaySystemSound, SetOdometry, StopSound
from thymio_sim_ros.sim.model.lidar import Lidar

if TYPE_CHECKING:
    from thymio_sim_ros.ros.interface.robot_inputs import InputContext
    from thymio_sim_ros.sim.model.readings import BatteryReading, MotorReading, PoseReading

_ENCODER_STEPS = 4096
"""Steps of an encoder for each turn of its wheel."""
_SOUNDS = {1: 0, 2: 5, 3: 5, 4: 1, 5: 1}
"""System sounds of the robot for the numbers of `turtlebot3_msgs/srv/Sound`; 0 is silence."""


def _imu(kind: Any, reading: PoseReading, robot: ProfileRobot) -> Any:
    return imu("imu_link", reading, robot, kind)


def _battery(_kind: Any, reading: BatteryReading, robot: ProfileRobot) -> Any:
    return battery("", reading, robot)


def _sensor_state(kind: Any, reading: MotorReading, robot: ProfileRobot) -> Any:
    from thymio_sim_ros.ros.interface.headers import stamped
    from thymio_sim_ros.sim.stimuli.battery import BatteryState

    left, right = (round(angle / math.tau * _ENCODER_STEPS) for angle in reading.angles_rad)
    message = kind(
        bumper=int(robot.is_touching),
        torque=True,
        left_encoder=left,
        right_encoder=right,
        battery=robot.state(BatteryState).volts,
    )
    return stamped(message, reading.stamp_ns, "")


def _stamped(message: Any, context: InputContext, robot: ProfileRobot) -> Sequence[Command]:
    return drive(message.twist, context, robot)


def _too_fast(message: Any) -> str:
    return too_fast(message.twist)


def _sound(request: Any, response: Any, robot: ProfileRobot) -> None:
    if request.value and request.value not in _SOUNDS:
        response.message = f"value is {request.value}, expected 0 to {max(_SOUNDS)}"
        raise ValueError(response.message)
    robot.post(PlaySystemSound(_SOUNDS[request.value]) if request.value else StopSound())
    response.success = True


def _motor_power(request: Any, response: Any, robot: ProfileRobot) -> None:
    if not request.data:
        robot.post(BodyTwist(0.0, 0.0))
    response.success = True
    response.message = "motors are on" if request.data else "wheels stand still until the next velocity"


def _reset_odometry(_request: Any, response: Any, robot: ProfileRobot) -> None:
    robot.post(SetOdometry(0.0, 0.0, 0.0))
    response.success = True
    response.message = "the odometry begins anew"


def _reset(_request: Any, _response: Any, world: ProfileWorld) -> None:
    world.reset()


_NO_MAP = "start a mapping or navigation node of your own; thymio-sim --ros-args -p publish_map:=true publishes /map"

_OF_CAMERA = ("image_raw", "image_raw/compressed", "image", "image/compressed", "camera_info", "points")
_OF_NAV2 = (
    "navigate_to_pose", "navigate_through_poses", "follow_waypoints", "compute_path_to_pose", "spin", "backup",
    "goal_pose", "initialpose", "amcl_pose", "plan", "particle_cloud", "reinitialize_global_localization",
    "global_costmap/costmap", "local_costmap/costmap",
)  # fmt: skip
_OF_GAZEBO = {
    "/spawn_entity": "use thymio-sim --playground, or /simulator/spawn",
    "/delete_entity": "use /simulator/remove",
    "/pause_physics": "call /simulator/pause with data: true",
    "/unpause_physics": "call /simulator/pause with data: false",
    "/set_entity_state /gazebo/set_entity_state": "place robots by /simulator/set_poses",
    "/get_entity_state /gazebo/get_entity_state /model_states /gazebo/model_states": "use /simulator/get_poses",
}

PROFILE = Profile(
    "turtlebot3",
    "a TurtleBot3 with /scan, /imu and its frames, among nine columns",
    playground="turtlebot3",
    program="none",
    parameters={
        "cmd_vel_timeout": 0.0,
        "robot_frame": "base_footprint",
        "left_wheel_joint": "wheel_left_joint",
        "right_wheel_joint": "wheel_right_joint",
    },
    lidar=Lidar(),
    frames=("imu_link",),
    replaces=frozenset({"imu"}),
    topics=(
        TopicRow("imu", "sensor_msgs/msg/Imu", "pose", _imu, "orientation (yaw 0 at the start), rates, accelerations"),
        TopicRow(
            "battery_state", "sensor_msgs/msg/BatteryState", "battery", _battery, "V, charge 0…1, charging or not"
        ),
        TopicRow(
            "sensor_state",
            "turtlebot3_msgs/msg/SensorState",
            "motor",
            _sensor_state,
            "bumper 1 while it touches something, wheel encoders of 4096 steps, V; the rest is 0",
            every_ns=50_000_000,
        ),
    ),
    inputs=(
        InputRow(
            "cmd_vel",
            "geometry_msgs/msg/TwistStamped",
            _stamped,
            "as Twist; both types are there, since TurtleBot3 has this one since ROS 2 Jazzy",
            limit_check=_too_fast,
            is_second=True,
        ),
    ),
    services=(
        ServiceRow("sound", "turtlebot3_msgs/srv/Sound", _sound, "play a sound of the robot, 0…5"),
        ServiceRow("motor_power", "std_srvs/srv/SetBool", _motor_power, "stop the wheels"),
        ServiceRow("reset", "std_srvs/srv/Trigger", _reset_odometry, "let the odometry begin anew"),
        ServiceRow("/reset_simulation", "std_srvs/srv/Empty", _reset, "begin anew, with time 0", is_of_world=True),
        ServiceRow("/reset_world", "std_srvs/srv/Empty", _reset, "begin anew, with time 0", is_of_world=True),
    ),
    actions=OWN_ACTIONS,
    missing=(
        Missing("magnetic_field", "The simulated robot has no magnetometer: use the orientation of imu."),
        *(Missing(name, "The simulated robot has no camera.") for name in _OF_CAMERA),
        *(
            Missing(name, "This node of a TurtleBot3 does not exist here; /simulator has parameters.")
            for name in (
                "turtlebot3_node/",
                "diff_drive_controller/",
                "robot_state_publisher/",
                "turtlebot3_diff_drive/",
            )
        ),
        Missing("/map", f"There is no SLAM in the simulator: {_NO_MAP}"),
        *(Missing(name, "Nav2 does not run here: use navigate_to_position, or start Nav2.") for name in _OF_NAV2),
        *(
            Missing(name, f"Gazebo does not run here: {instead}.")
            for words, instead in _OF_GAZEBO.items()
            for name in words.split()
        ),
    ),
)
