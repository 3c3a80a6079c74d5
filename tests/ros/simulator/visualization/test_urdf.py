"""The robot's description and the playground's markers, as a viewer reads them."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET

import pytest
from visualization_msgs.msg import Marker

from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.files.resources import playgrounds
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.simulator.visualization.markers import playground_markers
from thymio_sim_ros.ros.simulator.visualization.transforms import origin_of
from thymio_sim_ros.ros.simulator.visualization.urdf import fixed_frames, urdf
from thymio_sim_ros.sim.model.geometry import Pose


@pytest.mark.parametrize("name", ["", "thymio_2"])
def test_the_urdf_is_one_tree_with_two_turning_wheels(name):
    names = RobotNames(name)
    robot = ET.fromstring(urdf(names))
    links = {link.get("name") for link in robot.iter("link")}
    joints = list(robot.iter("joint"))
    children = {joint.find("child").get("link") for joint in joints}
    assert links - children == {names.frame("base_link")}
    assert {joint.find("parent").get("link") for joint in joints} <= links
    turning = {joint.get("name") for joint in joints if joint.get("type") == "continuous"}
    assert turning == {names.frame("left_wheel_joint"), names.frame("right_wheel_joint")}


def test_the_body_has_the_robot_s_size():
    robot = ET.fromstring(urdf(RobotNames("")))
    boxes = []
    for visual in robot.find("link[@name='base_link']").iter("visual"):
        x, _y, _z = map(float, visual.find("origin").get("xyz").split())
        size_x, size_y, _ = map(float, visual.find("geometry/box").get("size").split())
        boxes.append((x - size_x / 2, x + size_x / 2, size_y))
    assert min(box[0] for box in boxes) == pytest.approx(-0.030, abs=1e-3)
    assert max(box[1] for box in boxes) == pytest.approx(0.080, abs=1e-3)
    assert max(box[2] for box in boxes) == pytest.approx(0.110, abs=1e-3)


def test_rotations_of_fixed_frames_are_unit_quaternions():
    for frame in fixed_frames():
        assert math.hypot(*frame.quaternion) == pytest.approx(1.0)


@pytest.mark.parametrize("name", playgrounds())
def test_every_playground_can_be_drawn(name):
    _, playground = load_playground(name)
    message = playground_markers((*playground.floors, *playground.paints, *playground.solids))
    first, *markers = message.markers
    assert first.action == Marker.DELETEALL
    assert len({(marker.ns, marker.id) for marker in markers}) == len(markers)
    assert {marker.header.frame_id for marker in markers} == {"map"}
    solids = [marker for marker in markers if marker.ns.startswith("solid/")]
    assert len(solids) == len(playground.solids)
    for marker in markers:
        assert len(marker.points) % 3 == 0
        assert min(marker.scale.x, marker.scale.y, marker.scale.z) > 0.0
        assert marker.color.a == 1.0


def test_the_origin_of_odometry_leads_to_the_truth():
    truth, odometry = Pose(1.0, -2.0, 0.7), Pose(0.4, 0.3, -0.2)
    origin = origin_of(truth, odometry)
    x, y = origin.place((odometry.x_m, odometry.y_m))
    assert (x, y, origin.yaw_rad + odometry.yaw_rad) == pytest.approx((truth.x_m, truth.y_m, truth.yaw_rad))


def test_a_picture_is_a_texture_and_a_mosaic_for_viewers_without_textures():
    _, playground = load_playground("line_gradient")
    (print_,) = playground.paints
    message = playground_markers((*playground.floors, *playground.paints))
    (marker,) = (marker for marker in message.markers if marker.ns == "paint/track")
    assert (marker.scale.x, marker.scale.y) == pytest.approx((print_.size_x_m, print_.size_y_m))
    assert bytes(marker.texture.data[:4]) == b"\x89PNG"
    assert len(marker.points) == len(marker.colors) == len(marker.uv_coordinates) > 0
    assert {abs(point.x) <= 0.5 and abs(point.y) <= 0.5 for point in marker.points} == {True}
    assert {(round(point.x + 0.5 - uv.u, 6), round(point.y + 0.5 - uv.v, 6)) for point, uv in
            zip(marker.points, marker.uv_coordinates, strict=True)} == {(0.0, 0.0)}  # fmt: skip
