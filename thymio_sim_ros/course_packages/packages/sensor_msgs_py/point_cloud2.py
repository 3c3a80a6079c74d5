"""Points of `sensor_msgs/msg/PointCloud2` as arrays of NumPy, and clouds of points, as `sensor_msgs_py` has them."""

from __future__ import annotations

import sys
from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

__all__ = [
    "create_cloud",
    "create_cloud_xyz32",
    "dtype_from_fields",
    "read_points",
    "read_points_list",
    "read_points_numpy",
]

Points = NDArray[Any]
_TYPES = {
    PointField.INT8: np.int8,
    PointField.UINT8: np.uint8,
    PointField.INT16: np.int16,
    PointField.UINT16: np.uint16,
    PointField.INT32: np.int32,
    PointField.UINT32: np.uint32,
    PointField.FLOAT32: np.float32,
    PointField.FLOAT64: np.float64,
}


def read_points(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Sequence[int]] | None = None,
    reshape_organized_cloud: bool = False,
) -> Points:
    """The points as an array with a field for each field of the cloud, or for those of `field_names`.

    Args:
        cloud: The message.
        field_names: Fields, in the order of the result.
        skip_nans: Leave out points with a value that is not a number.
        uvs: Column and row of the points that are wanted.
        reshape_organized_cloud: The array of a cloud with several rows has the shape (height, width).

    Raises:
        ValueError: There is no field of a name, or the cloud has fewer bytes than its size says.
    """
    points = _grid(cloud)
    if field_names is not None:
        known = points.dtype.names or ()
        if missing := [name for name in field_names if name not in known]:
            raise ValueError(f"found no field {missing[0]} in the cloud, expected one of {', '.join(known)}")
        points = points[list(field_names)]
    if uvs is not None:
        columns, rows = np.asarray(list(uvs), np.intp).reshape(-1, 2).T
        points = points[rows, columns]
    elif not (reshape_organized_cloud and cloud.height > 1):
        points = points.reshape(-1)
    if skip_nans and not cloud.is_dense and points.ndim == 1:
        points = points[~np.any([np.isnan(points[name]) for name in points.dtype.names or ()], axis=0)]
    return points


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Sequence[int]] | None = None,
    reshape_organized_cloud: bool = False,
) -> Points:
    """As `read_points`, with the fields as the last axis. Raises ValueError also for fields of several types."""
    points = read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud)
    names = points.dtype.names or ()
    types = {points.dtype[name] for name in names}
    if len(types) > 1:
        raise ValueError(f"found fields of {', '.join(sorted(map(str, types)))}, expected one type: name such fields")
    return np.stack([points[name] for name in names], axis=-1)


def read_points_list(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Sequence[int]] | None = None,
) -> list[Any]:
    """As `read_points`, as a list of tuples with the names of the fields."""
    points = read_points(cloud, field_names, skip_nans, uvs)
    names = points.dtype.names or ()
    made = namedtuple("Point", names)  # type: ignore[misc]  # the fields are known at run time only
    return [made(*values) for values in points.tolist()]


def dtype_from_fields(fields: Iterable[PointField], point_step: int | None = None) -> np.dtype[Any]:
    """The type of a point, of `point_step` bytes; several values of one field are `name_0`, `name_1` and so on."""
    names, formats, offsets = [], [], []
    for field in fields:
        kind = np.dtype(_TYPES[field.datatype])
        for number in range(field.count):
            names.append(f"{field.name}_{number}" if field.count > 1 else field.name)
            formats.append(kind)
            offsets.append(field.offset + number * kind.itemsize)
    layout: Any = {"names": names, "formats": formats, "offsets": offsets}
    if point_step is not None:
        layout["itemsize"] = point_step
    made: np.dtype[Any] = np.dtype(layout)
    return made


def create_cloud(header: Header, fields: Sequence[PointField], points: Any, step: int | None = None) -> PointCloud2:
    """A cloud of points: an array with fields, or rows of values; its rows are those of an array of two dimensions."""
    kind = dtype_from_fields(fields, step)
    if isinstance(points, np.ndarray) and points.dtype.names is not None:
        values = points.astype(kind)
    else:
        rows = np.asarray(points).reshape(-1, len(kind.names or ()))
        values = np.zeros(len(rows), kind)
        for number, name in enumerate(kind.names or ()):
            values[name] = rows[:, number]
    grid = np.atleast_2d(values)
    height, width = grid.shape
    return PointCloud2(
        header=header,
        height=height,
        width=width,
        fields=list(fields),
        is_bigendian=sys.byteorder == "big",
        point_step=kind.itemsize,
        row_step=kind.itemsize * width,
        data=np.ascontiguousarray(grid).tobytes(),
        is_dense=False,
    )


def create_cloud_xyz32(header: Header, points: Any) -> PointCloud2:
    """A cloud of points with x, y and z."""
    names = enumerate("xyz")
    fields = [PointField(name=name, offset=4 * at, datatype=PointField.FLOAT32, count=1) for at, name in names]
    return create_cloud(header, fields, points)


def _grid(cloud: PointCloud2) -> Points:
    """The points in rows."""
    kind = dtype_from_fields(cloud.fields, cloud.point_step).newbyteorder(">" if cloud.is_bigendian else "<")
    data = np.frombuffer(memoryview(cloud.data).cast("B"), np.uint8)
    if len(data) < cloud.height * cloud.row_step or cloud.row_step < cloud.width * cloud.point_step:
        raise ValueError(
            f"found {len(data)} bytes in rows of {cloud.row_step}, expected {cloud.height} rows of {cloud.width} points"
            f" of {cloud.point_step} bytes"
        )
    rows = data[: cloud.height * cloud.row_step].reshape(cloud.height, cloud.row_step)
    used = np.ascontiguousarray(rows[:, : cloud.width * cloud.point_step])
    return used.view(kind).reshape(cloud.height, cloud.width)
