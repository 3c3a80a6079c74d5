"""Clients of the bridge cannot open files of this computer."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from rcl_interfaces.msg import Parameter as RosParameter
from rcl_interfaces.msg import ParameterType, ParameterValue, SetParametersResult
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node

from tests.bridge.studio import set_and_answer
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.ros.foxglove.file_access import call_refusal, parameter_refusal

PATHS = ["/etc/passwd", "line.json", "~/x.json", "../line", "file:///etc/passwd", "/proc/self/environ"]


@pytest.mark.parametrize("path", [*PATHS, ""])
def test_a_playground_must_not_be_a_path(path):
    assert "expected the name of a shipped playground" in parameter_refusal("playground", path)


@pytest.mark.parametrize("value", ["line", '{"format": 1}', "<aseba-playground/>", "data:;name=a.json;base64,e30="])
def test_a_playground_is_a_name_or_a_text(value):
    assert parameter_refusal("playground", value) == ""


@pytest.mark.parametrize("name", ["script.path", "robots.anna.script.path", "robots.a/b.script.path"])
def test_a_program_must_not_be_a_path(name):
    for path in PATHS:
        assert "expected the name of a built-in program" in parameter_refusal(name, path)
    for value in ("", "none", "line_follower", "menu"):
        assert parameter_refusal(name, value) == ""


@pytest.mark.parametrize(("name", "value"), [("script.source", "/etc/passwd"), ("path", "/tmp"), ("playground", 3)])
def test_other_parameters_are_left_alone(name, value):
    assert parameter_refusal(name, value) == ""


@pytest.mark.parametrize("service", ["SetParameters", "SetParametersAtomically"])
def test_services_of_parameters_are_checked_too(service):
    def request(name, text):
        value = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=text)
        return SetParameters.Request(parameters=[RosParameter(name=name, value=value)])

    type_name = f"rcl_interfaces/srv/{service}"
    assert "playground" in call_refusal(type_name, request("playground", "/etc/passwd"))
    assert call_refusal(type_name, request("playground", "line")) == ""
    assert call_refusal(type_name, request("anna", "/etc/passwd")) == ""
    assert call_refusal("std_srvs/srv/Trigger", object()) == ""


@pytest.mark.parametrize("is_nested", [False, True])
def test_a_world_must_not_be_a_path(is_nested):
    def request(uri):
        resource = SimpleNamespace(uri=uri, resource_string="")
        return SimpleNamespace(world_resource=resource) if is_nested else resource

    assert call_refusal("simulation_interfaces/srv/LoadWorld", request("/etc/passwd")) != ""
    assert call_refusal("simulation_interfaces/srv/LoadWorld", request("line")) == ""
    assert call_refusal("simulation_interfaces/srv/LoadWorld", request("")) == ""


def test_a_client_that_names_a_file_is_rejected_without_a_call_of_the_node(ros, studio, tmp_path):
    asked = []
    node = ros.add(Node("world", context=ros.context, enable_rosout=False))
    node.declare_parameter("playground", "line")
    node.add_on_set_parameters_callback(lambda items: asked.append(items) or SetParametersResult(successful=True))
    assert studio.parameter("/world.playground") == "line"
    status, answer = set_and_answer(studio, ms.Parameter("/world.playground", str(tmp_path / "mine.json")))
    assert "expected the name of a shipped playground" in status.message
    assert status.id == "parameter:/world.playground"
    assert answer == ms.ParameterValues((ms.Parameter("/world.playground", "line"),), "mine")
    assert asked == []
    set_and_answer(studio, ms.Parameter("/world.playground", "obstacle"))
    assert node.get_parameter("playground").value == "obstacle"
