"""Parameter values: the bridge's form and ROS's."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rcl_interfaces.msg import ParameterType, ParameterValue

from thymio_sim_ros.bridge.protocol.messages import Parameter
from thymio_sim_ros.ros.foxglove.parameter_values import UnfitValueError, from_ros, to_ros

INT64 = st.integers(-(2**63), 2**63 - 1)
FINITE = st.floats(allow_nan=False, allow_infinity=False)
TEXT = st.text(st.characters(exclude_categories=["Cs"]))
VALUES = st.one_of(
    st.builds(ParameterValue, type=st.just(ParameterType.PARAMETER_BOOL), bool_value=st.booleans()),
    st.builds(ParameterValue, type=st.just(ParameterType.PARAMETER_INTEGER), integer_value=INT64),
    st.builds(ParameterValue, type=st.just(ParameterType.PARAMETER_DOUBLE), double_value=FINITE),
    st.builds(ParameterValue, type=st.just(ParameterType.PARAMETER_STRING), string_value=TEXT),
    st.builds(
        ParameterValue,
        type=st.just(ParameterType.PARAMETER_BYTE_ARRAY),
        byte_array_value=st.binary().map(lambda data: [bytes([byte]) for byte in data]),
    ),
    st.builds(
        ParameterValue, type=st.just(ParameterType.PARAMETER_BOOL_ARRAY), bool_array_value=st.lists(st.booleans())
    ),
    st.builds(ParameterValue, type=st.just(ParameterType.PARAMETER_INTEGER_ARRAY), integer_array_value=st.lists(INT64)),
    st.builds(ParameterValue, type=st.just(ParameterType.PARAMETER_DOUBLE_ARRAY), double_array_value=st.lists(FINITE)),
    st.builds(ParameterValue, type=st.just(ParameterType.PARAMETER_STRING_ARRAY), string_array_value=st.lists(TEXT)),
)


@given(VALUES)
def test_every_ros_value_survives_the_way_to_a_client_and_back(value):
    assert to_ros(from_ros("/n.p", value), value.type) == value


def test_doubles_are_marked_as_doubles():
    value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=2.0)
    assert from_ros("/n.p", value) == Parameter("/n.p", 2.0, "float64")


def test_bytes_are_sent_as_base64():
    value = ParameterValue(type=ParameterType.PARAMETER_BYTE_ARRAY, byte_array_value=[b"\x01", b"\xff"])
    assert from_ros("/n.p", value) == Parameter("/n.p", "Af8=", "byte_array")


@pytest.mark.parametrize(("number", "text"), [(math.inf, "inf"), (-math.inf, "-inf"), (math.nan, "nan")])
def test_nan_and_infinity_are_text(number, text):
    assert from_ros("/n.p", ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=number)).value == text
    row = ParameterValue(type=ParameterType.PARAMETER_DOUBLE_ARRAY, double_array_value=[1.0, number])
    assert from_ros("/n.p", row).value == ("1.0", text)


def test_a_parameter_that_is_not_set_has_no_value():
    assert from_ros("/n.p", ParameterValue()) == Parameter("/n.p")
    assert to_ros(Parameter("/n.p")).type == ParameterType.PARAMETER_NOT_SET


def test_a_value_of_an_unknown_type_is_no_value():
    assert from_ros("/n.p", ParameterValue(type=77, bool_value=True)) == Parameter("/n.p")


@pytest.mark.parametrize(
    ("value", "current", "kind"),
    [
        (1, ParameterType.PARAMETER_DOUBLE, ParameterType.PARAMETER_DOUBLE),
        (1, ParameterType.PARAMETER_INTEGER, ParameterType.PARAMETER_INTEGER),
        (True, ParameterType.PARAMETER_DOUBLE, ParameterType.PARAMETER_BOOL),
        ((1, 2), ParameterType.PARAMETER_DOUBLE_ARRAY, ParameterType.PARAMETER_DOUBLE_ARRAY),
        ((1, 2.5), ParameterType.PARAMETER_NOT_SET, ParameterType.PARAMETER_DOUBLE_ARRAY),
        ((), ParameterType.PARAMETER_INTEGER_ARRAY, ParameterType.PARAMETER_INTEGER_ARRAY),
        ((), ParameterType.PARAMETER_NOT_SET, ParameterType.PARAMETER_STRING_ARRAY),
    ],
)
def test_the_current_type_determines_the_type_of_a_number(value, current, kind):
    assert to_ros(Parameter("/n.p", value), current).type == kind


@pytest.mark.parametrize(
    ("parameter", "text"),
    [
        (Parameter("p", 2**63), "expected an integer of 64 bits"),
        (Parameter("p", (1, 2**63)), "expected an integer of 64 bits"),
        (Parameter("p", (1, "x")), "expected a list with elements of one type"),
        (Parameter("p", (True, 1)), "expected a list with elements of one type"),
        (Parameter("p", "x", "float64"), "expected a number, found 'x'"),
        (Parameter("p", True, "float64"), "expected a number, found True"),
        (Parameter("p", 10**400, "float64"), "expected a number, found 1000"),
        (Parameter("p", "%", "byte_array"), "expected base64 text, found '%'"),
        (Parameter("p", 5, "byte_array"), "expected base64 text, found 5"),
        (Parameter("p", "\ud800"), "expected Unicode text"),
    ],
)
def test_a_value_that_ros_does_not_support_is_rejected(parameter, text):
    with pytest.raises(UnfitValueError, match=f"^{text}"):
        to_ros(parameter)
