"""Breakpoints and steps by line, local events that are watched."""

import pytest

from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.programs.breakpoints import Breakpoints
from thymio_sim_ros.device.programs.program import load_program

SOURCE = """var n = 0
var m

onevent prox
    n = n + 1
    # a comment
    m = n
onevent button.center
    n = 100
"""
PROX = [0] * 7


@pytest.fixture
def device():
    device = AsebaDevice()
    device.load(load_program(SOURCE, "test"))
    device.run(1000)
    return device


def prox(device):
    device.feed("proximity", PROX)
    device.run(1000)


def place(device):
    status = device.status
    return status.state, status.event, status.line


def test_a_breakpoint_pauses_before_its_line(device):
    assert device.run_control.set_breakpoints([7]) == Breakpoints((7,), {})
    prox(device)
    assert place(device) == ("paused", "prox", 7)
    assert (device.variables.get("n"), device.variables.get("m")) == ((1,), (0,))
    assert device.status.pc is not None


def test_resume_goes_on_off_the_breakpoint_and_meets_it_again(device):
    device.run_control.set_breakpoints([5])
    prox(device)
    device.run_control.resume()
    device.run(1000)
    assert place(device) == ("running", "", None)
    assert device.variables.get("m") == (1,)
    prox(device)
    assert place(device) == ("paused", "prox", 5)


def test_lines_without_code_move_to_the_next_with_code(device):
    assert device.run_control.set_breakpoints([6, 7, 1000]) == Breakpoints((7,), {6: 7, 1000: None})


def test_breakpoints_of_a_file_count_its_lines():
    text = f'<network>\n<event size="1" name="e"/>\n<node name="thymio-II">{SOURCE}</node></network>'
    device = AsebaDevice()
    device.load(load_program(text, "test.aesl"))
    device.run(1000)
    assert device.run_control.set_breakpoints([1, 3, 8]) == Breakpoints((3, 9), {1: None, 8: 9})
    prox(device)
    assert place(device) == ("paused", "prox", 9)


def test_new_breakpoints_replace_the_old_ones(device):
    device.run_control.set_breakpoints([5])
    assert device.run_control.set_breakpoints([]) == Breakpoints()
    prox(device)
    assert place(device) == ("running", "", None)


def test_step_line_stands_at_the_first_line_of_an_event_then_goes_line_by_line(device):
    device.run_control.pause()
    device.feed("proximity", PROX)
    lines = []
    for _ in range(3):
        device.run_control.step_line()
        lines.append(place(device))
    assert lines == [("paused", "prox", 5), ("paused", "prox", 7), ("paused", "", None)]
    assert device.variables.get("m") == (1,)


def test_a_step_into_a_fault_reports_it():
    device = AsebaDevice()
    device.load(load_program("var i = 9\nvar t[2]\nonevent prox\nt[i] = 1", "test"))
    device.run(1000)
    device.run_control.set_breakpoints([4])
    prox(device)
    device.run_control.resume()
    while device.status.state == "running":
        device.run(1000)
    assert place(device) == ("fault", "prox", 4)


def test_a_robot_that_is_off_does_not_step(device):
    device.run_control.switch_off()
    device.run_control.step_line()
    assert device.status.state == "off"


def test_a_new_program_has_no_breakpoints(device):
    device.run_control.set_breakpoints([5])
    device.load(load_program(SOURCE, "again"))
    device.run(1000)
    prox(device)
    assert place(device) == ("running", "", None)


def test_watched_local_events_are_returned_also_without_a_handler(device):
    device.local_events.watch({"acc", "button.left", "timer0", "prox"})
    device.feed("accelerometer", [0, 0, 23])
    device.feed("buttons", [0, 1, 0, 0, 0])
    device.feed("buttons", [0, 1, 1, 0, 0])
    device.variables.set("timer.period", (20, 0))
    prox(device)
    for now_ns in (10_000_000, 60_000_000):
        device.advance(now_ns)
        device.run(1000)
    assert device.local_events.pop() == ["acc", "button.left", "prox", "timer0", "timer0"]
    assert device.local_events.pop() == []


def test_unwatched_events_are_not_recorded(device):
    device.feed("accelerometer", [0, 0, 23])
    assert device.local_events.pop() == []
