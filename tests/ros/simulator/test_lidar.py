"""The lidar as ROS nodes see it: the topic `scan`, its frame."""

from __future__ import annotations

import math

import pytest
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

from tests.ros.simulator.test_node import WALL_AHEAD
from thymio_sim_ros.ros import combined
from thymio_sim_ros.ros.compat.tf2_messages import TFMessage
from thymio_sim_ros.sim.model.lidar import LIDAR_HEIGHT_M, LIDAR_PLACE, Lidar
from thymio_sim_ros.suite_config import SuiteConfig


def test_a_scan_has_the_distances_of_what_is_around_the_robot(ros, simulation):
    sim = simulation(playground=WALL_AHEAD, lidar=Lidar(beams=180, range_m=2.0, rate_hz=5.0, noise_m=0.0))
    scans = ros.collect(LaserScan, "/scan")
    sim.step(1.0)
    ros.until(lambda: len(scans) == 5)
    scan = scans[-1]
    assert scan.header.frame_id == "base_scan"
    assert (len(scan.ranges), len(scan.intensities)) == (180, 0)
    assert scan.ranges[0] == pytest.approx(0.45 - LIDAR_PLACE[0])
    assert scan.ranges[90] == math.inf
    assert (scan.angle_min, scan.angle_increment) == (0.0, pytest.approx(math.radians(2)))
    assert scan.angle_max == pytest.approx(scan.angle_min + 179 * scan.angle_increment)
    assert (scan.range_min, scan.range_max, scan.scan_time) == (pytest.approx(0.05), 2.0, pytest.approx(0.2))


def test_its_frame_and_its_head_are_where_it_measures(ros, simulation):
    simulation(lidar=True)
    frames = ros.collect(TFMessage, "/tf_static")
    descriptions = ros.collect(String, "/robot_description")
    ros.until(lambda: frames and descriptions)
    (place,) = [one for one in frames[-1].transforms if one.child_frame_id == "base_scan"]
    assert place.header.frame_id == "base_link"
    vector = place.transform.translation
    assert (vector.x, vector.y, vector.z) == (*LIDAR_PLACE, LIDAR_HEIGHT_M)
    assert '<link name="base_scan"/>' in descriptions[-1].data


def test_the_choice_of_a_start_reaches_the_world_and_a_replay_has_it_too(ros, tmp_path):
    lidar = Lidar(beams=90, range_m=1.5)
    log = str(tmp_path / "run.jsonl")
    nodes = combined.suite_nodes(
        ros.context, SuiteConfig(playground="base", program="none", web=False, foxglove=False, lidar=lidar, log=log)
    )
    (simulator,) = (ros.live(node) for node in nodes)
    assert simulator.runner.world.options.lidar == lidar
    simulator.runner.advance(20)
    simulator.stop()
    replay = SuiteConfig(program="none", web=False, foxglove=False, replay=log)
    (simulator,) = (ros.live(node) for node in combined.suite_nodes(ros.context, replay))
    assert simulator.runner.world.options.lidar == lidar
    assert any(one.topic_name == "/scan" for one in simulator.node.publishers)
