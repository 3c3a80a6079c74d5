"""Profiles, one module each: the names and types of another robot's courses, for `thymio-sim --like NAME`.

A module exports PROFILE: rows that say which reading, command, service or action of the simulator each foreign name
is. Types are named by text and found when the simulator starts, so that a profile can be read without a ROS graph; a
row gets the class. A module must not import packages of messages at its top for the same reason.

Without a profile nothing here is loaded by a suite.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.files import registry
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.lidar import Lidar

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message
    from thymio_sim_ros.ros.interface.names import RobotNames
    from thymio_sim_ros.ros.interface.robot_inputs import InputContext
    from thymio_sim_ros.sim.commands import Command
    from thymio_sim_ros.sim.model.geometry import Pose, Twist
    from thymio_sim_ros.sim.model.primitives import Color
    from thymio_sim_ros.sim.model.readings import Reading
    from thymio_sim_ros.sim.physics import Contact
    from thymio_sim_ros.sim.playground.reader import RobotStart

__all__ = [
    "ActionRow",
    "Ended",
    "InputRow",
    "Missing",
    "Motion",
    "ParameterRow",
    "Profile",
    "ProfileError",
    "ProfileRobot",
    "ProfileWorld",
    "ServiceRow",
    "TopicRow",
    "all_profiles",
    "missing_name",
    "missing_parameter",
    "named",
    "own_names",
]


S = TypeVar("S")


class ProfileError(ThymioSimError, ValueError):
    """A profile that cannot be used; the text says why and what to do."""


class ProfileRobot(Protocol):
    """A robot as the rows of a profile use it."""

    name: str
    """Its name in the world."""
    names: RobotNames
    """Its names in ROS."""
    memory: dict[str, Any]
    """What the rows keep of this robot; empty at first and after a reset of the world."""

    @property
    def world(self) -> ProfileWorld:
        """The world that it is in."""

    @property
    def pose(self) -> Pose:
        """The true pose, in m and rad."""

    @property
    def odometry(self) -> Pose:
        """The pose by odometry, in m and rad."""

    @property
    def speeds(self) -> Twist:
        """The true speeds, in m/s and rad/s."""

    @property
    def is_fallen(self) -> bool:
        """Whether it fell off an edge."""

    @property
    def is_lifted(self) -> bool:
        """Whether an operator holds it over the ground."""

    @property
    def is_touching(self) -> bool:
        """Whether it touches something."""

    @property
    def contacts(self) -> Sequence[Contact]:
        """Where it touches something, in order of the names."""

    @property
    def floor_color(self) -> Color | None:
        """The color of the ground below its middle, drawings included; None without ground."""

    def read(self, sensor: str) -> Reading | None:
        """Return the present reading of a sensor without memory."""

    def state(self, kind: type[S]) -> S:
        """Return the state of an actuator or stimulus, by its type."""

    def post(self, command: Command) -> None:
        """Post a command. Raises PlacementError for a place that is not free."""


class ProfileWorld(Protocol):
    """The world as the rows of a profile use it. Deferred ticks are executed before a row is called."""

    @property
    def now_ns(self) -> int:
        """The simulated time."""

    @property
    def robots(self) -> Mapping[str, ProfileRobot]:
        """The robots by their names in the world."""

    def spawn(self, start: RobotStart) -> None:
        """Add a robot. Raises ValueError for a name or a place that is taken, or no ground."""

    def remove(self, robot: str) -> None:
        """Remove a robot."""

    def reset(self) -> None:
        """Reset world, time and noise to the start."""

    def clear(self) -> None:
        """Erase everything that pens drew."""

    def paint(self, color: Color) -> None:
        """Give the first ground of the playground another color, 0…1 each; a reset ends it."""

    def report(self, about: str, reason: object) -> None:
        """Report that a request or a message was refused, in the log, on the page and to `thymio-sim doctor`."""

    def warn(self, text: str) -> None:
        """Log a warning."""


@dataclass(frozen=True, slots=True)
class TopicRow:
    """A topic on which each robot publishes a reading.

    Args:
        topic: Its name below the robot's.
        type: Such as `sensor_msgs/msg/Imu`.
        sensor: The sensor whose readings are published.
        encode: Gets the class of the type, the reading and the robot; returns the message, or None for no message.
        about: Content and units.
        every_ns: Shortest period; 0 publishes all readings.
        on_change: Published only if this part of the reading has changed.
        kind: The name of a QoS profile (`ros/interface/qos.py`).
        is_event: Whether `encode` returns None for most readings.
    """

    topic: str
    type: str
    sensor: str
    encode: Callable[[Any, Any, ProfileRobot], Message | None]
    about: str = ""
    every_ns: int = 0
    on_change: Callable[[Any], object] | None = None
    kind: str = "sensor"
    is_event: bool = False


@dataclass(frozen=True, slots=True)
class InputRow:
    """A topic that each robot subscribes to.

    `commands` returns the commands of a message, or raises ValueError to reject it; `limit_check` describes what
    will be clamped.
    `is_second`: the robot has the topic with another type already; both are there.
    `is_best_effort`: publishers of either reliability reach it.
    """

    topic: str
    type: str
    commands: Callable[[Any, InputContext, ProfileRobot], Sequence[Command]]
    about: str = ""
    kind: str = "command"
    limit_check: Callable[[Any], str] = lambda _message: ""
    is_second: bool = False
    is_best_effort: bool = False


@dataclass(frozen=True, slots=True)
class ServiceRow:
    """A service of each robot, or of the world.

    `answer` gets request, response and the robot, or the world for `is_of_world`, and fills the response. A ValueError
    that it raises is reported; the client gets the response as it is then.
    """

    name: str
    type: str
    answer: Callable[[Any, Any, Any], None]
    about: str = ""
    is_of_world: bool = False


@dataclass(frozen=True, slots=True)
class Ended:
    """The end of a motion: `reason` is empty if the goal was reached, otherwise it says why not."""

    reason: str = ""


class Motion(Protocol):
    """What a goal makes a robot do, in simulated time."""

    def step(self) -> Ended | None:
        """Post the commands of the next tick, or return how the motion ended. Called after each tick."""

    def feedback(self, kind: type[Any]) -> Any:
        """Return feedback of this class."""

    def result(self, kind: type[Any]) -> Any:
        """Return the result, of this class: also of a goal that was canceled, replaced or not reached."""

    def stop(self) -> None:
        """Stop the robot; called when the motion is over, whatever the reason."""


@dataclass(frozen=True, slots=True)
class ActionRow:
    """An action of each robot. `begin` gets the goal and the robot, or raises ValueError to reject the goal.

    A new goal of any action replaces the one that the robot pursues. `feedback_ns`: simulated time between feedback.
    """

    name: str
    type: str
    begin: Callable[[Any, ProfileRobot], Motion]
    about: str = ""
    feedback_ns: int = 100_000_000


@dataclass(frozen=True, slots=True)
class ParameterRow:
    """A parameter of the profile's node; `act` is called with the world and all values by name, also at the start."""

    name: str
    default: bool | int | float | str
    about: str = ""
    low: float | None = None
    high: float | None = None
    act: Callable[[ProfileWorld, Mapping[str, Any]], None] = lambda _world, _values: None


@dataclass(frozen=True, slots=True)
class Missing:
    """A topic, service, action, node or parameter of the other robot that does not exist here.

    `reason` says why and what to use. A `name` stands also for those below it, `reflexes` for `reflexes.REFLEX_BUMP`;
    that of a node ends with `/`, so that a topic may have it. Names other than those of parameters are relative to a
    robot, or begin with `/`. `type` is a type that no row has.
    """

    name: str
    reason: str
    type: str = ""


@dataclass(frozen=True, slots=True)
class Profile:
    """A robot whose courses run here.

    Args:
        name: The word after `--like`.
        about: One line for `--help`.
        node: Name of the node that has topics, services, actions and parameters; empty: the simulator.
        playground, program: What is loaded unless the user names something else; empty: as always.
        robots: Names of the robots in ROS, in the order of the playground; empty: as always.
        parameters: Parameters of the simulator that have other defaults.
        lidar: That of the robots, unless the user chooses another one; None: none.
        frames: Frames that are fixed at the origin of the robot.
        replaces: Topics of a robot that do not exist, since the profile has the name.
        topics, inputs, services, actions: The rows.
        node_parameters: Parameters of `node`.
        begin: Returns the commands with which a robot begins, when it comes and after a reset.
        each_tick: Called with the world after each tick.
        missing: Topics, services, actions and nodes that the other robot has and this one has not.
        missing_parameters: Parameters of `node` that the other robot has and this one has not.
        programs: Modules by names of packages and of their programs, for `thymio-sim ros2 run PACKAGE NAME`.
        is_optional: Whether rows of missing types are left out without a word.
    """

    name: str
    about: str
    node: str = ""
    playground: str = ""
    program: str = ""
    robots: tuple[str, ...] = ()
    parameters: Mapping[str, Any] = field(default_factory=dict)
    lidar: Lidar | None = None
    frames: tuple[str, ...] = ()
    replaces: frozenset[str] = frozenset()
    topics: tuple[TopicRow, ...] = ()
    inputs: tuple[InputRow, ...] = ()
    services: tuple[ServiceRow, ...] = ()
    actions: tuple[ActionRow, ...] = ()
    node_parameters: tuple[ParameterRow, ...] = ()
    begin: Callable[[ProfileRobot], Sequence[Command]] | None = None
    each_tick: Callable[[ProfileWorld], None] | None = None
    missing: tuple[Missing, ...] = ()
    missing_parameters: tuple[Missing, ...] = ()
    programs: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    is_optional: bool = False

    def __post_init__(self) -> None:
        if (self.node_parameters or self.missing_parameters) and not self.node:
            raise ValueError(f"profile {self.name}: found parameters of its node, expected the name of the node")

    def missing_name(self, name: str) -> str:
        """Why a topic, service, action or node of the other robot does not exist here; empty for any other name.

        `name` is the full name, that of a node with `/` at its end.
        """
        for one in self.missing:
            below, full = (one.name, name) if one.name.endswith("/") else (f"{one.name}/", f"{name}/")
            if full.startswith(below) if below.startswith("/") else f"/{below}" in full:
                return one.reason
        return ""

    def missing_parameter(self, name: str) -> str:
        """Why its node does not have a parameter of the other robot; empty for any other name."""
        found = (one for one in self.missing_parameters if name == one.name or name.startswith(f"{one.name}."))
        return next((one.reason for one in found), "")


def own_names() -> tuple[str, ...]:
    """Names of the profiles of this package, without loading them."""
    return registry.own_names(sys.modules[__name__])


def all_profiles() -> tuple[Profile, ...]:
    """All profiles, of this package and of other packages, in order of name."""
    return registry.collect(sys.modules[__name__], "PROFILE", Profile)


def missing_name(name: str, nodes: Collection[str]) -> str:
    """Why a graph with these nodes has no topic, service, action or node (`Profile.missing_name`) of a name; or ""."""
    return next(filter(None, (profile.missing_name(name) for profile in _running(nodes))), "")


def missing_parameter(node: str, name: str) -> str:
    """Why a node does not have a parameter; empty if it is not known."""
    return next(filter(None, (profile.missing_parameter(name) for profile in _running([node]) if profile.node)), "")


def _running(nodes: Collection[str]) -> Sequence[Profile]:
    """The profiles of a graph by their nodes, or, without such a node, those that have none."""
    profiles = all_profiles()
    with_node = [profile for profile in profiles if profile.node and f"/{profile.node}" in nodes]
    return with_node or [profile for profile in profiles if not profile.node]


def named(name: str) -> Profile:
    """Return a profile by its name. Raises ProfileError for an unknown one."""
    known = {profile.name: profile for profile in all_profiles()}
    if name not in known:
        raise ProfileError(f"found no robot '{name}', expected {fields.nearest(name, tuple(known))}")
    return known[name]
