"""The simulator's parameters: their effects, and the reasons of rejected values."""

from __future__ import annotations

import itertools
import json

import pytest
from geometry_msgs.msg import Twist, TwistStamped, Vector3
from nav_msgs.msg import OccupancyGrid, Odometry
from rcl_interfaces.msg import Log
from rcl_interfaces.srv import DescribeParameters, SetParameters
from rclpy.parameter import Parameter
from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import JointState, LaserScan, Range
from std_msgs.msg import Int16MultiArray, String
from visualization_msgs.msg import MarkerArray

from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.simulator import prepared_playground
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams

TWO = json.dumps(
    {
        "format": 1,
        "title": "Two",
        "shapes": [{"kind": "rectangle", "name": "ground", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"}],
        "robots": [{"name": "anna", "x_m": 0.0, "y_m": 0.0}, {"name": "bert", "x_m": 0.5, "y_m": 0.0}],
    }
)


SAME = "has this value already, nothing changed: the service /simulator/reset restarts the world"


def set_parameter(ros, name, value):
    request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
    return ros.call(SetParameters, "/simulator/set_parameters", request).results[0]


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("out_of_range", "nan", "out_of_range is 'nan', expected rep117 or driver"),
        ("pose_covariance_diagonal", [1.0], "pose_covariance_diagonal: found 1 values, expected 6"),
        ("twist_covariance_diagonal", [1.0] * 5 + [-1.0], "twist_covariance_diagonal[5] is -1.0, expected at least 0"),
        ("real_time_factor", -1.0, "real_time_factor"),
        ("real_time_factor", float("nan"), "real_time_factor"),
        ("step_ticks", 0, "step_ticks"),
        ("seed", -1, "seed"),
        ("noise", False, "noise"),
        ("proximity.left.fov", 9.0, "proximity.left.fov"),
    ],
)
def test_a_rejected_value_has_a_reason_and_changes_nothing(ros, simulation, name, value, reason):
    sim = simulation()
    before = sim.simulator.params.values
    result = set_parameter(ros, name, value)
    assert not result.successful
    assert reason in result.reason
    assert sim.simulator.params.values == before


def test_the_present_playground_again_changes_nothing_unless_its_file_does(ros, simulation, tmp_path):
    path = tmp_path / "mine.json"
    path.write_text(TWO)
    sim = simulation(playground=str(path))
    sim.step(0.2)
    world = sim.world
    result = set_parameter(ros, "playground", str(path))
    assert (result.successful, result.reason) == (True, f"playground {SAME}")
    assert sim.world is world
    path.write_text(TWO.replace("anna", "carl"))
    result = set_parameter(ros, "playground", str(path))
    assert (result.successful, result.reason) == (True, "")
    assert "carl" in sim.world.robots


def test_loading_the_current_playground_restarts_the_world(ros, simulation):
    sim = simulation(playground=TWO)
    sim.step(0.2)
    assert sim.simulator.parameter_callbacks.load_playground(TWO) == ""
    assert sim.world.now_ns == 0


def test_the_present_values_of_seed_and_pace_change_nothing(ros, simulation):
    sim = simulation(seed=3, real_time_factor=2.0)
    sim.step(0.2)
    world, pacer = sim.world, sim.simulator.runner.scheduler._pacer
    results = [set_parameter(ros, name, value) for name, value in (("seed", 3), ("real_time_factor", 2.0))]
    assert [(result.successful, result.reason) for result in results] == [(True, f"seed {SAME}"), (True, "")]
    assert (sim.world, sim.simulator.runner.scheduler._pacer) == (world, pacer)


def test_simulated_time_of_another_node_is_rejected(ros, simulation):
    simulation()
    result = set_parameter(ros, "use_sim_time", True)
    assert (result.successful, result.reason) == (
        False,
        "use_sim_time is rejected: the simulator is the source of simulated time, it cannot follow /clock",
    )
    assert set_parameter(ros, "use_sim_time", False).successful


def test_simulated_time_of_another_node_is_ignored_at_the_start(simulator_with, capfd):
    simulator = simulator_with("-p", "use_sim_time:=true")
    assert simulator.node.get_parameter("use_sim_time").value is False
    assert "use_sim_time is ignored: the simulator is the source of simulated time" in capfd.readouterr().err


def test_an_internal_error_while_reading_a_playground_rejects_it(ros, simulation, monkeypatch):
    """An internal error while reading a file must not end the simulator of a class."""
    sim = simulation()
    logs = ros.collect(Log, "/rosout")

    def fail(_value):
        raise ZeroDivisionError("unexpected")

    monkeypatch.setattr(prepared_playground, "load_playground", fail)
    result = set_parameter(ros, "playground", "strange.json")
    assert (result.successful, result.reason) == (False, "ZeroDivisionError: unexpected")
    ros.until(lambda: any("in fail" in log.msg for log in logs))
    sim.step(1)


def test_a_missing_home_folder_is_rejected(ros, simulation):
    simulation()
    assert "no playground '~no-such-user/x.json'" in set_parameter(ros, "playground", "~no-such-user/x.json").reason


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        ({"proximity_model": "sonar"}, "proximity_model is 'sonar', expected default or enki or cone"),
        ({"robot_names": ["1st"]}, "robot_names.name: found '1st', expected a ROS name"),
        ({"robot_names": ["bert"], "playground": TWO}, "robot_names: found 'bert' twice"),
    ],
)
def test_an_invalid_start_has_a_reason(ros, wrong, reason):
    with pytest.raises(StartError, match=reason):
        Simulator(ros.context, SimulatorParams(**wrong))


def test_every_parameter_is_described(ros, simulation):
    simulation()
    names = [one.name for one in parameters.declared(SimulatorParams())]
    request = DescribeParameters.Request(names=names)
    described = ros.call(DescribeParameters, "/simulator/describe_parameters", request).descriptors
    assert [descriptor.name for descriptor in described if not descriptor.description] == []
    assert {d.name: d.additional_constraints for d in described}["pose_covariance_diagonal"] == (
        "6 values; each at least 0"
    )


def test_ranges_follow_their_parameters_while_it_runs(ros, simulation):
    sim = simulation()
    ranges = ros.collect(Range, "/proximity/left")
    sim.until(lambda: ranges)
    assert ranges[-1].range == float("inf")
    assert set_parameter(ros, "out_of_range", "driver").successful
    assert set_parameter(ros, "proximity.left.range_max", 0.125).successful
    sim.until(lambda: ranges[-1].range == -1.0)
    assert (ranges[-1].max_range, ranges[-1].field_of_view) == pytest.approx((0.125, 0.3))


def test_covariances_follow_their_parameters(ros, simulation):
    sim = simulation(pose_covariance_diagonal=[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    odometry = ros.collect(Odometry, "/odom")
    sim.until(lambda: odometry)
    assert list(odometry[-1].pose.covariance[::7]) == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]


def test_a_new_seed_restarts_the_world_with_other_noise(ros, simulation):
    sim = simulation(seed=1)
    counts = ros.collect(Int16MultiArray, "/_raw/ground")
    sim.until(lambda: len(counts) == 5)
    first = [list(message.data) for message in counts]
    for seed in (2, 1):
        counts.clear()
        assert set_parameter(ros, "seed", seed).successful
        assert sim.world.now_ns == 0
        sim.until(lambda: len(counts) == 5)
        assert ([list(message.data) for message in counts] == first) == (seed == 1)


def test_robots_have_the_requested_names(ros, simulation):
    sim = simulation(robot_names=["thymio0"])
    odometry = ros.collect(Odometry, "/thymio0/odom")
    joints = ros.collect(JointState, "/thymio0/joint_states")
    sim.until(lambda: odometry and joints)
    assert (odometry[-1].header.frame_id, odometry[-1].child_frame_id) == ("thymio0/odom", "thymio0/base_link")
    assert joints[-1].name == ["thymio0/left_wheel_joint", "thymio0/right_wheel_joint"]


def test_frames_and_joints_have_the_requested_names(ros, simulation):
    sim = simulation(
        odom_frame="wheels", robot_frame="body", map_frame="world", left_wheel_joint="l", right_wheel_joint="r",
        tf_prefix="lab",
    )  # fmt: skip
    odometry = ros.collect(Odometry, "/odom")
    truth = ros.collect(Odometry, "/_ground_truth/odom")
    joints = ros.collect(JointState, "/joint_states")
    markers = ros.collect(MarkerArray, "/_markers")
    description = ros.collect(String, "/robot_description")
    sim.until(lambda: odometry and joints and markers and truth and description)
    assert (odometry[-1].header.frame_id, odometry[-1].child_frame_id) == ("lab/wheels", "lab/body")
    assert (truth[-1].header.frame_id, joints[-1].name) == ("world", ["lab/l", "lab/r"])
    assert {marker.header.frame_id for marker in markers[-1].markers} == {"world"}
    assert '<link name="lab/body">' in description[-1].data
    assert '<joint name="lab/l" type="continuous">' in description[-1].data


def frames_on(ros, topic):
    received = []
    ros.until(lambda: ros.node.count_publishers(topic))
    ros.node.create_subscription(tf2_messages.TFMessage, topic, received.append, 100, raw=True)
    ros.settle()
    return lambda: {(one.frame, one.child) for data in received for one in tf2_messages.decode(bytes(data))}


def test_frames_are_bare_in_the_robots_namespaces_on_request(ros, simulation):
    sim = simulation(playground=TWO, namespaced_tf=True)
    frames = frames_on(ros, "/bert/tf")
    sim.until(lambda: ("odom", "base_link") in frames())
    assert {frame for frame, _ in frames()} == {"map", "odom", "base_link"}
    assert ros.node.count_publishers("/bert/tf_static") == 1
    assert not ros.node.count_publishers("/tf")


def test_transforms_of_two_robots_share_a_topic(ros, simulation):
    sim = simulation(playground=TWO)
    frames = frames_on(ros, "/tf")
    sim.until(lambda: ("bert/odom", "bert/base_link") in frames())
    assert ("map", "anna/odom") in frames()


def test_topics_that_are_switched_off_are_not_published(ros, simulation):
    sim = simulation(
        publish_map_tf=False, publish_wheel_tf=False, publish_static_tf=False, publish_description=False,
        publish_ground_truth=False, publish_clock=False,
    )  # fmt: skip
    frames = frames_on(ros, "/tf")
    sim.until(lambda: frames())
    assert frames() == {("odom", "base_link")}
    for topic in ("/tf_static", "/robot_description", "/_ground_truth/odom", "/clock", "/map"):
        assert not ros.node.count_publishers(topic), topic


@pytest.mark.parametrize(("rate", "count"), [(20.0, 20), (-1.0, 100), (5.0, 5), (50.0, 50)])
def test_odometry_and_joints_have_their_rate(ros, simulation, rate, count):
    sim = simulation(odom_max_rate=rate)
    odometry, joints = ros.collect(Odometry, "/odom"), ros.collect(JointState, "/joint_states")
    sim.step(1.0)
    ros.until(lambda: (len(odometry), len(joints)) == (count, count))


@pytest.mark.parametrize(("rate", "period_s"), [(0.0, 0.1), (25.0, 0.04), (100.0, 0.01)])
def test_a_laser_scan_has_the_time_until_the_next_one(ros, simulation, rate, period_s):
    sim = simulation(sensor_rate=rate)
    scans = ros.collect(LaserScan, "/_proximity/laser")
    sim.until(lambda: len(scans) >= 5, seconds=2.0)
    stamps = [scan.header.stamp.sec + scan.header.stamp.nanosec / 1e9 for scan in scans]
    gaps = [later - earlier for earlier, later in itertools.pairwise(stamps)]
    assert gaps == pytest.approx([period_s] * len(gaps))
    assert [scan.scan_time for scan in scans] == pytest.approx([period_s] * len(scans))
    assert {scan.time_increment for scan in scans} == {0.0}


def test_all_sensors_have_one_rate_on_request(ros, simulation):
    sim = simulation(sensor_rate=50.0)
    counts = [ros.collect(Int16MultiArray, f"/_raw/{sensor}") for sensor in ("proximity", "ground", "motor")]
    sim.step(1.0)
    ros.until(lambda: [len(each) for each in counts] == [50, 50, 50])


def test_velocities_swap_their_names_on_request(ros, simulation):
    sim = simulation(stamped_cmd_vel=True, cmd_vel_timeout=0.0)
    ros.publisher(TwistStamped, "/cmd_vel").publish(TwistStamped(twist=Twist(linear=Vector3(x=0.1))))
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.05)
    ros.publisher(Twist, "/cmd_vel_unstamped").publish(Twist(linear=Vector3(x=-0.1)))
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m < 0.0)


def test_a_map_is_published_on_request(ros, simulation):
    simulation(playground=TWO, publish_map=True)
    maps = ros.collect(OccupancyGrid, "/map")
    ros.until(lambda: maps)
    info = maps[-1].info
    assert (info.width, info.height, maps[-1].header.frame_id) == (200, 200, "map")
    assert (info.origin.position.x, info.resolution) == pytest.approx((-1.0, 0.01))
    assert set(maps[-1].data) == {0}


def test_reliability_can_be_overridden(simulator_with):
    override = "qos_overrides./proximity/left.publisher.reliability:=best_effort"
    simulator = simulator_with("-p", override, playground="base")
    profiles = {
        topic: simulator.node.get_publishers_info_by_topic(topic)[0].qos_profile
        for topic in ("/proximity/left", "/proximity/right")
    }
    assert profiles["/proximity/left"].reliability == ReliabilityPolicy.BEST_EFFORT
    assert profiles["/proximity/right"].reliability == ReliabilityPolicy.RELIABLE


@pytest.mark.parametrize(
    ("policy", "value", "reason"),
    [
        ("reliability", "best", "found 'best', expected system_default, reliable, best_effort, best_available"),
        (
            "durability",
            "unknown",
            "found 'unknown', expected system_default, transient_local, volatile, best_available",
        ),
        ("history", "3", "found 3, expected system_default, keep_last, keep_all"),
        ("depth", "-1", "found -1, expected 0 to 2147483647"),
        ("depth", "many", "found 'many', expected 0 to 2147483647"),
        ("depth", "true", "found True, expected 0 to 2147483647"),
    ],
)
def test_an_invalid_qos_override_is_rejected_at_the_start(simulator_with, policy, value, reason):
    """Also that of a robot which may come later, and could not then."""
    name = f"qos_overrides./later/odom.publisher.{policy}"
    with pytest.raises(StartError) as refusal:
        simulator_with("-p", f"{name}:={value}", playground="base")
    assert str(refusal.value) == f"parameter {name}: {reason}"


def test_a_log_on_a_full_disk_ends_and_the_world_goes_on(ros, simulation):
    sim = simulation(log="/dev/full")
    logs = ros.collect(Log, "/rosout", where=lambda log: "the log ends here" in log.msg)
    sim.step(5.0)
    ros.until(lambda: logs)
    sim.step(5.0)
    sim.simulator.stop()
    ros.settle()
    assert [log.msg for log in logs] == ["the log ends here: /dev/full: No space left on device"]
    assert sim.world.now_ns == 10_000_000_000
