"""Parameters of the Aseba runtime: those for all robots, and free parameters (constants, values for one robot)."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence, Sized
from dataclasses import dataclass
from typing import Any

from rclpy.exceptions import InvalidNamespaceException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.validate_namespace import validate_namespace

from aseba_vm.frontend.lexer import is_name
from aseba_vm.vm import MAX_BREAKPOINTS
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.files import resources
from thymio_sim_ros.network.settings import HTTP_PORT, OFF, TDM_WS_PORT, NetworkSettings
from thymio_sim_ros.ros.rclpy_ext import parameters as params
from thymio_sim_ros.ros.rclpy_ext.parameters import group, param

__all__ = [
    "NetworkParams",
    "RuntimeParams",
    "WrongValueError",
    "adopt_overrides",
    "check_value",
    "declare_robot",
    "exclusive",
    "is_free",
]

STRINGS, INTEGERS = Parameter.Type.STRING_ARRAY, Parameter.Type.INTEGER_ARRAY
INT16 = range(-0x8000, 0x8000)

BEHAVIOUR = "behaviour"
ROBOT_NAMES, OLD_ROBOT_NAMES = "robot_names", "robots"
"""Renamed: `ros2 param dump` cannot write a parameter `robots` together with names that begin with `robots.`."""

ROBOT_TEXTS = {
    "script.path": "Program for this robot instead of the common one: name of a built-in program or an .aesl file",
    "script.source": "Program for this robot instead of the common one: the text",
    "script.name": "Name shown for a program given as text",
}
ROBOT_ARRAYS = {
    "breakpoints": (INTEGERS, "Breakpoint lines for this robot instead of the common ones"),
    "watch": (STRINGS, "Additional variables of this robot that have a topic"),
}
ARRAYS = {"local_events": STRINGS} | {word: kind for word, (kind, _) in ROBOT_ARRAYS.items()}
_FREE = re.compile(
    r"(?:robots\.(?P<robot>[A-Za-z_][A-Za-z0-9_/]*)\.)?"
    r"(?:script\.constants\.(?P<constant>.+)|(?P<plain>script\.path|script\.source|script\.name|breakpoints|watch))"
)


class WrongValueError(ThymioSimError, ValueError):
    """An invalid value of a parameter; the message says why."""


@dataclass(frozen=True)
class NetworkParams:
    """Parameters of the network servers; -1 is no server, 0 selects a free port."""

    aseba_port: int = param(
        OFF, "Aseba port of the first robot, further robots have the next ports", low=OFF, high=65535, fixed=True
    )
    aseba_address: str = param(
        "localhost",
        "Address of the Aseba ports; every program that reaches it controls the robots, without a token",
        fixed=True,
    )
    aseba_shared: bool = param(False, "Whether all robots are on one Aseba port", fixed=True)
    address: str = param("localhost", "Address of the servers whose clients need a token", fixed=True)
    tdm_port: int = param(OFF, "TCP port of the Thymio Device Manager", low=OFF, high=65535, fixed=True)
    tdm_ws_port: int = param(
        TDM_WS_PORT,
        "WebSocket port of the Thymio Device Manager, if its TCP port is open",
        low=0,
        high=65535,
        fixed=True,
    )
    http_port: int = param(
        OFF, f"Port of the HTTP interface; that of asebahttp is {HTTP_PORT}", low=OFF, high=65535, fixed=True
    )
    on_page: tuple[str, ...] = param(
        ("",),
        "Servers that are also on the port of a page in the same process: tdm (WebSocket at /tdm), http",
        fixed=True,
    )
    allowed_origins: tuple[str, ...] = param(
        ("",), "Origins of additional web pages that may connect, as https://host:port; * allows all", fixed=True
    )
    announce: bool = param(True, "Whether the servers are announced by mDNS", fixed=True)

    @classmethod
    def of(cls, settings: NetworkSettings) -> NetworkParams:
        """The parameters with these settings."""
        return cls(
            aseba_port=settings.aseba_port,
            aseba_address=settings.aseba_address,
            aseba_shared=settings.is_aseba_shared,
            address=settings.address,
            tdm_port=settings.tdm_port,
            tdm_ws_port=settings.tdm_ws_port,
            http_port=settings.http_port,
            on_page=settings.on_page or ("",),
            allowed_origins=settings.allowed_origins or ("",),
            announce=settings.is_announced,
        )

    @property
    def settings(self) -> NetworkSettings:
        """The settings of the servers."""
        return NetworkSettings(
            aseba_port=self.aseba_port,
            aseba_address=self.aseba_address,
            is_aseba_shared=self.aseba_shared,
            address=self.address,
            tdm_port=self.tdm_port,
            tdm_ws_port=self.tdm_ws_port,
            http_port=self.http_port,
            on_page=tuple(filter(None, self.on_page)),
            allowed_origins=tuple(filter(None, self.allowed_origins)),
            is_announced=self.announce,
        )


@dataclass(frozen=True)
class RuntimeParams:
    """Parameters of the Aseba runtime node."""

    robots: list[str] = param(
        [""],
        "Namespaces of the robots, without a simulator in the process; '' is a single robot without one",
        name=ROBOT_NAMES,
        fixed=True,
    )
    path: str = param("", "Program: name of a built-in behavior or an .aesl file", name="script.path")
    source: str = param("", "Program: text of an .aesl file or of one Aseba program", name="script.source")
    name: str = param("", "Name shown for a program given as text", name="script.name")
    behaviour: str = param(
        "", "Built-in behavior, such as menu, that runs when the robot is switched on; '' is the program, or the menu"
    )
    breakpoints: list[int] = param([], "Breakpoints: lines of the program file, from 1; at most 16", array=INTEGERS)
    watch: list[str] = param([], "Variables with a topic, aseba/variables/<name>", array=STRINGS)
    watch_rate: float = param(10.0, "Polls of variables per second of wall time", low=0.1, high=100.0)
    local_events: list[str] = param(
        [], "Local events, such as prox, that are published like events of the program; * is all", array=STRINGS
    )
    emit_reaches: str = param(
        "network",
        "Receivers of _aseba/emit of a robot: network (all that declare the event) or robot (only this one)",
        choices=("network", "robot"),
    )
    language: str = param("en", "Language of the help in _aseba/target; English if not translated")
    first_id: int = param(1, "Number of the first robot on the Aseba network", low=1, high=32000, fixed=True)
    robot: str = param(
        "",
        "Address of a real robot, in place of a simulator: tcp:host:port, or ser:device (ser is the first Thymio)",
        fixed=True,
    )
    cmd_vel_timeout: float = param(
        1.0, "Time after which a velocity for a real robot ends, s; 0 is never", low=0.0, high=3600.0, fixed=True
    )
    layout: str = param(
        "thymio", "Variables and native functions: thymio (firmware 14) or playground (Aseba Playground)", fixed=True
    )
    events: str = param(
        "firmware", "Event policy: firmware (events wait) or playground (an event ends the running handler)", fixed=True
    )
    card: str = param("", "Folder used as memory card; '' is no card", fixed=True)
    network: NetworkParams = group(NetworkParams(), "network")
    settings: str = param("", "Folder where the robot's settings are stored; '' does not store them", fixed=True)

    @property
    def options(self) -> DeviceOptions:
        """Options of the devices. Raises OptionError for an unknown choice."""
        folders = (resources.expanded(text) if text else None for text in (self.card, self.settings))
        return DeviceOptions(self.layout, self.events, *folders)


def adopt_overrides(node: Node) -> dict[str, Any]:
    """Declare free parameters given at the start and return their values. The others are declared as usual.

    Raises WrongValueError.
    """
    found = {}
    ours = params.by_name(RuntimeParams())
    params.warn_of_unknown(node, "ros.md", lambda name: name in ours or is_free(name) or name == OLD_ROBOT_NAMES, ours)
    given = params.overrides(node)
    if OLD_ROBOT_NAMES in given and ROBOT_NAMES not in given:
        node.get_logger().warning(f"parameter {OLD_ROBOT_NAMES} was renamed to {ROBOT_NAMES}")
        node._parameter_overrides[ROBOT_NAMES] = Parameter(ROBOT_NAMES, value=given[OLD_ROBOT_NAMES])
    for name, value in given.items():
        if value is not None and is_free(name):  # an empty list has no type, and equals the default
            check_value(name, value)
            found[name] = node.declare_parameter(name, value).value
    return found


def declare_robot(node: Node, robot: str) -> dict[str, Any]:
    """Declare the parameters of one robot that are not declared yet and return their values by full name."""
    values: dict[str, Any] = {}
    for word, text in ROBOT_TEXTS.items():
        name = f"robots.{robot}.{word}"
        if not node.has_parameter(name):
            values[name] = node.declare_parameter(name, "", params.described(text)).value
    for word, (kind, text) in ROBOT_ARRAYS.items():
        name = f"robots.{robot}.{word}"
        if not node.has_parameter(name):
            values[name] = params.declare_array(node, name, kind, text)
    return values


def check_value(name: str, value: Any) -> None:
    """Raise WrongValueError for an unknown free parameter or an invalid value."""
    if name == "local_events":
        _check_strings(name, value)
    if name == ROBOT_NAMES:
        for robot in value:
            _check_namespace(name, robot)
    match = _FREE.fullmatch(name)
    if match is None:
        return
    if match["constant"]:
        _check_constant(name, match["constant"], value)
    elif match["plain"] == "breakpoints":
        _check_lines(name, value)
    elif match["plain"] == "watch":
        _check_strings(name, value)
    elif not isinstance(value, str):
        raise WrongValueError(f"{name}: found {value!r}, expected text")


def is_free(name: str) -> bool:
    """Whether a parameter of this name may be set without being declared."""
    match = _FREE.fullmatch(name)
    return match is not None and bool(match["robot"] or match["constant"])


def exclusive(parameters: Sequence[Parameter], present: Callable[[str], Any]) -> list[Parameter]:
    """Return the parameters with path or source emptied where the other is given, and typed empty lists.

    A new common program, different from the `present` one, also resets the built-in behavior.
    """
    given = {parameter.name for parameter in parameters}
    result = []
    for parameter in parameters:
        kind = ARRAYS.get(parameter.name.rpartition(".")[2])
        is_empty = not isinstance(parameter.value, str) and isinstance(parameter.value, Sized) and not parameter.value
        result.append(Parameter(parameter.name, kind, []) if kind is not None and is_empty else parameter)
        for suffix, other in (("script.path", "script.source"), ("script.source", "script.path")):
            sibling = parameter.name.removesuffix(suffix) + other
            if parameter.name.endswith(suffix) and parameter.value and sibling not in given:
                result.append(Parameter(sibling, value=""))
        is_program = parameter.name in ("script.path", "script.source") and parameter.value
        if is_program and BEHAVIOUR not in given and parameter.value != present(parameter.name):
            result.append(Parameter(BEHAVIOUR, value=""))
    return result


def _check_constant(name: str, constant: str, value: object) -> None:
    if not is_name(constant):
        raise WrongValueError(f"{name}: a program cannot use the name '{constant}'")
    if value is not None and (isinstance(value, bool) or not isinstance(value, int) or value not in INT16):
        raise WrongValueError(f"{name}: found {value!r}, expected a whole number from -32768 to 32767")


def _check_namespace(name: str, robot: str) -> None:
    try:
        validate_namespace(f"/{robot}")
    except InvalidNamespaceException as error:
        raise WrongValueError(f"{name}: found {robot!r}, expected a namespace such as 'anna', or ''") from error


def _check_lines(name: str, value: Any) -> None:
    lines = _list(name, value, "lines")
    if any(isinstance(line, bool) or not isinstance(line, int) or line < 1 for line in lines):
        raise WrongValueError(f"{name}: found {lines}, expected lines from 1 on")
    if len(lines) > MAX_BREAKPOINTS:
        raise WrongValueError(f"{name}: found {len(lines)} breakpoints, expected at most {MAX_BREAKPOINTS}")


def _check_strings(name: str, value: Any) -> None:
    names = _list(name, value, "names")
    if any(not isinstance(item, str) for item in names):
        raise WrongValueError(f"{name}: found {names}, expected a list of names")


def _list(name: str, value: Any, of: str) -> list[Any]:
    """Return the items of a list parameter; one that was never set is empty."""
    if isinstance(value, str | bytes | int | float):  # a bool is an int
        raise WrongValueError(f"{name}: found {value!r}, expected a list of {of}")
    return list(value or ())
