"""The classes of a profile's types, and what is wrong with a profile."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from thymio_sim_ros.portable_ros import import_hook
from thymio_sim_ros.portable_ros.messages import interface_files
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, load_type
from thymio_sim_ros.ros.interface import sensor_topics
from thymio_sim_ros.ros.interface.robot_inputs import robot_inputs
from thymio_sim_ros.ros.profiles import ActionRow, InputRow, Profile, ProfileError, ServiceRow, TopicRow
from thymio_sim_ros.ros.simulator.robot_endpoints import SERVICES
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.sensors import all_sensors

__all__ = ["UsableProfile", "usable"]

_NODES = ("simulator", "aseba_runtime", "foxglove_bridge", "web_ui")
"""Names that nodes of the suite have."""

R = TypeVar("R", TopicRow, InputRow, ServiceRow, ActionRow)


@dataclass(frozen=True, slots=True)
class UsableProfile:
    """A profile without the rows whose types are not installed.

    `types` are the classes by name; `left_out` are sentences about the rows that are missing.
    """

    profile: Profile
    types: Mapping[str, Any]
    left_out: tuple[str, ...]


def usable(profile: Profile) -> UsableProfile:
    """Find the types of a profile, and check its names.

    On an installed ROS 2, rows whose package is not installed are left out: the others, with types that every ROS 2
    has, work. Raises ProfileError for a profile without a row that can be used, for types that the embedded graph does
    not know, for a type that a known package does not have, and for names that robots or nodes have already.
    """
    _check_names(profile)
    types: dict[str, Any] = {}
    absent: dict[str, str] = {}
    for name in dict.fromkeys(row.type for row in _rows(profile)):
        try:
            types[name] = load_type(name)
        except MissingTypeError as error:
            _check_type(profile, name)
            absent[name] = error.reason
    if not absent:
        return UsableProfile(profile, types, ())
    packages = list(dict.fromkeys(name.partition("/")[0] for name in absent))
    if not profile.is_optional and (not types or import_hook.is_served("rclpy")):
        name, reason = next(iter(absent.items()))
        raise ProfileError(
            f"--like {profile.name}: type {name} is not available: {reason}; expected the package"
            f" {' and '.join(packages)}, installed or as a folder with its definitions"
        )

    def kept(rows: Sequence[R]) -> tuple[R, ...]:
        return tuple(row for row in rows if row.type in types)

    left_out = [_name_of(row) for row in _rows(profile) if row.type in absent]
    verb, whose = ("is", "its") if len(packages) == 1 else ("are", "their")
    elsewhere = f", or use the embedded graph, which has {whose} types (--portable)"
    of_system = " and ".join(f"ros-<distribution>-{package.replace('_', '-')}" for package in packages)
    sentence = (
        f"--like {profile.name}: {', '.join(left_out)} left out, since {' and '.join(packages)} {verb} not installed in"
        f" this ROS 2: install {of_system}{elsewhere if all(map(interface_files.is_package, packages)) else ''}"
    )
    rest = replace(
        profile,
        topics=kept(profile.topics),
        inputs=kept(profile.inputs),
        services=kept(profile.services),
        actions=kept(profile.actions),
    )
    return UsableProfile(rest, types, () if profile.is_optional else (sentence,))


def _rows(profile: Profile) -> Iterable[TopicRow | InputRow | ServiceRow | ActionRow]:
    return (*profile.topics, *profile.inputs, *profile.services, *profile.actions)


def _name_of(row: TopicRow | InputRow | ServiceRow | ActionRow) -> str:
    return row.topic if isinstance(row, TopicRow | InputRow) else row.name


def _check_type(profile: Profile, name: str) -> None:
    """Raise ProfileError for a type that does not exist, though the definitions of its package are known."""
    package, _, short = name.partition("/")
    if interface_files.is_package(package) and short not in interface_files.interfaces(package):
        known = tuple(f"{package}/{other}" for other in interface_files.interfaces(package))
        raise ProfileError(f"--like {profile.name}: found no type {name}, expected {fields.nearest(name, known)}")


def _check_names(profile: Profile) -> None:
    """Raise ProfileError for a name that is used twice."""
    if profile.node in _NODES:
        raise ProfileError(f"--like {profile.name}: found the node '{profile.node}', which the suite has already")
    own = {row.topic for sensor in all_sensors() for row in sensor_topics.rows_of(sensor)}
    own |= {robot_input.topic for robot_input in robot_inputs()} | SERVICES.keys()
    taken = own - profile.replaces
    rows = [row for row in _rows(profile) if not (isinstance(row, InputRow) and row.is_second)]
    counts = Counter((type(row) in (TopicRow, InputRow), _name_of(row)) for row in rows)
    for (_, name), count in counts.items():
        if name in taken:
            raise ProfileError(
                f"--like {profile.name}: found '{name}', which the robot itself has; expected another name, or '{name}'"
                " among the names that the profile replaces"
            )
        if count > 1:
            raise ProfileError(f"--like {profile.name}: found '{name}' twice, expected unique names")
    if unknown := sorted(profile.replaces - own):
        raise ProfileError(
            f"--like {profile.name}: found '{unknown[0]}' among the names that it replaces, expected one of a robot"
        )
