"""What moves besides the robots of the playground: things, doors, robots that come and go; and the log of it all."""

from __future__ import annotations

import json
import math

import pytest
from geometry_msgs.msg import Point, Pose, PoseWithCovariance, PoseWithCovarianceStamped, Twist, Vector3
from nav_msgs.msg import Odometry
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray

from thymio_sim_ros.engine.replay import replay
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.sim.commands import MoveObject
from thymio_sim_ros.sim.playground.reader import RobotStart

GRAY = "#808080"
PUSHING = json.dumps(
    {
        "format": 1,
        "title": "Pushing",
        "shapes": [
            {"kind": "rectangle", "name": "ground", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
            {"kind": "cylinder", "name": "can", "x_m": 0.15, "y_m": 0, "radius_m": 0.03, "height_m": 0.1, "color": GRAY,
             "mass_kg": 0.1},
            {"kind": "cylinder", "name": "post", "x_m": 0, "y_m": 0.5, "radius_m": 0.03, "height_m": 0.1,
             "color": GRAY},
        ],
        "robots": [{"name": "thymio", "x_m": 0.0, "y_m": 0.0}],
    }
)  # fmt: skip


def shown(message):
    """Places by namespace; the message replaces what was shown before."""
    assert message.markers[0].action == Marker.DELETEALL
    return {marker.ns: marker.pose.position.x for marker in message.markers[1:]}


def test_moving_objects_have_their_own_markers(ros, simulation):
    sim = simulation(playground=PUSHING, noise=False, cmd_vel_timeout=0.0)
    fixed = ros.collect(MarkerArray, "/_markers", transient_local=True)
    objects = ros.collect(MarkerArray, "/_markers/objects", transient_local=True)
    ros.until(lambda: fixed and objects)
    assert "solid/can" not in shown(fixed[-1])
    assert shown(objects[-1]) == {"solid/can": 0.15}
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=0.1)))
    sim.until(lambda: shown(objects[-1])["solid/can"] > 0.25)
    sim.engine.post("can", MoveObject(5.0, 0.0, 0.0))
    sim.until(lambda: shown(objects[-1]) == {})
    sim.simulator.runner.reset()
    ros.until(lambda: shown(objects[-1]) == {"solid/can": 0.15})


def test_resting_objects_are_not_published_again(ros, simulation):
    sim = simulation(playground=PUSHING)
    objects = ros.collect(MarkerArray, "/_markers/objects", transient_local=True)
    ros.until(lambda: objects)
    sim.step(1.0)
    assert len(objects) == 1


def test_an_added_robot_has_topics_until_it_is_removed(ros, simulation):
    sim = simulation(playground=PUSHING, cmd_vel_timeout=0.0)
    states = ros.collect(String, "/simulator/_state", transient_local=True)
    old = ros.collect(Odometry, "/_ground_truth/odom")
    sim.until(lambda: old)
    sim.engine.spawn(RobotStart("late", -0.5, 0.0, 1.0))
    sim.tick()
    new = ros.collect(Odometry, "/late/_ground_truth/odom")
    sim.until(lambda: new)
    assert new[-1].child_frame_id == "late/base_link"
    ros.until(lambda: [robot["name"] for robot in json.loads(states[-1].data)["robots"]] == ["", "late"])
    publisher = ros.publisher(Twist, "/late/cmd_vel")
    publisher.publish(Twist(linear=Vector3(x=0.1)))
    sim.until(lambda: math.dist((new[-1].pose.pose.position.x, new[-1].pose.pose.position.y), (-0.5, 0.0)) > 0.05)
    sim.engine.remove("late")
    sim.step(0.1)
    ros.until(lambda: [robot["name"] for robot in json.loads(states[-1].data)["robots"]] == [""])
    count = len(old)
    sim.until(lambda: len(old) > count + 3)
    names = {name for name, _ in sim.simulator.node.get_topic_names_and_types()}
    assert not sim.simulator.node.get_publishers_info_by_topic("/late/_ground_truth/odom")
    assert "/_ground_truth/odom" in names


def test_the_static_frames_of_an_added_robot_are_published(simulation, monkeypatch):
    sim = simulation(playground=PUSHING)
    reported = []
    monkeypatch.setattr(sim.simulator.endpoints._transforms, "set_robots", reported.append)
    sim.engine.spawn(RobotStart("late", -0.5, 0.0))
    sim.step(0.02)
    assert [[names.frame("base_link") for names in robots] for robots in reported] == [["base_link", "late/base_link"]]


def test_reset_brings_back_the_robots_of_the_playground(ros, simulation):
    sim = simulation(playground=PUSHING)
    odometry = ros.collect(Odometry, "/_ground_truth/odom")
    sim.engine.remove("thymio")
    sim.engine.spawn(RobotStart("late", -0.5, 0.0))
    sim.step(0.1)
    sim.simulator.runner.reset()
    odometry.clear()
    sim.until(lambda: odometry)
    assert [names.name for names in sim.simulator.endpoints.robots.names.values()] == [""]


def test_an_occupied_place_is_rejected_and_the_node_continues(ros, simulation):
    sim = simulation(playground=PUSHING)
    publisher = ros.publisher(PoseWithCovarianceStamped, "/initialpose")

    def at(x_m, y_m):
        return PoseWithCovarianceStamped(pose=PoseWithCovariance(pose=Pose(position=Point(x=x_m, y=y_m))))

    publisher.publish(at(0.0, 0.5))
    publisher.publish(at(-0.5, 0.5))
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m == pytest.approx(-0.5))


def test_a_log_of_the_node_replays(ros, simulation, tmp_path):
    path = tmp_path / "run.jsonl"
    sim = simulation(playground=PUSHING, log=str(path), seed=3, cmd_vel_timeout=0.0)
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=0.1)))
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.1)
    sim.engine.spawn(RobotStart("late", -0.5, 0.0))
    sim.step(0.3)
    sim.simulator.runner.reset()
    sim.step(0.3)
    sim.simulator.close()
    found = replay(path)
    assert (found.runs, found.differs, found.is_complete) == (2, None, True)


def test_a_log_that_cannot_be_written_is_refused(simulation, tmp_path):
    with pytest.raises(StartError, match="No such file or directory, expected a writable file"):
        simulation(log=str(tmp_path / "nowhere" / "run.jsonl"))
