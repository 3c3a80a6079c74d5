"""The ROS endpoints of all robots of a world."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from thymio_sim_ros.ros.interface.names import Naming, RobotNames
from thymio_sim_ros.ros.simulator.robot_endpoints import RobotEndpoints, first_words

__all__ = ["RobotEndpointSet"]


class RobotEndpointSet:
    """Endpoints by name of the robot in the world. Invariant: a robot that stays keeps its topics and frames."""

    def __init__(self, make: Callable[[str, RobotNames], RobotEndpoints], naming: Naming) -> None:
        self._make, self._naming = make, naming
        self._endpoints: dict[str, RobotEndpoints] = {}

    def __getitem__(self, robot: str) -> RobotEndpoints:
        return self._endpoints[robot]

    @property
    def topics(self) -> int:
        """Total number of sensor topics."""
        return sum(endpoints.topics for endpoints in self._endpoints.values())

    def poll(self) -> None:
        """Find out which topics have subscribers."""
        for endpoints in self._endpoints.values():
            endpoints.poll()

    @property
    def names(self) -> dict[str, RobotNames]:
        """ROS names by name in the world, in the order of the world."""
        return {robot: endpoints.names for robot, endpoints in self._endpoints.items()}

    def check_name(self, robot: str) -> None:
        """Raise ValueError if the name is the first word of topics of a robot without a ROS name."""
        has_nameless = any(not endpoints.names.name for endpoints in self._endpoints.values())
        if has_nameless and robot in first_words():
            raise ValueError(f"the name '{robot}' is taken by topics of the robot that has no name")

    def reset(self, robots: Iterable[str]) -> None:
        """Serve the robots of a new or reset playground: a single robot has an empty ROS name, several keep theirs."""
        self._change(self._naming.all(robots))
        for endpoints in self._endpoints.values():
            endpoints.reset()

    def update(self, robots: Iterable[str]) -> bool:
        """Add endpoints of new robots, remove those of others, and return whether there was a change."""
        robots = list(robots)
        if robots == list(self._endpoints):
            return False
        known = self._endpoints
        self._change({robot: known[robot].names if robot in known else self._naming.one(robot) for robot in robots})
        return True

    def _change(self, names: Mapping[str, RobotNames]) -> None:
        kept: dict[str, RobotEndpoints] = {}
        for robot, endpoints in self._endpoints.items():
            if names.get(robot) == endpoints.names:
                kept[robot] = endpoints
            else:
                endpoints.close()
        self._endpoints = {robot: kept.get(robot) or self._make(robot, name) for robot, name in names.items()}
