"""Services of the runtime for editors: the target, and checks of texts that are not loaded."""

from __future__ import annotations

import json

import pytest
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import String

from tests.ros.aseba_tools import Status, get_variables, set_parameters
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import JSON
from thymio_sim_ros.device.editor.language_service import MOST_CHARACTERS
from thymio_sim_ros.ros.foxglove import json_messages


def request(**given):
    parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in given.items()]
    return SetParametersAtomically.Request(parameters=parameters)


def check(ros, **given):
    result = ros.call(SetParametersAtomically, "/aseba_runtime/check", request(**given)).result
    return result.successful, json.loads(result.reason)


def test_a_check_reports_errors_with_position_and_loads_nothing(ros, runtime):
    runtime("var me = 1")
    successful, reported = check(ros, source="onevent prox\n  motor.left.targt = 1")
    assert not successful
    (error,) = reported["errors"]
    assert (error["line"], error["column"], error["length"]) == (2, 3, 16)
    assert get_variables(ros, "me") == [[1]]


def test_a_check_reports_warnings_symbols_and_use(ros, runtime):
    runtime("var me = 1")
    source = "var a[3]\nonevent ping\nemit pong a[0] + K\nsub s\nreturn"
    successful, reported = check(ros, source=source, name="x.aseba", events=["ping 1", "pong 1"], constants=["K 5"])
    assert successful
    (warning,) = reported["warnings"]
    assert (warning["line"], warning["kind"]) == (4, "warning-uncalled-subroutine")
    (node,) = reported["nodes"]
    assert [symbol["name"] for symbol in node["variables"]] == ["a"]
    assert [symbol["name"] for symbol in node["handlers"]] == ["ping"]
    assert node["use"]["bytecode"][1] == 1534
    assert reported["constants"] == [{"name": "K", "value": 5}]


def test_a_check_knows_the_robots_names(ros, runtime):
    runtime("var me = 1", robots=["anna", "bert"])
    successful, reported = check(ros, source='<network><node name="anna">var a</node></network>')
    assert successful
    assert reported["nodes"][0]["name"] == "anna"


def test_a_check_may_bring_the_target_in_a_language(ros, runtime):
    runtime("var me = 1")
    _, reported = check(ros, source="", target=True, language="de")
    assert reported["target"]["language"] == "de"
    assert {"name", "help"} <= reported["target"]["natives"][0].keys()
    assert "program" not in reported["target"]
    assert "target" not in check(ros, source="")[1]


@pytest.mark.parametrize(
    ("given", "found"),
    [
        ({}, "found no parameter 'source'"),
        ({"source": 3}, "source: found INTEGER, expected STRING"),
        ({"source": "", "sauce": ""}, "found parameter 'sauce', expected one of source"),
        ({"source": "", "events": ["ping"]}, "events: found 'ping', expected a name and a number"),
        ({"source": "#" * (MOST_CHARACTERS + 1)}, f"expected at most {MOST_CHARACTERS}"),
    ],
)
def test_an_invalid_request_is_rejected_with_a_reason(ros, runtime, given, found):
    runtime("var me = 1")
    successful, reported = check(ros, **given)
    assert not successful
    assert reported["errors"][0]["kind"] == "request"
    assert found in reported["errors"][0]["message"]


def test_a_request_may_come_as_the_json_of_a_bridge(ros, runtime):
    runtime("var me = 1")
    text = json.dumps({"parameters": [{"name": "source", "value": {"type": 4, "string_value": "var 3"}}]})
    asked = json_messages.from_json(text.encode(), SetParametersAtomically.Request)
    answer = ros.call(SetParametersAtomically, "/aseba_runtime/check", asked)
    reported = json.loads(json.loads(json_messages.to_json(answer))["result"]["reason"])
    assert reported["errors"][0]["line"] == 1
    again = deserialize_message(serialize_message(asked), SetParametersAtomically.Request)
    assert again == asked


def test_an_editor_behind_the_bridge_checks_loads_and_steps(ros, studio, runtime):
    runtime("var me = 1")
    text = json.dumps({"parameters": [{"name": "source", "value": {"type": 4, "string_value": "var 3"}}]})
    check_service = studio.service("/aseba_runtime/check")
    studio.send(ms.ServiceRequest(check_service.id, 1, JSON, text.encode()))
    reason = json.loads(studio.next(ms.ServiceResponse).payload)["result"]["reason"]
    assert json.loads(reason)["errors"][0]["line"] == 1
    wish = (
        ms.Parameter("/aseba_runtime.script.source", "var me = K\nme = 3"),
        ms.Parameter("/aseba_runtime.script.constants.K", 2),
        ms.Parameter("/aseba_runtime.breakpoints", (2,)),
    )
    studio.send(ms.SetParameters((wish[1], wish[2], wish[0]), "wish"))
    ros.until(lambda: get_variables(ros, "me") == [[2]])
    step = studio.service("/aseba/step_line")
    studio.send(ms.ServiceRequest(step.id, 2, JSON, b"{}"))
    assert json.loads(studio.next(ms.ServiceResponse).payload) == {"success": True, "message": "paused"}
    assert get_variables(ros, "me") == [[3]]
    studio.send(ms.SetParameters((ms.Parameter("/aseba_runtime.breakpoints", ()),), "none"))
    status = Status(ros)
    ros.until(lambda: status.data("breakpoints") == [])


def test_the_target_comes_with_the_program_and_changes_with_it(ros, runtime):
    runtime("var me = 1\nsub turn\nreturn")
    targets = ros.collect(String, "/_aseba/target", transient_local=True)
    ros.until(lambda: targets)
    reported = json.loads(targets[-1].data)
    assert reported["name"] == "thymio-II"
    assert reported["program"]["variables"][0]["name"] == "me"
    assert reported["program"]["subroutines"] == [{"name": "turn", "line": 2, "column": 5}]
    source = '<network><event name="a.b" size="2"/><node name="thymio-II">var you</node></network>'
    assert set_parameters(ros, {"script.source": source, "script.name": "you.aesl"}).successful
    ros.until(lambda: json.loads(targets[-1].data)["program"]["name"] == "you.aesl")
    program = json.loads(targets[-1].data)["program"]
    assert program["events"] == [{"name": "a.b", "size": 2, "topic": "a_b"}]
    assert program["source"] == "var you"


def test_the_language_of_the_target_is_a_parameter(ros, runtime):
    runtime("var me = 1")
    targets = ros.collect(String, "/_aseba/target", transient_local=True)
    assert set_parameters(ros, {"language": "fr"}).successful
    ros.until(lambda: targets and json.loads(targets[-1].data)["language"] == "fr")
