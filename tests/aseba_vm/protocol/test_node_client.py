"""The client's side of nodes: discovery, descriptions, variables, programs; recorded bytes of Debian's tools."""

from __future__ import annotations

from pathlib import Path

import hypothesis
import pytest
from hypothesis import strategies as st

from aseba_vm import compile
from aseba_vm.protocol import (
    ArrayAccessOutOfBounds,
    BreakpointSetResult,
    Description,
    DeviceInfo,
    Disconnected,
    DivisionByZero,
    EventExecutionKilled,
    ExecutionStateChanged,
    FrameReader,
    GetDeviceInfo,
    GetNodeDescription,
    GetVariables,
    ListNodes,
    LocalEventDescription,
    Message,
    NamedVariable,
    NativeFunctionDescription,
    NodeClient,
    NodePresent,
    NodeSpecificError,
    Run,
    SetBytecode,
    SetVariables,
    UserMessage,
    Variables,
    decode,
    reports,
)
from aseba_vm.protocol.reports import ExecutionState
from aseba_vm.protocol.requests import read_ranges, set_bytecode, set_variables
from aseba_vm.target import LocalEvent, NativeFunction, Parameter, TargetDescription, Variable
from tests.aseba_vm.protocol.strategies import messages

RECORDED = Path(__file__).parents[2] / "data" / "network" / "playground_description.bin"
"""What Debian's Aseba Playground answers to LIST_NODES and GET_NODE_DESCRIPTION of version 5."""
HALF = bytes.fromhex("1a00 0100 0090 0b64756d6d796e6f64652d30 0500 0002 4000 2404 0000 0100 1e00")
"""What Debian's asebadummynode answers to GET_NODE_DESCRIPTION before it crashes."""

SECOND_NS = 1_000_000_000
TARGET = TargetDescription(
    "small",
    64,
    512,
    16,
    (Variable("a", 1), Variable("b", 3), Variable("c", 2)),
    (LocalEvent("tick", "now and then"),),
    (NativeFunction("beep", (Parameter("hertz", 1),), "beeps"),),
)


def described(target: TargetDescription, node: int = 1, version: int = 5) -> list[Message]:
    """The messages by which a node describes itself."""
    counts = len(target.variables), len(target.local_events), len(target.natives)
    sizes = target.bytecode_size, target.stack_size, target.variables_size
    return [
        Description(node, target.name, version, *sizes, *counts),
        *(NamedVariable(node, variable.size, variable.name) for variable in target.variables),
        *(LocalEventDescription(node, event.name, event.description) for event in target.local_events),
        *(NativeFunctionDescription(node, one.name, one.description, one.parameters) for one in target.natives),
    ]


def received(client: NodeClient, *arriving: Message) -> list[reports.Report]:
    return [report for message in arriving for report in client.receive(message)]


@pytest.fixture
def client() -> NodeClient:
    """A client with node 1, which is `TARGET`; all messages are sent."""
    client = NodeClient()
    client.start(0)
    received(client, NodePresent(1, 5), *described(TARGET))
    client.pop_messages()
    return client


def test_a_node_is_found_and_described() -> None:
    client = NodeClient(source=7, version=5)
    client.start(0)
    assert client.pop_messages() == [ListNodes(7, 5)]
    assert client.receive(NodePresent(3, 5)) == []
    assert client.pop_messages() == [GetNodeDescription(7, 3, 5)]
    assert received(client, *described(TARGET, 3)) == [reports.NodeConnected(3)]
    assert client.nodes[3].description == TARGET
    assert client.nodes[3].addresses == {"a": (0, 1), "b": (1, 3), "c": (4, 2)}


def test_the_recorded_description_of_the_playground_is_complete() -> None:
    client = NodeClient()
    client.start(0)
    found = received(client, *map(decode, FrameReader().feed(RECORDED.read_bytes())))
    assert found == [reports.NodeConnected(1)]
    target = client.nodes[1].description
    assert (target.name, target.variables_size, target.bytecode_size) == ("thymio-II", 586, 1534)
    assert (len(target.variables), len(target.local_events), len(target.natives)) == (30, 17, 52)
    assert target.addresses["motor.left.target"] == (57, 1)
    assert compile("call leds.top(32, 0, 0)\nonevent prox\nmotor.left.target = 3", target).words


def test_a_node_without_anything_is_complete_at_once() -> None:
    client = NodeClient()
    assert received(client, *described(TargetDescription("bare", 4, 4, 4))) == [reports.NodeConnected(1)]


def test_nodes_are_listed_every_second() -> None:
    client = NodeClient()
    client.start(0)
    sent = []
    for tenth in range(25):
        client.advance(tenth * SECOND_NS // 10)
        sent += client.pop_messages()
    assert sent == [ListNodes(0, 9)] * 3


def test_a_silent_node_is_gone_and_may_come_back(client: NodeClient) -> None:
    client.advance(2 * SECOND_NS)
    client.receive(UserMessage(1, 0))  # events alone may come from another client with the same number
    assert client.advance(3 * SECOND_NS) == [reports.NodeDisconnected(1, "no answer for 3 s")]
    assert not client.nodes
    client.pop_messages()
    client.receive(NodePresent(1, 5))
    assert client.pop_messages() == [GetNodeDescription(0, 1, 9)]


def test_a_node_that_answers_stays(client: NodeClient) -> None:
    for second in range(1, 10):
        assert client.advance(second * SECOND_NS) == []
        client.receive(NodePresent(1, 5))
    assert list(client.nodes) == [1]


def test_a_node_leaves(client: NodeClient) -> None:
    assert client.receive(Disconnected(1)) == [reports.NodeDisconnected(1, "it has left the network")]
    assert client.receive(Disconnected(1)) == []


def test_the_end_of_the_stream_ends_all_nodes(client: NodeClient) -> None:
    received(client, *described(TARGET, 2))
    assert client.end("cable pulled") == [
        reports.NodeDisconnected(1, "cable pulled"),
        reports.NodeDisconnected(2, "cable pulled"),
    ]
    assert (dict(client.nodes), client.pop_messages()) == ({}, [])


def test_a_node_that_crashes_in_its_description_is_reported() -> None:
    client = NodeClient()
    client.start(0)
    client.receive(NodePresent(1, 5))
    assert received(client, *map(decode, FrameReader().feed(HALF))) == []
    assert client.end("closed by the robot") == [
        reports.NodeUnusable(
            1,
            "closed by the robot before its description was complete: 0 of 1 local events, 0 of 30 native functions",
        )
    ]


def test_a_description_that_stops_is_requested_again_and_reported_once() -> None:
    client = NodeClient()
    client.start(0)
    received(client, NodePresent(1, 5), *described(TARGET)[:3])
    client.pop_messages()
    found, asked = [], 0
    for second in range(1, 8):
        client.receive(NodePresent(1, 5))
        found += client.advance(second * SECOND_NS)
        asked += client.pop_messages().count(GetNodeDescription(0, 1, 9))
    missing = "2 of 3 variables, 0 of 1 local events, 0 of 1 native functions"
    assert found == [reports.NodeUnusable(1, f"its description has stopped: {missing}")]
    assert asked == 3
    assert received(client, *described(TARGET)) == [reports.NodeConnected(1)]


def test_items_before_the_description_are_not_part_of_it() -> None:
    client = NodeClient()
    client.receive(NodePresent(1, 5))
    client.receive(NamedVariable(1, 9, "stray"))
    assert received(client, *described(TARGET)) == [reports.NodeConnected(1)]
    assert client.nodes[1].description == TARGET


def test_a_description_for_another_client_changes_nothing(client: NodeClient) -> None:
    client.receive(Variables(1, 0, (5,)))
    assert received(client, *described(TARGET)) == []
    assert client.nodes[1].value("a") == (5,)


def test_another_description_connects_the_node_again(client: NodeClient) -> None:
    other = TargetDescription("other", 8, 8, 8, (Variable("z", 1),))
    assert received(client, *described(other)) == [reports.NodeConnected(1)]
    assert list(client.nodes[1].addresses) == ["z"]


def test_variables_that_do_not_fit_the_memory_are_refused() -> None:
    wrong = TargetDescription("wrong", 2, 8, 8, (Variable("z", 3),))
    client = NodeClient()
    assert received(client, *described(wrong)) == [
        reports.NodeUnusable(1, "describes 3 words of variables, more than its 2")
    ]
    assert not client.nodes


def test_values_are_unknown_until_they_are_read(client: NodeClient) -> None:
    node = client.nodes[1]
    client.read(1)
    assert client.pop_messages() == [GetVariables(0, 1, 0, 6)]
    assert node.is_reading
    assert node.value("b") is None
    found = client.receive(Variables(1, 0, (1, 2, 3, 4, 0, 0)))
    assert found == [reports.VariablesRead(1, 0, (1, 2, 3, 4, 0, 0), ("a", "b", "c"))]
    assert not node.is_reading
    assert node.values() == {"a": (1,), "b": (2, 3, 4), "c": (0, 0)}


def test_changed_variables_are_named(client: NodeClient) -> None:
    client.receive(Variables(1, 0, (1, 2, 3, 4, 0, 0)))
    assert client.receive(Variables(1, 2, (3, 9, 7))) == [reports.VariablesRead(1, 2, (3, 9, 7), ("b", "c"))]
    assert client.receive(Variables(1, 2, (3, 9, 7))) == [reports.VariablesRead(1, 2, (3, 9, 7))]


def test_a_reply_in_pieces_is_one_read(client: NodeClient) -> None:
    client.read(1)
    client.receive(Variables(1, 0, (1, 2)))
    assert client.nodes[1].is_reading
    client.receive(Variables(1, 2, (3, 4, 5, 6)))
    assert not client.nodes[1].is_reading


def test_a_read_without_reply_times_out(client: NodeClient) -> None:
    client.read(1, ["c"])
    client.advance(2 * SECOND_NS)
    client.receive(NodePresent(1, 5))
    assert client.advance(3 * SECOND_NS + 1) == [reports.RequestTimedOut(1, GetVariables(0, 1, 4, 2))]
    assert not client.nodes[1].is_reading


def test_values_outside_the_memory_are_dropped(client: NodeClient) -> None:
    assert client.receive(Variables(1, 60, (1,) * 10)) == [reports.VariablesRead(1, 60, (1,) * 10)]
    assert client.receive(Variables(1, 65535, (1,))) == [reports.VariablesRead(1, 65535, (1,))]


def test_a_written_variable_has_its_value_at_once(client: NodeClient) -> None:
    client.receive(Variables(1, 0, (0,) * 6))
    client.write(1, "b", [7, 8])
    assert client.pop_messages() == [SetVariables(0, 1, 1, (7, 8))]
    assert client.nodes[1].value("b") == (7, 8, 0)
    with pytest.raises(ValueError, match="b: found 4 words, expected at most 3"):
        client.write(1, "b", [1] * 4)
    with pytest.raises(KeyError):
        client.write(1, "nothing", [1])


def test_an_answer_that_is_older_than_a_write_does_not_undo_it(client: NodeClient) -> None:
    node = client.nodes[1]
    client.read(1)
    client.write(1, "b", [7, 8])
    client.read(1)
    client.receive(Variables(1, 0, (1, 2)))
    client.receive(Variables(1, 2, (3, 4, 5, 6)))
    assert node.values() == {"a": (1,), "b": (7, 8, 4), "c": (5, 6)}
    found = client.receive(Variables(1, 0, (1, 9, 9, 4, 5, 6)))
    assert found == [reports.VariablesRead(1, 0, (1, 9, 9, 4, 5, 6), ("b",))]
    assert node.value("b") == (9, 9, 4)


def test_a_program_is_loaded_and_its_variables_are_known(client: NodeClient) -> None:
    program = compile("var n = 3\nvar m[2]\nonevent tick\nn++", TARGET)
    client.load(1, program)
    client.send(Run(0, 1))
    assert client.pop_messages() == [SetBytecode(0, 1, 0, tuple(program.words)), Run(0, 1)]
    state = ExecutionState(5, 3)
    assert client.receive(ExecutionStateChanged(1, 5, 3)) == [
        reports.StateReported(1, state),
        reports.ProgramLoaded(1),
    ]
    assert (client.nodes[1].state, state.is_active, state.is_step_by_step) == (state, True, True)
    client.read(1, ["n", "m"])
    assert client.pop_messages() == [GetVariables(0, 1, 6, 3)]


def test_a_long_program_is_confirmed_by_all_its_parts(client: NodeClient) -> None:
    client.load(1, compile("var n\n" + "n = n + 1\n" * 100, TARGET))
    assert [len(part.words) for part in client.pop_messages() if isinstance(part, SetBytecode)] == [256, 148]
    first = client.receive(ExecutionStateChanged(1, 0, 2))
    assert reports.ProgramLoaded(1) not in first
    assert reports.ProgramLoaded(1) in client.receive(ExecutionStateChanged(1, 0, 2))


@pytest.mark.parametrize("confirmed", [0, 1])
def test_a_program_that_is_not_confirmed_times_out(client: NodeClient, confirmed: int) -> None:
    client.load(1, compile("var n\n" + "n = n + 1\n" * 100, TARGET))
    last = client.pop_messages()[-1]
    received(client, *[ExecutionStateChanged(1, 0, 2)] * confirmed)
    client.advance(2 * SECOND_NS)
    client.receive(NodePresent(1, 5))
    expected = reports.ProgramLoaded(1) if confirmed else reports.RequestTimedOut(1, last)
    assert client.advance(3 * SECOND_NS) == [expected]


@pytest.mark.parametrize(
    "fault", [DivisionByZero(1, 4), ArrayAccessOutOfBounds(1, 4, 2, -1), NodeSpecificError(1, 4, "no card")]
)
def test_a_fault_stops_the_machine(client: NodeClient, fault: DivisionByZero) -> None:
    assert client.receive(fault) == [reports.FaultReported(1, fault)]
    assert client.nodes[1].state == ExecutionState(4, 2)


def test_a_killed_handler_leaves_the_machine_running(client: NodeClient) -> None:
    client.receive(ExecutionStateChanged(1, 0, 1))
    assert client.receive(EventExecutionKilled(1, 4)) == [reports.FaultReported(1, EventExecutionKilled(1, 4))]
    assert client.nodes[1].state == ExecutionState(0, 1)


def test_other_replies_are_reported(client: NodeClient) -> None:
    client.send(GetDeviceInfo(0, 1, 2))
    assert client.receive(DeviceInfo(1, 2, b"Ann")) == [reports.DeviceInfoReceived(1, 2, b"Ann")]
    assert client.receive(BreakpointSetResult(1, 8, 1)) == [reports.BreakpointReported(1, 8, True)]
    assert client.receive(UserMessage(1, 3, (1, -2))) == [reports.EventReceived(1, 3, (1, -2))]


def test_messages_of_unknown_nodes_and_other_clients_are_ignored(client: NodeClient) -> None:
    arriving = (Variables(9, 0, (1,)), ListNodes(1, 5), GetNodeDescription(0, 9, 5), SetVariables(1, 1, 0, (9,)))
    assert received(client, *arriving) == []
    assert client.pop_messages() == []
    assert client.nodes[1].value("a") is None


places = st.lists(st.tuples(st.integers(0, 2000), st.integers(0, 600)), max_size=30)


@hypothesis.given(places)
def test_reads_cover_all_places_and_cut_only_long_ones(wanted: list[tuple[int, int]]) -> None:
    asked = [(message.start, message.start + message.count) for message in read_ranges(1, wanted)]
    assert all(0 < end - start <= 256 for start, end in asked)
    covered = {address for start, end in asked for address in range(start, end)}
    assert covered == {address for start, size in wanted for address in range(start, start + size)}
    alone = [(start, start + size) for start, size in wanted if 0 < size <= 256]
    overlapping = any(a != b and a[0] < b[1] and b[0] < a[1] for a in alone for b in alone)
    long = any(size > 256 for _, size in wanted)
    if not overlapping and not long:
        assert all(any(start <= begin and end <= stop for start, stop in asked) for begin, end in alone)


@hypothesis.given(st.lists(st.integers(-0x8000, 0x7FFF), max_size=900), st.integers(0, 2000))
def test_long_writes_and_programs_arrive_whole(values: list[int], start: int) -> None:
    memory = dict[int, int]()
    for message in set_variables(1, start, values):
        assert len(message.values) <= 256
        memory |= dict(enumerate(message.values, message.start))
    assert [memory[start + index] for index in range(len(values))] == values
    parts = set_bytecode(1, [value & 0xFFFF for value in values])
    assert [word for part in parts for word in part.words] == [value & 0xFFFF for value in values]
    assert parts[0].start == 0


@hypothesis.given(st.lists(messages, max_size=30), st.integers(0, 255))
def test_no_message_does_harm(arriving: list[Message], step: int) -> None:
    client = NodeClient()
    client.start(0)
    received(client, *described(TARGET, 1))
    for index, message in enumerate(arriving):
        client.receive(message)
        client.advance(index * step * SECOND_NS // 100)
    assert all(node.description.variables_end <= node.description.variables_size for node in client.nodes.values())
    client.end("over")
    assert not client.nodes
