"""Kernels: the distances of the rays of all robots. `raycast.scalar` has the same for single rays, and the derivations.

A kernel keeps a list of candidates for each fan, pairs of a robot and an obstacle that are near each other with a
margin; it finds them again when something has moved by a third of the margin, fallen or come back. The rays of a robot
are computed in the frame of each candidate, and only for sensors that are near it and not turned away.
"""

from __future__ import annotations

import math

from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Floats, Ints, kernel
from thymio_sim_ros.sim.kernel.elementary import cos, sin
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.robot_state import RobotState
from thymio_sim_ros.sim.raycast.obstacle_table import (
    BOX,
    DISC,
    FAR_M,
    HULL_FRAME,
    NOWHERE_M,
    Obstacles,
    Planes,
)

__all__ = ["Candidates", "Limits", "Mounts", "Near", "Rays", "cast"]

_FAR = math.inf
_TINY = 1e-300
"""Replaces 0 in a division, where a ray is parallel to a side."""
_MARGIN_M = 0.15
_MOVE_M = _MARGIN_M / 3
"""Both of a pair may move so far along each axis, which leaves a third as reserve."""
_HULL_X, _HULL_Y, _HULL_COS, _HULL_SIN, _, _ = HULL_FRAME
_HULL_HEIGHT_M = robot_constants.HULL_HEIGHT_M


class Mounts(Record):
    """The sensors of a robot, in its frame."""

    x: Floats
    """Origin of the rays, m."""
    y: Floats
    axis_x: Floats
    """Unit direction of the middle ray."""
    axis_y: Floats
    cosine: Floats
    """Of the angle between the axis and the outermost ray."""
    sine: Floats
    first_ray: Ints
    """The rays of a sensor are `first_ray` to `last_ray`, the end not included."""
    last_ray: Ints


class Rays(Record):
    """Unit directions of the rays in the robot's frame, sensor by sensor."""

    x: Floats
    y: Floats


class Limits(Record):
    """Range and height of the rays; one element."""

    range: Floats
    """Length of the rays, m."""
    reach: Floats
    """Distance of the farthest end of a ray from the robot's origin, at most, m."""
    height: Floats
    """Height of the rays above the floor, m; lower obstacles are not detected."""


class Near(Record):
    """The obstacles as they were when the candidates of a fan were determined."""

    x: Floats
    """Position, m; FAR_M if the candidates are out of date."""
    y: Floats
    height: Floats
    """Height, m."""
    reach_x: Floats
    """Distance along the world's axes within which a robot may detect it, with a margin, m."""
    reach_y: Floats


class Candidates(Record):
    """The obstacles that each robot may detect: a part of the list `near`, which has rows of `Obstacles`."""

    first: Ints
    """The part of a robot is `first` to `last`, the end not included."""
    last: Ints


@kernel
def _meet_disc(x: float, y: float, dx: float, dy: float, radius: float) -> float:
    """The distance at which a ray enters a disc around the origin, inf if it does not."""
    middle = -(x * dx + y * dy)
    square = radius * radius - (x * x + y * y - middle * middle)
    enter = middle - math.sqrt(max(square, 0.0))
    return enter if square >= 0.0 and enter >= 0.0 else _FAR


@kernel
def _meet_box(x: float, y: float, dx: float, dy: float, half_x: float, half_y: float) -> float:
    """The distance at which a ray enters a box around the origin, inf if it does not.

    It enters the strip |x| <= half_x at the smaller of the two distances (-x ± half_x) / dx, and the box where it is in
    both strips.
    """
    across_x = 1.0 / (_TINY if dx == 0.0 else dx)
    across_y = 1.0 / (_TINY if dy == 0.0 else dy)
    middle_x = -x * across_x
    middle_y = -y * across_y
    wide_x = abs(half_x * across_x)
    wide_y = abs(half_y * across_y)
    enter = max(middle_x - wide_x, middle_y - wide_y)
    leave = min(middle_x + wide_x, middle_y + wide_y)
    return enter if 0.0 <= enter <= leave else _FAR


@kernel
def _meet_polygon(x: float, y: float, dx: float, dy: float, planes: Planes, first: int, last: int) -> float:
    """The distance at which a ray enters the half planes `first` to `last` (exclusive), inf if it does not."""
    enter = -_FAR
    leave = _FAR
    for plane in range(first, last):
        nx = planes.normal_x[plane]
        ny = planes.normal_y[plane]
        along = nx * dx + ny * dy
        if along == 0.0:
            along = _TINY
        time = (planes.limit[plane] - nx * x - ny * y) / along
        if along < 0.0:
            enter = max(enter, time)
        else:
            leave = min(leave, time)
    return enter if 0.0 <= enter <= leave else _FAR


@kernel
def _is_facing(x: float, y: float, ax: float, ay: float, cosine: float, sine: float, radius: float) -> int:
    """Whether a ray of a sensor at x, y may meet a circle around the origin.

    The sensor's axis is ax, ay; `cosine` and `sine` are of the angle between the axis and its outermost ray, which is
    below 90 degrees. Seen from the sensor, the center of the circle is `ahead` along the axis and `aside` of it. The
    outermost ray passes it at the signed distance aside * cosine - ahead * sine; beyond the radius, no ray meets the
    circle. A circle behind the sensor passes this test, so `ahead` is tested, too.
    """
    ahead = -(ax * x + ay * y)
    aside = abs(ax * y - ay * x)
    return 1 if aside * cosine - ahead * sine <= radius and ahead >= -radius else 0


@kernel
def _place_hulls(robots: RobotState, obstacles: Obstacles, count: int) -> None:
    """Write the frames of the robots' hulls, the last `count` obstacles."""
    for robot in range(count):
        row = obstacles.count - count + robot
        if robots.is_standing[robot] == 0:
            obstacles.x[row] = FAR_M
            obstacles.height[row] = NOWHERE_M
            continue
        c = cos(robots.yaw[robot])
        s = sin(robots.yaw[robot])
        obstacles.x[row] = robots.x[robot] + c * _HULL_X - s * _HULL_Y
        obstacles.y[row] = robots.y[robot] + s * _HULL_X + c * _HULL_Y
        obstacles.cosine[row] = c * _HULL_COS - s * _HULL_SIN
        obstacles.sine[row] = s * _HULL_COS + c * _HULL_SIN
        obstacles.height[row] = _HULL_HEIGHT_M


@kernel
def _is_stale(obstacles: Obstacles, known: Near) -> int:
    """Whether something has moved too far for the list of candidates, fallen or come back."""
    for row in range(obstacles.count):
        if (
            abs(obstacles.x[row] - known.x[row]) > _MOVE_M
            or abs(obstacles.y[row] - known.y[row]) > _MOVE_M
            or obstacles.height[row] != known.height[row]
        ):
            return 1
    return 0


@kernel
def _find_candidates(
    robots: RobotState, obstacles: Obstacles, known: Near, limits: Limits, candidates: Candidates, near: Ints
) -> None:
    """List the obstacles that each robot may detect."""
    reach = limits.reach[0]
    height = limits.height[0]
    first_hull = obstacles.count - candidates.count
    for row in range(obstacles.count):
        known.x[row] = obstacles.x[row]
        known.y[row] = obstacles.y[row]
        known.height[row] = obstacles.height[row]
        # Half size of the bounding box: that of the circle around it, as what moves may turn. The box of what never
        # turns is smaller, except for a disc.
        half_x = obstacles.half_x[row]
        half_y = obstacles.half_y[row]
        half = math.sqrt(half_x * half_x + half_y * half_y)
        c = abs(obstacles.cosine[row])
        s = abs(obstacles.sine[row])
        along_x = half
        along_y = half
        if obstacles.is_fixed[row] == 1:
            along_x = min(half, c * half_x + s * half_y)
            along_y = min(half, s * half_x + c * half_y)
        known.reach_x[row] = along_x + reach + _MARGIN_M
        known.reach_y[row] = along_y + reach + _MARGIN_M
    found = 0
    for robot in range(candidates.count):
        candidates.first[robot] = found
        candidates.last[robot] = found
        if robots.is_standing[robot] == 0:
            continue
        x = robots.x[robot]
        y = robots.y[robot]
        for row in range(obstacles.count):
            if (
                abs(x - obstacles.x[row]) <= known.reach_x[row]
                and abs(y - obstacles.y[row]) <= known.reach_y[row]
                and obstacles.height[row] >= height
                and row != first_hull + robot
            ):
                near[found] = row
                found += 1
        candidates.last[robot] = found


@kernel
def cast(
    robots: RobotState,
    obstacles: Obstacles,
    planes: Planes,
    mounts: Mounts,
    rays: Rays,
    limits: Limits,
    known: Near,
    candidates: Candidates,
    near: Ints,
    distances: Floats,
) -> None:
    """Write the lengths of all rays to `distances`, shape (robots, sensors, rays), inf for a ray that meets nothing.

    Args:
        robots: poses of the robots.
        obstacles: all obstacles, those of the robots last; these are written.
        planes: half planes of the polygons.
        mounts: sensors of a robot.
        rays: rays of a robot.
        limits: range and height of the rays.
        known: one element for each obstacle; written, as are `candidates` and `near`.
        candidates: one element for each robot.
        near: rows of the candidates, shape (robots * obstacles,).
        distances: result.
    """
    count = candidates.count
    _place_hulls(robots, obstacles, count)
    if _is_stale(obstacles, known) == 1:
        _find_candidates(robots, obstacles, known, limits, candidates, near)
    # Locals: WebAssembly reads an element of a record from memory each time.
    range_m = limits.range[0]
    reach_m = limits.reach[0]
    first_hull = obstacles.count - count
    far = range_m * (1.0 + 1e-12)
    for number in range(count * rays.count):
        distances[number] = _FAR
    for robot in range(count):
        own = first_hull + robot
        for pair in range(candidates.first[robot], candidates.last[robot]):
            row = near[pair]
            half_x = obstacles.half_x[row]
            half_y = obstacles.half_y[row]
            turn_c = obstacles.cosine[row]
            turn_s = obstacles.sine[row]
            # Position and heading (c, s) of the robot in the frame of the obstacle: a rotation by minus its heading.
            dx = robots.x[robot] - obstacles.x[row]
            dy = robots.y[robot] - obstacles.y[row]
            x = turn_c * dx + turn_s * dy
            y = turn_c * dy - turn_s * dx
            if abs(x) - half_x > reach_m or abs(y) - half_y > reach_m:
                continue
            own_c = obstacles.cosine[own] * _HULL_COS + obstacles.sine[own] * _HULL_SIN
            own_s = obstacles.sine[own] * _HULL_COS - obstacles.cosine[own] * _HULL_SIN
            c = own_c * turn_c + own_s * turn_s
            s = own_s * turn_c - own_c * turn_s
            radius = math.sqrt(half_x * half_x + half_y * half_y)
            for sensor in range(mounts.count):
                px = mounts.x[sensor]
                py = mounts.y[sensor]
                sx = x + c * px - s * py
                sy = y + s * px + c * py
                if max(abs(sx) - half_x, abs(sy) - half_y) > range_m:
                    continue
                ax = c * mounts.axis_x[sensor] - s * mounts.axis_y[sensor]
                ay = s * mounts.axis_x[sensor] + c * mounts.axis_y[sensor]
                cosine = mounts.cosine[sensor]
                if cosine > 0.0 and _is_facing(sx, sy, ax, ay, cosine, mounts.sine[sensor], radius) == 0:
                    continue
                for ray in range(mounts.first_ray[sensor], mounts.last_ray[sensor]):
                    way_x = c * rays.x[ray] - s * rays.y[ray]
                    way_y = s * rays.x[ray] + c * rays.y[ray]
                    if obstacles.kind[row] == BOX:
                        met = _meet_box(sx, sy, way_x, way_y, half_x, half_y)
                    elif obstacles.kind[row] == DISC:
                        met = _meet_disc(sx, sy, way_x, way_y, half_x)
                    else:
                        met = _meet_polygon(
                            sx, sy, way_x, way_y, planes, obstacles.first_plane[row], obstacles.last_plane[row]
                        )
                    number = robot * rays.count + ray
                    if met < far and met < distances[number]:
                        distances[number] = met
