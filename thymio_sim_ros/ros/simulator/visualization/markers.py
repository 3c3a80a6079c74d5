"""Converts a playground to a visualization_msgs/MarkerArray in the frame `map`: solids, floors and paint.

Namespaces are the kinds of primitives, ids their order, so that both are stable; DELETEALL comes first
(docs/spec/ros-interface.md section 5).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence

from geometry_msgs.msg import Point as PointMsg
from geometry_msgs.msg import Vector3
from sensor_msgs.msg import CompressedImage
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray, UVCoordinate

from thymio_sim_ros.ros.interface.convert_readings import quaternion
from thymio_sim_ros.ros.interface.names import MAP_FRAME
from thymio_sim_ros.sim.formats import image_io
from thymio_sim_ros.sim.formats.image_io import Pixels
from thymio_sim_ros.sim.ground.rect_tiling import Tile, mosaic
from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Box, Color, Disc, Drawable, Floor, Paint, Print, Solid

LAYER_M = 0.0002
"""Vertical distance between successive layers of paint, so that viewers draw them in the right order."""


MAX_TEXELS = 2048
"""Side of the largest texture in texels; graphics hardware supports at least twice that."""


MAX_TILES = 16_000
"""Total number of tiles of all images: each has six points, which take time to create and to send."""


def playground_markers(primitives: Iterable[Drawable], frame: str = MAP_FRAME) -> MarkerArray:
    """Return markers of all primitives in order; adjacent paint of one name and color becomes one marker."""
    primitives = list(primitives)
    prints = sum(isinstance(primitive, Print) for primitive in primitives)
    markers = [Marker(action=Marker.DELETEALL)]
    layer = 0
    for (kind, name, color), group in itertools.groupby(primitives, key=_sort_of):
        outlines = []
        for primitive in group:
            if isinstance(primitive, Solid):
                markers.append(_solid(primitive, len(markers)))
            elif isinstance(primitive, Print):
                layer += 1
                markers.append(_print(primitive, len(markers), layer * LAYER_M, MAX_TILES // prints))
            else:
                outlines.append(primitive.vertices)
        if not outlines:
            continue
        layer += kind is Paint
        namespace = "floor" if kind is Floor else "paint"
        markers.append(_patches(f"{namespace}/{name}", len(markers), outlines, color, layer * LAYER_M))
    for marker in markers:
        marker.header.frame_id = frame
    return MarkerArray(markers=markers)


def _sort_of(primitive: Drawable) -> tuple[type, str, Color]:
    color = (1.0, 1.0, 1.0) if isinstance(primitive, Print) else primitive.color
    return type(primitive), primitive.name, color


def _solid(solid: Solid, number: int) -> Marker:
    marker = _marker(f"solid/{solid.name}", number, solid.color)
    marker.pose.position = PointMsg(x=solid.pose.x_m, y=solid.pose.y_m, z=solid.height_m / 2)
    marker.pose.orientation = quaternion(solid.pose.yaw_rad)
    outline = solid.outline
    if isinstance(outline, Box):
        marker.type = Marker.CUBE
        marker.scale = Vector3(x=outline.size_x_m, y=outline.size_y_m, z=solid.height_m)
    elif isinstance(outline, Disc):
        marker.type = Marker.CYLINDER
        marker.scale = Vector3(x=2 * outline.radius_m, y=2 * outline.radius_m, z=solid.height_m)
    else:
        marker.type = Marker.TRIANGLE_LIST
        marker.scale = Vector3(x=1.0, y=1.0, z=1.0)
        marker.points = _prism(outline.vertices, solid.height_m / 2)
    return marker


def _patches(namespace: str, number: int, outlines: Sequence[Sequence[Point]], color: Color, height_m: float) -> Marker:
    marker = _marker(namespace, number, color)
    marker.type = Marker.TRIANGLE_LIST
    marker.scale = Vector3(x=1.0, y=1.0, z=1.0)
    marker.pose.position.z = height_m
    marker.points = [_point(corner, 0.0) for outline in outlines for corner in _fan(outline)]
    return marker


def _print(printed: Print, number: int, height_m: float, tiles: int) -> Marker:
    """Return a marker with the image as a texture (our page, RViz) and as colored tiles for other viewers."""
    marker = _marker(f"paint/{printed.name}", number, (1.0, 1.0, 1.0))
    marker.type = Marker.TRIANGLE_LIST
    marker.scale = Vector3(x=printed.size_x_m, y=printed.size_y_m, z=1.0)
    marker.pose.position = PointMsg(x=printed.pose.x_m, y=printed.pose.y_m, z=height_m)
    marker.pose.orientation = quaternion(printed.pose.yaw_rad)
    pixels = Pixels(printed.columns, printed.rows, printed.rgba)
    for tile in mosaic(pixels, most=tiles):
        red, green, blue, opacity = tile.color
        marker.colors += [ColorRGBA(r=red, g=green, b=blue, a=opacity)] * 6
        for u, v in _fan(_corners(tile)):
            marker.points.append(PointMsg(x=u - 0.5, y=v - 0.5))
            marker.uv_coordinates.append(UVCoordinate(u=u, v=v))
    marker.texture_resource = f"embedded://{printed.name}"
    marker.texture = CompressedImage(format="png", data=image_io.encode_png(pixels, most=MAX_TEXELS))
    return marker


def _corners(tile: Tile) -> tuple[Point, ...]:
    return ((tile.left, tile.bottom), (tile.right, tile.bottom), (tile.right, tile.top), (tile.left, tile.top))


def _marker(namespace: str, number: int, color: Color) -> Marker:
    red, green, blue = color
    return Marker(ns=namespace, id=number, action=Marker.ADD, color=ColorRGBA(r=red, g=green, b=blue, a=1.0))


def _fan(outline: Sequence[Point]) -> Iterator[Point]:
    """Yield the triangles of a convex polygon as a triangle fan: three corners each, counter-clockwise."""
    for second, third in itertools.pairwise(outline[1:]):
        yield from (outline[0], second, third)


def _prism(outline: Sequence[Point], half_height_m: float) -> list[PointMsg]:
    """Return the triangles of the sides and the top of an upright prism centered at height zero."""
    points = [_point(corner, half_height_m) for corner in _fan(outline)]
    for index, end in enumerate(outline):
        begin = outline[index - 1]
        low_begin, low_end = _point(begin, -half_height_m), _point(end, -half_height_m)
        high_begin, high_end = _point(begin, half_height_m), _point(end, half_height_m)
        points += [low_begin, low_end, high_end, low_begin, high_end, high_begin]
    return points


def _point(point: Point, z_m: float) -> PointMsg:
    return PointMsg(x=point[0], y=point[1], z=z_m)
