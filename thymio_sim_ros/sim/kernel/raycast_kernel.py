"""Kernel: the distances of the rays of all robots, computed as in `BatchRaycaster.cast`, operation by operation.

The order of the operations is part of the contract: kernel and numpy path give the same bits. The derivations are in
`raycast/scalar.py` (discs, half planes) and `raycast/batch.py` (boxes, facing, candidates).
"""

from __future__ import annotations

import math

from aseba_vm.kernel.types import Floats, Ints, kernel

__all__ = ["COUNTS", "cast"]

COUNTS = ("robots", "sensors", "rays", "things", "fixed", "is_narrow", "seen", "is_stale")
"""Meaning of each element of `counts`; the last two are results."""
_ROBOTS, _SENSORS, _RAYS, _THINGS, _FIXED, _IS_NARROW, _SEEN, _IS_STALE = range(len(COUNTS))
_RANGE, _REACH, _MOST, _HULL = 0, 1, 2, 3
"""Indices in `sizes`: range and reach of the rays, how far anything may move before the candidates are stale, and the
six numbers of the hull's frame."""
_FAR = math.inf
_TINY = 1e-300
_DISC, _BOX = -2, -1


@kernel
def meet_disc(x: float, y: float, dx: float, dy: float, radius: float) -> float:
    """Return the distance at which a ray enters a disc around the origin, inf if it does not."""
    middle = -(x * dx + y * dy)
    square = radius * radius - (x * x + y * y - middle * middle)
    enter = middle - math.sqrt(max(square, 0.0))
    return enter if square >= 0.0 and enter >= 0.0 else _FAR


@kernel
def meet_box(x: float, y: float, dx: float, dy: float, half_x: float, half_y: float) -> float:
    """Return the distance at which a ray enters a box around the origin, inf if it does not."""
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
    """Return the distance at which a ray enters the half planes `first` to `last` (exclusive), inf if it does not."""
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
    """Return whether a ray of a sensor at x, y may meet a circle around the origin.

    The sensor's axis is ax, ay; `cos` and `sin` are of the angle between the axis and its outermost ray.
    """
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
    """Write the numbers of the sensors that detect something to `numbers`, and their rays' lengths to `distances`.

    Args:
        counts: see `COUNTS`; the number of sensors that detect something, and whether the candidates are stale, are
            written.
        sizes: see `_RANGE` and the indices after it.
        places: origins of the sensors in the robot's frame, shape (2, sensors).
        axes: directions of the sensors' axes, shape (2, sensors).
        edges: cosines and sines of the angles between axis and outermost ray, shape (2, sensors).
        directions: directions of the rays, shape (2, sensors, rays).
        poses: x, y, yaw of the robots, shape (robots, 3).
        turns: cosines and sines of the yaws, shape (2, robots); numpy's, as kernels have no sine.
        frames: fixed obstacles, loose obstacles, robots, shape (all, 7); those of the robots are written here.
        was: positions of loose obstacles and robots when the candidates were found, shape (loose + robots, 2).
        kinds: kind of each frame (`raycast/obstacle_table.py`).
        first: index in `things` of the first candidate of each robot, shape (robots + 1,).
        things: candidates of all robots: indices in `frames`.
        planes: half planes of all polygons, shape (planes, 3); the hull is the last polygon.
        sides: index in `planes` of the first half plane of each polygon, shape (polygons + 1,).
        numbers: result, shape (robots * sensors,): robot * sensors + sensor.
        distances: result, shape (robots * sensors, rays), inf for a ray that meets nothing.
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

    # Write the frames of the robots, and test whether anything has moved too far for the list of candidates.
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

    # `seen` counts the rows of results that are final. The sensors of the current robot get the rows after them, even
    # if they detect nothing, and are compacted when the robot is done. A row is final only at or before the row it was
    # computed in, so that nothing is overwritten too early.
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
            # position and heading (c, s) of the robot in the frame of the obstacle
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
                    if sees == 0:  # the first obstacle that this robot may see: clear its rows
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
        if sees == 1:  # keep the rows of the sensors that detect something
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
