import inspect
import re

import pytest

from aseba_vm import TargetDescription, Variable, VirtualMachine, compile, vm
from aseba_vm.machine import machine_messages, reference
from aseba_vm.targets import THYMIO_II
from aseba_vm.vm import ACTIVE, STEP_BY_STEP

EVENTS = [("ping", 2), ("pong", 0)]


def machine_with(source, **options):
    program = compile(source, THYMIO_II, EVENTS)
    machine = VirtualMachine(THYMIO_II, **options)
    machine.load(program)
    machine.run()
    machine.pop_messages()
    return machine, program


def value_of(expression, before=""):
    machine, _ = machine_with(f"var r var x = 7 var t[4] {before} r = {expression}")
    return machine.variables[128]


@pytest.mark.parametrize(
    ("before", "expression", "value"),
    [
        ("x = 32767", "x + 1", -32768),
        ("x = -32768", "-x", -32768),
        ("x = -32768", "abs x", -32768),
        ("x = -7", "x / 2", -4),
        ("x = -7", "x % 2", -1),
        ("x = 2", "-7 / x", -3),
        ("x = -1", "-32768 / x", -32768),
        ("x = -1", "-32768 % x", 0),
        ("x = 16", "1 << x", 0),
        ("x = 32", "1 << x", 1),
        ("x = -1", "1 << x", 0),
        ("x = 31", "-5 >> x", -1),
        ("x = 300", "x * x", 24464),
        ("x = 5", "~x", -6),
    ],
)
def test_arithmetic_is_that_of_16_bits(before, expression, value):
    assert value_of(expression, before) == value


def test_a_fresh_machine_does_nothing():
    machine = VirtualMachine(THYMIO_II)
    assert machine.run() is False
    assert not machine.is_active


def test_loading_starts_the_initialization_and_keeps_the_variables():
    machine = VirtualMachine(THYMIO_II)
    machine.variables[200] = 5
    machine.load(compile("acc[0] = 3", THYMIO_II))
    assert machine.is_active
    assert machine.run() is True
    assert machine.variables[200] == 5


def test_a_run_at_its_limit_continues_in_the_next_run():
    machine, _ = machine_with("var n onevent tap while n < 100 do n++ end")
    machine.start_local(8)
    machine.run(50)
    assert machine.is_active
    assert 0 < machine.variables[128] < 100
    machine.run()
    assert machine.variables[128] == 100


def test_a_long_event_may_be_killed_instead():
    machine, _ = machine_with("var n onevent tap while n < 100 do n++ end", kills_long_events=True)
    machine.start_local(8)
    machine.run(50)
    assert not machine.is_active
    assert isinstance(machine.pop_messages()[-1], machine_messages.EventKilled)


def test_an_emitted_event_is_left_in_the_outbox():
    machine, _ = machine_with("onevent tap emit ping [3, -4] emit pong")
    machine.start_local(8)
    machine.run()
    assert machine.pop_messages() == (machine_messages.Emitted(0, (3, -4)), machine_messages.Emitted(1, ()))
    assert machine.pop_messages() == ()


def test_a_global_event_brings_source_and_arguments():
    machine, _ = machine_with("var s var v[2] onevent ping s = event.source v = event.args[0:1]")
    machine.receive(0, 42, [5, -6])
    machine.run()
    assert machine.variables[128:131] == [42, 5, -6]


def test_a_global_event_kills_the_running_one():
    machine, _ = machine_with("onevent ping while acc[0] == 0 do acc[1]++ end")
    machine.receive(0, 1, [])
    machine.run(10)
    machine.receive(0, 1, [])
    assert [type(message) for message in machine.pop_messages()] == [machine_messages.EventKilled]


def test_a_local_event_waits_for_the_running_one():
    machine, _ = machine_with("onevent tap acc[1]++ acc[1]++")
    assert machine.start_local(8)
    machine.run(1)
    assert not machine.start_local(8)
    machine.run()
    assert machine.variables[THYMIO_II.addresses["event.source"][0]] == machine.node_id


def test_when_keeps_its_condition_between_events():
    machine, _ = machine_with("var n onevent tap when acc[0] > 0 do n++ end")
    acc = THYMIO_II.addresses["acc"][0]
    counts = []
    for value in (1, 1, 0, 1):
        machine.variables[acc] = value
        machine.start_local(8)
        machine.run()
        counts.append(machine.variables[128])
    assert counts == [1, 1, 1, 2]


@pytest.mark.parametrize(
    ("source", "reason", "row"),
    [
        ("var t[4]\nvar i = 9\nt[i] = 1", "index 9 is outside an array of 4", 2),
        ("var t[4]\nvar i = -1\nt[i] = 1", "index -1 is outside an array of 4", 2),
        ("var z\n\nz = 5 / z", "division by zero", 2),
        ("var q[8]\nvar v\ncall deque.pop_back(q, v)", "a deque was given a wrong index or too many values", 2),
        ("var a = -1\ncall math.sqrt(a, a)", "square root of a negative number", 1),
    ],
)
def test_a_fault_stops_the_machine_with_reason_and_address(source, reason, row):
    machine, program = machine_with(source)
    assert machine.fault.message == reason
    assert program.row_of(machine.fault.pc) == row
    assert machine.flags == STEP_BY_STEP
    machine.start_local(8)
    assert machine.run() is False


def test_every_fault_has_a_sentence():
    reasons = set(re.findall(r'"([a-z]+(?:-[a-z]+)+)"', "".join(inspect.getsource(part) for part in (vm, reference))))
    assert "stack-underflow" in reasons
    assert {machine_messages.BadCode(0, reason).message for reason in reasons} & reasons == set()
    assert machine_messages.NodeSpecific(0, "sqrt-of-negative").message == "square root of a negative number"
    assert machine_messages.NodeSpecific(0, "no card").message == "no card"


def test_resuming_clears_the_fault():
    machine, _ = machine_with("var z z = 5 / z")
    machine.resume()
    assert machine.fault is None
    assert not machine.is_step_by_step


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ([3, 0xFFFF, 3, 0xF000], "unknown-instruction"),
        ([3, 0xFFFF, 3, 0x1001, 0x7003], "unknown-unary-operator"),
        ([3, 0xFFFF, 3, 0x1001, 0x1001, 0x8012], "unknown-binary-operator"),
        ([3, 0xFFFF, 3, 0x4080], "stack-underflow"),
        ([3, 0xFFFF, 3, 0x1001, 0x9FFF], "stack-overflow"),
        ([3, 0xFFFF, 3, 0x3FFF], "variable-out-of-range"),
        ([3, 0xFFFF, 3, 0x9800], "jump-out-of-range"),
        ([3, 0xFFFF, 900], None),
        ([3, 0xFFFF, 60000], "jump-out-of-range"),
        ([3, 0xFFFF, 3, 0xB000, 0, 600], "emit-too-long"),
        ([3, 0xFFFF, 3, 0xB000, 639, 2], "variable-out-of-range"),
        ([3, 0xFFFF, 3, 0xCFFF], "unknown-native"),
        ([3, 0xFFFF, 3, 0xDFFF], "jump-out-of-range"),
        ([3, 0xFFFF, 3, 0x17FF, 0xE000], "jump-out-of-range"),
    ],
)
def test_words_that_no_compiler_writes_are_a_fault(words, reason):
    machine = VirtualMachine(THYMIO_II)
    machine.set_bytecode(words)
    machine.resume()
    machine.run(1000)
    assert (machine.fault and machine.fault.reason) == reason


def test_words_outside_the_memories_raise_value_error():
    machine = VirtualMachine(THYMIO_II)
    with pytest.raises(ValueError, match="do not fit"):
        machine.set_bytecode([0] * 2000)
    with pytest.raises(ValueError, match="outside a memory"):
        machine.write_variables(639, [1, 2])


def test_a_breakpoint_stops_before_its_instruction():
    machine, program = machine_with("var n onevent tap\nn = 1\nn = 2")
    machine.set_breakpoint(program.addresses_of(2)[0])
    machine.start_local(8)
    machine.run()
    assert machine.variables[128] == 1
    assert machine.is_step_by_step
    machine.run()
    assert machine.variables[128] == 1
    machine.step()
    machine.step()
    assert machine.variables[128] == 2


def test_a_machine_has_room_for_sixteen_breakpoints():
    machine = VirtualMachine(THYMIO_II)
    for pc in range(17):
        machine.set_breakpoint(pc)
    assert machine.pop_messages()[-1] == machine_messages.BreakpointSet(16, is_set=False)
    machine.clear_breakpoint(0)
    assert machine.breakpoints == tuple(range(1, 16))
    machine.clear_breakpoints()
    assert machine.breakpoints == ()


def test_a_tracer_sees_every_instruction():
    machine, _ = machine_with("onevent tap acc[0] = 1")
    seen = []
    machine.tracer = seen.append
    machine.start_local(8)
    machine.run()
    assert seen == [3, 4, 5]


def test_reset_calls_the_node_before_the_initialization():
    states = []
    machine = VirtualMachine(THYMIO_II, on_reset=lambda machine: states.append(machine.flags))
    machine.load(compile("acc[0] = 1", THYMIO_II))
    assert states == [STEP_BY_STEP]
    assert machine.flags == ACTIVE


def test_the_commands_answer_with_the_state():
    machine, _ = machine_with("acc[0] = 1")
    machine.pause()
    machine.resume()
    machine.stop()
    machine.report_state()
    flags = [message.flags for message in machine.pop_messages()]
    assert flags == [STEP_BY_STEP, 0, STEP_BY_STEP, STEP_BY_STEP]


def test_a_machine_without_memory_is_possible():
    machine = VirtualMachine(TargetDescription("none", 0, 0, 0))
    machine.reset()
    machine.receive(0, 1, [1])
    machine.resume()
    assert machine.run() is False


def test_events_go_to_the_second_and_third_variable():
    target = TargetDescription("t", 8, 100, 8, (Variable("id", 1), Variable("source", 1), Variable("args", 2)))
    machine = VirtualMachine(target)
    machine.receive(0, 7, [1, 2, 3])
    assert machine.variables == [0, 7, 1, 2, 0, 0, 0, 0]
