"""The record of one robot during a test: poses after each tick, contacts and emitted events."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.robot.robot import Robot

__all__ = ["SECOND_NS", "Event", "Moment", "Record", "Touch"]

SECOND_NS = 1_000_000_000


@dataclass(frozen=True, slots=True)
class Moment:
    """Pose and velocity of a robot at a simulated time in s: m/s along its heading, rad/s counter-clockwise."""

    at_s: float
    pose: Pose
    speed_m_s: float
    spin_rad_s: float


@dataclass(frozen=True, slots=True)
class Touch:
    """A robot began to touch something, named by `other`, at a simulated time in s."""

    at_s: float
    other: str


@dataclass(frozen=True, slots=True)
class Event:
    """A program emitted a global event at a simulated time in s."""

    at_s: float
    name: str
    args: tuple[int, ...]


class Record:
    """The record of one robot, oldest first. Only `clear` clears it, so that no program under test can."""

    def __init__(self) -> None:
        self.moments: list[Moment] = []
        self.touches: list[Touch] = []
        self.events: list[Event] = []
        self.cleared = 0
        """Number of times the record was cleared."""
        self._touching: frozenset[str] = frozenset()

    def add_tick(self, robot: Robot, now_ns: int) -> None:
        """Record the state of the robot after a tick."""
        at_s, twist = now_ns / SECOND_NS, robot.twist
        self.moments.append(Moment(at_s, robot.pose, twist.linear_m_s, twist.angular_rad_s))
        if robot.body.touching or self._touching:
            touching = frozenset(contact.other for contact in robot.body.touching.values())
            self.touches += [Touch(at_s, other) for other in sorted(touching - self._touching)]
            self._touching = touching

    def add_event(self, name: str, args: Sequence[int], now_ns: int) -> None:
        """Record an event emitted by the program."""
        self.events.append(Event(now_ns / SECOND_NS, name, tuple(args)))

    def since(self, seconds: float) -> list[Moment]:
        """The moments since a simulated time in s."""
        return [moment for moment in self.moments if moment.at_s >= seconds]

    def clear(self) -> None:
        """Clear the record."""
        self.moments.clear()
        self.touches.clear()
        self.events.clear()
        self.cleared += 1
        self._touching = frozenset()
