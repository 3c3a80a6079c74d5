"""`sensor_msgs_py.point_cloud2`, as course files import it where it is not installed."""

from __future__ import annotations

import importlib.util
import math

import numpy as np
import pytest

if importlib.util.find_spec("sensor_msgs") is None:
    pytest.skip("needs the messages of ROS", allow_module_level=True)

from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

from thymio_sim_ros.course_packages.packages.sensor_msgs_py import point_cloud2

FIELDS = [
    PointField(name="x", offset=0, datatype=PointField.FLOAT32, count=1),
    PointField(name="ring", offset=6, datatype=PointField.UINT16, count=1),
    PointField(name="normal", offset=8, datatype=PointField.FLOAT64, count=2),
]


def test_points_are_read_as_they_were_given() -> None:
    cloud = point_cloud2.create_cloud_xyz32(Header(frame_id="map"), [(1, 2, 3), (4.5, math.nan, 6)])
    assert (cloud.header.frame_id, cloud.height, cloud.width, cloud.point_step, cloud.row_step) == ("map", 1, 2, 12, 24)
    assert point_cloud2.read_points(cloud)["x"].tolist() == [1.0, 4.5]
    assert point_cloud2.read_points(cloud, ("z", "x"), skip_nans=True).tolist() == [(3.0, 1.0), (6.0, 4.5)]
    assert point_cloud2.read_points_numpy(cloud, skip_nans=True).tolist() == [[1.0, 2.0, 3.0]]
    (first, _) = point_cloud2.read_points_list(cloud, ["x", "y"])
    assert (first.x, first.y) == (1.0, 2.0)


def test_fields_have_their_places_types_and_numbers() -> None:
    cloud = point_cloud2.create_cloud(Header(), FIELDS, [(1.5, 7, 0.1, 0.2), (2.5, 8, 0.3, 0.4)], step=32)
    assert (cloud.point_step, len(cloud.data)) == (32, 64)
    points = point_cloud2.read_points(cloud)
    assert points.dtype.names == ("x", "ring", "normal_0", "normal_1")
    assert points["ring"].dtype == np.uint16
    assert points[1].tolist() == (2.5, 8, 0.3, 0.4)
    again = point_cloud2.create_cloud(Header(), FIELDS, points, step=32)
    assert bytes(again.data) == bytes(cloud.data)


def test_organized_clouds_have_rows_gaps_and_either_order_of_bytes() -> None:
    values = np.arange(6, dtype=">f4").reshape(2, 3)
    rows = b"".join(row.tobytes() + b"gap!" for row in values)
    cloud = PointCloud2(
        height=2,
        width=3,
        fields=FIELDS[:1],
        is_bigendian=True,
        point_step=4,
        row_step=16,
        data=rows,
        is_dense=True,
    )
    assert point_cloud2.read_points(cloud)["x"].tolist() == [0, 1, 2, 3, 4, 5]
    assert point_cloud2.read_points(cloud, reshape_organized_cloud=True)["x"].tolist() == values.tolist()
    assert point_cloud2.read_points(cloud, uvs=[(2, 0), (0, 1)])["x"].tolist() == [2, 3]


def test_what_does_not_fit_is_said() -> None:
    cloud = point_cloud2.create_cloud(Header(), FIELDS, [(1.5, 7, 0.1, 0.2)])
    with pytest.raises(ValueError, match="found no field q in the cloud, expected one of x, ring, normal_0, normal_1"):
        point_cloud2.read_points(cloud, ["q"])
    with pytest.raises(ValueError, match="found fields of float32, float64, uint16, expected one type"):
        point_cloud2.read_points_numpy(cloud)
    cloud.width = 2
    with pytest.raises(ValueError, match="found 24 bytes in rows of 24, expected 1 rows of 2 points of 24 bytes"):
        point_cloud2.read_points(cloud)
