"""The simulator node in the test's own process: commands in, messages out, simulated time stepped."""

from __future__ import annotations

import base64
import gc
import json
import math
import weakref

import pytest
from geometry_msgs.msg import Twist, TwistStamped, Vector3
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, LaserScan, Range
from std_msgs.msg import (
    Bool,
    ColorRGBA,
    Empty,
    Float32,
    Float32MultiArray,
    Float64MultiArray,
    Int16MultiArray,
    String,
)
from std_srvs.srv import Empty as EmptyService
from std_srvs.srv import SetBool, Trigger
from visualization_msgs.msg import Marker, MarkerArray

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.ros.interface.convert_readings import yaw_of
from thymio_sim_ros.ros.rclpy_ext.node_runner import make_executor
from thymio_sim_ros.sim.commands import BUTTONS, LED_GROUPS, BodyTwist

WALL_AHEAD = json.dumps(
    {
        "format": 1,
        "title": "Wall ahead",
        "shapes": [
            {"kind": "rectangle", "name": "ground", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
            {
                "kind": "box",
                "name": "wall",
                "x_m": 0.5,
                "y_m": 0.0,
                "size_x_m": 0.1,
                "size_y_m": 1.0,
                "height_m": 0.1,
                "color": "#ff0000",
            },
        ],
        "robots": [{"name": "thymio", "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0}],
    }
)


def forward(speed_m_s, turn_rad_s=0.0):
    return Twist(linear=Vector3(x=speed_m_s), angular=Vector3(z=turn_rad_s))


def test_cmd_vel_moves_the_robot(ros, simulation):
    sim = simulation(cmd_vel_timeout=0.0)
    odometry = ros.collect(Odometry, "/odom")
    ros.publisher(Twist, "/cmd_vel").publish(forward(0.1))
    sim.until(lambda: odometry and odometry[-1].pose.pose.position.x > 0.1)
    last = odometry[-1]
    assert (last.header.frame_id, last.child_frame_id) == ("odom", "base_link")
    assert last.twist.twist.linear.x == pytest.approx(0.1, rel=0.05)
    assert abs(last.pose.pose.position.y) < 0.02


def test_an_internal_error_pauses_the_world_and_is_logged(ros, simulation, monkeypatch):
    sim = simulation()
    logs, states = ros.collect(Log, "/rosout"), ros.collect(String, "/simulator/_state")

    def fail(_sensors):
        raise ZeroDivisionError("unexpected")

    monkeypatch.setattr(sim.world, "step", fail)
    assert sim.simulator.runner.paused
    answer = ros.call(Trigger, "/simulator/step", Trigger.Request())
    ros.until(lambda: any("the world stopped at 0 ns" in log.msg and "in fail" in log.msg for log in logs))
    assert not answer.success
    monkeypatch.undo()
    assert ros.call(Trigger, "/simulator/step", Trigger.Request()).success
    ros.until(lambda: states and json.loads(states[-1].data)["paused"])


def test_retained_topics_are_published_again_after_a_reset(ros, simulation):
    sim = simulation()
    ros.publisher(Bool, "/pen/down").publish(Bool(data=True))
    ros.publisher(Float32MultiArray, "/sound/tone").publish(Float32MultiArray(data=[440.0, 1000.0]))
    ros.publisher(Twist, "/cmd_vel").publish(forward(0.1))
    sounds, trails = (
        ros.collect(Float32MultiArray, "/_sound/state"),
        ros.collect(MarkerArray, "/_pen/trail", transient_local=True),
    )
    sim.until(lambda: sounds and sounds[-1].data[0] > 0 and trails and len(trails[-1].markers) > 1)
    assert ros.call(Trigger, "/simulator/reset", Trigger.Request()).success
    late_sounds = ros.collect(Float32MultiArray, "/_sound/state", transient_local=True)
    late_trails = ros.collect(MarkerArray, "/_pen/trail", transient_local=True)
    ros.until(lambda: late_sounds and late_trails)
    assert list(late_sounds[-1].data) == [0.0, 0.0, 1.0]
    assert [marker.action for marker in late_trails[-1].markers] == [Marker.DELETEALL]
    ros.until(lambda: list(sounds[-1].data) == [0.0, 0.0, 1.0] and len(trails[-1].markers) == 1)


def test_a_robot_that_is_shut_down_is_silent(ros, simulation):
    sim = simulation()
    sounds = ros.collect(Float32MultiArray, "/_sound/state")
    ros.publisher(Bool, "/_alarm").publish(Bool(data=True))
    sim.until(lambda: sounds and sounds[-1].data[0] > 0)
    ros.publisher(Empty, "/shutdown").publish(Empty())
    sim.until(lambda: sounds[-1].data[0] == 0)
    before = len(sounds)
    sim.step(7.0)
    assert len(sounds) == before


def test_a_stamped_command_turns_the_robot(ros, simulation):
    sim = simulation()
    truth = ros.collect(Odometry, "/_ground_truth/odom")
    ros.publisher(TwistStamped, "/cmd_vel_stamped").publish(TwistStamped(twist=forward(0.0, 1.0)))
    sim.until(lambda: truth and yaw_of(truth[-1].pose.pose.orientation) > 0.5)
    assert truth[-1].header.frame_id == "map"


def test_wheel_commands_turn_the_wheels(ros, simulation):
    sim = simulation(noise=False)
    joints = ros.collect(JointState, "/joint_states")
    ros.publisher(Float64MultiArray, "/_wheels/command").publish(Float64MultiArray(data=[2.0, 4.0]))
    sim.until(lambda: joints and joints[-1].position[1] > 1.0)
    assert joints[-1].name == ["left_wheel_joint", "right_wheel_joint"]
    assert list(joints[-1].velocity) == pytest.approx([2.0, 4.0], rel=0.01)
    assert joints[-1].position[0] == pytest.approx(joints[-1].position[1] / 2, rel=0.1)


def test_a_command_ends_after_its_timeout(ros, simulation):
    sim = simulation(cmd_vel_timeout=0.5)
    odometry = ros.collect(Odometry, "/odom")
    ros.publisher(Twist, "/cmd_vel").publish(forward(0.1))
    sim.until(lambda: odometry and odometry[-1].twist.twist.linear.x > 0.05)
    sim.until(lambda: odometry[-1].twist.twist.linear.x == 0.0, seconds=1.0)
    assert odometry[-1].pose.pose.position.x == pytest.approx(0.05, abs=0.01)


def test_commands_persist_without_a_timeout(ros, simulation):
    sim = simulation(cmd_vel_timeout=0.0)
    odometry = ros.collect(Odometry, "/odom")
    ros.publisher(Twist, "/cmd_vel").publish(forward(0.02))
    sim.until(lambda: odometry and odometry[-1].twist.twist.linear.x > 0.01)
    sim.step(5.0)
    assert sim.world.robots["thymio"].pose.x_m > 0.09


def test_nan_in_a_command_is_refused(ros, simulation):
    sim = simulation()
    publisher = ros.publisher(Twist, "/cmd_vel")
    odometry = ros.collect(Odometry, "/odom")
    publisher.publish(forward(math.nan))
    publisher.publish(forward(0.1))
    sim.until(lambda: odometry and odometry[-1].pose.pose.position.x > 0.05)


def test_a_wall_ahead_lowers_the_range(ros, simulation):
    sim = simulation(playground=WALL_AHEAD, cmd_vel_timeout=0.0)
    ranges = ros.collect(Range, "/proximity/center")
    counts = ros.collect(Int16MultiArray, "/_raw/proximity")
    scans = ros.collect(LaserScan, "/_proximity/laser")
    sim.until(lambda: ranges and counts and scans)
    assert ranges[-1].range == math.inf
    assert (ranges[-1].min_range, ranges[-1].max_range) == pytest.approx((0.0215, 0.14))
    assert ranges[-1].header.frame_id == "proximity_center_link"
    assert counts[-1].data[2] == 0
    ros.publisher(Twist, "/cmd_vel").publish(forward(0.1))
    sim.until(lambda: ranges[-1].range < 0.06)
    sim.until(lambda: counts[-1].data[2] > 2500)
    sim.until(lambda: scans[-1].ranges[2] < 0.15)


def test_the_driver_s_ranges_are_a_parameter(ros, simulation):
    sim = simulation(out_of_range="driver")
    ranges = ros.collect(Range, "/proximity/center")
    sim.until(lambda: ranges)
    assert ranges[-1].range == -1.0


def test_a_pressed_button_is_seen_once(ros, simulation):
    sim = simulation()
    pressed = ros.collect(Bool, "/buttons/center")
    ros.publisher(Bool, "/_press/center").publish(Bool(data=True))
    sim.until(lambda: pressed and pressed[-1].data)
    sim.step(0.5)
    assert [message.data for message in pressed] in ([False, True], [True])


def test_leds_show_the_commanded_levels(ros, simulation):
    sim = simulation()
    state = ros.collect(Float32MultiArray, "/_led/state", transient_local=True)
    ros.publisher(ColorRGBA, "/led/body/top").publish(ColorRGBA(r=1.0, g=0.5, b=0.0, a=1.0))
    sim.until(lambda: state and list(state[-1].data[:3]) == [1.0, 0.5, 0.0])
    labels = {dimension.label: dimension.size for dimension in state[-1].layout.dim}
    assert labels == LED_GROUPS


def test_a_short_led_array_is_refused(ros, simulation):
    sim = simulation()
    state = ros.collect(Float32MultiArray, "/_led/state", transient_local=True)
    publisher = ros.publisher(Float32MultiArray, "/led/circle")
    publisher.publish(Float32MultiArray(data=[1.0]))
    publisher.publish(Float32MultiArray(data=[1.0] * 8))
    sim.until(lambda: state and sum(state[-1].data) == 8.0)


def test_reset_rewinds_world_and_clock(ros, simulation):
    sim = simulation(cmd_vel_timeout=0.0)
    clocks = ros.collect(Clock, "/clock")
    odometry = ros.collect(Odometry, "/odom")
    ros.publisher(Twist, "/cmd_vel").publish(forward(0.1))
    sim.until(lambda: odometry and odometry[-1].pose.pose.position.x > 0.1)
    assert ros.call(Trigger, "/simulator/reset").success
    ros.until(lambda: clocks[-1].clock.sec == 0 and clocks[-1].clock.nanosec == 0)
    seen = len(odometry)
    sim.until(lambda: len(odometry) > seen)
    assert odometry[-1].pose.pose.position.x == 0.0
    assert sim.world.robots["thymio"].pose.x_m == 0.0


def test_reset_repeats_the_run_bit_for_bit(ros, simulation):
    sim = simulation(seed=7)
    odometry = ros.collect(Odometry, "/odom")
    poses = []
    for _ in range(2):
        sim.simulator.runner.reset()
        sim.world.post("thymio", sim_twist())
        sim.step(2.0)
        poses.append(sim.world.robots["thymio"].pose)
    ros.until(lambda: odometry)
    assert poses[0] == poses[1]
    assert poses[0].x_m > 0.1


def sim_twist():
    return BodyTwist(0.1, 0.2)


def test_pause_step_and_run(ros, simulation):
    sim = simulation(step_ticks=5)
    assert ros.call(Trigger, "/simulator/step").message == "now 0.050 s"
    assert sim.world.now_ns == 50_000_000
    assert ros.call(SetBool, "/simulator/pause", SetBool.Request(data=False)).message == "running"
    refused = ros.call(Trigger, "/simulator/step")
    assert not refused.success
    assert "pause" in refused.message
    states = ros.collect(String, "/simulator/_state", transient_local=True)
    ros.until(lambda: states and json.loads(states[-1].data)["paused"] is False)


def test_the_true_pose_is_repeated_while_paused(ros, simulation):
    sim = simulation(playground="base")
    sim.simulator.runner.pause(True)
    odometry = ros.collect(Odometry, "/_ground_truth/odom")
    idle = make_executor(ros.context)

    def arrived() -> bool:
        sim.simulator.run_once(idle)
        return bool(odometry)

    ros.until(arrived)
    place, pose = odometry[-1].pose.pose.position, sim.world.robots["thymio"].pose
    assert (place.x, place.y) == (pose.x_m, pose.y_m)
    assert sim.world.now_ns == 0


def test_the_playground_can_be_changed_and_a_bad_one_is_refused(ros, simulation):
    sim = simulation(playground="base")
    markers = ros.collect(MarkerArray, "/_markers", transient_local=True)
    ros.until(lambda: markers)
    world = sim.world
    bad = set_parameter(ros, "playground", '{"format": 1, "title": "x", "shapes": [{"kind": "bx"}]}')
    assert not bad.successful
    assert "bx" in bad.reason
    assert sim.world is world
    missing = set_parameter(ros, "playground", "obstacel")
    assert "did you mean 'obstacle'" in missing.reason
    seen = len(markers)
    assert set_parameter(ros, "playground", "obstacle").successful
    ros.until(lambda: len(markers) > seen)
    kinds = [marker.type for marker in markers[-1].markers if marker.action == Marker.ADD]
    assert kinds.count(Marker.CYLINDER) == 24
    assert markers[-1].markers[0].action == Marker.DELETEALL
    sim.step(0.1)
    assert len(sim.world.robots) == 1


def test_a_change_of_playground_and_seed_builds_one_engine_of_both(ros, simulation, monkeypatch):
    sim = simulation(playground="base")
    built = []
    monkeypatch.setattr(
        "thymio_sim_ros.ros.simulator.prepared_playground.Engine",
        lambda *args, **options: built.append(Engine(*args, **options)) or built[-1],
    )
    wanted = [Parameter("seed", value=7), Parameter("playground", value="obstacle")]
    request = SetParametersAtomically.Request(parameters=[parameter.to_parameter_msg() for parameter in wanted])
    assert ros.call(SetParametersAtomically, "/simulator/set_parameters_atomically", request).result.successful
    assert built == [sim.engine]
    assert sim.world.options.seed == 7
    assert sim.world.playground.title == load_playground("obstacle")[1].title


def test_a_command_to_a_robot_that_has_gone_with_its_playground_is_dropped(ros, simulation):
    sim = simulation(playground="two_robots")
    late = sim.simulator.endpoints.robots["red"]._owner.post
    assert set_parameter(ros, "playground", "base").successful
    late(BodyTwist(0.1, 0.0))
    sim.step(0.1)
    assert list(sim.world.robots) == ["thymio"]


def test_the_memory_of_a_world_is_freed_when_another_one_replaces_it(ros, simulation):
    sim = simulation(playground="two_robots")
    ground = weakref.ref(sim.world._shared.ground)
    gc.disable()
    try:
        assert set_parameter(ros, "playground", "base").successful
        assert ground() is None
    finally:
        gc.enable()


def test_a_refused_upload_names_its_file_and_the_old_world_stays(ros, simulation):
    sim = simulation(playground="base")
    world = sim.world
    text = base64.b64encode(b"<aseba-playground>\n<world w='x'/></aseba-playground>").decode()
    result = set_parameter(ros, "playground", f"data:;name=my%20maze.playground;base64,{text}")
    assert result.reason == "my maze.playground: line 2: <world> w: found 'x', expected a number"
    assert not result.successful
    assert sim.world is world


def test_the_state_lists_what_could_not_be_converted(ros, simulation):
    simulation(
        playground='<aseba-playground><color name="w"/><world w="90" h="90" color="w"/><feeder/></aseba-playground>'
    )
    states = ros.collect(String, "/simulator/_state", transient_local=True)
    ros.until(lambda: states)
    (note,) = json.loads(states[-1].data)["notes"]
    assert note.startswith("line 1: <feeder> skipped")


def set_parameter(ros, name, value):
    request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
    return ros.call(SetParameters, "/simulator/set_parameters", request).results[0]


def test_the_graph_has_the_driver_s_names(ros, simulation):
    sim = simulation()
    sim.step(1.2)
    ros.call(EmptyService, "/is_ready")
    topics = dict(ros.node.get_topic_names_and_types())
    expected = {
        "/odom": "nav_msgs/msg/Odometry",
        "/joint_states": "sensor_msgs/msg/JointState",
        "/tf": "tf2_msgs/msg/TFMessage",
        "/tf_static": "tf2_msgs/msg/TFMessage",
        "/robot_description": "std_msgs/msg/String",
        "/cmd_vel": "geometry_msgs/msg/Twist",
        "/ground/left": "sensor_msgs/msg/Range",
        "/ground/right": "sensor_msgs/msg/Range",
        "/_proximity/laser": "sensor_msgs/msg/LaserScan",
        "/_buttons": "sensor_msgs/msg/Joy",
        "/_led/state": "std_msgs/msg/Float32MultiArray",
        **{f"/buttons/{button}": "std_msgs/msg/Bool" for button in BUTTONS},
    }
    assert {name: topics.get(name) for name in expected} == {name: [kind] for name, kind in expected.items()}


def test_a_rejected_start_parameter_has_a_reason(ros):
    from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
    from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams

    with pytest.raises(StartError, match="nowhere"):
        Simulator(ros.context, SimulatorParams(playground="nowhere"))


def test_a_pen_draws_a_trail(ros, simulation):
    sim = simulation(cmd_vel_timeout=0.0)
    trails = ros.collect(MarkerArray, "/_pen/trail", transient_local=True)
    ros.publisher(ColorRGBA, "/_pen/color").publish(ColorRGBA(r=1.0, a=1.0))
    ros.publisher(Float32, "/_pen/width").publish(Float32(data=0.03125))
    ros.publisher(Bool, "/pen/down").publish(Bool(data=True))
    ros.publisher(Twist, "/cmd_vel").publish(forward(0.1))
    sim.until(lambda: trails and len(trails[-1].markers) > 1 and trails[-1].markers[-1].points[-1].x > 0.1)
    _, *_, line = trails[-1].markers
    assert (line.ns, line.header.frame_id, line.scale.x) == ("pen", "map", 0.03125)
    assert (line.color.r, line.color.g, line.color.b) == (1.0, 0.0, 0.0)


def test_a_sound_from_ros_is_played_and_published(ros, simulation):
    sim = simulation()
    reported = ros.collect(Float32MultiArray, "/_sound/state")
    ros.publisher(Float32MultiArray, "/sound/tone").publish(Float32MultiArray(data=[440.0, 0.5]))
    sim.until(lambda: len(reported) >= 2)
    assert [list(message.data[:2]) for message in reported] == [[440.0, 0.5], [0.0, 0.0]]


def test_an_unknown_motor_model_is_refused(ros):
    from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
    from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams

    with pytest.raises(StartError, match="motor_model is 'quick', expected ideal or firmware"):
        Simulator(ros.context, SimulatorParams(motor_model="quick"))
