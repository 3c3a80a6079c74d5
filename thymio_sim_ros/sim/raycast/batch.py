"""Ray casts of all robots of a batch: the computations of `raycast.scalar` on arrays, equal to 1e-9.

Candidates are a list of pairs (robot, obstacle) that are near each other with a margin; the list is rebuilt when
something has moved by a third of the margin. The pairs are reduced to those in the robot's reach, then to those near a
sensor and in front of it. Only their rays are computed, in the frame of the obstacle.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel.memory import is_available
from thymio_sim_ros.sim.kernel.raycast_binding import RaycastBinding
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.raycast.obstacle_table import (
    BOX,
    DISC,
    HEIGHT,
    NOWHERE_M,
    ObstacleTable,
    Values,
    polygon_in_frame,
)
from thymio_sim_ros.sim.raycast.scalar import Obstacle

__all__ = ["BatchRaycaster", "Fan", "Indices", "Values"]

_MARGIN_M = 0.15
_SAME_M = 1e-9
"""Sizes closer than this are those of the same thing."""
_TINY = 1e-300
"""Replaces 0 in a division, where a ray is parallel to a side."""
_HULL_FRAME, _planes = polygon_in_frame(robot_constants.hull())
assert _planes is not None  # it is no box
_HULL_PLANES = _planes

Indices = npt.NDArray[np.intp]
_NOTHING: Indices = np.zeros(0, dtype=np.intp)


class Fan:
    """The rays of sensors of a robot: origins and unit directions in its frame, range, height above the floor."""

    __slots__ = ("axes", "cos", "directions", "height_m", "is_narrow", "places", "range_m", "reach_m", "sin")

    def __init__(
        self,
        places: Sequence[tuple[float, float]],
        directions: Sequence[Sequence[tuple[float, float]]],
        range_m: float,
        height_m: float,
    ) -> None:
        self.places = np.array(places).T
        """Origins, shape (2, sensors)."""
        self.directions = np.array(directions).transpose(2, 0, 1)
        """Unit directions, shape (2, sensors, rays)."""
        self.axes = self.directions[:, :, self.directions.shape[2] // 2]
        """Directions of the middle ray of each sensor, shape (2, sensors)."""
        self.cos = (self.axes[:, :, None] * self.directions).sum(axis=0).min(axis=1)
        """Cosine of the angle between axis and outermost ray, shape (sensors,); `sin` is its sine."""
        self.sin = np.sqrt(np.maximum(0.0, 1.0 - self.cos**2))
        self.is_narrow = bool((self.cos > 0.0).all())
        """Whether all rays are within 90 degrees of their axis, so that sensors that face away can be dropped."""
        self.range_m, self.height_m = range_m, height_m
        self.reach_m = range_m + max(math.hypot(x, y) for x, y in places)


class BatchRaycaster:
    """Casts the rays of a fixed set of robots.

    Poses of robots are given with every cast; objects and doors are updated by `move`.
    """

    def __init__(
        self, fixed: Sequence[Obstacle], loose: Sequence[Obstacle | None] = (), *, is_compiled: bool | None = None
    ) -> None:
        """Index the obstacles.

        Args:
            fixed: obstacles that never move.
            loose: obstacles that can move, by number; None for a missing one.
            is_compiled: whether to use kernels or numpy; None: kernels if available. The results are the same.
        """
        self._is_compiled = is_available() if is_compiled is None else is_compiled
        self._kernels: dict[Fan, RaycastBinding] = {}
        self._table = ObstacleTable([*fixed, *loose])
        self._fixed = len(fixed)
        self._fallen: frozenset[int] = frozenset()
        self._lists: dict[Fan, tuple[Values, Indices, Indices]] = {}
        """Candidate pairs by fan: where loose things and robots were when they were found, robots, obstacles."""

    def move(self, moved: Mapping[int, Obstacle | None], fallen: Collection[int] = ()) -> None:
        """Update movable obstacles, by their numbers; None removes one.

        Robots with the numbers in `fallen` neither detect anything nor are detected.
        """
        if len(fallen) != len(self._fallen) or not self._fallen.issuperset(fallen):
            self._fallen = frozenset(fallen)
            self._lists.clear()
        for number, obstacle in moved.items():
            row = self._table.rows[self._fixed + number]
            size = row[4:].copy()
            self._table.put(self._fixed + number, obstacle)
            # Candidates allow for motion, not for a change of size or height: an object that fell, or came back.
            if np.abs(row[4:] - size).max() > _SAME_M:
                self._lists.clear()

    def cast(self, poses: Values, fan: Fan) -> tuple[Indices, Values]:
        """Cast the rays of robots at `poses`, shape (robots, 3): x, y, yaw.

        Returns the sorted numbers of the sensors that detect something, shape (hits,), and the distances of their rays
        in m, shape (hits, rays), inf for a ray that meets nothing. Sensor s of robot r has the number r * sensors + s.
        """
        if self._is_compiled:
            return self._cast_compiled(poses, fan)
        sensors, rays = fan.directions.shape[1:]
        frames, kinds = self._with_robots(poses)
        robot, thing = self._near(poses, frames, fan)
        cos, sin = np.cos(poses[:, 2]), np.sin(poses[:, 2])

        # The robot's position and heading (c, s) in the frame of the obstacle: a rotation by minus the heading of the
        # obstacle. In that frame the bounding box is |x| <= half_x, |y| <= half_y.
        near = frames[thing]
        dx, dy = poses[robot, 0] - near[:, 0], poses[robot, 1] - near[:, 1]
        x, y = near[:, 2] * dx + near[:, 3] * dy, near[:, 2] * dy - near[:, 3] * dx
        hits = ((np.abs(x) - near[:, 4] <= fan.reach_m) & (np.abs(y) - near[:, 5] <= fan.reach_m)).nonzero()[0]
        if len(hits) == 0:
            return _NOTHING, np.zeros((0, rays))
        robot, thing, near, x, y = robot[hits], thing[hits], near[hits], x[hits], y[hits]
        c = cos[robot] * near[:, 2] + sin[robot] * near[:, 3]
        s = sin[robot] * near[:, 2] - cos[robot] * near[:, 3]

        # The sensors of these robots in the same frame; those beyond the range of the box or facing away are dropped.
        px, py = fan.places
        sx = x[:, None] + c[:, None] * px - s[:, None] * py
        sy = y[:, None] + s[:, None] * px + c[:, None] * py
        limit = fan.range_m
        is_near = np.maximum(np.abs(sx) - near[:, 4, None], np.abs(sy) - near[:, 5, None]) <= limit
        pair, sensor = np.nonzero(is_near)
        if fan.is_narrow:
            pair, sensor = _facing(fan, pair, sensor, sx[pair, sensor], sy[pair, sensor], c[pair], s[pair], near[pair])
        sx, sy, near, kind = sx[pair, sensor], sy[pair, sensor], near[pair], kinds[thing[pair]]
        rx, ry = fan.directions[:, sensor]
        c, s = c[pair, None], s[pair, None]
        distances = self._meet(sx[:, None], sy[:, None], c * rx - s * ry, s * rx + c * ry, near, kind)

        distances = np.where(distances < limit * (1.0 + 1e-12), distances, math.inf)
        seen = np.nonzero(distances.min(axis=1) < math.inf)[0]
        if len(seen) == 0:
            return _NOTHING, np.zeros((0, rays))
        # A sensor may see several obstacles: sort by sensor, and take the minimum over each run of equal numbers.
        number = robot[pair[seen]] * sensors + sensor[seen]
        order = np.argsort(number, kind="stable")
        number = number[order]
        first = np.diff(number, prepend=-1).nonzero()[0]
        return number[first], np.minimum.reduceat(distances[seen[order]], first, axis=0)

    def _cast_compiled(self, poses: Values, fan: Fan) -> tuple[Indices, Values]:
        kernel = self._kernels.get(fan)
        if kernel is None:
            things = len(self._table.rows)
            kernel = RaycastBinding(fan, len(poses), things, self._fixed, _HULL_FRAME, _MARGIN_M / 3)
            self._kernels[fan] = kernel
        # The kernel itself tests whether the candidates are stale; it then answers None and gets a new list.
        found = kernel.cast(poses, self._table.rows) if fan in self._lists else None
        while found is None:
            frames, kinds = self._with_robots(poses)
            robot, thing = self._pairs(poses, frames, fan)
            places = self._places(poses, frames)
            self._lists[fan] = (places, robot, thing)
            kernel.begin(frames, kinds, [*self._table.polygons, _HULL_PLANES], robot, thing, places)
            found = kernel.cast(poses, self._table.rows)
        return found

    def _places(self, poses: Values, frames: Values) -> Values:
        """Return the positions of everything that can move, shape (loose obstacles + robots, 2)."""
        return np.concatenate((frames[self._fixed : len(frames) - len(poses), :2], poses[:, :2]))

    def _with_robots(self, poses: Values) -> tuple[Values, Indices]:
        """Return frames, shape (obstacles + robots, 7), and kinds of all obstacles and, after them, all robots.

        Columns are those of `ObstacleTable.rows`. All robots share the last polygon, the hull.
        """
        x, y, cos, sin, half_x, half_y = _HULL_FRAME
        robots = np.empty((len(poses), 7))
        c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        robots[:, 0] = poses[:, 0] + c * x - s * y
        robots[:, 1] = poses[:, 1] + s * x + c * y
        robots[:, 2] = c * cos - s * sin
        robots[:, 3] = s * cos + c * sin
        robots[:, 4:] = half_x, half_y, robot_constants.HULL_HEIGHT_M
        robots[list(self._fallen), HEIGHT] = NOWHERE_M
        kinds = np.full(len(poses), len(self._table.polygons), dtype=np.intp)
        return np.concatenate([self._table.rows, robots]), np.concatenate([self._table.kinds, kinds])

    def _near(self, poses: Values, frames: Values, fan: Fan) -> tuple[Indices, Indices]:
        """Candidate pairs of robots and obstacles that are at least as high as the rays, sorted by robot."""
        found = self._lists.get(fan)
        places = self._places(poses, frames)
        # Both of a pair may move by a third of the margin along each axis, which leaves a third as reserve.
        if found is None or np.abs(places - found[0]).max(initial=0.0) > _MARGIN_M / 3:
            found = self._lists[fan] = (places, *self._pairs(poses, frames, fan))
        return found[1:]

    def _pairs(self, poses: Values, frames: Values, fan: Fan) -> tuple[Indices, Indices]:
        """Return the pairs whose bounding boxes are within reach and margin, sorted by robot: sweep and prune along x.

        Robots are sorted by x; for each obstacle, `first` and `last` delimit the robots that overlap it in x. Repeat
        and cumsum expand these ranges to pairs, which are then filtered by y.
        """
        reach = fan.reach_m + _MARGIN_M
        # Half sizes of the bounding box of a turned rectangle. The circle around it is a bound as well, and a tighter
        # one for a disc.
        half = np.hypot(frames[:, 4], frames[:, 5])
        wide_x = np.minimum(half, np.abs(frames[:, 2]) * frames[:, 4] + np.abs(frames[:, 3]) * frames[:, 5]) + reach
        wide_y = np.minimum(half, np.abs(frames[:, 3]) * frames[:, 4] + np.abs(frames[:, 2]) * frames[:, 5]) + reach
        own = len(frames) - len(poses)
        wide_x[self._fixed :] = wide_y[self._fixed :] = half[self._fixed :] + reach  # what moves may turn
        high = np.flatnonzero(frames[:, HEIGHT] >= fan.height_m)  # lower obstacles are below the rays
        order = np.argsort(poses[:, 0], kind="stable")
        xs = poses[order, 0]
        first = np.searchsorted(xs, frames[high, 0] - wide_x[high], side="left")
        last = np.searchsorted(xs, frames[high, 0] + wide_x[high], side="right")
        # Expand the range first[i]…last[i] of each obstacle i to one entry per pair. In the flat list, obstacle i
        # begins at cumsum - counts; so `start` plus the index in the list is the index among the sorted robots.
        counts = last - first
        thing = np.repeat(high, counts)
        start = np.repeat(first - (np.cumsum(counts) - counts), counts)
        robot = order[start + np.arange(len(thing))]
        keep = np.abs(poses[robot, 1] - frames[thing, 1]) <= wide_y[thing]
        # No robot sees itself, and one that has fallen sees nothing.
        keep &= (thing != robot + own) & (frames[own + robot, HEIGHT] > NOWHERE_M)
        robot, thing = robot[keep], thing[keep]
        order = np.lexsort((thing, robot))
        return robot[order], thing[order]

    def _meet(self, x: Values, y: Values, dx: Values, dy: Values, near: Values, kind: Indices) -> Values:
        """Distances at which rays enter the obstacle in whose frame they are; inf if they do not."""
        distances = np.empty(dx.shape)
        for this in (np.flatnonzero(np.bincount(kind - DISC)) + DISC).tolist():
            rows = (kind == this).nonzero()[0]
            ray = (x[rows], y[rows], dx[rows], dy[rows])
            if this == DISC:
                distances[rows] = _meet_discs(*ray, near[rows, 4, None])
            elif this == BOX:
                distances[rows] = _meet_boxes(*ray, near[rows, 4, None], near[rows, 5, None])
            else:
                polygons = self._table.polygons
                planes = polygons[this] if this < len(polygons) else _HULL_PLANES
                distances[rows] = _meet_polygon(*ray, planes)
        return distances


def _facing(
    fan: Fan, pair: Indices, sensor: Indices, x: Values, y: Values, c: Values, s: Values, near: Values
) -> tuple[Indices, Indices]:
    """Pairs whose rays may meet the circle around the obstacle; sensors are at x, y in its frame, turned by c, s."""
    # Seen from the sensor, the center of the circle is `ahead` along the axis and `aside` of it. The outermost ray, at
    # the angle with cos and sin to the axis, passes it at the signed distance aside * cos - ahead * sin; beyond the
    # radius, no ray meets the circle. A circle behind the sensor passes this test, so `ahead` is tested, too. Rays
    # beyond 90 degrees would break both tests, hence `is_narrow`.
    ax, ay = fan.axes[:, sensor]
    ax, ay = c * ax - s * ay, s * ax + c * ay
    radius = np.sqrt(near[:, 4] * near[:, 4] + near[:, 5] * near[:, 5])
    ahead, aside = -(ax * x + ay * y), np.abs(ax * y - ay * x)
    facing = ((aside * fan.cos[sensor] - ahead * fan.sin[sensor] <= radius) & (ahead >= -radius)).nonzero()[0]
    return pair[facing], sensor[facing]


def _meet_discs(x: Values, y: Values, dx: Values, dy: Values, radius: Values) -> Values:
    """Return the distances at which rays enter discs around the origin, as in `DiscObstacle.distance`."""
    middle = -(x * dx + y * dy)
    square = radius * radius - (x * x + y * y - middle * middle)
    enter = middle - np.sqrt(np.maximum(square, 0.0))
    return np.where((square >= 0.0) & (enter >= 0.0), enter, math.inf)


def _meet_boxes(x: Values, y: Values, dx: Values, dy: Values, half_x: Values, half_y: Values) -> Values:
    """Return the distances at which rays enter boxes around the origin: the slab method.

    A ray is between the sides x = ±half_x for t in middle_x ± wide_x, and between y = ±half_y likewise; it is inside
    the box where both intervals overlap. A ray along an axis gets intervals that are practically infinite or empty.
    """
    across_x, across_y = 1.0 / np.where(dx == 0.0, _TINY, dx), 1.0 / np.where(dy == 0.0, _TINY, dy)
    middle_x, middle_y = -x * across_x, -y * across_y
    wide_x, wide_y = np.abs(half_x * across_x), np.abs(half_y * across_y)
    enter = np.maximum(middle_x - wide_x, middle_y - wide_y)
    leave = np.minimum(middle_x + wide_x, middle_y + wide_y)
    return np.where((enter >= 0.0) & (enter <= leave), enter, math.inf)


def _meet_polygon(x: Values, y: Values, dx: Values, dy: Values, planes: Values) -> Values:
    """Return the distances at which rays enter a polygon of half planes, as in `ConvexObstacle.distance`."""
    nx, ny, c = (part[:, None] for part in planes.T)
    along = nx * dx[:, None, :] + ny * dy[:, None, :]
    along[along == 0.0] = _TINY
    times = (c - nx * x[:, None, :] - ny * y[:, None, :]) / along
    enter = np.where(along < 0.0, times, -math.inf).max(axis=1)
    leave = np.where(along > 0.0, times, math.inf).min(axis=1)
    return np.where((enter >= 0.0) & (enter <= leave), enter, math.inf)
