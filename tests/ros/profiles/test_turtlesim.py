"""`--like turtlesim` on a stepped world: topics, services, the action and parameters of the turtle."""

from __future__ import annotations

import math

import pytest
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist, Vector3
from rcl_interfaces.msg import Log
from rclpy.action import ActionClient
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from std_srvs.srv import Empty
from visualization_msgs.msg import MarkerArray

from tests import ros_graph
from thymio_sim_ros.ros.profiles import turtlesim
from thymio_sim_ros.sim.commands import Lift

pytestmark = ros_graph.needs_package("turtlesim")

action, msg, srv = (ros_graph.module(f"turtlesim.{kind}") for kind in ("action", "msg", "srv"))

MIDDLE = 499 / 90
UNIT_M = 0.04


@pytest.fixture
def sim(simulation):
    return simulation(like="turtlesim")


@pytest.fixture
def call(ros, sim):
    """Call a service and step until it is answered."""

    def call(kind, service, /, **fields):
        client = ros.node.create_client(kind, service)
        ros.until(client.service_is_ready)
        answered = client.call_async(kind.Request(**fields))
        return sim.until(lambda: answered.done() and answered).result()

    return call


@pytest.fixture
def goals(ros, sim):
    """Send a goal to turn; returns the client's handle once it is answered, and the feedback."""
    client = ActionClient(ros.node, action.RotateAbsolute, "/turtle1/rotate_absolute")
    feedback = []

    def send(theta):
        ros.until(client.server_is_ready)
        answered = client.send_goal_async(
            action.RotateAbsolute.Goal(theta=theta), lambda message: feedback.append(message.feedback)
        )
        return sim.until(lambda: answered.done() and answered).result()

    yield send, feedback
    client.destroy()


def pose_of(sim, robot="turtle1"):
    """Where a turtle is, in units."""
    pose = sim.world.robots[robot].pose
    return pose.x_m / UNIT_M, pose.y_m / UNIT_M, pose.yaw_rad


def drive(linear, angular=0.0):
    return Twist(linear=Vector3(x=linear), angular=Vector3(z=angular))


def test_names_are_those_of_turtlesim(ros, sim):
    node = ros.node
    topics = dict(node.get_publisher_names_and_types_by_node("turtlesim", "/"))
    assert topics["/turtle1/pose"] == ["turtlesim/msg/Pose"]
    assert topics["/turtle1/color_sensor"] == ["turtlesim/msg/Color"]
    inputs = dict(node.get_subscriber_names_and_types_by_node("turtlesim", "/"))
    assert inputs["/turtle1/cmd_vel"] == ["geometry_msgs/msg/Twist"]
    services = dict(node.get_service_names_and_types_by_node("turtlesim", "/"))
    assert {"/clear", "/kill", "/reset", "/spawn"} <= services.keys()
    assert {f"/turtle1/{word}" for word in ("set_pen", "teleport_absolute", "teleport_relative")} <= services.keys()
    assert node.count_subscribers("/turtle1/cmd_vel") == 1, "the robot's own is replaced"


def test_a_velocity_is_in_units_and_ends_after_a_second(ros, sim):
    poses = ros.collect(msg.Pose, "/turtle1/pose")
    ros.publisher(Twist, "/turtle1/cmd_vel").publish(drive(2.0))
    sim.step(2.0)
    assert (poses[0].x, poses[0].y, poses[0].theta) == pytest.approx((MIDDLE, MIDDLE, 0.0), abs=0.1)
    assert poses[-1].x == pytest.approx(MIDDLE + 2.0, abs=0.1)
    assert max(pose.linear_velocity for pose in poses) == pytest.approx(2.0, rel=0.1)
    assert poses[-1].linear_velocity == pytest.approx(0.0, abs=1e-3)


def test_the_curve_of_the_tutorial_is_not_clamped_and_a_faster_one_keeps_its_radius(ros, sim):
    logged = ros.collect(Log, "/rosout")
    poses = ros.collect(msg.Pose, "/turtle1/pose")
    publisher = ros.publisher(Twist, "/turtle1/cmd_vel")
    publisher.publish(drive(2.0, 1.8))
    sim.step(0.9)
    slow = poses[-1]
    assert not any("same curve" in line.msg for line in logged)
    publisher.publish(drive(20.0, 18.0))
    sim.until(lambda: any("same curve" in line.msg for line in logged))
    sim.step(0.5)
    fast = poses[-1]
    radii = [pose.linear_velocity / pose.angular_velocity for pose in (slow, fast)]
    assert radii == pytest.approx([2.0 / 1.8] * 2, rel=0.05)


def test_the_color_sensor_sees_the_background_and_its_own_line(ros, sim):
    colors = ros.collect(msg.Color, "/turtle1/color_sensor")
    sim.until(lambda: colors)
    assert (colors[0].r, colors[0].g, colors[0].b) in {(69, 86, 255), (179, 184, 255)}
    ros.publisher(Twist, "/turtle1/cmd_vel").publish(drive(1.0))
    sim.step(0.5)
    assert (colors[-1].r, colors[-1].g, colors[-1].b) == (179, 184, 255)


def test_spawn_chooses_a_name_and_a_turtle_has_its_own_topics(ros, sim, call):
    assert call(srv.Spawn, "/spawn", x=2.0, y=2.0, theta=0.2, name="").name == "turtle2"
    assert pose_of(sim, "turtle2") == pytest.approx((2.0, 2.0, 0.2), abs=1e-6)
    ros.publisher(Twist, "/turtle2/cmd_vel").publish(drive(1.0))
    sim.step(0.5)
    assert pose_of(sim, "turtle2")[0] > 2.3
    assert pose_of(sim)[0] == pytest.approx(MIDDLE, abs=0.05)


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"x": math.nan, "y": 1.0}, "/spawn rejected: x is nan, expected a finite number"),
        ({"x": 1.0, "y": 1.0, "name": "turtle1"}, "/spawn rejected: the name 'turtle1' is taken"),
        ({"x": 40.0, "y": 1.0}, "there is no ground"),
        ({"x": 1.0, "y": 1.0, "theta": math.inf}, "/spawn rejected: theta is inf, expected a finite number"),
        ({"x": 1.0, "y": 1.0, "name": "my turtle"}, "/spawn rejected: name: found 'my turtle', expected a ROS name"),
        ({"x": 1.0, "y": 1.0, "name": "törtchen"}, "/spawn rejected: name: found 'törtchen', expected a ROS name"),
        ({"x": 1.0, "y": 1.0, "name": "/a/b"}, "/spawn rejected: name: found '/a/b', expected a ROS name"),
    ],
)
def test_a_turtle_that_cannot_be_is_refused_with_the_reason(ros, sim, call, fields, reason):
    logged = ros.collect(Log, "/rosout")
    assert call(srv.Spawn, "/spawn", **fields).name == ""
    sim.until(lambda: any(reason in line.msg for line in logged))
    assert list(sim.world.robots) == ["turtle1"]


def test_a_turtle_may_be_spawned_with_any_angle(sim, call):
    assert call(srv.Spawn, "/spawn", x=2.0, y=2.0, theta=6.3 + 2 * math.pi, name="dizzy").name == "dizzy"
    assert pose_of(sim, "dizzy")[2] == pytest.approx(6.3 - 2 * math.pi, abs=1e-5)


def test_theta_stays_between_minus_and_plus_pi_while_the_turtle_turns(ros, sim):
    poses = ros.collect(msg.Pose, "/turtle1/pose")
    drive = ros.publisher(Twist, "/turtle1/cmd_vel")
    for _ in range(5):
        drive.publish(Twist(angular=Vector3(z=2.0)))
        sim.step(0.8)
    thetas = [pose.theta for pose in poses]
    assert min(thetas) < -3.0 < 3.0 < max(thetas)
    assert all(abs(theta) <= math.pi + 1e-6 for theta in thetas)


def test_a_clamp_that_cannot_be_seen_is_not_reported(ros, sim):
    logged = ros.collect(Log, "/rosout", where=lambda log: "clamped" in log.msg)
    drive = ros.publisher(Twist, "/turtle1/cmd_vel")
    for fast in (1.801, 3.0):
        drive.publish(Twist(linear=Vector3(x=fast), angular=Vector3(z=2.0)))
        sim.step(0.2)
    sim.until(lambda: logged)
    assert [line.msg for line in logged if "found 3 units/s and 2 rad/s" not in line.msg] == []


def test_turtles_without_end_are_refused(ros, sim, call, monkeypatch):
    monkeypatch.setattr(turtlesim, "MOST_TURTLES", 3)
    logged = ros.collect(Log, "/rosout")
    names = [call(srv.Spawn, "/spawn", x=2.0, y=2.0, theta=0.0, name="").name for _ in range(4)]
    assert names == ["turtle2", "turtle3", "", ""]
    sim.until(lambda: any("/spawn rejected: found 3 turtles, expected at most so many" in line.msg for line in logged))


def test_turtles_drive_through_each_other_as_games_of_catching_need_it(ros, sim, call):
    call(srv.Spawn, "/spawn", x=MIDDLE + 2.0, y=MIDDLE, theta=1.0, name="prey")
    call(srv.Spawn, "/spawn", x=MIDDLE + 2.2, y=MIDDLE, theta=0.0, name="beside")
    assert list(sim.world.robots) == ["turtle1", "prey", "beside"]
    ros.publisher(Twist, "/turtle1/cmd_vel").publish(drive(2.0))
    sim.step(1.5)
    assert pose_of(sim)[0] == pytest.approx(MIDDLE + 2.0, abs=0.1)
    assert pose_of(sim, "prey") == pytest.approx((MIDDLE + 2.0, MIDDLE, 1.0), abs=1e-6)


def test_kill_and_reset(ros, sim, call, runtime):
    runtime()
    call(srv.Spawn, "/spawn", x=2.0, y=2.0, theta=0.0, name="a")
    call(srv.Spawn, "/spawn", x=9.0, y=2.0, theta=0.0, name="b")
    sim.step(0.2)
    call(srv.Kill, "/kill", name="a")
    sim.step(0.2)
    assert list(sim.world.robots) == ["turtle1", "b"]
    logged = ros.collect(Log, "/rosout")
    call(srv.Kill, "/kill", name="a")
    sim.until(lambda: any("found no turtle 'a', expected one of turtle1, b" in line.msg for line in logged))
    call(srv.Kill, "/kill", name="turtle1")
    call(Empty, "/reset")
    sim.step(0.2)
    assert list(sim.world.robots) == ["turtle1"]
    assert pose_of(sim) == pytest.approx((MIDDLE, MIDDLE, 0.0), abs=0.01)
    assert ros.node.count_subscribers("/turtle1/cmd_vel") == 1


def test_teleports_draw_a_line_and_clear_erases_it(ros, sim, call):
    trails = ros.collect(MarkerArray, "/turtle1/_pen/trail", transient_local=True)
    call(srv.TeleportAbsolute, "/turtle1/teleport_absolute", x=2.0, y=MIDDLE, theta=0.0)
    sim.step(0.3)
    assert pose_of(sim) == pytest.approx((2.0, MIDDLE, 0.0), abs=1e-6)
    assert sim.world.color_at(4.0 * UNIT_M, MIDDLE * UNIT_M) == pytest.approx((179 / 255, 184 / 255, 1.0))
    sim.until(lambda: any(marker.points for marker in trails[-1].markers))
    call(srv.TeleportRelative, "/turtle1/teleport_relative", linear=3.0, angular=math.pi / 2)
    sim.step(0.1)
    assert pose_of(sim) == pytest.approx((2.0, MIDDLE + 3.0, math.pi / 2), abs=1e-5)
    call(Empty, "/clear")
    sim.step(0.3)
    assert sim.world.color_at(4.0 * UNIT_M, MIDDLE * UNIT_M) == pytest.approx((69 / 255, 86 / 255, 1.0))
    sim.until(lambda: not any(marker.points for marker in trails[-1].markers))


def test_the_pen_has_color_and_width_and_can_be_off(sim, call):
    call(srv.SetPen, "/turtle1/set_pen", r=255, g=0, b=0, width=10, off=0)
    call(srv.TeleportAbsolute, "/turtle1/teleport_absolute", x=8.0, y=MIDDLE, theta=0.0)
    sim.step(0.05)
    assert sim.world.color_at(7.0 * UNIT_M, MIDDLE * UNIT_M) == (1.0, 0.0, 0.0)
    assert sim.world.color_at(7.0 * UNIT_M, (MIDDLE + 0.1) * UNIT_M) == (1.0, 0.0, 0.0)
    call(srv.SetPen, "/turtle1/set_pen", r=0, g=255, b=0, width=10, off=1)
    call(srv.TeleportAbsolute, "/turtle1/teleport_absolute", x=8.0, y=9.0, theta=0.0)
    sim.step(0.05)
    assert sim.world.color_at(8.0 * UNIT_M, 8.0 * UNIT_M) == pytest.approx((69 / 255, 86 / 255, 1.0))


@pytest.mark.parametrize(
    ("word", "fields", "reason"),
    [
        ("absolute", {"x": math.nan, "y": 1.0}, "x is nan, expected a finite number"),
        ("absolute", {"x": 40.0, "y": 1.0}, "there is no ground; the nearest is 'field'"),
        ("relative", {"linear": -math.inf}, "linear is -inf, expected a finite number"),
        ("relative", {"linear": 1000.0}, "there is no ground; the nearest is 'field'"),
    ],
)
def test_a_teleport_that_cannot_be_changes_nothing(ros, sim, call, word, fields, reason):
    logged = ros.collect(Log, "/rosout")
    call(getattr(srv, f"Teleport{word.title()}"), f"/turtle1/teleport_{word}", **fields)
    rejected = f"/turtle1/teleport_{word} rejected: "
    sim.until(lambda: any(rejected in line.msg and reason in line.msg for line in logged))
    assert pose_of(sim) == pytest.approx((MIDDLE, MIDDLE, 0.0), abs=0.01)


@pytest.mark.parametrize(("linear", "angular"), [(math.nan, 0.0), (1.0, math.inf)])
def test_a_velocity_that_is_no_number_is_rejected(ros, sim, linear, angular):
    logged = ros.collect(Log, "/rosout")
    ros.publisher(Twist, "/turtle1/cmd_vel").publish(drive(linear, angular))
    sim.until(lambda: any("/turtle1/cmd_vel rejected: " in line.msg for line in logged))
    sim.step(0.2)
    assert pose_of(sim) == pytest.approx((MIDDLE, MIDDLE, 0.0), abs=0.01)


def test_a_turtle_that_meets_a_wall_is_reported(ros, sim, call):
    logged = ros.collect(Log, "/rosout")
    call(srv.TeleportAbsolute, "/turtle1/teleport_absolute", x=10.5, y=5.0, theta=0.0)
    ros.publisher(Twist, "/turtle1/cmd_vel").publish(drive(2.0))
    sim.until(lambda: any("turtle1 hit something at x=11" in line.msg for line in logged), 2.0)
    assert [line.name for line in logged if "hit something" in line.msg] == ["turtlesim"]


def test_rotate_absolute_turns_with_feedback_and_a_result(sim, goals):
    send, feedback = goals
    handle = send(1.57)
    assert handle.accepted
    ended = handle.get_result_async()
    sim.until(ended.done, 10.0)
    assert ended.result().status == GoalStatus.STATUS_SUCCEEDED
    assert ended.result().result.delta == pytest.approx(-1.57, abs=0.03)
    assert pose_of(sim)[2] == pytest.approx(1.57, abs=0.03)
    remaining = [message.remaining for message in feedback]
    assert len(remaining) > 5
    assert remaining == sorted(remaining, reverse=True)


def test_a_goal_can_be_canceled(sim, goals):
    send, _ = goals
    handle = send(3.0)
    sim.step(0.5)
    canceled = handle.cancel_goal_async()
    ended = handle.get_result_async()
    sim.until(lambda: canceled.done() and ended.done())
    assert ended.result().status == GoalStatus.STATUS_CANCELED
    there = pose_of(sim)[2]
    assert 0.2 < there < 1.0
    sim.step(0.5)
    assert pose_of(sim)[2] == pytest.approx(there, abs=0.02)


def test_velocities_do_not_end_a_turn(ros, sim, goals):
    send, _ = goals
    handle = send(2.0)
    ended = handle.get_result_async()
    velocities = ros.publisher(Twist, "/turtle1/cmd_vel")
    for _ in range(5):
        velocities.publish(drive(0.5))
        sim.step(0.1)
    sim.until(ended.done, 10.0)
    assert ended.result().status == GoalStatus.STATUS_SUCCEEDED
    assert pose_of(sim)[2] == pytest.approx(2.0, abs=0.02)


def test_a_turn_that_a_hand_ends_is_aborted_with_the_reason(ros, sim, goals):
    send, _ = goals
    logged = ros.collect(Log, "/rosout")
    handle = send(3.0)
    sim.engine.post("turtle1", Lift(True))
    ended = handle.get_result_async()
    sim.until(ended.done, 10.0)
    assert ended.result().status == GoalStatus.STATUS_ABORTED
    sim.until(lambda: any("the robot was lifted" in line.msg for line in logged))


def test_a_new_goal_replaces_the_old_one(ros, sim, goals):
    send, _ = goals
    logged = ros.collect(Log, "/rosout")
    first = send(3.0)
    sim.step(0.3)
    second = send(-1.0)
    ended = [handle.get_result_async() for handle in (first, second)]
    sim.until(lambda: all(one.done() for one in ended), 10.0)
    assert [one.result().status for one in ended] == [GoalStatus.STATUS_ABORTED, GoalStatus.STATUS_SUCCEEDED]
    assert any("another goal has replaced it" in line.msg for line in logged)
    assert pose_of(sim)[2] == pytest.approx(-1.0, abs=0.03)


def test_a_goal_without_a_number_is_rejected(ros, sim, goals):
    send, _ = goals
    logged = ros.collect(Log, "/rosout")
    assert not send(math.nan).accepted
    sim.until(lambda: any("rotate_absolute rejected: theta is nan, expected a finite" in line.msg for line in logged))


def test_a_turn_that_a_reset_ends_is_aborted(sim, call, goals):
    send, _ = goals
    handle = send(3.0)
    sim.step(0.3)
    ended = handle.get_result_async()
    call(Empty, "/reset")
    sim.until(ended.done)
    assert ended.result().status == GoalStatus.STATUS_ABORTED


def test_the_background_is_a_parameter_and_a_reset_keeps_it(ros, sim, call):
    colors = ros.collect(msg.Color, "/turtle1/color_sensor")
    scenes = ros.collect(MarkerArray, "/_markers", transient_local=True)
    client = AsyncParameterClient(ros.node, "turtlesim")
    ros.until(client.services_are_ready)
    call(srv.SetPen, "/turtle1/set_pen", r=0, g=0, b=0, width=3, off=1)
    call(Empty, "/clear")
    done = client.set_parameters([Parameter("background_r", value=150)])
    sim.until(done.done)
    sim.until(lambda: (colors[-1].r, colors[-1].g, colors[-1].b) == (150, 86, 255))
    sim.until(lambda: any(round(255 * marker.color.r) == 150 for marker in scenes[-1].markers))
    refused = client.set_parameters([Parameter("background_r", value=256)])
    (result,) = sim.until(lambda: refused.done() and refused).result().results
    assert not result.successful
    assert "expected 0 to 255" in result.reason
    call(Empty, "/reset")
    sim.step(0.1)
    assert sim.world.color_at(0.01, 0.01) == pytest.approx((150 / 255, 86 / 255, 1.0))


def test_the_drawing_is_the_same_in_a_replay(sim, call, tmp_path):
    call(srv.Spawn, "/spawn", x=2.0, y=2.0, theta=0.2, name="")
    call(srv.TeleportAbsolute, "/turtle2/teleport_absolute", x=2.0, y=9.0, theta=0.0)
    call(Empty, "/clear")
    sim.step(0.2)
    call(srv.TeleportAbsolute, "/turtle2/teleport_absolute", x=3.0, y=9.0, theta=0.0)
    sim.step(0.2)
    file = tmp_path / "run.jsonl.gz"
    file.write_bytes(sim.simulator.runner.run_log())
    from thymio_sim_ros.engine.replay import last_run

    logged = last_run(file)
    engine = logged.new_engine()
    while engine.tick < logged.ticks:
        logged.repeat_inputs(engine)
        engine.step()
    for x, y in ((2.0, 5.0), (2.5, 9.0)):
        place = x * UNIT_M, y * UNIT_M
        assert engine.world.color_at(*place) == sim.world.color_at(*place)
    assert engine.world.color_at(2.5 * UNIT_M, 9.0 * UNIT_M) == pytest.approx((179 / 255, 184 / 255, 1.0))
