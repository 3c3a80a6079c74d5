"""Variables of a program as services and topics."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, ListParameters
from std_msgs.msg import Int16MultiArray

from tests.ros.aseba.conftest import BEHIND_A_NETWORK, HERE, PLACES
from tests.ros.aseba_tools import Proximity, get_variables, set_parameters, set_variables, words
from thymio_sim_ros.sim.model.units import PROXIMITY_FULL, units_to_speed

SOURCE = "var count = 3\nvar list[4] = [1, 2, 3, 4]\nonevent prox\ncount = count + 1"

in_this_process = pytest.mark.parametrize("runtime", [HERE], indirect=True)


@pytest.fixture(params=PLACES)
def runtime(request, runtime):
    """Make a runtime with a robot here or behind a network."""
    return request.getfixturevalue("remote_runtime") if request.param == BEHIND_A_NETWORK else runtime


def integer(value):
    return ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=value)


def test_variables_are_read_by_name_and_element(ros, runtime):
    runtime(SOURCE)
    found = get_variables(ros, "count", "list", "list[2]", "_productId", "list[4]", "nothing")
    assert found == [[3], [1, 2, 3, 4], [3], [8], None, None]


def test_variables_are_written_each_with_its_result(ros, runtime):
    runtime(SOURCE)
    results = set_variables(
        ros,
        {
            "count": integer(-5),
            "list": words(5, 6, 7, 8),
            "list[1]": integer(60),
            "nothing": integer(1),
            "acc": words(1, 2),
            "list[0]": integer(40000),
            "list[9]": integer(1),
            "list[3]": words(1, 2),
            "temperature": ParameterValue(type=ParameterType.PARAMETER_STRING, string_value="warm"),
        },
    )
    assert [result.successful for result in results] == [True, True, True] + [False] * 6
    reasons = [result.reason for result in results[3:]]
    assert reasons[0] == "no variable is called 'nothing'"
    assert reasons[1] == "acc: 2 words found, expected 3"
    assert "40000 found, expected -32768 to 32767" in reasons[2]
    assert reasons[3] == "list: found element 9, expected 0 to 3"
    assert reasons[4] == "list[3]: found 2 integers, expected 1"
    assert "expected an integer (2) or an integer array (7)" in reasons[5]
    assert get_variables(ros, "count", "list") == [[-5], [5, 60, 7, 8]]


@in_this_process
def test_a_written_target_moves_the_robot(ros, runtime):
    runtime(SOURCE)
    driven = ros.collect(Twist, "/cmd_vel")
    set_variables(ros, {"motor.left.target": integer(120)})
    ros.until(lambda: driven and math.isclose(driven[-1].linear.x, units_to_speed(60), rel_tol=1e-6))


def test_variables_are_listed_by_prefix_and_depth(ros, runtime):
    runtime(SOURCE)

    def listed(**fields):
        result = ros.call(ListParameters, "/aseba/list_variables", ListParameters.Request(**fields)).result
        return list(result.names), list(result.prefixes)

    names, prefixes = listed()
    assert {"count", "list", "prox.horizontal", "_productId"} <= set(names)
    assert "prox.ground" in prefixes
    assert listed(prefixes=["button"])[0] == [
        f"button.{side}" for side in ("backward", "left", "center", "forward", "right")
    ]
    assert all("." not in name for name in listed(depth=1)[0])


def test_variables_are_described(ros, runtime):
    runtime(SOURCE)
    request = DescribeParameters.Request(names=["prox.horizontal", "count", "nothing"])
    known, own, nothing = ros.call(DescribeParameters, "/aseba/describe_variables", request).descriptors
    assert known.additional_constraints == "7 values"
    assert known.description.startswith("distance: five in front")
    assert own.additional_constraints == "1 value"
    assert (own.integer_range[0].from_value, own.integer_range[0].to_value) == (-32768, 32767)
    assert nothing.type == ParameterType.PARAMETER_NOT_SET


@in_this_process
def test_a_watched_variable_has_a_retained_topic(ros, runtime):
    runtime(SOURCE, watch=["list", "no.such"], watch_rate=100.0)
    counts_wanted = set_parameters(ros, {"watch": ["count", "prox.horizontal"]})
    assert counts_wanted.successful
    counts = ros.collect(Int16MultiArray, "/aseba/variables/count", transient_local=True)
    ranges = ros.collect(Int16MultiArray, "/aseba/variables/prox_horizontal", transient_local=True)
    ros.until(lambda: counts and ranges)
    Proximity(ros).send(0.0, *[-1.0] * 6)
    ros.until(lambda: list(counts[-1].data) == [4] and ranges[-1].data[0] == PROXIMITY_FULL)
    assert [list(message.data) for message in counts] == [[3], [4]]
    ros.until(lambda: ros.node.count_publishers("/aseba/variables/list") == 0)


@in_this_process
def test_a_robot_may_be_watched_alone(ros, runtime):
    runtime(SOURCE, robots=["anna", "bert"], watch=["count"])
    assert set_parameters(ros, {"robots.bert.watch": ["list"]}).successful
    lists = ros.collect(Int16MultiArray, "/bert/aseba/variables/list", transient_local=True)
    ros.until(lambda: lists and list(lists[-1].data) == [1, 2, 3, 4])
    ros.until(lambda: ros.node.count_publishers("/bert/aseba/variables/count") == 1)
    assert ros.node.count_publishers("/anna/aseba/variables/list") == 0


def test_a_watched_variable_gets_a_topic_with_the_program_that_declares_it(ros, runtime):
    runtime("var other", watch=["count"])
    assert ros.node.count_publishers("/aseba/variables/count") == 0
    assert set_parameters(ros, {"script.source": SOURCE}).successful
    counts = ros.collect(Int16MultiArray, "/aseba/variables/count", transient_local=True)
    ros.until(lambda: counts and list(counts[-1].data) == [3])


def test_all_variables_are_in_one_table_while_it_has_subscribers(ros, runtime):
    node = runtime(SOURCE, watch_rate=50.0)
    tables = ros.collect(Int16MultiArray, "/_aseba/variables")
    ros.until(lambda: tables)

    def table():
        found, at = {}, 0
        for dimension in tables[-1].layout.dim:
            found[dimension.label] = list(tables[-1].data[at : at + dimension.size])
            at += dimension.size
        assert at == len(tables[-1].data)
        return found

    assert table()["list"] == [1, 2, 3, 4]
    assert table()["_productId"] == [8]
    set_variables(ros, {"count": integer(99)})
    ros.until(lambda: table()["count"] == [99])
    reported = len(tables)
    ros.until(lambda: len(tables) > reported, what="the table again, for those who have just come")
    assert node.robots[0].device.variables.get("count") == (99,)
