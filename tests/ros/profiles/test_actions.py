"""The actions of every robot: turn, drive, go to a pose; how goals are rejected, canceled, replaced and blocked."""

from __future__ import annotations

import json
import math

import pytest
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, Twist, Vector3
from rcl_interfaces.msg import Log
from rclpy.action import ActionClient

from tests import ros_graph
from tests.ros.rclpy_ext.test_connections import beaten
from thymio_sim_ros.engine.replay import last_run
from thymio_sim_ros.ros.interface.convert_readings import quaternion, yaw_of
from thymio_sim_ros.sim.commands import Lift, MotorTargets
from thymio_sim_ros.sim.model.geometry import Pose, wrap_angle

pytestmark = ros_graph.needs_package("irobot_create_msgs")

actions = ros_graph.module("irobot_create_msgs.action")
DriveDistance, NavigateToPosition, RotateAngle = (
    actions.DriveDistance,
    actions.NavigateToPosition,
    actions.RotateAngle,
)
NAMES = {RotateAngle: "rotate_angle", DriveDistance: "drive_distance", NavigateToPosition: "navigate_to_position"}

WALL_AHEAD = json.dumps(
    {
        "format": 1,
        "title": "Wall ahead",
        "shapes": [
            {"kind": "rectangle", "name": "ground", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
            {"kind": "box", "name": "wall", "x_m": 0.4, "y_m": 0.0, "size_x_m": 0.1, "size_y_m": 1.0,
             "height_m": 0.1, "color": "#ff0000"},
        ],
        "robots": [{"name": "thymio", "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0}],
    }
)  # fmt: skip


class Goals:
    """Sends goals to a robot of a stepped world."""

    def __init__(self, ros, sim, robot=""):
        self.ros, self.sim = ros, sim
        self.prefix = f"/{robot}/" if robot else "/"
        self.clients = {}
        self.feedback = []

    def send(self, kind, **fields):
        """The client's handle of a goal, once it is answered."""
        if kind not in self.clients:
            self.clients[kind] = ActionClient(self.ros.node, kind, self.prefix + NAMES[kind])
            self.ros.until(self.clients[kind].server_is_ready)
        answered = self.clients[kind].send_goal_async(
            kind.Goal(**fields), lambda message: self.feedback.append(message.feedback)
        )
        return self.sim.until(lambda: answered.done() and answered).result()

    def result(self, handle, seconds=60.0):
        """Status and result of a goal, once it has ended."""
        ended = handle.get_result_async()
        done = self.sim.until(lambda: ended.done() and ended, seconds=seconds).result()
        return done.status, done.result


@pytest.fixture
def goals(ros):
    made = []

    def make(sim, robot=""):
        made.append(Goals(ros, sim, robot))
        return made[-1]

    yield make
    for one in made:
        for client in one.clients.values():
            client.destroy()


def pose(x, y, yaw=0.0, frame=""):
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y = x, y
    message.pose.orientation = quaternion(yaw)
    return message


def reasons(ros):
    """The texts of all warnings that come from now on."""
    return ros.collect(Log, "/rosout", where=lambda message: message.level == 30)


def test_a_robot_turns_by_an_angle_and_says_what_remains(ros, simulation, goals):
    sim = simulation()
    send = goals(sim)
    status, result = send.result(send.send(RotateAngle, angle=-math.pi / 2))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert result.pose.header.frame_id == "odom"
    assert yaw_of(result.pose.pose.orientation) == pytest.approx(-math.pi / 2, abs=0.01)
    left = [one.remaining_angle_travel for one in send.feedback]
    assert len(left) >= 5
    assert left == sorted(left)
    assert left[0] < -1.2
    assert left[-1] > -0.4


@pytest.mark.parametrize("distance", [0.3, -0.2])
def test_a_robot_drives_a_distance_and_stands_still(simulation, goals, distance):
    sim = simulation(noise=False)
    send = goals(sim)
    status, result = send.result(send.send(DriveDistance, distance=distance, max_translation_speed=0.1))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert result.pose.pose.position.x == pytest.approx(distance, abs=0.002)
    before = sim.world.robots["thymio"].pose
    sim.step(1.0)
    assert sim.world.robots["thymio"].pose == before


@pytest.mark.parametrize("frame", ["", "odom", "map", "base_link"])
def test_a_robot_goes_to_a_pose_in_each_frame(simulation, goals, frame):
    sim = simulation(noise=False, playground="base")
    robot = sim.world.robots["thymio"]
    send = goals(sim)
    send.result(send.send(RotateAngle, angle=0.7))
    start = robot.pose
    goal = {"map": pose(start.x_m + 0.2, start.y_m + 0.1, 2.0, "map")}.get(frame, pose(0.2, 0.1, 2.0, frame))
    handle = send.send(NavigateToPosition, goal_pose=goal, achieve_goal_heading=True)
    status, result = send.result(handle)
    assert status == GoalStatus.STATUS_SUCCEEDED
    if frame == "map":
        place = robot.pose.x_m - start.x_m, robot.pose.y_m - start.y_m, robot.pose.yaw_rad
    else:
        found = result.pose.pose
        place = found.position.x, found.position.y, yaw_of(found.orientation)
    ahead = (*Pose(0.0, 0.0, 0.7).place((0.2, 0.1)), 2.7)
    expected = ahead if frame == "base_link" else (0.2, 0.1, 2.0)
    assert place[:2] == pytest.approx(expected[:2], abs=0.004)
    assert wrap_angle(place[2] - expected[2]) == pytest.approx(0.0, abs=0.02)
    assert {one.navigate_state for one in send.feedback if hasattr(one, "navigate_state")} == {1, 2, 3}


@pytest.mark.parametrize(
    ("kind", "fields", "reason"),
    [
        (RotateAngle, {"angle": math.nan}, "angle (rad) is nan, expected a finite number"),
        (RotateAngle, {"angle": 9000.0}, "angle (rad) is 9000, expected at most 628.319"),
        (RotateAngle, {"angle": 1.0, "max_rotation_speed": 0.0}, "max_rotation_speed (rad/s) is 0, expected a number"),
        (DriveDistance, {"distance": math.inf}, "distance (m) is inf, expected a finite number"),
        (DriveDistance, {"distance": 500.0}, "distance (m) is 500, expected at most 100"),
        (DriveDistance, {"distance": 1.0, "max_translation_speed": -0.1}, "max_translation_speed (m/s) is -0.1"),
        (NavigateToPosition, {"goal_pose": pose(math.nan, 0.0)}, "goal_pose: position.x (m) is nan"),
        (
            NavigateToPosition,
            {"goal_pose": pose(0.1, 0.0, 0.0, "mars")},
            "found frame 'mars', expected odom or base_link",
        ),
    ],
)
def test_a_goal_that_makes_no_sense_is_rejected_with_the_reason(ros, simulation, goals, kind, fields, reason):
    sim = simulation()
    logged = reasons(ros)
    assert not goals(sim).send(kind, **fields).accepted
    sim.until(lambda: any(reason in one.msg and f"/{NAMES[kind]}" in one.msg for one in logged))


def test_a_robot_in_a_hand_takes_no_goal_and_loses_the_one_that_it_has(ros, simulation, goals):
    sim = simulation()
    send, logged = goals(sim), reasons(ros)
    handle = send.send(DriveDistance, distance=0.5)
    sim.step(0.2)
    sim.engine.post("thymio", Lift(is_lifted=True))
    assert send.result(handle)[0] == GoalStatus.STATUS_ABORTED
    sim.until(lambda: any("the robot was lifted" in one.msg for one in logged))
    assert not send.send(DriveDistance, distance=0.5).accepted


def test_a_wall_ends_a_goal_with_its_name(ros, simulation, goals):
    sim = simulation(playground=WALL_AHEAD)
    send, logged = goals(sim), reasons(ros)
    status, result = send.result(send.send(DriveDistance, distance=2.0), seconds=8.0)
    assert status == GoalStatus.STATUS_ABORTED
    assert result.pose.pose.position.x == pytest.approx(0.27, abs=0.01)
    sim.until(lambda: any("blocked by 'wall'" in one.msg for one in logged))
    assert send.result(send.send(DriveDistance, distance=-0.1))[0] == GoalStatus.STATUS_SUCCEEDED


def test_a_fall_ends_a_goal(simulation, goals):
    sim = simulation(playground="borderless")
    send = goals(sim)
    assert send.result(send.send(DriveDistance, distance=5.0))[0] == GoalStatus.STATUS_ABORTED
    assert not send.send(RotateAngle, angle=1.0).accepted


def test_a_goal_that_is_canceled_stops_the_robot(simulation, goals):
    sim = simulation()
    send = goals(sim)
    handle = send.send(RotateAngle, angle=50.0)
    sim.step(0.5)
    canceled = handle.cancel_goal_async()
    sim.until(canceled.done)
    assert send.result(handle)[0] == GoalStatus.STATUS_CANCELED
    sim.step(0.1)
    assert sim.world.robots["thymio"].twist.angular_rad_s == 0.0


def test_a_new_goal_of_any_action_replaces_the_old_one(simulation, goals):
    sim = simulation()
    send = goals(sim)
    first = send.send(RotateAngle, angle=50.0)
    sim.step(0.5)
    second = send.send(DriveDistance, distance=0.1)
    assert send.result(first)[0] == GoalStatus.STATUS_ABORTED
    assert send.result(second)[0] == GoalStatus.STATUS_SUCCEEDED


def test_another_command_ends_a_goal_and_is_followed(ros, simulation, goals):
    sim = simulation(cmd_vel_timeout=0.0)
    send, logged = goals(sim), reasons(ros)
    handle = send.send(DriveDistance, distance=0.5)
    sim.step(0.5)
    ros.publisher(Twist, "/cmd_vel").publish(Twist(angular=Vector3(z=1.0)))
    assert send.result(handle)[0] == GoalStatus.STATUS_ABORTED
    sim.until(lambda: any("another command drives the wheels" in one.msg for one in logged))
    sim.step(0.2)
    assert sim.world.robots["thymio"].twist.angular_rad_s == pytest.approx(1.0, abs=0.1)


def test_after_a_goal_the_program_drives_again(simulation, goals):
    sim = simulation(noise=False)
    sim.engine.post("thymio", MotorTargets(50, 50))
    sim.step(0.1)
    send = goals(sim)
    assert send.result(send.send(RotateAngle, angle=1.0))[0] == GoalStatus.STATUS_SUCCEEDED
    sim.step(0.2)
    assert sim.world.robots["thymio"].twist.linear_m_s == pytest.approx(0.0166, abs=0.001)


def test_each_robot_has_its_own_goal(simulation, goals):
    sim = simulation(playground="two_robots")
    first, second = (names.name for names in sim.simulator.endpoints.robots.names.values())
    one, other = goals(sim, first), goals(sim, second)
    turning, driving = one.send(RotateAngle, angle=1.0), other.send(DriveDistance, distance=0.1)
    assert one.result(turning)[0] == other.result(driving)[0] == GoalStatus.STATUS_SUCCEEDED


def test_a_reset_of_the_world_ends_a_goal(simulation, goals):
    sim = simulation()
    send = goals(sim)
    handle = send.send(DriveDistance, distance=0.5)
    sim.step(0.2)
    sim.reset()
    assert send.result(handle)[0] == GoalStatus.STATUS_ABORTED


def test_a_run_with_goals_is_repeated_from_its_log(simulation, goals, tmp_path):
    log = tmp_path / "run.jsonl"
    sim = simulation(seed=4, log=str(log))
    send = goals(sim)
    handle = send.send(NavigateToPosition, goal_pose=pose(0.2, 0.15, 1.0), achieve_goal_heading=True)
    assert send.result(handle)[0] == GoalStatus.STATUS_SUCCEEDED
    digest, tick = sim.engine.digest(), sim.engine.tick
    sim.simulator.stop()
    repeated = last_run(log)
    engine = repeated.new_engine()
    while engine.tick < tick:
        repeated.repeat_inputs(engine)
        engine.step(())
    assert engine.digest() == digest


def test_an_action_client_with_another_name_is_reported(ros, simulation, goals):
    sim = simulation()
    client = ActionClient(ros.node, DriveDistance, "/bot/drive_distance")
    ros.until(lambda: beaten(sim.simulator))
    (one,) = beaten(sim.simulator)
    assert str(one).startswith(
        "/bot/drive_distance has an action client of irobot_create_msgs/action/DriveDistance by node"
    )
    assert "Send goals to /drive_distance, or start the simulator with" in str(one)
    assert "'robot_names:=[bot]'" in str(one)
    client.destroy()
    client = ActionClient(ros.node, DriveDistance, "/drive_distance")
    ros.until(lambda: not beaten(sim.simulator))
    client.destroy()
