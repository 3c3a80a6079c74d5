"""Files with several programs: which robot gets which."""

import pytest

from thymio_sim_ros.device.programs.program import ProgramError, load_file
from thymio_sim_ros.device.programs.program_assignment import RobotId, assign_programs

ANNA, BERT, CARL = RobotId("anna", 1), RobotId("bert", 2), RobotId("carl", 3)


def file_of(*nodes, robots=("anna", "bert", "carl"), **options):
    text = "".join(f'<node name="{name}" nodeId="{number}">var {code}</node>\n' for name, number, code in nodes)
    return load_file(f"<network>\n{text}</network>", "test.aesl", robots=robots, **options)


def codes(shares):
    return {name: share.program and share.program.source.removeprefix("var ") for name, share in shares.items()}


def test_one_program_is_for_all():
    shares = assign_programs(file_of(("thymio-II", 7, "a")), [ANNA, BERT])
    assert codes(shares) == {"anna": "a", "bert": "a"}
    assert shares["anna"].notes == ()


def test_a_lone_robot_without_a_name_takes_the_node_of_its_number():
    shares = assign_programs(file_of(("thymio-II", 2, "a"), ("thymio-II", 1, "b")), [RobotId("", 1)])
    assert codes(shares) == {"": "b"}
    assert shares[""].notes == ("no robot is left for node 'thymio-II' 2",)


def test_names_come_before_numbers_and_numbers_before_order():
    shares = assign_programs(
        file_of(("thymio-II", 9, "order"), ("thymio-II", 2, "number"), ("anna", 2, "name")), [ANNA, BERT, CARL]
    )
    assert codes(shares) == {"anna": "name", "bert": "number", "carl": "order"}
    assert shares["bert"].notes == ()
    assert shares["carl"].notes == ("node 'thymio-II' 9 runs here, on number 3, as it was next in order",)


def test_nodes_without_a_number_are_assigned_in_order_without_a_note():
    shares = assign_programs(file_of(("thymio-II", 0, "a"), ("thymio-II", 0, "b")), [ANNA, BERT])
    assert codes(shares) == {"anna": "a", "bert": "b"}
    assert [share.notes for share in shares.values()] == [(), ()]


def test_a_robot_without_a_node_runs_nothing_and_gets_a_note():
    shares = assign_programs(file_of(("thymio-II", 1, "a"), ("thymio-II", 2, "b")), [ANNA, BERT, CARL])
    assert shares["carl"].program is None
    assert shares["carl"].notes == ("the file has no program left for this robot: it runs nothing",)


def test_the_only_node_with_a_robot_s_name_is_for_that_robot():
    shares = assign_programs(file_of(("bert", 0, "b")), [ANNA, BERT])
    assert codes(shares) == {"anna": None, "bert": "b"}


def test_nodes_of_other_kinds_are_skipped_with_a_note():
    shares = assign_programs(file_of(("thymio-II", 1, "a"), ("e-puck", 2, "b")), [ANNA])
    assert shares["anna"].notes == ("not for a Thymio, left out: node 'e-puck'",)


def test_an_error_in_one_of_several_programs_names_the_node():
    with pytest.raises(ProgramError) as caught:
        file_of(("thymio-II", 1, "a"), ("anna", 2, "a b"))
    assert str(caught.value).startswith("test.aesl: line 3, column 36: node 'anna' 2: no variable")


def test_an_error_in_the_only_program_names_no_node():
    with pytest.raises(ProgramError, match=r"line 2, column \d+: expected"):
        file_of(("thymio-II", 1, "3"))


def test_constants_take_the_place_of_the_file_s_or_are_added():
    text = '<network><constant name="A" value="1"/><node name="thymio-II">var a = A + B</node></network>'
    (program,) = load_file(text, "test.aesl", constants={"A": 40, "B": 2}).programs
    assert program.constants == (("A", 40), ("B", 2))


SUITE = "Thymio_4 on LAPTOP-8J2 - 8636"


@pytest.mark.parametrize("name", [SUITE, "Serielles USB-Gerät", "e-puck"])
def test_the_only_node_is_for_all_robots_whatever_its_name(name):
    shares = assign_programs(file_of((name, "{01234567-89ab-cdef-0123-456789abcdef}", "a")), [ANNA, BERT])
    assert codes(shares) == {"anna": "a", "bert": "a"}
    assert shares["bert"].notes == (f"node '{name}' runs here, as it is the only one of the file",)


@pytest.mark.parametrize("opening", ["<node>", "<node name=''>", "<node nodeId='' name=' '>"])
def test_the_only_node_needs_no_name(opening):
    shares = assign_programs(load_file(f"<network>{opening}var a</node></network>", "test.aesl"), [RobotId("", 1)])
    assert codes(shares) == {"": "a"}


def test_nodes_named_after_devices_go_to_robots_by_number_and_then_in_order():
    shares = assign_programs(file_of((SUITE, 0, "a"), ("Serielles USB-Gerät", 7, "b"), ("third", 1, "c")), [ANNA, BERT])
    assert codes(shares) == {"anna": "c", "bert": "a"}
    assert shares["bert"].notes == (
        f"node '{SUITE}' runs here, as no robot has its name and this one was the next without a program",
        "no robot is left for node 'Serielles USB-Gerät' 7",
    )


def test_a_robot_s_own_node_comes_before_one_named_after_a_device():
    shares = assign_programs(file_of((SUITE, 1, "device"), ("anna", 9, "own")), [ANNA, BERT])
    assert codes(shares) == {"anna": "own", "bert": "device"}


def test_two_nodes_of_one_name_go_to_two_robots():
    shares = assign_programs(file_of((SUITE, 0, "a"), (SUITE, 0, "b")), [ANNA, BERT])
    assert codes(shares) == {"anna": "a", "bert": "b"}


def test_a_device_s_program_that_does_not_compile_is_left_out_where_others_have_a_robot_s_name():
    shares = assign_programs(file_of((SUITE, 0, "a = b"), ("anna", 0, "own")), [ANNA, BERT])
    assert codes(shares) == {"anna": "own", "bert": None}
    assert "is left out, as it does not compile for a Thymio: test.aesl: line 2, column" in shares["bert"].notes[0]


def test_a_device_s_program_that_does_not_compile_is_an_error_otherwise():
    with pytest.raises(ProgramError, match=r"line 2, column \d+: node 'Thymio_4 on"):
        file_of((SUITE, 0, "a = b"), ("other", 0, "a"))


def test_the_error_of_a_program_for_another_device_names_the_device():
    with pytest.raises(
        ProgramError, match=r"no variable is called 'ir'.*; the program was made for the device 'e-puck'"
    ):
        file_of(("e-puck", 1, "a = ir"))
