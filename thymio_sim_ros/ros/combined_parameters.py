"""The parameters of the suite in one process: the nodes that each belongs to, and default values.

rcl would set a parameter without a node name (`-p port:=9000`) on every node of the process, but `port` of the page is
not `port` of the bridge. `assigned` assigns each parameter to the nodes that it is intended for. This also works in a
namespace, where rcl does not find nodes by `-p node:name:=value`.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from thymio_sim_ros.ros.aseba.parameters import NetworkParams, RuntimeParams, is_free
from thymio_sim_ros.ros.profiles import Profile, named
from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.simulator.parameters import LidarParams, SimulatorParams
from thymio_sim_ros.suite_config import SuiteConfig

__all__ = ["BRIDGE", "PAGE", "RUNTIME", "SIMULATOR", "SUITE", "Target", "assigned", "defaults", "targets"]

SUITE = "thymio"
"""Name of the process; `-p thymio:name:=value` is the same as `-p name:=value`."""

SIMULATOR, RUNTIME, BRIDGE, PAGE = "simulator", "aseba_runtime", "foxglove_bridge", "web_ui"

Target = tuple[str, str]
"""A node and its name of the parameter."""

_SPECIAL: Mapping[str, tuple[Target, ...]] = {
    "port": ((PAGE, "port"),),
    "foxglove_port": ((BRIDGE, "port"), (PAGE, "foxglove_port")),
    "robot_names": ((SIMULATOR, "robot_names"),),
    "robot": (),
}
"""Parameters whose names have different meanings in different nodes. The runtime gets the robots from the simulator.
Whether there is a simulator is decided by the option `--robot`, before there are nodes.
"""

_ROS_PARAMETERS: Mapping[str, tuple[str, ...]] = {
    "use_sim_time": (RUNTIME, BRIDGE, PAGE),
    "start_type_description_service": (SIMULATOR, RUNTIME, BRIDGE, PAGE),
}
"""Parameters that rclpy declares, and the nodes that they are intended for. The simulator publishes simulated time, and
must not use it itself."""

_PARAMETER = ("-p", "--param")
_QUOTED = ('"', "'", "[", "{")


def defaults(suite: SuiteConfig) -> dict[str, Any]:
    """The parameters of each node of the suite by the name of the node, with the values of the suite."""
    device = suite.device
    simulated = SimulatorParams(
        playground=suite.playground,
        seed=suite.seed,
        motor_model=suite.motor_model,
        proximity_model=suite.proximity_model,
        lidar=LidarParams.of(suite.lidar),
        out_of_range=suite.out_of_range,
        log=suite.log,
        replay=suite.replay,
        replay_from=suite.replay_from_s,
        real_time_factor=suite.real_time_factor,
        cmd_vel_timeout=suite.cmd_vel_timeout_s,
    )
    values: dict[str, Any] = {
        SIMULATOR: simulated.like(named(suite.like)) if suite.like else simulated,
        RUNTIME: RuntimeParams(
            path=suite.program,
            behaviour=suite.behaviour,
            robot=suite.robot,
            cmd_vel_timeout=suite.cmd_vel_timeout_s,
            layout=device.layout,
            events=device.events,
            card=str(device.card or ""),
            settings=str(device.settings or ""),
            network=NetworkParams.of(suite.network),
        ),
    }
    both: dict[str, Any] = {"tls": bool(suite.certificate), "certfile": suite.certificate, "keyfile": suite.key}
    both |= {"address": suite.address, "trusted_proxies": suite.trusted_proxies or ("",)}
    if suite.foxglove:
        from thymio_sim_ros.ros.foxglove.options import FoxgloveParams

        values[BRIDGE] = FoxgloveParams(port=suite.foxglove_port, **both)
    if suite.web:
        from thymio_sim_ros.ros.web.node import WebParams

        values[PAGE] = WebParams(port=suite.port, foxglove_port=suite.foxglove_port, nodes=suite.nodes.value, **both)
    return values


def targets(name: str, profile: Profile | None = None) -> tuple[Target, ...]:
    """The targets of a parameter of the suite, with the node of a profile if there is one; empty if no node has it."""
    if profile is not None and (
        any(name == row.name for row in profile.node_parameters) or profile.missing_parameter(name)
    ):
        return ((profile.node, name),)
    if name in _SPECIAL:
        return _SPECIAL[name]
    if name in _ROS_PARAMETERS:
        return tuple((node, name) for node in _ROS_PARAMETERS[name])
    if name.startswith("qos_overrides."):
        return ((SIMULATOR, name),)
    if is_free(name):
        return ((RUNTIME, name),)
    return tuple((node, name) for node, values in defaults(SuiteConfig()).items() if name in parameters.by_name(values))


@contextmanager
def assigned(words: Sequence[str], profile: Profile | None = None) -> Iterator[tuple[list[str], list[str]]]:
    """Yield the ROS arguments with each parameter assigned to its nodes, and warnings about unknown parameters.

    The arguments name a temporary file, which exists until the context ends. Raises StartError if it cannot be written.
    """
    before, given, after = _split(words)
    if not given:
        yield list(words), []
        return
    sections, warnings = _sections(given, profile)
    with ExitStack() as stack:
        try:
            # Not a NamedTemporaryFile: on Windows a file that is open cannot be opened once more.
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="thymio-sim-"))
            file = Path(folder, "parameters.yaml")
            file.write_text(_yaml(sections), encoding="utf-8")
        except OSError as error:
            raise StartError(
                f"cannot write the parameters to a temporary file: {error.strerror} ({error.filename})"
            ) from error
        yield [*before, "--params-file", str(file), *after], warnings


def _split(words: Sequence[str]) -> tuple[list[str], list[str], list[str]]:
    """Split words into the parameters, `node:name:=value` or `name:=value`, and the others before and after the last.

    What comes after it, such as a file of parameters, overrides it.
    """
    rest: list[str] = []
    given: list[str] = []
    place = 0
    is_of_ros, waiting = False, list(words)
    while waiting:
        word = waiting.pop(0)
        if word == "--ros-args" or (word == "--" and is_of_ros):
            is_of_ros = word == "--ros-args"
        if is_of_ros and word in _PARAMETER and waiting and ":=" in waiting[0]:
            given.append(waiting.pop(0))
            place = len(rest)
        else:
            rest.append(word)
    return rest[:place], given, rest[place:]


def _sections(given: Sequence[str], profile: Profile | None) -> tuple[dict[str, dict[str, str]], list[str]]:
    """Return node → parameter → value as it was written, and warnings.

    Parameters that name a node are applied last, and so override those without.
    """
    of_profile = (profile.node,) if profile is not None and profile.node else ()
    sections: dict[str, dict[str, str]] = {node: {} for node in (SIMULATOR, RUNTIME, BRIDGE, PAGE, *of_profile)}
    warnings: list[str] = []
    rules = [(*left.rpartition(":")[::2], value) for left, _, value in (rule.partition(":=") for rule in given)]
    for node, name, value in sorted(rules, key=lambda rule: rule[0] not in ("", SUITE)):
        found = targets(name, profile) if node in ("", SUITE) else ((node, name),)
        if not found:
            known = [key for values in defaults(SuiteConfig()).values() for key in parameters.by_name(values)]
            warnings.append(
                f"parameter {name} is not a parameter of the suite and has no effect{parameters.meant(name, known)}"
            )
        for target, own_name in found:
            if target in sections:
                sections[target][own_name] = value
            else:
                near = parameters.meant(target, list(sections))
                warnings.append(f"parameter {name}: the suite has no node {target}{near}")
    return sections, warnings


def _yaml(sections: Mapping[str, Mapping[str, str]]) -> str:
    """The text of a parameter file; `/**/` matches the nodes in every namespace."""
    lines = []
    for node, values in sections.items():
        if values:
            lines += [f"/**/{node}:", "  ros__parameters:"]
            lines += [f"    {json.dumps(name)}: {_scalar(value)}" for name, value in values.items()]
    return "\n".join([*lines, ""])


def _scalar(value: str) -> str:
    """A value as rcl parses it; text that YAML would parse as several lines or as a mapping is quoted."""
    if value.startswith(_QUOTED):
        return value.replace("\n", " ")
    is_plain = value and "\n" not in value and ": " not in value and not value.endswith(":")
    return value if is_plain else json.dumps(value)
