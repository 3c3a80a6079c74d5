"""Kernel: the distances of the rays of all robots, computed as in `BatchRaycaster.cast`, operation by operation."""

from __future__ import annotations

import math

from thymio_sim_ros.sim.kernel.types import Floats, Ints, kernel

__all__ = ["COUNTS", "cast"]

COUNTS = ("robots", "sensors", "rays", "things", "fixed", "is_narrow", "seen", "is_stale")
"""What each of `counts` is: the last two are answers."""
_ROBOTS, _SENSORS, _RAYS, _THINGS, _FIXED, _IS_NARROW, _SEEN, _IS_STALE = range(len(COUNTS))
_RANGE, _REACH, _MOST, _HULL = 0, 1, 2, 3
"""Places in `sizes`; the frame of a hull has six numbers."""
_FAR = math.inf
_TINY = 1e-300
_DISC, _BOX = -2, -1


@kernel
def meet_disc(x: float, y: float, dx: float, dy: float, radius: float) -> float:
    """How far a ray goes until it enters a disc round the origin."""
    middle = -(x * dx + y * dy)
    square = radius * radius - (x * x + y * y - middle * middle)
    enter = middle - math.sqrt(max(square, 0.0))
    return enter if square >= 0.0 and enter >= 0.0 else _FAR


@kernel
def meet_box(x: float, y: float, dx: float, dy: float, half_x: float, half_y: float) -> float:
    """How far a ray goes until it enters a box round the origin."""
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
def meet_polygon(x: float, y: float, dx: float, dy: float, planes: Floats, first: int, last: int) -> float:
    """How far a ray goes until it is inside all of some half planes."""
    enter = -_FAR
    leave = _FAR
    for plane in range(first, last):
        nx = planes[3 * plane]
        ny = planes[3 * plane + 1]
        along = nx * dx + ny * dy
        if along == 0.0:
            along = _TINY
        time = (planes[3 * plane + 2] - nx * x - ny * y) / along
        if along < 0.0:
            enter = max(enter, time)
        else:
            leave = min(leave, time)
    return enter if 0.0 <= enter <= leave else _FAR


@kernel
def is_facing(x: float, y: float, ax: float, ay: float, cos: float, sin: float, radius: float) -> int:
    """Whether a ray of a sensor at x, y may meet a circle round the origin: axis, and angle to its outermost ray."""
    ahead = -(ax * x + ay * y)
    aside = abs(ax * y - ay * x)
    return 1 if aside * cos - ahead * sin <= radius and ahead >= -radius else 0


@kernel
def cast(
    counts: Ints,
    sizes: Floats,
    places: Floats,
    axes: Floats,
    edges: Floats,
    directions: Floats,
    poses: Floats,
    turns: Floats,
    frames: Floats,
    was: Floats,
    kinds: Ints,
    first: Ints,
    things: Ints,
    planes: Floats,
    sides: Ints,
    numbers: Ints,
    distances: Floats,
) -> None:
    """Number of each sensor that sees anything, counted robot by robot, and the distances of its rays.

    Things are those that never move, those that may, then robots: a frame of seven numbers each. Those near robot r are
    `things` from `first[r]` on; the list is stale when anything is too far from where it `was`. The planes of polygon k
    are those from `sides[k]` on; the last polygon is the hull. Of sensors there are x, y of places and axes, cosine and
    sine of `edges`, x, y of `directions` of every ray.
    """
    robots = counts[_ROBOTS]
    sensors = counts[_SENSORS]
    rays = counts[_RAYS]
    own = counts[_THINGS]
    limit = sizes[_RANGE]
    reach = sizes[_REACH]
    most = sizes[_MOST]
    far = limit * (1.0 + 1e-12)
    loose = own - counts[_FIXED]
    is_stale = 0
    for thing in range(loose):
        at = 7 * (counts[_FIXED] + thing)
        if abs(frames[at] - was[2 * thing]) > most or abs(frames[at + 1] - was[2 * thing + 1]) > most:
            is_stale = 1
    hull_x = sizes[_HULL]
    hull_y = sizes[_HULL + 1]
    for robot in range(robots):
        x = poses[3 * robot]
        y = poses[3 * robot + 1]
        if abs(x - was[2 * (loose + robot)]) > most or abs(y - was[2 * (loose + robot) + 1]) > most:
            is_stale = 1
        c = turns[robot]
        s = turns[robots + robot]
        at = 7 * (own + robot)
        frames[at] = x + c * hull_x - s * hull_y
        frames[at + 1] = y + s * hull_x + c * hull_y
        frames[at + 2] = c * sizes[_HULL + 2] - s * sizes[_HULL + 3]
        frames[at + 3] = s * sizes[_HULL + 2] + c * sizes[_HULL + 3]
    counts[_IS_STALE] = is_stale
    if is_stale == 1:
        return
    seen = 0
    for robot in range(robots):
        sees = 0
        for pair in range(first[robot], first[robot + 1]):
            thing = things[pair]
            at = 7 * thing
            half_x = frames[at + 4]
            half_y = frames[at + 5]
            turn_c = frames[at + 2]
            turn_s = frames[at + 3]
            dx = poses[3 * robot] - frames[at]
            dy = poses[3 * robot + 1] - frames[at + 1]
            x = turn_c * dx + turn_s * dy
            y = turn_c * dy - turn_s * dx
            if abs(x) - half_x <= reach and abs(y) - half_y <= reach:
                c = turns[robot] * turn_c + turns[robots + robot] * turn_s
                s = turns[robots + robot] * turn_c - turns[robot] * turn_s
                radius = math.sqrt(half_x * half_x + half_y * half_y)
                for sensor in range(sensors):
                    px = places[sensor]
                    py = places[sensors + sensor]
                    sx = x + c * px - s * py
                    sy = y + s * px + c * py
                    if max(abs(sx) - half_x, abs(sy) - half_y) > limit:
                        continue
                    ax = axes[sensor]
                    ay = axes[sensors + sensor]
                    if (
                        counts[_IS_NARROW] == 1
                        and is_facing(
                            sx, sy, c * ax - s * ay, s * ax + c * ay, edges[sensor], edges[sensors + sensor], radius
                        )
                        == 0
                    ):
                        continue
                    if sees == 0:
                        sees = 1
                        for number in range(sensors * rays):
                            distances[seen * rays + number] = _FAR
                    for ray in range(rays):
                        rx = directions[sensor * rays + ray]
                        ry = directions[(sensors + sensor) * rays + ray]
                        way_x = c * rx - s * ry
                        way_y = s * rx + c * ry
                        if kinds[thing] == _BOX:
                            met = meet_box(sx, sy, way_x, way_y, half_x, half_y)
                        elif kinds[thing] == _DISC:
                            met = meet_disc(sx, sy, way_x, way_y, half_x)
                        else:
                            polygon = kinds[thing]
                            met = meet_polygon(sx, sy, way_x, way_y, planes, sides[polygon], sides[polygon + 1])
                        if met < far:
                            number = (seen + sensor) * rays + ray
                            distances[number] = min(distances[number], met)
        if sees == 1:
            begin = seen
            for sensor in range(sensors):
                nearest = _FAR
                for ray in range(rays):
                    met = distances[(begin + sensor) * rays + ray]
                    distances[seen * rays + ray] = met
                    nearest = min(nearest, met)
                if nearest < _FAR:
                    numbers[seen] = robot * sensors + sensor
                    seen += 1
    counts[_SEEN] = seen
