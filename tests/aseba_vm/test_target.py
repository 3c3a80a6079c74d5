import pytest

from aseba_vm import NativeFunction, Parameter, TargetDescription, TargetError, Variable
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.vectors import targets


def test_addresses_are_sums_of_sizes():
    target = TargetDescription("t", 10, 10, 10, (Variable("a", 1), Variable("b", 3), Variable("c", 2)))
    assert target.addresses == {"a": (0, 1), "b": (1, 3), "c": (4, 2)}
    assert target.variables_end == 6


def test_local_events_are_numbered_downwards():
    assert THYMIO_II.local_event_number("button.backward") == 0xFFFE
    assert THYMIO_II.local_event_number("tap") == 0xFFF6
    with pytest.raises(KeyError):
        THYMIO_II.local_event_number("nothing")


def test_free_sizes_come_before_those_of_templates():
    sizes = (-2, 0, 1, -1, 0, -2)
    native = NativeFunction("f", tuple(Parameter(str(index), size) for index, size in enumerate(sizes)))
    assert native.free_sizes == (1, 4, 3, 0)


@pytest.mark.parametrize("name", sorted(targets()))
def test_the_descriptions_of_the_vectors_are_read(name):
    assert targets()[name].name


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({}, "field 'name' is missing"),
        ({"name": "t", "variables_size": "many"}, "invalid literal"),
        (
            {
                "name": "t",
                "variables_size": 10**9,
                "bytecode_size": 1,
                "stack_size": 1,
                "variables": [],
                "local_events": [],
                "natives": [],
            },
            "a size is not in 0..65536",
        ),
    ],
)
def test_a_wrong_description_is_refused(data, message):
    with pytest.raises(TargetError, match=message):
        TargetDescription.from_data(data)
