"""A robot as a node of an Aseba network: docs/spec/aseba-protocol.md section 1.4, message by message."""

from __future__ import annotations

import hypothesis
import pytest
from hypothesis import strategies as st

from aseba_vm.machine.machine_messages import Emitted
from aseba_vm.protocol import (
    ArrayAccessOutOfBounds,
    BreakpointSetResult,
    ChangedVariables,
    ClearAllBreakpoints,
    ClearBreakpoint,
    Description,
    DeviceInfo,
    DivisionByZero,
    ExecutionStateChanged,
    GetChangedVariables,
    GetDescription,
    GetDescriptionFragment,
    GetDeviceInfo,
    GetExecutionState,
    GetNodeDescription,
    GetVariables,
    ListNodes,
    LocalEventDescription,
    NamedVariable,
    NativeFunctionDescription,
    NodePresent,
    NodeSpecificError,
    Pause,
    Reboot,
    Reset,
    Run,
    SetBreakpoint,
    SetBytecode,
    SetDeviceInfo,
    SetVariables,
    Step,
    Stop,
    UserMessage,
    Variables,
    encode,
)
from tests.aseba_vm.protocol.strategies import messages as any_message
from thymio_sim_ros.device.behavior_host import MENU, BehaviorHost
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.network_node import NetworkNode
from thymio_sim_ros.device.programs.foreign import FOREIGN, MAX_EVENTS, foreign_program
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.sim.commands import MotorTargets

BUDGET = 5000
CLIENT, OTHER = 7, 8
ID = 3
EVENTS = (("ping", 2), ("pong", 1))
SOURCE = """var n = 5
var list[3] = [1, 2, 3]
onevent ping
n = event.args[0] + 1
emit pong n
onevent timer0
n = 0
"""


def compiled(source, events=EVENTS, name="test.aesl"):
    declared = "".join(f'<event size="{size}" name="{event}"/>' for event, size in events)
    code = source.replace("<", "&lt;")
    return load_program(f'<network>{declared}<node name="thymio-II">{code}</node></network>', name)


def table(words):
    """Addresses by event number."""
    return dict(zip(words[1 : words[0] : 2], words[2 : words[0] : 2], strict=True))


class Bench:
    """A node with one client. `send` returns the replies to the client, then what all clients get."""

    def __init__(self, *, node_id=ID, client=CLIENT):
        self.device = AsebaDevice(node_id=node_id)
        self.host = BehaviorHost(self.device)
        self.node = NetworkNode(self.host, name="anna", uuid=bytes(range(16)))
        if client is not None:
            self.node.connect(client)

    def send(self, *messages, client=CLIENT):
        found = []
        for message in messages:
            found += self.node.handle(client, message)
        return found + self.node.pop_messages()

    def run(self):
        self.device.run(BUDGET)
        return self.node.pop_messages()

    def write(self, source, events=EVENTS):
        """Write a program as tools do, and return its words with the messages that this caused."""
        words = compiled(source, events).program.words
        caused = self.send(SetBytecode(0, ID, 0, words))
        self.node.install_bytecode()
        return words, caused

    def states(self, *messages):
        return [(item.pc, item.flags) for item in self.send(*messages) if isinstance(item, ExecutionStateChanged)]


@pytest.fixture
def bench():
    return Bench()


@pytest.mark.parametrize(("stated", "answered"), [(4, 4), (5, 5), (9, 9), (12, 9)])
def test_the_version_is_that_of_the_client_up_to_9(bench, stated, answered):
    assert bench.send(ListNodes(0, stated)) == [NodePresent(ID, answered)]
    assert bench.send(GetNodeDescription(0, ID, stated))[0].version == answered


def test_the_description_is_that_of_the_robot_in_one_burst(bench):
    described = target()
    header, *items = bench.send(GetNodeDescription(0, ID, 5))
    counts = len(described.variables), len(described.local_events), len(described.natives)
    sizes = described.bytecode_size, described.stack_size, described.variables_size
    assert header == Description(ID, described.name, 5, *sizes, *counts)
    expected = (
        [NamedVariable] * counts[0] + [LocalEventDescription] * counts[1] + [NativeFunctionDescription] * counts[2]
    )
    assert [type(item) for item in items] == expected
    assert [item.name for item in items[: counts[0]]] == [variable.name for variable in described.variables]
    assert items[-1].parameters == described.natives[-1].parameters
    assert max(len(encode(item)) for item in items) <= 522


def test_descriptions_without_a_node_are_for_old_clients_only(bench):
    assert bench.send(GetDescription(0, 5)) == []
    assert bench.send(GetDescription(0, 4))[0].version == 4


def test_fragments_of_the_description(bench):
    whole = bench.send(GetNodeDescription(0, ID, 9))
    assert bench.send(GetDescriptionFragment(0, ID, 9, -1)) == whole[:1]
    assert bench.send(GetDescriptionFragment(0, ID, 9, -2)) == whole
    assert bench.send(GetDescriptionFragment(0, ID, 9, 0)) == [whole[1]]
    assert bench.send(GetDescriptionFragment(0, ID, 9, len(whole) - 2)) == [whole[-1]]
    assert bench.send(GetDescriptionFragment(0, ID, 9, len(whole) - 1)) == []


def test_messages_to_other_nodes_are_ignored(bench):
    assert bench.send(GetVariables(0, ID + 1, 0, 5), Stop(0, ID + 1), SetBytecode(0, ID + 1, 0, (1,))) == []


def test_a_program_waits_in_step_by_step_mode_until_run(bench):
    words, written = bench.write(SOURCE)
    init = table(words)[0xFFFF]
    assert written == [ExecutionStateChanged(ID, init, 3)]
    assert bench.run() == []
    assert bench.states(GetExecutionState(0, ID)) == [(init, 3)]
    assert bench.states(Run(0, ID)) == [(init, 1)]
    assert bench.run() == []
    assert bench.device.variables.read(target().variables_end, 4) == (5, 1, 2, 3)
    assert bench.states(GetExecutionState(0, ID))[0][1] == 0


def test_every_chunk_resets(bench):
    words = compiled(SOURCE).program.words
    chunks = [SetBytecode(0, ID, start, words[start : start + 9]) for start in range(0, len(words), 9)]
    sent = bench.send(*chunks)
    assert len(sent) == len(chunks)
    assert {type(message) for message in sent} == {ExecutionStateChanged}
    bench.send(Run(0, ID))
    bench.run()
    assert bench.device.variables.read(target().variables_end, 1) == (5,)


def test_a_reset_prepares_the_start_and_clears_the_variables(bench):
    words, _ = bench.write(SOURCE)
    bench.send(Run(0, ID))
    bench.run()
    assert bench.states(Reset(0, ID)) == [(table(words)[0xFFFF], 3)]
    assert bench.device.variables.read(target().variables_end, 4) == (0,) * 4


def test_a_reset_without_a_program(bench):
    bench.send(SetBytecode(0, ID, 0, (1,)))
    assert [flags for _, flags in bench.states(Reset(0, ID))] == [2]


def test_an_event_of_a_client_reaches_the_program_and_its_answer_all_clients(bench):
    bench.write(SOURCE)
    bench.send(Run(0, ID))
    bench.run()
    bench.send(UserMessage(1, 0, (41, 0)))
    assert bench.run() == [UserMessage(ID, 1, (42,))]
    assert bench.device.variables.get("event.source") == (1,)


def test_an_event_that_the_program_does_not_know_is_ignored(bench):
    bench.write(SOURCE)
    bench.send(Run(0, ID), UserMessage(0, 500, (1,) * 258), UserMessage(0, 1, (3,)))
    assert bench.run() == []


def test_pause_step_and_the_end_of_a_handler(bench):
    words, _ = bench.write("var n\nonevent ping\nn = 1\n")
    bench.send(Run(0, ID))
    bench.run()
    assert [flags for _, flags in bench.states(Pause(0, ID))] == [2]
    assert [flags for _, flags in bench.states(Step(0, ID))] == [2]
    bench.send(UserMessage(0, 0, (1, 2)))
    start = table(words)[0]
    assert bench.states(Step(0, ID)) == [(start, 3)]
    places = []
    while not places or places[-1][1] == 3:
        places += bench.states(Step(0, ID))
    assert places[0] == (start + 1, 3)
    assert places[-1][1] == 2


def test_an_event_that_arrives_during_a_pause_waits_before_its_first_instruction(bench):
    words, _ = bench.write(SOURCE)
    bench.send(Run(0, ID))
    bench.run()
    bench.send(Pause(0, ID), UserMessage(0, 0, (1, 2)))
    start = table(words)[0]
    assert bench.run() == [ExecutionStateChanged(ID, start, 3)]
    assert bench.run() == []
    assert bench.states(Step(0, ID))[0][0] > start
    bench.send(Run(0, ID))
    bench.run()
    bench.device.run_control.pause()  # on the page: its next step starts the event
    bench.send(UserMessage(0, 0, (1, 2)))
    assert [message.flags for message in bench.run()] == []


def test_a_pending_event_starts_at_the_end_of_a_handler(bench):
    words, _ = bench.write("var n\nonevent ping\nn = 1\nonevent pong\nn = 2\n")
    bench.send(Run(0, ID))
    bench.run()
    bench.send(UserMessage(0, 0, (1, 2)), UserMessage(0, 1, (1,)), Pause(0, ID))
    assert bench.states(Step(0, ID))[-1] == (table(words)[0], 3)
    found = []
    while len(found) < 2:
        found = bench.states(Step(0, ID))
    assert found[0][1] == 2
    assert found[1] == (table(words)[1], 3)


def test_stop_drops_the_handler(bench):
    bench.write("var n\nwhile n == n do\nend\n")
    bench.send(Run(0, ID))
    bench.run()
    assert [flags for _, flags in bench.states(Stop(0, ID))] == [2]
    assert bench.run() == []


def test_a_breakpoint_is_hit_with_flags_7(bench):
    words, _ = bench.write(SOURCE)
    start = table(words)[0]
    assert bench.send(SetBreakpoint(0, ID, start)) == [BreakpointSetResult(ID, start, 1)]
    bench.send(Run(0, ID))
    bench.run()
    bench.send(UserMessage(0, 0, (1, 2)))
    assert bench.run() == [ExecutionStateChanged(ID, start, 7)]
    assert bench.states(Step(0, ID))[0][0] > start
    bench.send(ClearBreakpoint(0, ID, start), Run(0, ID))
    assert bench.run() == [UserMessage(ID, 1, (2,))]


def test_sixteen_breakpoints(bench):
    found = [bench.send(SetBreakpoint(0, ID, pc))[0].success for pc in range(10, 27)]
    assert found == [1] * 16 + [0]
    assert bench.send(SetBreakpoint(0, ID, 60000)) == [BreakpointSetResult(ID, 60000, 0)]
    bench.send(ClearAllBreakpoints(0, ID))
    assert bench.send(SetBreakpoint(0, ID, 26))[0].success == 1


def test_a_client_takes_its_breakpoints_with_it_and_no_others(bench):
    bench.node.connect(OTHER)
    bench.host.load(compiled(SOURCE))
    bench.device.run_control.set_breakpoints([7])
    of_page = bench.device._vm.breakpoints
    for client, pc in ((CLIENT, 20), (OTHER, 20), (CLIENT, 21), (OTHER, 22)):
        bench.send(SetBreakpoint(0, ID, pc), client=client)
    bench.node.disconnect(CLIENT)
    assert sorted(bench.device._vm.breakpoints) == sorted([*of_page, 20, 22])
    bench.send(ClearAllBreakpoints(0, ID), client=OTHER)
    assert bench.device._vm.breakpoints == of_page


def test_breakpoints_of_clients_survive_those_of_lines_and_end_with_the_program(bench):
    bench.host.load(compiled(SOURCE))
    bench.send(SetBreakpoint(0, ID, 20))
    bench.device.run_control.set_breakpoints([7])
    assert 20 in bench.device._vm.breakpoints
    bench.host.load(compiled("var other"))
    assert bench.device._vm.breakpoints == ()


def test_variables_are_read_and_written_as_far_as_the_memory_reaches(bench):
    size = target().variables_size
    address, _ = target().addresses["motor.left.target"]
    assert bench.send(SetVariables(0, ID, address, (-200,))) == []
    assert bench.send(GetVariables(0, ID, address, 1)) == [Variables(ID, address, (-200,))]
    assert MotorTargets(-200, 0) in bench.device.pop_commands()
    assert [len(item.values) for item in bench.send(GetVariables(0, ID, 0, 0xFFFF))] == [256] * (size // 256) + [
        size % 256
    ]
    assert bench.send(GetVariables(0, ID, size - 2, 10))[0].values == (0, 0)
    assert bench.send(GetVariables(0, ID, size + 5, 3)) == [Variables(ID, size + 5, ())]
    bench.send(SetVariables(0, ID, size - 1, (1, 2, 3)), SetVariables(0, ID, 65000, (1,)))
    assert bench.send(GetVariables(0, ID, size - 1, 1))[0].values == (1,)


def test_changed_variables_are_those_since_the_last_request_of_the_client(bench):
    bench.node.connect(OTHER)
    first = bench.send(GetChangedVariables(0, ID))
    assert sum(len(values) for message in first for _, values in message.ranges) == target().variables_size
    assert max(len(encode(message)) for message in first) <= 522
    assert bench.send(GetChangedVariables(0, ID)) == [ChangedVariables(ID, ())]
    bench.send(SetVariables(0, ID, 100, (1, 2)), SetVariables(0, ID, 300, (7,)))
    assert bench.send(GetChangedVariables(0, ID)) == [ChangedVariables(ID, ((100, (1, 2)), (300, (7,))))]
    assert len(bench.send(GetChangedVariables(0, ID), client=OTHER)) == len(first)


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("var a = 1\nvar b = 0\na = a / b", DivisionByZero),
        ("var i = 70\nvar a[3]\na[i] = 1", ArrayAccessOutOfBounds),
        ("var d[5]\nvar x[1]\ncall deque.size(d, x[0])\ncall deque.get(d, x, 90)", ArrayAccessOutOfBounds),
    ],
)
def test_faults(bench, source, expected):
    bench.write(source)
    bench.send(Run(0, ID))
    faults = bench.run()
    assert [type(fault) for fault in faults] == [expected]
    assert bench.states(GetExecutionState(0, ID))[0][1] == 2
    if expected is ArrayAccessOutOfBounds:
        assert len(encode(faults[0])) == 12
    bench.send(UserMessage(0, 0, (1, 1)))
    assert bench.run() == []


def test_code_that_no_compiler_writes_is_a_specific_error_of_the_node(bench):
    bench.send(SetBytecode(0, ID, 0, (3, 0xFFFF, 3, 0xF000)), Run(0, ID))
    (fault,) = bench.run()
    assert isinstance(fault, NodeSpecificError)
    assert fault.text


def test_data_of_the_device(bench):
    assert bench.send(GetDeviceInfo(0, ID, 1)) == [DeviceInfo(ID, 1, bytes(range(16)))]
    assert bench.send(GetDeviceInfo(0, ID, 2)) == [DeviceInfo(ID, 2, b"anna")]
    assert len(bench.send(GetDeviceInfo(0, ID, 3))[0].data) == 6
    assert bench.send(GetDeviceInfo(0, ID, 9)) == []
    bench.send(SetDeviceInfo(0, ID, 2, "é".encode() * 40))
    assert bench.send(GetDeviceInfo(0, ID, 2))[0].data == "é".encode() * 27


@pytest.mark.parametrize(("name", "data"), [("red", b"red "), ("x" * 60, b"x" * 54)])
def test_a_name_has_an_even_size(bench, name, data):
    """The asebaswitch of Aseba 1.6 takes the message for a user message, and aborts if its size is odd."""
    bench.node.name = name
    assert bench.send(GetDeviceInfo(0, ID, 2)) == [DeviceInfo(ID, 2, data)]


def test_without_clients_nothing_is_collected():
    bench = Bench(client=None)
    bench.host.load(compiled("emit ping [1, 2]"))
    bench.device.run(BUDGET)
    assert bench.node.pop_messages() == []
    assert bench.node._outbox == []


def test_events_that_stay_in_the_robot_do_not_reach_the_network(bench):
    bench.host.start(MENU)
    bench.device.run(BUDGET)
    names = [name for name, _ in bench.host.program.events]
    bench.node.pop_messages()
    bench.send(UserMessage(0, names.index("menu.open"), (9, 9, 9)))
    assert not bench.device.is_busy
    bench.device.run_control.observe(Emitted(names.index("menu.start"), (1,)))
    assert bench.node.pop_messages() == []


# --- programs


def test_bytecode_becomes_a_program_with_its_disassembly(bench):
    bench.write(SOURCE)
    program = bench.host.program
    assert program.is_foreign
    assert program.name == FOREIGN
    assert "onevent timer0" in program.source
    assert "emit 1 from" in program.source
    assert program.events == (("event_0", 32), ("event_1", 1))
    pc = program.program.words[2]
    assert program.source.split("\n")[program.line_of(pc) - 1].startswith(f"{pc:5} ")


def test_events_keep_the_names_of_the_last_file(bench):
    bench.host.load(compiled("var other", EVENTS))
    bench.write(SOURCE, (*EVENTS, ("third", 1)))
    assert bench.host.program.events == EVENTS
    bench.write(SOURCE.replace("n = 0", "emit third 4"), (*EVENTS, ("third", 1)))
    assert bench.host.program.events == (*EVENTS, ("event_2", 1))


def test_a_known_program_is_recognized(bench):
    known = compiled(SOURCE)
    bench.host.load(known)
    bench.write("var x = 3")
    assert bench.host.program.is_foreign
    bench.write(SOURCE)
    assert bench.host.program is known
    bench.send(Run(0, ID))
    bench.run()
    assert bench.device.variables.get("n") == (5,)


def test_a_foreign_program_starts_again_after_a_reboot(bench):
    bench.write(SOURCE)
    bench.send(Run(0, ID))
    bench.run()
    bench.send(SetVariables(0, ID, target().variables_end, (77,)), Reboot(0, ID))
    bench.run()
    assert bench.host.program.is_foreign
    assert bench.device.variables.read(target().variables_end, 1) == (5,)


def test_a_breakpoint_at_a_line_of_the_disassembly(bench):
    bench.write(SOURCE)
    program = bench.host.program
    line = next(number for number, text in enumerate(program.source.split("\n"), 1) if "emit" in text)
    assert bench.device.run_control.set_breakpoints([line]).lines == (line,)
    bench.send(Run(0, ID))
    bench.run()
    bench.send(UserMessage(0, 0, (1, 2)))
    bench.run()
    assert bench.device.status.line == line


def test_the_last_event_of_the_menu_does_not_reach_a_program_of_the_network(bench):
    bench.host.start(MENU)
    bench.device.run(BUDGET)
    bench.write("var n\nonevent ping\nn = 1\n")
    bench.send(Run(0, ID))
    bench.run()
    assert bench.device.variables.read(target().variables_end, 1) == (0,)


@hypothesis.given(st.lists(st.integers(0, 0xFFFF), max_size=80))
@hypothesis.settings(max_examples=200)
def test_any_words_are_a_program(words):
    program = foreign_program(words)
    assert program.program.words == tuple(words)
    assert len(program.events) <= MAX_EVENTS
    for pc in range(len(words) + 3):
        line = program.line_of(pc)
        assert line is None or 1 <= line <= len(program.lines)


# --- anything

commands = st.one_of(
    any_message,
    st.builds(
        SetBytecode, st.just(0), st.just(ID), st.integers(0, 1600), st.lists(st.integers(0, 0xFFFF), max_size=40)
    ),
    st.builds(SetVariables, st.just(0), st.just(ID), st.integers(0, 700), st.lists(st.integers(-9, 9), max_size=9)),
    st.builds(GetVariables, st.just(0), st.just(ID), st.integers(0, 0xFFFF), st.integers(0, 0xFFFF)),
    st.builds(UserMessage, st.just(0), st.integers(0, 5), st.lists(st.integers(-9, 9), max_size=300).map(tuple)),
    st.builds(SetBreakpoint, st.just(0), st.just(ID), st.integers(0, 1600)),
    st.sampled_from([kind(0, ID) for kind in (Run, Pause, Step, Stop, Reset, Reboot, GetExecutionState)]),
)


@hypothesis.given(st.lists(commands, max_size=30))
@hypothesis.settings(max_examples=60, suppress_health_check=list(hypothesis.HealthCheck))
def test_no_message_breaks_a_node(sent):
    bench = Bench()
    bench.host.load(compiled(SOURCE))
    for message in sent:
        for reply in [*bench.send(message), *bench.run()]:
            assert len(encode(reply)) <= 522
        bench.device.pop_commands()
        bench.host.pop_events()
    assert bench.node.handle(CLIENT, ListNodes(0, 5)) == [NodePresent(ID, 5)]
