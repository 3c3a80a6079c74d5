"""Debugging by source row."""

import pytest

from aseba_vm import VirtualMachine, compile
from aseba_vm.debug import Debugger, Usage
from aseba_vm.machine.machine_messages import DivisionByZero, ExecutionState
from aseba_vm.targets import THYMIO_II

SOURCE = """\
var a = 1
var b

sub double
a = a * 2

onevent button.center
b = 5
callsub double

a = a + 1
"""


@pytest.fixture
def debugger():
    return _debugger(SOURCE)


def _debugger(source):
    program = compile(source, THYMIO_II)
    machine = VirtualMachine(THYMIO_II)
    machine.load(program)
    machine.run()
    return Debugger(machine, program)


def _press(debugger):
    debugger.machine.start_local(0xFFFE - THYMIO_II.local_event_number("button.center"))


def _value(debugger, name):
    return debugger.machine.variables[debugger.program.addresses[name][0]]


def test_nothing_is_current_when_no_event_is_active(debugger):
    assert (debugger.row, debugger.segment) == (None, None)


def test_the_row_and_the_event_are_those_about_to_be_executed(debugger):
    _press(debugger)
    assert debugger.row == 7
    assert debugger.segment.name == "button.center"


def test_a_breakpoint_stops_before_its_row(debugger):
    assert debugger.set_breakpoint(10) == 10
    _press(debugger)
    debugger.machine.run()
    assert (debugger.row, _value(debugger, "a"), _value(debugger, "b")) == (10, 2, 5)
    assert debugger.resume() is False
    assert _value(debugger, "a") == 3


def test_a_breakpoint_on_a_row_without_code_moves_to_the_next(debugger):
    assert debugger.set_breakpoint(9) == 10
    assert debugger.breakpoints == (10,)


def test_a_breakpoint_after_the_last_row_is_refused(debugger):
    assert debugger.set_breakpoint(99) is None


def test_the_seventeenth_breakpoint_is_refused():
    debugger = _debugger("var a\n" + "a = 1\n" * 20)
    assert [debugger.set_breakpoint(row) for row in range(1, 18)] == [*range(1, 17), None]


def test_a_row_has_one_breakpoint_and_loses_it(debugger):
    assert [debugger.set_breakpoint(7), debugger.set_breakpoint(7)] == [7, 7]
    assert len(debugger.machine.breakpoints) == 1
    debugger.clear_breakpoint(7)
    assert debugger.breakpoints == ()
    debugger.set_breakpoint(8)
    debugger.clear_breakpoints()
    assert debugger.breakpoints == ()


def test_running_on_stops_at_the_next_breakpoint(debugger):
    debugger.set_breakpoint(7)
    debugger.set_breakpoint(4)
    _press(debugger)
    debugger.machine.run()
    assert debugger.row == 7
    assert debugger.resume() is True
    assert (debugger.row, debugger.segment.name) == (4, "double")


def test_a_step_goes_to_the_next_row_and_into_subroutines(debugger):
    debugger.machine.pause()
    _press(debugger)
    rows = []
    while debugger.machine.is_active:
        rows.append(debugger.row)
        assert debugger.step_row()
    assert [row for row in rows if row in {7, 8, 4, 10}] == [7, 8, 4, 10]


def test_a_step_reports_one_state(debugger):
    debugger.machine.pause()
    _press(debugger)
    debugger.machine.pop_messages()
    debugger.step_row()
    assert [type(message) for message in debugger.machine.pop_messages()] == [ExecutionState]


def test_a_step_that_never_leaves_its_row_gives_up():
    debugger = _debugger("var a\nonevent button.center\nwhile a == 0 do a = 0 end\na = 1")
    _press(debugger)
    assert debugger.step_row(limit=1000) is False
    assert debugger.row == 2


def test_a_fault_ends_a_step():
    debugger = _debugger("var a\nonevent button.center\na = 1 / a\na = 2")
    _press(debugger)
    assert debugger.step_row()
    assert isinstance(debugger.machine.fault, DivisionByZero)


def test_memory_use_is_reported(debugger):
    target = THYMIO_II
    assert debugger.memory_use == Usage(target.variables_end + 2, target.variables_size)
    assert debugger.bytecode_use == Usage(len(debugger.program.words), target.bytecode_size)
    assert debugger.stack_use.total == target.stack_size
    calls = _debugger("var a\ncallsub s\nsub s\ncallsub t\nreturn\nsub t\na = a + a\nreturn")
    assert calls.stack_use.used == 4, "two return addresses, two words of the sum"
    assert Usage(1, 4).share == 0.25
    assert Usage(0, 0).share == 0
