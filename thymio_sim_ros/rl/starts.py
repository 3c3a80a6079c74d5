"""Random start poses in a playground."""

from __future__ import annotations

import itertools
import math

import numpy as np

from thymio_sim_ros.rl.errors import TaskError
from thymio_sim_ros.rl.tasks import Start
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.robot_constants import HULL_RADIUS_M
from thymio_sim_ros.sim.playground.model import Playground
from thymio_sim_ros.sim.playground.placement import Footprint, Occupied, footprint_of
from thymio_sim_ros.sim.shapes.track import Track

__all__ = ["Starts"]

RADIUS_M = HULL_RADIUS_M + 0.05
"""No solid, robot or edge is nearer than this to the origin of a robot at its start."""
_TRIES = 10_000
_RIM = 8
"""Points around a start that must be on the floor."""

Box = tuple[float, float, float, float]
"""Left, bottom, right, top, m."""


class Starts:
    """Draws start poses in a playground."""

    def __init__(self, playground: Playground, start: Start) -> None:
        """Raises TaskError if the playground has no floor to start on, or not exactly one track to start on."""
        self._playground, self._start = playground, start
        self._solids = [footprint_of(solid) for solid in playground.solids]
        corners = [corner for floor in playground.floors for corner in floor.vertices]
        if start == "anywhere" and not corners:
            raise TaskError(f"playground '{playground.name}': found no floor, expected one to start anywhere on")
        self._box: Box = (0.0, 0.0, 0.0, 0.0)
        if corners:
            xs, ys = zip(*corners, strict=True)
            self._box = (min(xs), min(ys), max(xs), max(ys))
        tracks = [shape.shape for shape in playground.shapes if isinstance(shape.shape, Track)]
        if start == "line" and len(tracks) != 1:
            raise TaskError(f"playground '{playground.name}': found {len(tracks)} tracks, expected one to start on")
        stations = tracks[0].stations() if start == "line" else ()
        self._pieces = [piece for piece in itertools.pairwise(stations) if piece[0][:2] != piece[1][:2]]
        self._lengths_m = np.array([math.dist(a[:2], b[:2]) for a, b in self._pieces])

    def draw(self, random: np.random.Generator, count: int) -> list[Pose]:
        """Start poses of robots, not too near to solids, edges and each other.

        Raises TaskError if there is no room, or if the playground has fewer robots and says where they start.
        """
        if self._start == "playground":
            robots = self._playground.robots
            if len(robots) < count:
                name = self._playground.name
                raise TaskError(f"playground '{name}': found {len(robots)} robots, expected at least {count}")
            return [robot.pose for robot in robots[:count]]
        occupied, poses = Occupied(self._solids), []
        for number in range(count):
            pose, place = self._draw_one(random, occupied, number)
            occupied.add(place)
            poses.append(pose)
        return poses

    def _draw_one(self, random: np.random.Generator, occupied: Occupied, number: int) -> tuple[Pose, Footprint]:
        for _ in range(_TRIES):
            pose = self._on_line(random) if self._start == "line" else self._anywhere(random)
            place = Footprint(f"robot {number}", (pose.x_m, pose.y_m), RADIUS_M)
            if occupied.blocker(place) is None and self._is_on_floor(pose):
                return pose, place
        raise TaskError(f"playground '{self._playground.name}': found no free place for robot {number}")

    def _anywhere(self, random: np.random.Generator) -> Pose:
        left, bottom, right, top = self._box
        x, y, yaw = random.uniform((left, bottom, -math.pi), (right, top, math.pi)).tolist()
        return Pose(x, y, yaw)

    def _on_line(self, random: np.random.Generator) -> Pose:
        index = int(random.choice(len(self._pieces), p=self._lengths_m / self._lengths_m.sum()))
        (ax, ay, yaw), (bx, by, _) = self._pieces[index]
        part, back = float(random.random()), bool(random.integers(2))
        heading = yaw + math.pi if back else yaw
        return Pose(ax + part * (bx - ax), ay + part * (by - ay), math.remainder(heading, math.tau))

    def _is_on_floor(self, pose: Pose) -> bool:
        floors = self._playground.floors
        angles = [math.tau * step / _RIM for step in range(_RIM)]
        rim = [(pose.x_m + RADIUS_M * math.cos(angle), pose.y_m + RADIUS_M * math.sin(angle)) for angle in angles]
        return not floors or all(any(floor.holds(point) for floor in floors) for point in rim)
