"""Who may import whom (docs/architecture.md): every import of every module, read from its syntax tree."""

from __future__ import annotations

import ast
import graphlib
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

from tests.syntax import ROOT, place, tree

PACKAGES = ("aseba_vm", "thymio_sim_ros")
OURS = "thymio_sim_ros"


@dataclass(frozen=True)
class Rule:
    """What the modules below a name may import: of ours, of others; and what of the standard library they may not."""

    ours: frozenset[str]
    others: frozenset[str] = frozenset()
    never: frozenset[str] = frozenset()


def _names(*names: str) -> frozenset[str]:
    return frozenset(f"{OURS}.{name}" if name != "aseba_vm" else name for name in names)


NO_WALL_CLOCK = frozenset({"asyncio", "threading", "time", "socket", "selectors", "multiprocessing"})
MESSAGES = frozenset({
    "action_msgs", "builtin_interfaces", "diagnostic_msgs", "geometry_msgs", "lifecycle_msgs", "nav_msgs",
    "rcl_interfaces", "rosgraph_msgs", "sensor_msgs", "service_msgs", "simulation_interfaces", "std_msgs", "std_srvs",
    "tf2_msgs", "thymio_msgs", "type_description_interfaces", "unique_identifier_msgs", "visualization_msgs",
})  # fmt: skip
ROS = MESSAGES | {"rclpy", "ament_index_python", "rosidl_parser", "rosidl_runtime_py"}
ALL_OF_OURS = frozenset(PACKAGES)
KERNELS = frozenset({"aseba_vm.kernel"})
DECLARATIONS = _names(
    "sim.commands", "sim.model", "sim.sensors", "sim.actuators", "sim.stimuli", "sim.plugin_api", "sim.audio.synthesis"
)

# The longest name that fits a module decides.
RULES = {
    "aseba_vm": Rule(_names("aseba_vm"), never=NO_WALL_CLOCK),
    # one compiler of kernels to WebAssembly for natives of the machine and laws of the simulator
    f"{OURS}.sim": Rule(_names("sim", "files.registry") | KERNELS, frozenset({"numpy"}), NO_WALL_CLOCK),
    # one decoding of text files for programs and playgrounds
    f"{OURS}.sim.formats.xml_tree": Rule(
        _names("sim") | {"aseba_vm.aesl.text_decoding", "aseba_vm.errors"}, never=NO_WALL_CLOCK
    ),
    # the one place where the core measures real time: a picture that takes too much to draw is refused
    f"{OURS}.sim.formats.svg_worker": Rule(frozenset(), frozenset({"resvg_py"}), NO_WALL_CLOCK - {"time"}),
    f"{OURS}.sim.physics": Rule(_names("sim") | KERNELS, frozenset({"numpy", "pymunk"}), NO_WALL_CLOCK),
    f"{OURS}.device": Rule(_names("aseba_vm", "device", "files.registry") | DECLARATIONS, never=NO_WALL_CLOCK),
    f"{OURS}.files.registry": Rule(frozenset(), never=NO_WALL_CLOCK),
    # world and devices: no ROS, no network, no clock on the wall
    f"{OURS}.engine": Rule(_names("aseba_vm", "device", "engine", "sim"), never=NO_WALL_CLOCK),
    f"{OURS}.files": Rule(_names("aseba_vm", "device", "files", "sim")),
    f"{OURS}.access": Rule(_names("access"), frozenset({"aiohttp"})),  # for a type
    f"{OURS}.names": Rule(_names("access", "names")),
    f"{OURS}.bridge": Rule(_names("access", "bridge"), frozenset({"aiohttp", "foxglove_websocket", "websockets"})),
    f"{OURS}.bridge.rosbridge": Rule(_names("bridge"), frozenset({"cbor2"}), NO_WALL_CLOCK),
    f"{OURS}.web": Rule(
        _names("access", "web", "bridge", "files.playground_index", "files.resources", "sim"), frozenset({"aiohttp"})
    ),
    f"{OURS}.page_nodes": Rule(_names("access", "bridge.handshake", "page_nodes", "web"), frozenset({"aiohttp"})),
    f"{OURS}.network": Rule(
        _names("access", "aseba_vm", "bridge", "device.programs", "names.addresses", "network", "web"),
        frozenset({"aiohttp", "serial", "zeroconf"}),
    ),
    f"{OURS}.network.http": Rule(
        _names("access", "aseba_vm", "device.programs", "files.block_files", "network.http"),
        never=NO_WALL_CLOCK,
    ),
    f"{OURS}.network.http.server": Rule(
        _names("access", "aseba_vm", "bridge", "network", "web"), frozenset({"aiohttp"})
    ),
    f"{OURS}.network.tdm.protocol": Rule(_names("network.tdm.protocol"), frozenset({"flatbuffers"}), NO_WALL_CLOCK),
    f"{OURS}.network.tdm": Rule(
        _names("aseba_vm", "device.programs", "network.tdm"), frozenset({"flatbuffers"}), NO_WALL_CLOCK
    ),
    f"{OURS}.classroom": Rule(
        _names("access", "aseba_vm", "bridge", "classroom", "files", "names.addresses", "sim"),
        frozenset({"segno", "websockets"}),
    ),
    f"{OURS}.classroom.router": Rule(_names("access", "classroom", "web"), frozenset({"aiohttp"})),
    f"{OURS}.classroom.server": Rule(_names("bridge", "classroom", "web"), frozenset({"aiohttp"})),
    f"{OURS}.classroom.suite_proxy": Rule(_names("access", "web"), frozenset({"aiohttp", "multidict", "yarl"})),
    f"{OURS}.studio_layout": Rule(_names("studio_layout"), never=NO_WALL_CLOCK),
    f"{OURS}.ros": Rule(ALL_OF_OURS - {f"{OURS}.cli"}, ROS),
    f"{OURS}.ros.foxglove.rosbridge.values": Rule(ALL_OF_OURS - {f"{OURS}.cli"}, ROS | {"cbor2", "numpy"}),
    f"{OURS}.bags": Rule(
        _names("bags", "end_signals", "ros.foxglove.schemas", "ros.foxglove.types"), ROS | {"rosbags"}
    ),
    # the verbs of ros2 that tutorials need: a node of its own, on any graph
    f"{OURS}.ros_commands": Rule(
        _names("bags.qos", "portable_ros.messages.message_class", "ros.profiles", "ros_commands")
        | _names("ros.foxglove.json_messages", "ros.foxglove.schemas", "ros.foxglove.types"),
        ROS | {"yaml"},
    ),
    f"{OURS}.ros_commands.arguments": Rule(frozenset()),
    f"{OURS}.bags.arguments": Rule(frozenset()),
    f"{OURS}.tf": Rule(
        _names("course_packages", "tf", "ros.compat.tf2_messages", "ros.rclpy_ext.throttled_log"),
        ROS | {"numpy", "tf2_geometry_msgs", "tf2_ros", "tf_transformations"},
    ),
    # rclpy and messages in pure Python: know no robot
    f"{OURS}.portable_ros": Rule(_names("portable_ros"), frozenset({"numpy", "rosbags", "yaml"})),
    f"{OURS}.portable_ros.rosbridge": Rule(_names("errors", "portable_ros"), frozenset({"cbor2", "websockets"})),
    f"{OURS}.portable_ros.__main__": Rule(_names("course_packages", "portable_ros")),
    f"{OURS}.portable_ros.ros_types": Rule(_names("portable_ros"), MESSAGES),  # for their types
    # the packages of other names, which only programs of students import
    f"{OURS}.course_packages": Rule(
        _names(
            "course_packages", "portable_ros.import_hook", "ros.compat.absent_types", "ros.compat.tf2_messages", "tf"
        ),
        ROS,
    ),
    f"{OURS}.course_packages.stubs": Rule(frozenset()),
    f"{OURS}.course_packages.packages.sensor_msgs_py": Rule(
        frozenset(), frozenset({"numpy", "sensor_msgs", "std_msgs"})
    ),
    f"{OURS}.tf.buffer_core": Rule(_names("tf.errors"), never=NO_WALL_CLOCK),
    f"{OURS}.tf.transformations": Rule(frozenset(), frozenset({"numpy"}), NO_WALL_CLOCK),
    # students copy them: rclpy, messages, and tf2 for those who have the wheels only
    f"{OURS}.examples": Rule(_names("tf"), ROS),
    # programs of a foreign package, with its types
    f"{OURS}.turtlesim": Rule(frozenset(), ROS | {"turtlesim"}),
    f"{OURS}.launch": Rule(frozenset(), frozenset({"launch", "launch_ros"})),
    f"{OURS}.batch_runs": Rule(_names("batch_runs"), frozenset({"dask", "distributed"})),
    f"{OURS}.sweep": Rule(
        _names("aseba_vm", "device", "engine", "files", "sim", "sweep"),
        frozenset({"pyarrow"}),
        NO_WALL_CLOCK - {"time"},
    ),
    f"{OURS}.missions": Rule(_names("device.programs", "engine", "files", "missions", "sim"), never=NO_WALL_CLOCK),
    f"{OURS}.rl": Rule(_names("engine", "files", "rl", "sim"), frozenset({"gymnasium", "numpy"}), NO_WALL_CLOCK),
    f"{OURS}.rl.parallel_env": Rule(_names("rl"), frozenset({"gymnasium", "numpy", "pettingzoo"}), NO_WALL_CLOCK),
    f"{OURS}.testing": Rule(_names("device", "engine", "files", "missions", "sim", "testing"), frozenset({"pytest"})),
    f"{OURS}.testing.ros": Rule(ALL_OF_OURS, ROS | {"pytest"}),
    f"{OURS}.lockstep": Rule(_names("course_packages", "errors", "lockstep", "names.type_names", "portable_ros"), ROS),
    f"{OURS}.grading": Rule(
        _names("aseba_vm", "batch_runs", "files.block_files", "files.test_files", "grading"), frozenset({"pytest"})
    ),
    f"{OURS}.grading.sandbox.tracked_processes": Rule(_names("grading"), frozenset({"psutil"})),
    f"{OURS}.grading.gradescope": Rule(frozenset(), frozenset({"yaml"})),
    f"{OURS}.grading.test_process": Rule(
        _names("files.test_files", "grading", "portable_ros.import_hook", "pytest_plugin", "testing"),
        frozenset({"pytest"}),
    ),
    f"{OURS}.pytest_plugin": Rule(ALL_OF_OURS, frozenset({"pytest"})),
    f"{OURS}.notebook": Rule(ALL_OF_OURS, frozenset({"jupyter_server"})),
    f"{OURS}.cli": Rule(ALL_OF_OURS),
    f"{OURS}.cli.banner": Rule(ALL_OF_OURS, frozenset({"segno"})),
    OURS: Rule(ALL_OF_OURS),
}
STARTERS = {
    f"{OURS}.bags",
    f"{OURS}.cli",
    f"{OURS}.course_packages",
    f"{OURS}.testing.ros",
    f"{OURS}.pytest_plugin",
    f"{OURS}.ros",
    f"{OURS}.ros_commands",
    f"{OURS}.tf",
}


def _sources() -> dict[str, Path]:
    """Every module of ours, dotted name → file."""
    paths = [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]
    return {".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path for path in paths}


SOURCES = _sources()


def _found(path: Path) -> Iterator[tuple[str, str]]:
    """Dotted names that a file imports anywhere, and where; `from package import module` counts as the module."""
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            yield from ((alias.name, place(path, node)) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{place(path, node)}: imports are absolute"
            for alias in node.names:
                name = f"{node.module}.{alias.name}"
                yield (name if name in SOURCES else str(node.module)), place(path, node)


@cache
def _imports(module: str) -> dict[str, str]:
    """Dotted names that a module imports, and where."""
    return dict(_found(SOURCES[module]))


def _below(name: str, package: str) -> bool:
    return name == package or name.startswith(f"{package}.")


def _rule(module: str) -> Rule:
    return RULES[max((name for name in RULES if _below(module, name)), key=len)]


def _is_refused(name: str, rule: Rule) -> bool:
    top = name.split(".")[0]
    if top in PACKAGES:
        # The package itself holds nothing but the version, `errors` nothing but the base of all exceptions.
        return name not in (OURS, f"{OURS}.errors") and not any(_below(name, allowed) for allowed in rule.ours)
    if top in sys.stdlib_module_names:
        return top in rule.never
    return top not in rule.others


def test_every_module_imports_only_what_its_package_may() -> None:
    refused = {
        where: name
        for module in SOURCES
        for name, where in _imports(module).items()
        if _is_refused(name, _rule(module))
    }
    assert not refused, "\n".join(f"{where}: may not import {name}" for where, name in refused.items())


def test_only_the_commands_and_the_fixtures_import_ros() -> None:
    ros = f"{OURS}.ros"
    importers = {module for module in SOURCES if any(_below(name, ros) for name in _imports(module))}
    assert {module for module in importers if not any(_below(module, starter) for starter in STARTERS)} == set()


def test_no_module_imports_itself_by_a_detour() -> None:
    graph = {module: {name for name in _imports(module) if name in SOURCES} - {OURS} for module in SOURCES}
    graphlib.TopologicalSorter(graph).prepare()


PICTURE = re.compile(r"^(commands +cli.*\n.*?)```", re.MULTILINE | re.DOTALL)
"""The rooms in docs/architecture.md: the name of a row, at least two blanks, its rooms."""


def _room(module: str) -> str | None:
    """The room of a module as the picture names it; None for the modules that are in no room."""
    if _below(module, "aseba_vm"):
        return "aseba_vm"
    parts = module.split(".")[1:]
    if parts[:1] == ["ros"]:
        return "/".join(parts[:2]) if len(parts) > 2 or _is_package(module) else None
    return parts[0] if len(parts) > 1 or parts == ["pytest_plugin"] or (parts and _is_package(module)) else None


def _is_package(module: str) -> bool:
    return SOURCES[module].name == "__init__.py"


def test_the_picture_of_the_rooms_is_true() -> None:
    found = PICTURE.search((ROOT / "docs" / "architecture.md").read_text(encoding="utf-8"))
    assert found is not None
    rows = [re.split(" {2,}", line)[1:] for line in found[1].splitlines()]
    row_of = {room: number for number, rooms in enumerate(rows) for room in rooms}
    assert row_of.keys() == {room for module in SOURCES if (room := _room(module)) is not None} - {"launch", "ros"}
    upward = {
        f"{room} imports {other} ({where})"
        for module in SOURCES
        if (room := _room(module)) in row_of
        for name, where in _imports(module).items()
        if name in SOURCES and (other := _room(name)) in row_of and row_of[other] < row_of[room]
    }
    assert upward == set()


@pytest.mark.process
def test_everything_without_ros_can_be_imported_where_rclpy_cannot() -> None:
    with_ros = (
        f"{OURS}.bags",
        f"{OURS}.course_packages.packages",
        f"{OURS}.ros",
        f"{OURS}.ros_commands",
        f"{OURS}.testing.ros",
        f"{OURS}.lockstep",
        f"{OURS}.launch",
        f"{OURS}.tf",
        f"{OURS}.examples",
        f"{OURS}.turtlesim",
        f"{OURS}.cli.preload",
    )
    pure = [module for module in SOURCES if not any(_below(module, name) for name in with_ros)]
    pure = [module for module in pure if not module.endswith("__main__")]
    program = (
        "import importlib, sys\n"
        "sys.modules.update(dict.fromkeys(['rclpy', 'std_msgs', 'rcl_interfaces']))\n"
        "for name in sys.argv[1:]: importlib.import_module(name)\n"
    )
    # rclpy warns as well, when the former name of a module is imported
    command = [sys.executable, "-W", "ignore:importing 'qos_event' is deprecated", "-c", program, *pure]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert done.returncode == 0


@pytest.mark.process
def test_the_language_needs_nothing_but_the_standard_library() -> None:
    """aseba_vm is useful without a robot: -S hides every installed package."""
    program = f"import sys; sys.path.insert(0, {str(ROOT)!r}); import aseba_vm"
    subprocess.run([sys.executable, "-I", "-S", "-c", program], check=True, capture_output=True)
