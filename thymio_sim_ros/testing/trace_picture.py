"""A picture of a test's world from above: what stands and lies there, and where the robots drove."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Mapping, Sequence

from thymio_sim_ros.sim.formats.image_io import Pixels, data_uri, encode_png
from thymio_sim_ros.sim.model.geometry import Point, Pose
from thymio_sim_ros.sim.model.primitives import Color, Disc, Mark, Paint, Solid
from thymio_sim_ros.sim.playground.reader import Playground

__all__ = ["draw_traces"]

_WIDTH = 640
_MARGIN_M = 0.1
_ROBOT_M = 0.055
"""Radius of the disc that shows a robot."""
_MOST_POINTS = 2000
_TRACES = ("#d4302b", "#1f6fd1", "#2b8a3e", "#a8480b", "#7a3fb0")


def draw_traces(playground: Playground, traces: Mapping[str, Sequence[Pose]]) -> str:
    """Draw the start of a playground and the poses of each robot, oldest first, as SVG. Empty traces are left out."""
    driven = {name: _thinned(poses) for name, poses in traces.items() if poses}
    points = [*_points(playground), *((pose.x_m, pose.y_m) for poses in driven.values() for pose in poses)]
    left, right = min(x for x, _ in points) - _MARGIN_M, max(x for x, _ in points) + _MARGIN_M
    low, high = min(y for _, y in points) - _MARGIN_M, max(y for _, y in points) + _MARGIN_M
    body = [
        *(_polygon(floor.vertices, "#f4f4f2", "#b5b5b0") for floor in playground.floors),
        *(_mark(mark) for mark in playground.paints),
        *(_solid(solid) for solid in playground.solids),
    ]
    for number, (name, poses) in enumerate(driven.items()):
        body += _trace(name, poses, _TRACES[number % len(_TRACES)])
    size = f'width="{_WIDTH}" height="{_WIDTH * (high - low) / (right - left):.0f}"'
    box = f'viewBox="{left:.4f} {-high:.4f} {right - left:.4f} {high - low:.4f}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} {box}>'
    return "\n".join([head, *body, "</svg>\n"])


def _points(playground: Playground) -> Iterable[Point]:
    for floor in playground.floors:
        yield from floor.vertices
    for solid in playground.solids:
        yield solid.pose.x_m, solid.pose.y_m
        yield from solid.vertices
    for robot in playground.robots:
        yield robot.x_m, robot.y_m


def _thinned(poses: Sequence[Pose]) -> Sequence[Pose]:
    step = len(poses) // _MOST_POINTS + 1
    return [*poses[::step], poses[-1]]


def _trace(name: str, poses: Sequence[Pose], color: str) -> list[str]:
    path = " ".join(f"{pose.x_m:.4f},{-pose.y_m:.4f}" for pose in poses)
    first, last = poses[0], poses[-1]
    nose_x, nose_y = last.place((_ROBOT_M, 0.0))
    return [
        f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="0.006" stroke-linejoin="round"/>',
        f'<circle cx="{first.x_m:.4f}" cy="{-first.y_m:.4f}" r="0.012" fill="{color}"/>',
        f'<circle cx="{last.x_m:.4f}" cy="{-last.y_m:.4f}" r="{_ROBOT_M}" fill="{color}" fill-opacity="0.35"'
        f' stroke="{color}" stroke-width="0.004"><title>{html.escape(name)}</title></circle>',
        f'<line x1="{last.x_m:.4f}" y1="{-last.y_m:.4f}" x2="{nose_x:.4f}" y2="{-nose_y:.4f}" stroke="{color}"'
        ' stroke-width="0.006"/>',
    ]


def _solid(solid: Solid) -> str:
    if isinstance(solid.outline, Disc):
        x, y, radius = solid.pose.x_m, solid.pose.y_m, solid.outline.radius_m
        return f'<circle cx="{x:.4f}" cy="{-y:.4f}" r="{radius:.4f}" fill="{_hex(solid.color)}"/>'
    return _polygon(solid.vertices, _hex(solid.color), "none")


def _mark(mark: Mark) -> str:
    if isinstance(mark, Paint):
        return _polygon(mark.vertices, _hex(mark.color), "none")
    png = encode_png(Pixels(mark.columns, mark.rows, mark.rgba), most=_WIDTH)
    degrees, x, y = -math.degrees(mark.pose.yaw_rad), mark.pose.x_m, -mark.pose.y_m
    place = f'x="{x - mark.size_x_m / 2:.4f}" y="{y - mark.size_y_m / 2:.4f}"'
    size = f'width="{mark.size_x_m:.4f}" height="{mark.size_y_m:.4f}" preserveAspectRatio="none"'
    turn = f'transform="rotate({degrees:.2f} {x:.4f} {y:.4f})"'
    return f'<image {place} {size} {turn} href="{data_uri(png, "image/png")}"/>'


def _polygon(vertices: Iterable[Point], fill: str, stroke: str) -> str:
    points = " ".join(f"{x:.4f},{-y:.4f}" for x, y in vertices)
    return f'<polygon points="{points}" fill="{fill}" stroke="{stroke}" stroke-width="0.002"/>'


def _hex(color: Color) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in color)
