"""The launch file, without launch (no wheel has it): it passes on what the nodes declare, and they run by it."""

from __future__ import annotations

import dataclasses
import importlib
import re
import runpy
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
import yaml

from tests.patience import PATIENCE_S

pytest.importorskip("rclpy")

from tests.processes import Process, free_port, wait_for_port
from thymio_sim_ros.access.tokens import READ_ONLY_VARIABLE, TOKEN, TOKEN_VARIABLE
from thymio_sim_ros.device.event_queue import POLICIES
from thymio_sim_ros.device.layout import LAYOUTS
from thymio_sim_ros.ros.rclpy_ext import parameters as params
from thymio_sim_ros.ros.simulator import parameters as simulator_params
from thymio_sim_ros.suite_config import SuiteConfig

ROOT = Path(__file__).parents[2]
LAUNCH = ROOT / "thymio_sim_ros" / "launch" / "thymio.launch.py"
# Executable or node → its module, which has the dataclass of its parameters.
MODULES = {
    "thymio": "combined",
    "simulator": "simulator.node",
    "aseba_runtime": "aseba.node",
    "foxglove_bridge": "foxglove.node",
    "web_ui": "web.node",
}
NAMES = {
    "launch": ["LaunchContext", "LaunchDescription"],
    "launch.actions": ["DeclareLaunchArgument", "OpaqueFunction", "SetEnvironmentVariable", "Shutdown"],
    "launch.conditions": ["IfCondition"],
    "launch.events": [],
    "launch.events.process": ["ProcessExited"],
    "launch.substitutions": ["LaunchConfiguration", "PathJoinSubstitution"],
    "launch_ros": [],
    "launch_ros.actions": ["Node"],
    "launch_ros.parameter_descriptions": ["ParameterValue"],
    "launch_ros.substitutions": ["FindPackageShare"],
}


class Call:
    """Any object of launch: remembers how it was made; a configuration is looked up as in launch."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self.args, self.kwargs = args, kwargs

    def perform(self, context: dict[str, str]) -> str:
        """The text of a substitution, by the launch arguments."""
        if type(self).__name__ == "LaunchConfiguration":
            return context[self.args[0]]
        raise AssertionError(f"unknown: {type(self).__name__}")


@pytest.fixture
def description(monkeypatch: pytest.MonkeyPatch) -> Call:
    for name, classes in NAMES.items():
        module = ModuleType(name)
        vars(module).update({class_name: type(class_name, (Call,), {}) for class_name in classes})
        monkeypatch.setitem(sys.modules, name, module)
    result = runpy.run_path(str(LAUNCH))["generate_launch_description"]()
    assert isinstance(result, Call)
    return result


def _actions(description: Call, kind: str) -> list[Call]:
    return [action for action in description.args[0] if type(action).__name__ == kind]


def _function(description: Call, name: str) -> Any:
    """The function of that name that is run when the launch arguments are known."""
    functions = [action.kwargs["function"] for action in _actions(description, "OpaqueFunction")]
    return {function.__name__: function for function in functions}[name]


def _defaults(description: Call) -> dict[str, str]:
    return {one.args[0]: one.kwargs["default_value"] for one in _actions(description, "DeclareLaunchArgument")}


def _ours(description: Call, **arguments: str) -> list[dict[str, Any]]:
    """How each of our own processes is started with these launch arguments."""
    make_nodes = _function(description, "_nodes")
    nodes = [node.kwargs for node in make_nodes(_defaults(description) | arguments)]
    assert {node["package"] for node in nodes} == {"thymio_sim_ros"}
    return nodes


def _value(parameter: Any, context: dict[str, str]) -> Any:
    """A parameter as launch gives it: the text of its substitution, read as YAML unless it is text."""
    if not isinstance(parameter, Call):
        return parameter
    text, kind = parameter.args[0].perform(context), parameter.kwargs["value_type"]
    return text if kind is str else yaml.safe_load(text)


def _command_line(description: Call, node: dict[str, Any], folder: Path, **arguments: str) -> list[str]:
    """The arguments by which launch starts a process."""
    context = _defaults(description) | arguments
    words = [*node.get("arguments", ()), "--ros-args", *node.get("ros_arguments", ())]
    if "name" in node:
        words += ["-r", f"__node:={node['name']}"]
    if namespace := node["namespace"].perform(context):
        words += ["-r", f"__ns:=/{namespace}"]
    for number, parameters in enumerate(node.get("parameters", ())):
        if isinstance(parameters, dict):
            file = folder / f"{node['name']}_{number}.yaml"
            values = {name: _value(value, context) for name, value in parameters.items()}
            file.write_text(yaml.safe_dump({"/**": {"ros__parameters": values}}))
            parameters = file
        words += ["--params-file", str(parameters)]
    return words


def _declared(module: str) -> dict[str, type]:
    """Parameter name → type of its default, of every parameter dataclass that a module defines."""
    namespace = vars(importlib.import_module(f"thymio_sim_ros.ros.{module}")).values()
    classes = [item for item in namespace if isinstance(item, type) and dataclasses.is_dataclass(item)]
    fields = [field for item in classes for field in dataclasses.fields(item)]
    groups = [field for field in fields if field.metadata and dataclasses.is_dataclass(field.default)]
    return {
        f"{group.name}.{one.name}": type(one.default) for group in groups for one in params.declared(group.default)
    } | {
        field.metadata["options"].name or field.name: list
        if field.default is dataclasses.MISSING
        else type(field.default)
        for item in classes
        for field in dataclasses.fields(item)
        if "options" in field.metadata
    }


def _rules(node: dict[str, Any]) -> dict[tuple[str, str], str]:
    """The parameters on the command line of a process: node and name → value as it is written."""
    rules = [rule.partition(":=") for rule in node["ros_arguments"] if ":=" in rule]
    return {(name.partition(":")[0], name.partition(":")[2]): value for name, _, value in rules}


def test_simulator_and_runtime_are_one_process_and_the_others_nodes_of_their_names(description: Call) -> None:
    robots, *others = _ours(description)
    assert (robots["executable"], robots["arguments"], "name" in robots) == ("thymio", ["--headless"], False)
    assert [node["executable"] for node in others] == [node["name"] for node in others] == list(MODULES)[-2:]


def test_every_parameter_that_is_passed_is_declared_with_its_type(description: Call) -> None:
    robots, *others = _ours(description, playground="5")
    passed = {
        (node["name"], name): value.kwargs["value_type"]
        for node in others
        for name, value in node["parameters"][0].items()
        if name != "use_sim_time"
    }
    for key, value in _rules(robots).items():
        read = yaml.safe_load(value)
        passed[key] = list[str] if isinstance(read, list) else type(read)
    declared = {(node, name): kind for node, module in MODULES.items() for name, kind in _declared(module).items()}
    lists = {list: list[str]}  # the only lists that are passed are lists of names
    assert passed == {key: lists.get(declared.get(key), declared.get(key)) for key in passed}


def test_bridge_and_page_have_simulated_time(description: Call) -> None:
    _, *others = _ours(description)
    assert [node["parameters"][0]["use_sim_time"] for node in others] == [True, True]


def test_every_argument_has_a_text_and_is_used(description: Call) -> None:
    arguments = _actions(description, "DeclareLaunchArgument")
    assert all(argument.kwargs["description"] for argument in arguments)
    source = LAUNCH.read_text()
    used = set(re.findall(r'(?:value|text)\["(\w+)"\]', source))
    assert {argument.args[0] for argument in arguments} <= used


def test_an_argument_with_choices_has_those_of_its_parameter(description: Call) -> None:
    listed = {item.args[0]: item.kwargs["choices"] for item in _actions(description, "DeclareLaunchArgument")}
    parameters = {item.name: item for item in params.declared(simulator_params.SimulatorParams())}
    for name in ("motor_model", "proximity_model"):
        assert listed[name] == list(parameters[name].options.choices)
    assert listed["layout"] == list(LAYOUTS)
    assert listed["events"] == list(POLICIES)
    assert listed["playground"] is None


def test_the_pages_say_how_long_a_velocity_command_lasts(description: Call) -> None:
    defaults = {item.args[0]: item.kwargs["default_value"] for item in _actions(description, "DeclareLaunchArgument")}
    assert float(defaults["cmd_vel_timeout"]) == simulator_params.SimulatorParams().cmd_vel_timeout == 0.0
    for page in ("README.md", "docs/ros.md"):
        text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
        assert f"{SuiteConfig().cmd_vel_timeout_s:g} s" in text, page
        assert "until the next one" in text, page


def test_a_file_of_parameters_is_last_and_must_exist(description: Call, tmp_path: Path) -> None:
    robots, *others = _ours(description)
    assert all(len(node["parameters"]) == 1 for node in others)
    assert "--params-file" not in robots["ros_arguments"]
    file = tmp_path / "mine.yaml"
    with pytest.raises(RuntimeError, match=r"params_file: found '.*mine\.yaml', expected a YAML file"):
        _ours(description, params_file=str(file))
    file.touch()
    robots, *others = _ours(description, params_file=str(file))
    assert robots["ros_arguments"][-2:] == ["--params-file", str(file)]
    assert all(node["parameters"][1:] == [str(file)] for node in others)


@pytest.mark.process
def test_the_nodes_run_with_a_namespace_names_and_a_file_of_parameters(ros, description, tmp_path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(
        "/**/simulator:\n  ros__parameters: {playground: two_robots}\n"
        "/**/aseba_runtime:\n  ros__parameters: {script.path: none}\n"
    )
    arguments = {
        "namespace": "lab1",
        "robot_names": "[anna, bert]",
        "namespaced_tf": "true",
        "params_file": str(file),
        "port": str(free_port()),
        "foxglove_port": str(free_port()),
    }
    started: list[Process] = []
    try:
        for node in _ours(description, **arguments):
            module = f"thymio_sim_ros.ros.{MODULES[node['executable']]}"
            started.append(Process(tmp_path, module, *_command_line(description, node, tmp_path, **arguments)))
        wanted = {f"/lab1/{robot}/{topic}" for robot in ("anna", "bert") for topic in ("odom", "tf", "_aseba/status")}
        ros.until(lambda: all(map(ros.node.count_publishers, wanted)), PATIENCE_S, what=f"publishers of {wanted}")
        assert ros.node.count_publishers("/tf") == 0
        nodes = {(name, "/lab1") for name in MODULES if name != "thymio"}
        ros.until(lambda: nodes <= set(ros.node.get_node_names_and_namespaces()), PATIENCE_S, what="all nodes")
        for port in ("port", "foxglove_port"):
            wait_for_port(int(arguments[port]))
    finally:
        for one in started:
            one.end()


def test_rviz_is_started_on_demand_with_the_shipped_configuration(description: Call) -> None:
    (rviz,) = [node for node in _actions(description, "Node") if node.kwargs["package"] == "rviz2"]
    option, path = rviz.kwargs["arguments"]
    share, *names = path.args[0]
    assert (option, share.args, names) == ("-d", ("thymio_sim_ros",), ["rviz", "thymio.rviz"])
    assert rviz.kwargs["condition"].args[0].args == ("rviz",)
    kinds = [
        type(action).__name__ for action in description.args[0] if type(action).__name__ != "DeclareLaunchArgument"
    ]
    assert kinds == ["Node", "OpaqueFunction", "OpaqueFunction"], (
        "where it is not installed, nothing may be running yet"
    )
    config = (ROOT / "resource" / "rviz" / "thymio.rviz").read_text()
    absolute = set(re.findall(r"Value: (/\S+)", config)) - {"/map_updates"}
    assert {old for old, _ in rviz.kwargs["remappings"]} == absolute
    assert all(old == f"/{new}" for old, new in rviz.kwargs["remappings"])


@pytest.mark.parametrize(("code", "is_end"), [(0, False), (1, False), (-11, False), (2, True)])
def test_a_node_that_rejects_its_arguments_ends_all_others(description: Call, code: int, is_end: bool) -> None:
    for node in _ours(description):
        assert bool(node["on_exit"](SimpleNamespace(returncode=code, process_name="simulator-1"), None)) == is_end


def _tokens(description: Call, address: str, require_token: str, environment: dict[str, str]) -> dict[str, str]:
    configurations = {"address": address, "require_token": require_token}
    context = SimpleNamespace(launch_configurations=configurations, environment=environment)
    return dict(variable.args for variable in _function(description, "_give_tokens")(context))


def test_bridge_and_page_get_the_same_tokens_by_their_environment(description: Call) -> None:
    made = _tokens(description, "0.0.0.0", "true", {})
    assert made.keys() == {TOKEN_VARIABLE, READ_ONLY_VARIABLE}
    assert all(map(TOKEN.fullmatch, made.values()))
    assert _tokens(description, "0.0.0.0", "true", {TOKEN_VARIABLE: "mine"}).keys() == {READ_ONLY_VARIABLE}


@pytest.mark.parametrize(
    ("address", "require_token"),
    [("localhost", "true"), ("127.0.0.1", "true"), ("::1", "true"), ("0.0.0.0", "false")],
)
def test_no_tokens_are_created_if_none_is_needed(description: Call, address: str, require_token: str) -> None:
    assert _tokens(description, address, require_token, {}) == {}


def test_a_node_that_exits_is_restarted_on_demand(description: Call) -> None:
    assert {node["respawn"].args for node in _ours(description)} == {("respawn",)}
