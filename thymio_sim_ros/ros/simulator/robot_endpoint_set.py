"""The ports of all robots of a world, while robots come and go."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from thymio_sim_ros.ros.interface.names import Naming, RobotNames
from thymio_sim_ros.ros.simulator.robot_endpoints import RobotPorts

__all__ = ["Roster"]


class Roster:
    """Robots' ports by their name in the world. Invariant: who stays keeps topics and frames."""

    def __init__(self, make: Callable[[str, RobotNames], RobotPorts], naming: Naming) -> None:
        self._make, self._naming = make, naming
        self._ports: dict[str, RobotPorts] = {}

    def __getitem__(self, robot: str) -> RobotPorts:
        return self._ports[robot]

    @property
    def topics(self) -> int:
        """How many topics of sensors there are."""
        return sum(ports.topics for ports in self._ports.values())

    def look(self) -> None:
        """Find out which topics somebody hears now."""
        for ports in self._ports.values():
            ports.look()

    @property
    def names(self) -> tuple[RobotNames, ...]:
        """Of all robots, in the order of the world."""
        return tuple(ports.names for ports in self._ports.values())

    @property
    def by_robot(self) -> dict[str, RobotNames]:
        """The same by their names in the world."""
        return {robot: ports.names for robot, ports in self._ports.items()}

    def begin(self, robots: Iterable[str]) -> None:
        """The robots of a playground: one alone has no name, of several each has its own."""
        self._change(self._naming.all(robots))
        for ports in self._ports.values():
            ports.forget()

    def follow(self, robots: Iterable[str]) -> bool:
        """Whether robots have come or gone; who has come has topics and frames of its name."""
        robots = list(robots)
        if robots == list(self._ports):
            return False
        known = self._ports
        self._change({robot: known[robot].names if robot in known else self._naming.one(robot) for robot in robots})
        return True

    def _change(self, names: Mapping[str, RobotNames]) -> None:
        kept: dict[str, RobotPorts] = {}
        for robot, ports in self._ports.items():
            if names.get(robot) == ports.names:
                kept[robot] = ports
            else:
                ports.close()
        self._ports = {robot: kept.get(robot) or self._make(robot, name) for robot, name in names.items()}
