"""The launch file, without launch (no wheel has it): what it passes on is what the nodes declare."""

from __future__ import annotations

import dataclasses
import importlib
import runpy
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("rclpy")

from thymio_sim_ros.bridge.access import READ_ONLY_VARIABLE, TOKEN, TOKEN_VARIABLE
from thymio_sim_ros.device.events import POLICIES
from thymio_sim_ros.device.layout import LAYOUTS
from thymio_sim_ros.nodes import params, simulator_params
from thymio_sim_ros.suite import Suite

ROOT = Path(__file__).parents[2]
LAUNCH = ROOT / "thymio_sim_ros" / "launch" / "thymio.launch.py"
# Executable → the module whose parameter dataclass it declares.
MODULES = {
    "simulator": "simulator_node",
    "aseba_runtime": "aseba_node",
    "foxglove_bridge": "foxglove_node",
    "web_ui": "web_node",
}
NAMES = {
    "launch": ["LaunchContext", "LaunchDescription"],
    "launch.actions": ["DeclareLaunchArgument", "OpaqueFunction", "SetEnvironmentVariable", "Shutdown"],
    "launch.conditions": ["IfCondition"],
    "launch.events": [],
    "launch.events.process": ["ProcessExited"],
    "launch.substitutions": ["LaunchConfiguration", "PathJoinSubstitution", "PythonExpression"],
    "launch_ros": [],
    "launch_ros.actions": ["Node"],
    "launch_ros.parameter_descriptions": ["ParameterValue"],
    "launch_ros.substitutions": ["FindPackageShare"],
}


class Call:
    """Any object of launch: remembers how it was made."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self.args, self.kwargs = args, kwargs


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


def _ours(description: Call) -> list[dict[str, Any]]:
    """How each of our own nodes is started."""
    nodes = [action.kwargs for action in _actions(description, "Node")]
    return [node for node in nodes if node["package"] == "thymio_sim_ros"]


def _declared(module: str) -> dict[str, type]:
    """Parameter name → type of its default, of every parameter dataclass that a module defines."""
    namespace = vars(importlib.import_module(f"thymio_sim_ros.nodes.{module}")).values()
    classes = [item for item in namespace if isinstance(item, type) and dataclasses.is_dataclass(item)]
    return {
        field.metadata.get("name", field.name): type(field.default)
        for item in classes
        for field in dataclasses.fields(item)
        if "text" in field.metadata
    }


def test_every_executable_is_started_as_the_node_of_its_name(description: Call) -> None:
    nodes = _ours(description)
    assert [node["executable"] for node in nodes] == [node["name"] for node in nodes] == list(MODULES)


def test_every_parameter_that_is_passed_is_declared_with_its_type(description: Call) -> None:
    passed = {
        (node["name"], name): value.kwargs["value_type"]
        for node in _ours(description)
        for name, value in node["parameters"][0].items()
        if name != "use_sim_time"
    }
    declared = {(node, name): kind for node, module in MODULES.items() for name, kind in _declared(module).items()}
    assert passed == {key: declared.get(key) for key in passed}


def test_all_but_the_simulator_follow_simulated_time(description: Call) -> None:
    follow = {node["name"] for node in _ours(description) if node["parameters"][0].get("use_sim_time")}
    assert follow == MODULES.keys() - {"simulator"}


def test_every_argument_has_a_text_and_is_used(description: Call) -> None:
    arguments = _actions(description, "DeclareLaunchArgument")
    assert all(argument.kwargs["description"] for argument in arguments)
    source = LAUNCH.read_text()
    assert [name for (name,) in (argument.args for argument in arguments) if f'value["{name}"]' not in source] == []


def test_an_argument_that_is_one_of_few_words_lists_those_of_its_parameter(description: Call) -> None:
    listed = {item.args[0]: item.kwargs["choices"] for item in _actions(description, "DeclareLaunchArgument")}
    parameters = {item.name: item for item in params.declared(simulator_params.SimulatorParams())}
    for name in ("motor_model", "proximity_model"):
        assert listed[name] == list(parameters[name].metadata["choices"])
    assert listed["layout"] == list(LAYOUTS)
    assert listed["events"] == list(POLICIES)
    assert listed["playground"] is None


def test_the_pages_tell_how_long_a_velocity_holds(description: Call) -> None:
    defaults = {item.args[0]: item.kwargs["default_value"] for item in _actions(description, "DeclareLaunchArgument")}
    assert float(defaults["cmd_vel_timeout"]) == simulator_params.SimulatorParams().cmd_vel_timeout == 0.0
    for page in ("README.md", "docs/ros.md"):
        text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
        assert f"{Suite().cmd_vel_timeout_s:g} s, s" in text, page
        assert "until the next one" in text, page


def test_rviz_is_started_with_the_shipped_configuration_if_wanted(description: Call) -> None:
    (rviz,) = [node for node in _actions(description, "Node") if node.kwargs["package"] == "rviz2"]
    option, path = rviz.kwargs["arguments"]
    share, *names = path.args[0]
    assert (option, share.args, names) == ("-d", ("thymio_sim_ros",), ["rviz", "thymio.rviz"])
    assert rviz.kwargs["condition"].args[0].args == ("rviz",)
    assert _actions(description, "Node")[0] is rviz, "where it is not installed, nothing may be running yet"


@pytest.mark.parametrize(("code", "is_end"), [(0, False), (1, False), (-11, False), (2, True)])
def test_a_node_that_refuses_what_it_was_given_ends_all_others(description: Call, code: int, is_end: bool) -> None:
    for node in _ours(description):
        assert bool(node["on_exit"](SimpleNamespace(returncode=code, process_name="simulator-1"), None)) == is_end


def _tokens(description: Call, address: str, require_token: str, environment: dict[str, str]) -> dict[str, str]:
    (function,) = _actions(description, "OpaqueFunction")
    configurations = {"address": address, "require_token": require_token}
    context = SimpleNamespace(launch_configurations=configurations, environment=environment)
    return dict(variable.args for variable in function.kwargs["function"](context))


def test_bridge_and_page_get_the_same_tokens_by_their_environment(description: Call) -> None:
    made = _tokens(description, "0.0.0.0", "true", {})
    assert made.keys() == {TOKEN_VARIABLE, READ_ONLY_VARIABLE}
    assert all(map(TOKEN.fullmatch, made.values()))
    assert _tokens(description, "0.0.0.0", "true", {TOKEN_VARIABLE: "mine"}).keys() == {READ_ONLY_VARIABLE}


@pytest.mark.parametrize(
    ("address", "require_token"),
    [("localhost", "true"), ("127.0.0.1", "true"), ("::1", "true"), ("0.0.0.0", "false")],
)
def test_no_tokens_are_made_where_none_is_needed(description: Call, address: str, require_token: str) -> None:
    assert _tokens(description, address, require_token, {}) == {}


def test_a_node_that_died_is_started_again_if_wanted(description: Call) -> None:
    assert {node["respawn"].args for node in _ours(description)} == {("respawn",)}
