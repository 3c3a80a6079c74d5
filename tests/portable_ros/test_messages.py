"""Fields that only the messages for tests have: defaults of several values, and texts of UTF-16."""

from __future__ import annotations

import pytest

from thymio_sim_ros.portable_ros.messages import cdr, interface_files
from thymio_sim_ros.portable_ros.messages.message_class import message_type
from thymio_sim_ros.portable_ros.rclpy.exceptions import NoTypeSupportImportedException
from thymio_sim_ros.portable_ros.rclpy.type_support import check_is_valid_msg_type
from thymio_sim_ros.portable_ros.test_msgs.message_fixtures import get_test_msg

WStrings = message_type("test_msgs/msg/WStrings")


def test_arrays_and_sequences_have_their_defaults_each_message_its_own() -> None:
    for name in ("Arrays", "BoundedSequences", "UnboundedSequences"):
        kind = message_type(f"test_msgs/msg/{name}")
        one, other = kind(), kind()
        assert list(one.bool_values_default) == [False, True, False]
        assert list(one.byte_values_default) == [b"\0", b"\1", b"\xff"]
        assert list(one.int16_values_default) == [0, 32767, -32768]
        assert list(one.float64_values_default) == [3.1415, 0.0, -3.1415]
        assert list(one.string_values_default) == ["", "max value", "min value"]
        one.int16_values_default[0] = 5
        assert other.int16_values_default[0] == 0


def test_constants_and_defaults_of_a_class_cannot_be_changed() -> None:
    kind = message_type("rcl_interfaces/msg/Log")
    with pytest.raises(AttributeError, match="property 'INFO' of 'Metaclass_Log' object has no setter"):
        kind.INFO = 1
    with pytest.raises(AttributeError, match="property 'INFO' of 'Metaclass_Log' object has no deleter"):
        del kind.INFO
    with pytest.raises(AttributeError, match="'Log' object attribute 'INFO' is read-only"):
        kind().INFO = 1
    assert kind.INFO == kind().INFO == 20
    defaults = message_type("test_msgs/msg/Defaults")
    with pytest.raises(AttributeError, match="has no setter"):
        defaults.INT8_VALUE__DEFAULT = 1
    assert defaults.INT8_VALUE__DEFAULT == defaults().int8_value == -50


def test_a_class_made_from_a_message_class_shows_its_own_name() -> None:
    class Sub(WStrings):  # type: ignore[misc, valid-type]
        pass

    assert repr(Sub()).startswith(f"{__name__.rpartition('.')[0]}.Sub(wstring_value='")


@pytest.mark.parametrize("name", list(interface_files.names("test_msgs", "msg")))
def test_samples_of_messages_are_the_same_after_a_journey(name: str) -> None:
    samples = get_test_msg(name)
    for sample in samples:
        assert cdr.deserialize(cdr.serialize(sample), type(sample)) == sample
    has_values = bool(samples[0].get_fields_and_field_types())
    assert (samples[1] != samples[2]) == has_values


def test_there_are_no_samples_of_other_messages() -> None:
    with pytest.raises(NotImplementedError):
        get_test_msg("String")


def test_a_wide_text_has_four_bytes_for_each_unit() -> None:
    message = WStrings(wstring_value="a\U0001f600b")
    data = cdr.serialize(message)
    # Measured with Fast DDS.
    assert data.hex().startswith("0001000004000000610000003dd8000000de000062000000")
    message.unbounded_sequence_of_wstrings = ["", "ハロー"]
    assert cdr.deserialize(cdr.serialize(message), WStrings) == message


def test_a_text_that_utf_16_does_not_have_is_refused() -> None:
    with pytest.raises(TypeError, match="surrogates not allowed"):
        cdr.serialize(WStrings(wstring_value="\udcc3"))


def test_a_class_of_an_installed_ros_has_no_type_support_here() -> None:
    class Metaclass(type):
        _TYPE_SUPPORT = None

    class Foreign(metaclass=Metaclass):
        pass

    with pytest.raises(NoTypeSupportImportedException):
        check_is_valid_msg_type(Foreign)
