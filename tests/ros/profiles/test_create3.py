"""`--like create3` on a stepped world: hazards, intensities, buttons, lights, notes, services and actions."""

from __future__ import annotations

import json
import math

import pytest
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import PoseStamped, Twist, Vector3
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient
from rclpy.qos import QoSProfile, ReliabilityPolicy

from tests import ros_graph
from tests.ros.profiles.test_actions import WALL_AHEAD, pose
from thymio_sim_ros.ros.interface.convert_readings import yaw_of
from thymio_sim_ros.sim.actuators.loudspeaker import LoudspeakerState
from thymio_sim_ros.sim.commands import BodyTwist, Lift, MoveRobot, PressButton
from thymio_sim_ros.sim.model.geometry import wrap_angle

pytestmark = ros_graph.needs_package("irobot_create_msgs")

action, msg, srv = (ros_graph.module(f"irobot_create_msgs.{kind}") for kind in ("action", "msg", "srv"))

BUMP, CLIFF, WHEEL_DROP = 1, 2, 4

EDGE_AHEAD = json.dumps(
    {
        "format": 1,
        "title": "An edge ahead",
        "shapes": [{"kind": "rectangle", "name": "ground", "size_x_m": 1.0, "size_y_m": 1.0, "color": "#ffffff"}],
        "robots": [{"name": "thymio", "x_m": 0.35, "y_m": 0.0, "yaw_rad": 0.0}],
    }
)


@pytest.fixture
def sim(simulation):
    return simulation(like="create3", noise=False, playground=WALL_AHEAD)


@pytest.fixture
def act(ros, sim):
    """Send a goal and step until it has ended; returns whether it was accepted, its status, result and feedback."""
    clients = []

    def act(kind, name, /, seconds=60.0, **fields):
        client = ActionClient(ros.node, kind, name)
        clients.append(client)
        ros.until(client.server_is_ready)
        feedback = []
        sent = client.send_goal_async(kind.Goal(**fields), lambda message: feedback.append(message.feedback))
        handle = sim.until(lambda: sent.done() and sent).result()
        if not handle.accepted:
            return False, None, None, feedback
        ended = handle.get_result_async()
        done = sim.until(lambda: ended.done() and ended, seconds=seconds).result()
        return True, done.status, done.result, feedback

    yield act
    for client in clients:
        client.destroy()


@pytest.fixture
def call(ros, sim):
    def call(kind, name, /, **fields):
        client = ros.node.create_client(kind, name)
        ros.until(client.service_is_ready)
        answered = client.call_async(kind.Request(**fields))
        return sim.until(lambda: answered.done() and answered).result()

    return call


def detections(message):
    return {(one.type, one.header.frame_id) for one in message.detections}


@pytest.mark.parametrize("reliability", [ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT])
def test_velocities_of_either_reliability_drive_the_robot(ros, sim, reliability):
    publisher = ros.node.create_publisher(Twist, "/cmd_vel", QoSProfile(depth=1, reliability=reliability))
    ros.until(publisher.get_subscription_count)
    publisher.publish(Twist(linear=Vector3(x=0.1)))
    sim.until(lambda: sim.world.robots["thymio"].twist.linear_m_s > 0.05)


def test_a_bump_is_detected_where_the_robot_touches(ros, sim):
    hazards = ros.collect(msg.HazardDetectionVector, "/hazard_detection")
    sim.step(0.5)
    assert len(hazards) == pytest.approx(25, abs=2)
    assert detections(hazards[-1]) == set()
    sim.engine.post("thymio", BodyTwist(0.1, 0.0))
    sim.until(lambda: (BUMP, "bump_front_center") in detections(hazards[-1]), seconds=5.0)
    sim.engine.post("thymio", MoveRobot(0.2, 0.0, math.pi / 4))
    sim.engine.post("thymio", BodyTwist(0.1, 0.0))
    sim.until(lambda: (BUMP, "bump_right") in detections(hazards[-1]), seconds=5.0)


def test_a_robot_in_a_hand_has_dropped_wheels_and_is_kidnapped(ros, sim):
    hazards, kidnapped = (
        ros.collect(msg.HazardDetectionVector, "/hazard_detection"),
        ros.collect(msg.KidnapStatus, "/kidnap_status"),
    )
    sim.engine.post("thymio", Lift(is_lifted=True))
    sim.step(0.2)
    assert detections(hazards[-1]) == {(WHEEL_DROP, "wheel_drop_left"), (WHEEL_DROP, "wheel_drop_right")}
    assert kidnapped[-1].is_kidnapped


def test_an_edge_is_a_cliff(ros, simulation):
    sim = simulation(like="create3", playground=EDGE_AHEAD)
    hazards = ros.collect(msg.HazardDetectionVector, "/hazard_detection")
    sim.step(0.3)
    assert detections(hazards[-1]) == set()
    sim.engine.post("thymio", BodyTwist(0.05, 0.0))
    sim.until(lambda: {kind for kind, _ in detections(hazards[-1])} == {CLIFF}, seconds=5.0)


def test_intensities_grow_towards_a_wall(ros, sim):
    found = ros.collect(msg.IrIntensityVector, "/ir_intensity")
    sim.step(0.3)
    places = [one.header.frame_id for one in found[-1].readings]
    assert places[0] == "ir_intensity_side_left"
    assert len(places) == 7
    assert [one.value for one in found[-1].readings] == [0] * 7
    sim.engine.post("thymio", MoveRobot(0.23, 0.0, 0.0))
    sim.step(0.3)
    values = {one.header.frame_id: one.value for one in found[-1].readings}
    assert values["ir_intensity_front_center_left"] == values["ir_intensity_front_center_right"] > 3000


def test_buttons_are_pressed_for_a_time(ros, sim):
    found = ros.collect(msg.InterfaceButtons, "/interface_buttons")
    sim.step(0.1)
    sim.engine.post("thymio", PressButton("left", True))
    sim.step(0.5)
    assert (found[-1].button_1.is_pressed, found[-1].button_2.is_pressed) == (True, False)
    sim.engine.post("thymio", PressButton("left", False))
    sim.step(0.1)
    lasted = found[-1].button_1.last_pressed_duration
    assert not found[-1].button_1.is_pressed
    assert lasted.sec + lasted.nanosec * 1e-9 == pytest.approx(0.5, abs=0.03)


def test_wheels_say_how_they_turn(ros, sim):
    speeds, stopped = ros.collect(msg.WheelVels, "/wheel_vels"), ros.collect(msg.StopStatus, "/stop_status")
    sim.step(0.1)
    assert stopped[-1].is_stopped
    sim.engine.post("thymio", BodyTwist(0.066, 0.0))
    sim.step(0.2)
    assert (speeds[-1].velocity_left, speeds[-1].velocity_right) == pytest.approx((3.0, 3.0))
    assert not stopped[-1].is_stopped


def test_the_ring_of_lights_is_the_body_of_a_thymio(ros, sim):
    red, blue, black = msg.LedColor(red=255), msg.LedColor(blue=255), msg.LedColor()
    publisher = ros.publisher(msg.LightringLeds, "/cmd_lightring")
    publisher.publish(msg.LightringLeds(override_system=True, leds=[blue, blue, black, red, red, black]))
    sim.step(0.1)
    lights = dict(sim.world.robots["thymio"].snapshot().leds)
    assert (lights["bottom_left"], lights["bottom_right"], lights["top"]) == ((32, 0, 0), (0, 0, 32), (0, 0, 0))
    publisher.publish(msg.LightringLeds(override_system=False))
    sim.step(0.1)
    lights = dict(sim.world.robots["thymio"].snapshot().leds)
    assert lights["bottom_left"] == (0, 0, 0)


def note(frequency, seconds):
    return msg.AudioNote(frequency=frequency, max_runtime=Duration(nanosec=round(seconds * 1e9)))


def test_notes_are_played_one_after_the_other_and_can_be_appended(ros, sim):
    speaker = sim.world.robots["thymio"].state(LoudspeakerState)
    heard = []

    def listen(seconds):
        for _ in range(round(seconds * 100)):
            sim.tick()
            frequency = 0 if speaker.note is None else round(speaker.note.frequency_hz)
            if not heard or heard[-1] != frequency:
                heard.append(frequency)

    publisher = ros.publisher(msg.AudioNoteVector, "/cmd_audio")
    publisher.publish(msg.AudioNoteVector(notes=[note(440, 0.1), note(0, 0.1), note(880, 0.1)]))
    listen(0.15)
    publisher.publish(msg.AudioNoteVector(notes=[note(660, 0.1)], append=True))
    listen(0.5)
    assert [frequency for frequency in heard if frequency] == [440, 880, 660]
    publisher.publish(msg.AudioNoteVector(notes=[note(440, 0.9)]))
    listen(0.1)
    publisher.publish(msg.AudioNoteVector())
    listen(0.1)
    assert heard[-1] == 0


def test_the_odometry_is_set_and_an_emergency_stop_stops(ros, sim, call):
    odometry = ros.collect(Odometry, "/odom")
    goal = PoseStamped().pose
    goal.position.x, goal.position.y = 1.0, -2.0
    call(srv.ResetPose, "/reset_pose", pose=goal)
    sim.step(0.2)
    assert (odometry[-1].pose.pose.position.x, odometry[-1].pose.pose.position.y) == (1.0, -2.0)
    sim.engine.post("thymio", BodyTwist(0.1, 0.0))
    sim.step(0.1)
    assert call(srv.EStop, "/e_stop", e_stop_on=True).success
    sim.step(0.1)
    assert sim.world.robots["thymio"].twist.linear_m_s == 0.0


def test_turns_drives_and_poses(sim, act):
    robot = sim.world.robots["thymio"]
    assert act(action.Undock, "/undock")[1:3] == (GoalStatus.STATUS_SUCCEEDED, action.Undock.Result(is_docked=False))
    assert act(action.RotateAngle, "/rotate_angle", angle=math.pi / 2)[1] == GoalStatus.STATUS_SUCCEEDED
    assert act(action.DriveDistance, "/drive_distance", distance=0.2)[1] == GoalStatus.STATUS_SUCCEEDED
    assert (robot.pose.x_m, robot.pose.y_m) == pytest.approx((0.0, 0.2), abs=0.005)
    accepted, status, result, feedback = act(
        action.DriveArc, "/drive_arc", angle=-math.pi / 2, radius=0.1, translate_direction=1
    )
    assert (accepted, status) == (True, GoalStatus.STATUS_SUCCEEDED)
    assert (robot.pose.x_m, robot.pose.y_m) == pytest.approx((0.1, 0.3), abs=0.01)
    assert yaw_of(result.pose.pose.orientation) == pytest.approx(0.0, abs=0.02)
    assert feedback[0].remaining_angle_travel < -1.0
    status = act(
        action.NavigateToPosition, "/navigate_to_position", goal_pose=pose(0.0, 0.0), achieve_goal_heading=True
    )
    assert status[1] == GoalStatus.STATUS_SUCCEEDED
    assert wrap_angle(robot.pose.yaw_rad) == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize(
    ("kind", "name", "fields"),
    [
        (action.Dock, "/dock", {}),
        (action.DriveArc, "/drive_arc", {"angle": 1.0, "radius": math.nan, "translate_direction": 1}),
        (action.DriveArc, "/drive_arc", {"angle": 1.0, "radius": -0.1, "translate_direction": 1}),
        (action.DriveArc, "/drive_arc", {"angle": 1.0, "radius": 0.1}),
        (action.WallFollow, "/wall_follow", {"follow_side": 0, "max_runtime": Duration(sec=1)}),
        (action.WallFollow, "/wall_follow", {"follow_side": 1}),
        (action.AudioNoteSequence, "/audio_note_sequence", {}),
        (action.LedAnimation, "/led_animation", {"animation_type": 1}),
        (action.LedAnimation, "/led_animation", {"max_runtime": Duration(sec=1)}),
    ],
)
def test_goals_that_make_no_sense_are_rejected(sim, act, kind, name, fields):
    assert not act(kind, name, **fields)[0]


@pytest.mark.parametrize("side", [1, -1])
def test_a_wall_is_followed_on_either_side(sim, act, side):
    robot = sim.world.robots["thymio"]
    accepted, status, result, feedback = act(
        action.WallFollow, "/wall_follow", follow_side=side, max_runtime=Duration(sec=8), seconds=20.0
    )
    assert (accepted, status) == (True, GoalStatus.STATUS_SUCCEEDED)
    assert result.runtime.sec == 8
    assert feedback[-1].engaged
    # The wall is across; with the wall on its left the robot has turned right, towards negative y.
    assert side * robot.pose.y_m < -0.15
    assert 0.06 < 0.35 - robot.pose.x_m < 0.12


def test_a_melody_is_played_some_times(sim, act):
    sequence = msg.AudioNoteVector(notes=[note(440, 0.2), note(660, 0.3)])
    accepted, status, result, _ = act(
        action.AudioNoteSequence, "/audio_note_sequence", note_sequence=sequence, iterations=3
    )
    assert (accepted, status) == (True, GoalStatus.STATUS_SUCCEEDED)
    assert (result.complete, result.iterations_played) == (True, 3)
    assert result.runtime.sec + result.runtime.nanosec * 1e-9 == pytest.approx(1.5, abs=0.03)


@pytest.mark.parametrize("kind", [1, 2])
def test_lights_are_animated_for_a_time(sim, act, kind):
    ring = msg.LightringLeds(leds=[msg.LedColor(red=255)] + [msg.LedColor()] * 5)
    accepted, status, result, feedback = act(
        action.LedAnimation, "/led_animation", animation_type=kind, lightring=ring, max_runtime=Duration(sec=2)
    )
    assert (accepted, status, result.runtime.sec) == (True, GoalStatus.STATUS_SUCCEEDED, 2)
    assert len(feedback) > 10
    sim.step(0.1)
    assert dict(sim.world.robots["thymio"].snapshot().leds)["bottom_right"] == (0, 0, 0)


def test_places_of_sensors_have_no_prefix_where_robots_have_names(ros, simulation):
    sim = simulation(like="create3", noise=False, playground=WALL_AHEAD, robot_names=["bot"])
    hazards, intensities = (
        ros.collect(msg.HazardDetectionVector, "/bot/hazard_detection"),
        ros.collect(msg.IrIntensityVector, "/bot/ir_intensity"),
    )
    sim.engine.post("bot", MoveRobot(0.26, 0.0, 0.0))
    sim.engine.post("bot", BodyTwist(0.1, 0.0))
    sim.until(lambda: hazards and (BUMP, "bump_front_center") in detections(hazards[-1]), seconds=5.0)
    assert hazards[-1].header.frame_id == "bot/base_link"
    assert intensities[-1].readings[1].header.frame_id == "ir_intensity_left"
