"""The endpoints of all robots of a world, while robots come and go."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from thymio_sim_ros.ros.interface.names import Naming, RobotNames
from thymio_sim_ros.ros.simulator.robot_endpoints import RobotEndpoints

__all__ = ["RobotEndpointSet"]


class RobotEndpointSet:
    """Robots' endpoints by their name in the world. Invariant: who stays keeps topics and frames."""

    def __init__(self, make: Callable[[str, RobotNames], RobotEndpoints], naming: Naming) -> None:
        self._make, self._naming = make, naming
        self._endpoints: dict[str, RobotEndpoints] = {}

    def __getitem__(self, robot: str) -> RobotEndpoints:
        return self._endpoints[robot]

    @property
    def topics(self) -> int:
        """How many topics of sensors there are."""
        return sum(endpoints.topics for endpoints in self._endpoints.values())

    def poll(self) -> None:
        """Find out which topics somebody hears now."""
        for endpoints in self._endpoints.values():
            endpoints.poll()

    @property
    def names(self) -> tuple[RobotNames, ...]:
        """Of all robots, in the order of the world."""
        return tuple(endpoints.names for endpoints in self._endpoints.values())

    @property
    def by_robot(self) -> dict[str, RobotNames]:
        """The same by their names in the world."""
        return {robot: endpoints.names for robot, endpoints in self._endpoints.items()}

    def reset(self, robots: Iterable[str]) -> None:
        """The robots of a playground: one alone has no name, of several each has its own."""
        self._change(self._naming.all(robots))
        for endpoints in self._endpoints.values():
            endpoints.reset()

    def update(self, robots: Iterable[str]) -> bool:
        """Whether robots have come or gone; who has come has topics and frames of its name."""
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
