"""Programs of clients: compile, load, run, step, breakpoints, faults."""

from __future__ import annotations

from uuid import UUID

import pytest

from aseba_vm import aesl, compile, targets
from tests.network.tdm.machine_node import MachineNode
from tests.network.tdm.talk import Talk, values
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.constants import Command, ErrorCode, VMError, VMState, Watch
from thymio_sim_ros.network.tdm.protocol.values import encode_value

GROUP, NODE = UUID(int=1), UUID(int=2)

LINES = "var a = 1\n\n# nothing\nvar b\nb = a + 1\nb = 7\nonevent button.left\na = b / (b - 7)\n"


@pytest.fixture
def talk() -> Talk:
    """One node; client 1 has locked it and watches its machine."""
    talk = Talk(MachineNode())
    talk.join(1)
    talk.ask(1, m.LockNode, NODE)
    talk.ask(1, m.WatchNode, NODE, Watch.VM_STATE)
    talk.received.clear()
    return talk


def _states(talk: Talk) -> list[tuple[int, int, int]]:
    """State, line and error of what client 1 has been sent."""
    return [(state.state, state.line, state.error) for state in talk.take(1, m.VMExecutionStateChanged)]


def test_a_program_is_loaded_and_does_not_start(talk: Talk) -> None:
    answer = talk.load(1, NODE, LINES)
    node = talk.networks[0][0]
    target = node.vm.target
    words = len(talk.networks[0][0].vm.bytecode)
    assert answer == m.CompilationResultSuccess(
        answer.request_id, answer.bytecode_size, 1534, target.variables_end + 2, target.variables_size
    )
    assert 0 < answer.bytecode_size <= words
    node.run()
    assert node.vm.variables[target.variables_end] == 0


def test_a_long_program_is_loaded_in_parts_and_answered_once(talk: Talk) -> None:
    text = "var a[300]\n" + "\n".join(f"a[{number}] = a[{number + 1}] * {number}" for number in range(150))
    answer = talk.load(1, NODE, text)
    assert isinstance(answer, m.CompilationResultSuccess)
    assert answer.bytecode_size > 512


def test_a_compile_check_loads_nothing(talk: Talk) -> None:
    before = talk.networks[0][0].vm.bytecode
    answer = talk.ask(1, m.CompileAndLoadCodeOnVM, NODE, 1, LINES, 1)
    assert isinstance(answer, m.CompilationResultSuccess)
    assert talk.networks[0][0].vm.bytecode == before


def test_an_error_has_its_place_from_zero(talk: Talk) -> None:
    answer = talk.load(1, NODE, "var a = 1\n  b = 2\n")
    assert isinstance(answer, m.CompilationResultFailure)
    assert (answer.character, answer.line, answer.column) == (12, 1, 2)
    assert "'b'" in answer.message


def test_a_program_needs_the_lock(talk: Talk) -> None:
    talk.join(2)
    assert talk.load(2, NODE, LINES).error == ErrorCode.UNKNOWN_NODE
    assert talk.command(2, NODE, Command.RUN).error == ErrorCode.UNKNOWN_NODE
    answer = talk.ask(2, m.SetBreakpoints, NODE, (m.Breakpoint(1),))
    assert answer == m.SetBreakpointsResponse(answer.request_id, ErrorCode.UNKNOWN_NODE)


def test_a_node_that_does_not_confirm_a_program_is_an_error(talk: Talk) -> None:
    talk.is_silent = True
    talk.send(1, m.CompileAndLoadCodeOnVM(8, NODE, 1, LINES, 2))
    assert talk.received[1] == []
    talk.advance(4000)
    assert talk.take(1, m.Error) == [m.Error(8, ErrorCode.UNKNOWN)]


def test_run_pause_and_reset_are_shown(talk: Talk) -> None:
    talk.load(1, NODE, LINES)
    assert _states(talk) == [(VMState.PAUSED, 1, 0)]
    assert isinstance(talk.command(1, NODE, Command.RUN), m.RequestCompleted)
    talk.run()
    assert _states(talk) == [(VMState.RUNNING, 0, 0)]
    assert talk.networks[0][0].vm.variables[talk.networks[0][0].vm.target.variables_end + 1] == 7
    talk.command(1, NODE, Command.PAUSE)
    assert _states(talk) == [(VMState.PAUSED, 0, 0)]
    talk.command(1, NODE, Command.RESET)
    assert _states(talk) == [(VMState.PAUSED, 1, 0)]


def test_a_step_to_the_next_line_takes_as_many_instructions_as_it_needs(talk: Talk) -> None:
    talk.load(1, NODE, LINES)
    _states(talk)
    lines = []
    for _ in range(4):
        talk.command(1, NODE, Command.STEP_TO_NEXT_LINE)
        lines += _states(talk)
    assert lines == [(VMState.PAUSED, 5, 0), (VMState.PAUSED, 6, 0), (VMState.PAUSED, 0, 0)]


def test_a_step_executes_one_instruction(talk: Talk) -> None:
    talk.load(1, NODE, LINES)
    node = talk.networks[0][0]
    before = node.vm.pc
    talk.command(1, NODE, Command.STEP)
    assert node.vm.pc > before
    assert node.vm.is_active


def test_breakpoints_are_set_by_lines_and_hit(talk: Talk) -> None:
    talk.load(1, NODE, LINES)
    answer = talk.ask(1, m.SetBreakpoints, NODE, (m.Breakpoint(6), m.Breakpoint(2), m.Breakpoint(99)))
    assert answer.error == 0
    assert [point.line for point in answer.breakpoints] == [5, 6]  # line 2 has no code
    _states(talk)
    talk.command(1, NODE, Command.RUN)
    talk.run()
    assert _states(talk) == [(VMState.RUNNING, 0, 0), (VMState.PAUSED, 5, 0)]
    assert talk.ask(1, m.SetBreakpoints, NODE, ()).breakpoints == ()
    talk.command(1, NODE, Command.RUN)
    talk.run()
    assert _states(talk) == [(VMState.RUNNING, 0, 0)]


def test_more_breakpoints_than_a_node_has_are_not_accepted(talk: Talk) -> None:
    talk.load(1, NODE, "var a\n" + "a = a + 1\n" * 20)
    answer = talk.ask(1, m.SetBreakpoints, NODE, tuple(m.Breakpoint(line) for line in range(2, 22)))
    assert [point.line for point in answer.breakpoints] == list(range(2, 18))


def test_a_node_without_our_program_has_no_lines(talk: Talk) -> None:
    assert talk.ask(1, m.SetBreakpoints, NODE, (m.Breakpoint(1),)).breakpoints == ()


def test_breakpoints_that_a_node_does_not_confirm_are_answered(talk: Talk) -> None:
    talk.load(1, NODE, LINES)
    talk.is_silent = True
    talk.send(1, m.SetBreakpoints(8, NODE, (m.Breakpoint(5),)))
    talk.advance(2900)
    assert talk.take(1, m.SetBreakpointsResponse) == []
    talk.advance(200)
    assert talk.take(1, m.SetBreakpointsResponse) == [m.SetBreakpointsResponse(8)]


def test_breakpoints_go_with_the_lock(talk: Talk) -> None:
    talk.load(1, NODE, LINES)
    talk.ask(1, m.SetBreakpoints, NODE, (m.Breakpoint(5),))
    assert talk.networks[0][0].vm.breakpoints != ()
    talk.ask(1, m.UnlockNode, NODE)
    assert talk.networks[0][0].vm.breakpoints == ()


def test_a_fault_has_its_line_and_stays_until_the_program_runs_again(talk: Talk) -> None:
    talk.load(1, NODE, LINES)
    talk.command(1, NODE, Command.RUN)
    talk.run()
    _states(talk)
    node = talk.networks[0][0]
    button = targets.THYMIO_II.local_event_number("button.left")
    talk.from_node(0, node.start(button))
    talk.exchange()
    assert _states(talk) == [(VMState.STOPPED, 8, VMError.DIVISION_BY_ZERO)]
    talk.join(2)
    talk.ask(2, m.WatchNode, NODE, Watch.VM_STATE)
    (shown,) = talk.take(2, m.VMExecutionStateChanged)
    assert (shown.error, shown.error_msg) == (VMError.DIVISION_BY_ZERO, "division by zero")
    talk.command(1, NODE, Command.RUN)
    assert _states(talk) == [(VMState.RUNNING, 0, 0)]


def test_an_index_outside_an_array_is_explained(talk: Talk) -> None:
    talk.load(1, NODE, "var a[3]\nvar i = 5\na[i] = 1")
    talk.command(1, NODE, Command.RUN)
    talk.run()
    found = talk.take(1, m.VMExecutionStateChanged)[-1]
    assert (found.error, found.line, found.error_msg) == (VMError.OUT_OF_BOUNDS, 3, "index 5 of an array of 3 words")


def test_stop_stops_the_wheels_and_replaces_the_program(talk: Talk) -> None:
    talk.load(1, NODE, "motor.left.target = 100\nonevent timer0\nmotor.left.target = 200")
    talk.command(1, NODE, Command.RUN)
    talk.run()
    node = talk.networks[0][0]
    assert node.value("motor.left.target") == (100,)
    _states(talk)
    assert isinstance(talk.command(1, NODE, Command.STOP), m.RequestCompleted)
    assert node.value("motor.left.target") == (0,)
    assert _states(talk)[-1] == (VMState.STOPPED, 0, 0)
    talk.command(1, NODE, Command.RUN)
    talk.run()
    talk.from_node(0, node.start(targets.THYMIO_II.local_event_number("timer0")))
    assert node.value("motor.left.target") == (0,)


def test_a_local_client_may_stop_a_node_without_its_lock(talk: Talk) -> None:
    talk.join(2)
    talk.join(3, is_local=False)
    assert talk.command(3, NODE, Command.STOP).error == ErrorCode.UNKNOWN_NODE
    assert isinstance(talk.command(2, NODE, Command.STOP), m.RequestCompleted)


def test_an_unknown_command_is_rejected(talk: Talk) -> None:
    assert talk.ask(1, m.SetVMExecutionState, NODE, 99).error == ErrorCode.UNKNOWN


def test_variables_of_programs_come_and_go(talk: Talk) -> None:
    talk.load(1, NODE, "var first = 5")
    talk.ask(1, m.WatchNode, NODE, Watch.VARIABLES)
    talk.received.clear()
    talk.load(1, NODE, "var second[2] = [1, 2]")
    talk.command(1, NODE, Command.RUN)
    talk.run()
    talk.advance(200)
    shown = [values(message) for message in talk.take(1, m.VariablesChanged)]
    assert shown[0] == {"first": ()}  # null
    assert {"second": (1, 2)}.items() <= {name: words for part in shown[1:] for name, words in part.items()}.items()


NETWORK = aesl.Network(
    (("go", 1),),
    (("SPEED", 50),),
    nodes=(aesl.Node("thymio-II", 1, "onevent go\nmotor.left.target = SPEED\nemit go SPEED"),),
)


def test_a_file_brings_its_events_and_constants(talk: Talk) -> None:
    talk.ask(1, m.WatchNode, GROUP, Watch.SHARED_EVENTS | Watch.SHARED_VARIABLES)
    talk.received.clear()
    answer = talk.ask(1, m.CompileAndLoadCodeOnVM, GROUP, 2, aesl.dumps(NETWORK), 2)
    assert isinstance(answer, m.CompilationResultSuccess)
    assert talk.take(1, m.EventsDescriptionsChanged)[0].events == (m.EventDescription("go", 1),)
    assert values(talk.take(1, m.VariablesChanged)[0]) == {"SPEED": (50,)}


def test_a_file_for_several_nodes_is_answered_once() -> None:
    talk = Talk()
    talk.add_network([MachineNode(1), MachineNode(2)])
    talk.join(1)
    for node in talk.take(1, m.NodesChanged)[0].nodes:
        talk.ask(1, m.LockNode, node.node_id)
    assert isinstance(
        talk.ask(1, m.CompileAndLoadCodeOnVM, GROUP, 2, aesl.dumps(NETWORK), 2), m.CompilationResultSuccess
    )
    assert all(node.vm.bytecode[0] > 1 for node in talk.networks[0])


def test_the_programs_of_a_file_go_to_robots_as_everywhere_else() -> None:
    """An editor names a node after the device that it was connected to, with a number of that device."""
    talk = Talk()
    talk.add_network([MachineNode(1), MachineNode(2)])
    talk.join(1)
    for node in talk.take(1, m.NodesChanged)[0].nodes:
        talk.ask(1, m.LockNode, node.node_id)
    nodes = (aesl.Node("Thymio_4 on LAPTOP", 77, "var a = 1"), aesl.Node("thymio-II", 2, "var a[5]"))
    answer = talk.ask(1, m.CompileAndLoadCodeOnVM, GROUP, 2, aesl.dumps(aesl.Network(nodes=nodes)), 2)
    assert isinstance(answer, m.CompilationResultSuccess)
    words = [compile(node.code, targets.THYMIO_II).words for node in nodes]
    assert [node.vm.bytecode[: len(each)] for node, each in zip(talk.networks[0], words, strict=True)] == words


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("<network>", (0, 9)),
        (aesl.dumps(aesl.Network(nodes=(aesl.Node("thymio-II", 1, "var a\nb = 1"),))), None),
    ],
)
def test_a_wrong_file_is_an_error_with_its_place(talk: Talk, text: str, place: tuple[int, int] | None) -> None:
    answer = talk.ask(1, m.CompileAndLoadCodeOnVM, NODE, 2, text, 2)
    assert isinstance(answer, m.CompilationResultFailure)
    row = next((row for row, line in enumerate(text.split("\n")) if "b = 1" in line), 0)
    assert (answer.line, answer.column) == (place or (row, 0))


def test_the_text_of_a_program_precedes_its_bytecode_and_compiles_to_it(talk: Talk) -> None:
    talk.ask(1, m.RegisterEvents, NODE, (m.EventDescription("go", 1),))
    talk.ask(1, m.SetVariables, GROUP, (m.NamedValue("SPEED", encode_value((50,))),))
    talk.programs.clear()
    source = "onevent go\nmotor.left.target = SPEED\n"
    talk.load(1, NODE, source)
    ((network, known),) = talk.programs
    assert network == 0
    file = aesl.loads(known.text, strict=True)
    words = compile(file.nodes[0].code, targets.THYMIO_II, file.events, file.constants).words
    assert talk.networks[0][0].vm.bytecode[: len(words)] == words == known.program.words
    assert file.nodes[0].code == known.source == source
    assert [known.text.split("\n")[line - 1].strip() for line in known.lines[:2]][1:] == ["motor.left.target = SPEED"]
