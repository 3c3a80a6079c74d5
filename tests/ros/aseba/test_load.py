"""The service `load`: one request loads a program or a built-in behavior, and starts it."""

from __future__ import annotations

import json

import pytest
from rcl_interfaces.msg import Parameter as ParameterMsg
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter

from tests.ros.aseba_tools import Status, get_parameter, get_variables, set_parameters

SERVICE = "/aseba_runtime/load"
COUNT = "var n = {}\nonevent button.left\nn++"
ROBOTS = pytest.mark.parametrize("robot", [{}, {"robot": "red"}], ids=["all", "one"])


def ask(ros, *parameters):
    request = SetParametersAtomically.Request(parameters=parameters)
    result = ros.call(SetParametersAtomically, SERVICE, request).result
    return result.successful, json.loads(result.reason or "{}")


def load(ros, **given):
    """Call the service; return whether it succeeded, and its answer."""
    return ask(ros, *(Parameter(name, value=value).to_parameter_msg() for name, value in given.items()))


def n(ros, *robots):
    return [get_variables(ros, "n", robot=f"/{robot}")[0] for robot in robots]


@pytest.fixture
def two(simulation, runtime):
    """Red and blue, with a program."""
    sim = simulation(playground="two_robots")
    runtime(COUNT.format(1))
    return sim


def test_a_program_is_loaded_into_all_robots_and_is_then_the_parameter(ros, two):
    assert set_parameters(ros, {"robots.blue.script.source": COUNT.format(2)}).successful
    assert n(ros, "red", "blue") == [[1], [2]]
    successful, answer = load(ros, source=COUNT.format(3), name="three.aesl")
    assert (successful, answer["errors"]) == (True, [])
    assert n(ros, "red", "blue") == [[3], [3]]
    assert (get_parameter(ros, "script.source"), get_parameter(ros, "script.name")) == (COUNT.format(3), "three.aesl")
    assert get_parameter(ros, "robots.blue.script.source") == ""


def test_a_program_is_loaded_into_one_robot(ros, two):
    assert load(ros, source=COUNT.format(5), robot="blue")[0]
    assert n(ros, "red", "blue") == [[1], [5]]
    assert get_parameter(ros, "robots.blue.script.source") == COUNT.format(5)


@ROBOTS
def test_the_same_program_starts_again(ros, two, robot):
    for _ in range(2):
        assert load(ros, source=COUNT.format(4), **robot)[0]
        assert n(ros, "red") == [[4]]
        two["red"]["n"] = 50
        assert n(ros, "red") == [[50]]


def test_a_robot_that_was_stopped_by_a_fault_runs_again(ros, two):
    status = Status(ros, "/red")
    for _ in range(2):
        assert load(ros, source="var a[2]\nvar i = 7\na[i] = 1")[0]
        ros.until(lambda: status["state"] == "fault")
    assert load(ros, source=COUNT.format(6))[0]
    ros.until(lambda: status["state"] == "running")


def test_a_mistake_is_answered_in_the_language_of_the_request_and_changes_nothing(ros, two):
    successful, answer = load(ros, source="var x\nx = y", language="de", name="bad.aesl")
    (error,) = answer["errors"]
    assert not successful
    assert (error["line"], error["column"]) == (2, 5)
    assert "Variable" in error["message"]
    assert n(ros, "red", "blue") == [[1], [1]]
    assert get_parameter(ros, "script.source") == COUNT.format(1)


@ROBOTS
def test_a_behavior_starts_on_all_robots_or_on_one(ros, two, robot):
    red, blue = Status(ros, "/red"), Status(ros, "/blue")
    assert load(ros, source=COUNT.format(2), robot="red")[0]
    for _ in range(2):
        assert load(ros, behaviour="explorer", **robot)[0]
        ros.until(lambda: red["program"] == "explorer.aesl")
        ros.until(lambda: blue["program"] == ("program" if robot else "explorer.aesl"))
    assert load(ros, source=COUNT.format(7), **robot)[0]
    ros.until(lambda: red["program"] == "program")
    assert n(ros, "red") == [[7]]


def test_the_menu_is_for_all_robots(ros, two):
    blue = Status(ros, "/blue")
    assert load(ros, behaviour="menu", robot="red")[0]
    ros.until(lambda: blue["program"] == "menu.aesl")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "expected either 'source', the text of a program, or 'behaviour'"),
        ({"source": "var a", "behaviour": "menu"}, "expected either 'source'"),
        ({"source": "var a", "robot": "green"}, "robot: found 'green', expected one of red, blue"),
        ({"behaviour": "freindly"}, "did you mean 'friendly'?"),
        ({"sauce": "var a"}, "found parameter 'sauce', expected one of source, name, behaviour, robot, language"),
        ({"source": 5}, "source: found INTEGER, expected STRING"),
    ],
)
def test_a_wrong_request_says_what_is_wrong_and_changes_nothing(ros, two, given, message):
    successful, answer = load(ros, **given)
    assert not successful
    assert message in answer["errors"][0]["message"]
    assert n(ros, "red", "blue") == [[1], [1]]


def test_a_value_of_an_unknown_type_is_refused(ros, two):
    wrong = ParameterMsg(name="source")
    wrong.value.type = 99
    successful, answer = ask(ros, wrong)
    assert not successful
    assert "found a value of unknown type 99" in answer["errors"][0]["message"]
