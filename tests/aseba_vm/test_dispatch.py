"""Event dispatch without a robot: the robot queues events, the reference's simulator kills the active handler."""

import pytest

from aseba_vm import VirtualMachine, compile
from aseba_vm.dispatch import MAX_QUEUED_EVENTS, FirmwareDispatch, PlaygroundDispatch
from aseba_vm.machine.machine_messages import EventKilled
from aseba_vm.targets import THYMIO_II

SOURCE = """\
var log[8]
var n = 0
onevent ping
log[n] = 1  n = n + 1
onevent button.center
log[n] = 2  n = n + 1
onevent prox
log[n] = 3  n = n + 1
"""


def _begin(policy):
    machine = VirtualMachine(THYMIO_II)
    program = compile(SOURCE, THYMIO_II, [("ping", 1)])
    machine.load(program)
    machine.run()
    return machine, policy(machine), program.addresses["log"][0]


def _turns(dispatch):
    while dispatch.run():
        pass


def test_the_robot_serves_local_events_by_their_number():
    machine, dispatch, log = _begin(FirmwareDispatch)
    dispatch.raise_local("prox")
    dispatch.raise_local("button.center")
    assert dispatch.pending == ("button.center", "prox")
    _turns(dispatch)
    assert machine.variables[log : log + 3] == [2, 3, 0]


def test_local_events_that_wait_together_are_one():
    machine, dispatch, log = _begin(FirmwareDispatch)
    dispatch.raise_local("prox")
    dispatch.raise_local("prox")
    _turns(dispatch)
    assert machine.variables[log : log + 2] == [3, 0]


def test_nothing_interrupts_a_handler_of_the_robot():
    machine, dispatch, log = _begin(FirmwareDispatch)
    dispatch.raise_local("prox")
    dispatch.run()
    dispatch.run(limit=2)
    dispatch.raise_local("button.center")
    dispatch.receive(0)
    _turns(dispatch)
    assert machine.variables[log : log + 3] == [3, 1, 2]
    assert not [message for message in machine.pop_messages() if isinstance(message, EventKilled)]


def test_global_events_wait_in_line_up_to_a_number():
    machine, dispatch, log = _begin(FirmwareDispatch)
    assert [dispatch.receive(0) for _ in range(MAX_QUEUED_EVENTS + 1)] == [True] * MAX_QUEUED_EVENTS + [False]
    dispatch.clear()
    assert dispatch.run() is False
    dispatch.receive(0, 5, [7])
    _turns(dispatch)
    assert machine.variables[log] == 1
    assert machine.variables[1:3] == [5, 7]


def test_a_new_event_kills_the_handler_of_the_playground():
    machine, dispatch, log = _begin(PlaygroundDispatch)
    dispatch.raise_local("prox")
    dispatch.run(limit=2)
    dispatch.raise_local("button.center")
    assert any(isinstance(message, EventKilled) for message in machine.pop_messages())
    dispatch.run()
    assert machine.variables[log : log + 2] == [2, 0]
    assert dispatch.receive(0) is True
    dispatch.run()
    assert machine.variables[log : log + 2] == [2, 1]


def test_a_long_handler_of_the_playground_continues_in_the_next_step():
    program = compile("var n\nonevent prox\nwhile n < 300 do\nn++\nend", THYMIO_II)
    machine = VirtualMachine(THYMIO_II)
    machine.load(program)
    machine.run()
    dispatch = PlaygroundDispatch(machine)
    dispatch.raise_local("prox")
    before = machine.instructions
    steps = 0
    while machine.is_active:
        dispatch.run()
        steps += 1
    assert machine.variables[program.addresses["n"][0]] == 300
    assert steps == 1 + (machine.instructions - before) // 1000 > 1


@pytest.mark.parametrize("policy", [FirmwareDispatch, PlaygroundDispatch])
def test_a_local_event_that_the_target_lacks_is_a_key_error(policy):
    _, dispatch, _ = _begin(policy)
    with pytest.raises(KeyError):
        dispatch.raise_local("nothing")
