"""What clients watch and change: variables, events, shared variables, scratchpads."""

from __future__ import annotations

from uuid import UUID

import pytest
from flatbuffers import flexbuffers

from aseba_vm import protocol as p
from tests.network.tdm.machine_node import MachineNode
from tests.network.tdm.talk import Talk, values
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.constants import ErrorCode, VMState, Watch
from thymio_sim_ros.network.tdm.protocol.values import NO_VALUE, encode_value

GROUP, NODE = UUID(int=1), UUID(int=2)


@pytest.fixture
def talk() -> Talk:
    """One node; client 1 has locked it, client 2 is connected."""
    talk = Talk(MachineNode())
    talk.join(1)
    talk.join(2)
    talk.ask(1, m.LockNode, NODE)
    talk.received.clear()
    return talk


def _named(**named: tuple[int, ...]) -> tuple[m.NamedValue, ...]:
    return tuple(m.NamedValue(name.replace("_", "."), encode_value(words)) for name, words in named.items())


def test_a_watch_of_variables_begins_with_all_of_them_in_order_of_their_names(talk: Talk) -> None:
    assert isinstance(talk.ask(2, m.WatchNode, NODE, Watch.VARIABLES), m.RequestCompleted)
    dump, completed = talk.received[2]
    assert isinstance(completed, m.RequestCompleted)
    names = [value.name for value in dump.vars]
    assert names == sorted(talk.networks[0][0].vm.target.addresses)
    assert values(dump)["prox.horizontal"] == (0,) * 7


def test_then_only_changes_are_sent_every_tenth_of_a_second(talk: Talk) -> None:
    talk.ask(2, m.WatchNode, NODE, Watch.VARIABLES)
    talk.received.clear()
    talk.advance(300)
    assert talk.received[2] == []
    talk.networks[0][0].handle(p.SetVariables(5, 1, talk.networks[0][0].vm.target.addresses["acc"][0], (1, -2, 300)))
    talk.advance(300)
    assert [values(message) for message in talk.take(2, m.VariablesChanged)] == [{"acc": (1, -2, 300)}]
    assert talk.received[1] == []


def test_nothing_is_requested_from_a_node_that_nobody_watches(talk: Talk) -> None:
    asked: list[p.Message] = []
    node = talk.networks[0][0]
    handle = node.handle
    node.handle = lambda message: asked.append(message) or handle(message)  # type: ignore[func-returns-value]
    talk.advance(3000)
    assert {type(message) for message in asked} == {p.ListNodes}
    talk.ask(2, m.WatchNode, NODE, Watch.VARIABLES)
    talk.ask(2, m.WatchNode, NODE, Watch.NONE)
    asked.clear()
    talk.advance(3000)
    assert {type(message) for message in asked} == {p.ListNodes}


def test_written_variables_reach_the_node_and_those_that_watch(talk: Talk) -> None:
    talk.ask(2, m.WatchNode, NODE, Watch.VARIABLES)
    talk.received.clear()
    sent = _named(motor_left_target=(-300,), leds_top=(1, 2, 3))
    sent = tuple(m.NamedValue(value.name.replace("leds.top", "acc"), value.value) for value in sent)
    assert isinstance(talk.ask(1, m.SetVariables, NODE, sent), m.RequestCompleted)
    assert talk.networks[0][0].value("motor.left.target") == (-300,)
    talk.advance(200)
    assert values(talk.take(2, m.VariablesChanged)[0]) == {"motor.left.target": (-300,), "acc": (1, 2, 3)}


@pytest.mark.parametrize(
    "value",
    [
        m.NamedValue("no.such", encode_value((1,))),
        m.NamedValue("acc", encode_value((1,))),
        m.NamedValue("acc", bytes(flexbuffers.Dumps("text"))),
        m.NamedValue("acc", b""),
    ],
)
def test_a_wrong_variable_is_rejected_and_none_is_written(talk: Talk, value: m.NamedValue) -> None:
    sent = (*_named(motor_left_target=(5,)), value)
    assert talk.ask(1, m.SetVariables, NODE, sent).error == ErrorCode.UNSUPPORTED_VARIABLE_TYPE
    assert talk.networks[0][0].value("motor.left.target") == (0,)


def test_only_the_locker_writes(talk: Talk) -> None:
    assert talk.ask(2, m.SetVariables, NODE, _named(acc=(1, 2, 3))).error == ErrorCode.UNKNOWN_NODE


def test_events_are_registered_and_shown_to_those_that_watch_them(talk: Talk) -> None:
    talk.ask(2, m.WatchNode, NODE, Watch.SHARED_EVENTS)
    assert talk.take(2, m.EventsDescriptionsChanged) == [m.EventsDescriptionsChanged(GROUP)]
    table = (m.EventDescription("go", 2), m.EventDescription("halt", 0))
    assert isinstance(talk.ask(1, m.RegisterEvents, NODE, table), m.RequestCompleted)
    (shown,) = talk.take(2, m.EventsDescriptionsChanged)
    assert shown.events == (m.EventDescription("go", 2, 0), m.EventDescription("halt", 0, 1))
    assert isinstance(talk.ask(1, m.RegisterEvents, GROUP, ()), m.RequestCompleted)
    assert talk.take(2, m.EventsDescriptionsChanged)[0].events == ()


@pytest.mark.parametrize(
    "table",
    [
        (m.EventDescription("go"), m.EventDescription("go")),
        (m.EventDescription(""),),
        (m.EventDescription("go", 259),),
        tuple(m.EventDescription(f"e{number}") for number in range(1001)),
    ],
)
def test_an_impossible_table_is_rejected_and_the_old_one_stays(talk: Talk, table: tuple[object, ...]) -> None:
    talk.ask(1, m.RegisterEvents, NODE, (m.EventDescription("old", 1),))
    assert talk.ask(1, m.RegisterEvents, NODE, table).error == ErrorCode.UNKNOWN
    talk.ask(2, m.WatchNode, GROUP, Watch.SHARED_EVENTS)
    assert [event.name for event in talk.take(2, m.EventsDescriptionsChanged)[0].events] == ["old"]


def test_events_of_clients_reach_the_program(talk: Talk) -> None:
    talk.ask(1, m.RegisterEvents, NODE, (m.EventDescription("other"), m.EventDescription("go", 2)))
    talk.load(1, NODE, "onevent go\nmotor.left.target = event.args[0] + event.args[1]\nmotor.right.target = 1")
    node = talk.networks[0][0]
    node.handle(p.Run(0, 1))
    node.run()
    sent = (m.NamedValue("unknown", encode_value(())), m.NamedValue("go", encode_value((100, -30))))
    assert isinstance(talk.ask(1, m.SendEvents, GROUP, sent), m.RequestCompleted)
    node.run()
    assert node.value("motor.left.target") == (70,)


@pytest.mark.parametrize("value", [encode_value((1,)), encode_value((1, 2, 3)), NO_VALUE, b"", b"\xff" * 9])
def test_an_event_of_another_size_is_rejected(talk: Talk, value: bytes) -> None:
    talk.ask(1, m.RegisterEvents, NODE, (m.EventDescription("go", 2),))
    error = talk.ask(1, m.SendEvents, NODE, (m.NamedValue("go", value),)).error
    assert error == ErrorCode.UNSUPPORTED_VARIABLE_TYPE


def test_emitted_events_reach_those_that_watch_the_node(talk: Talk) -> None:
    talk.ask(1, m.RegisterEvents, NODE, (m.EventDescription("ready"), m.EventDescription("seen", 2)))
    talk.ask(2, m.WatchNode, NODE, Watch.EVENTS)
    talk.received.clear()
    talk.from_node(0, [p.UserMessage(1, 1, (5, -6)), p.UserMessage(1, 0)])
    talk.exchange()
    assert [values(message) for message in talk.take(2, m.EventsEmitted)] == [{"seen": (5, -6)}, {"ready": ()}]
    assert talk.received[1] == []


def test_events_without_a_name_or_with_another_size_are_not_shown(talk: Talk) -> None:
    talk.ask(1, m.RegisterEvents, NODE, (m.EventDescription("seen", 2),))
    talk.ask(2, m.WatchNode, NODE, Watch.EVENTS)
    talk.received.clear()
    talk.from_node(0, [p.UserMessage(1, 0, (1,)), p.UserMessage(1, 7), p.UserMessage(99, 0, (1, 2))])
    talk.exchange()
    assert talk.received[2] == []


def test_shared_variables_reach_those_that_watch_them(talk: Talk) -> None:
    talk.ask(2, m.WatchNode, NODE, Watch.SHARED_VARIABLES)
    assert talk.take(2, m.VariablesChanged) == [m.VariablesChanged(GROUP)]
    text = m.NamedValue("label", bytes(flexbuffers.Dumps("any form")))
    assert isinstance(talk.ask(1, m.SetVariables, GROUP, (text, *_named(SPEED=(7,)))), m.RequestCompleted)
    (shown,) = talk.take(2, m.VariablesChanged)
    assert (shown.node_id, shown.vars) == (GROUP, (*_named(SPEED=(7,)), text))
    talk.ask(1, m.SetVariables, GROUP, (m.NamedValue("label", NO_VALUE),))
    assert talk.take(2, m.VariablesChanged)[0].vars == _named(SPEED=(7,))


def test_shared_variables_are_limited(talk: Talk) -> None:
    large = tuple(m.NamedValue(f"v{number}", b"\4" * 20_000) for number in range(6))
    assert talk.ask(1, m.SetVariables, GROUP, large).error == ErrorCode.UNSUPPORTED_VARIABLE_TYPE


def test_shared_integers_are_constants_of_programs(talk: Talk) -> None:
    talk.ask(1, m.SetVariables, GROUP, _named(SPEED=(7,), LIST=(1, 2)))
    assert isinstance(talk.load(1, NODE, "motor.left.target = SPEED * 2"), m.CompilationResultSuccess)
    assert isinstance(talk.load(1, NODE, "motor.left.target = LIST"), m.CompilationResultFailure)


def test_scratchpads_are_kept_for_other_clients(talk: Talk) -> None:
    talk.ask(2, m.WatchNode, NODE, Watch.SCRATCHPADS)
    talk.received.clear()
    answer = talk.ask(1, m.ScratchpadUpdate, NODE, None, NODE, 1, "var a", "mine")
    assert isinstance(answer, m.RequestCompleted)
    kept = m.ScratchpadUpdate(0, NODE, GROUP, NODE, 1, "var a", "mine")
    assert talk.take(2, m.ScratchpadUpdate) == [kept]
    talk.join(3)
    talk.ask(3, m.WatchNode, NODE, Watch.SCRATCHPADS)
    assert talk.take(3, m.ScratchpadUpdate) == [kept]
    assert talk.ask(2, m.ScratchpadUpdate, NODE, None, NODE, 1, "var b").error == ErrorCode.UNKNOWN_NODE
    talk.ask(1, m.ScratchpadUpdate, NODE, None, NODE, 1, "", "", True)
    assert talk.take(2, m.ScratchpadUpdate)[0].deleted
    talk.join(4)
    talk.ask(4, m.WatchNode, NODE, Watch.SCRATCHPADS)
    assert talk.take(4, m.ScratchpadUpdate) == []


def test_flags_replace_those_of_the_node_and_leave_those_of_the_group(talk: Talk) -> None:
    talk.ask(2, m.WatchNode, NODE, Watch.EVENTS | Watch.SHARED_EVENTS)
    talk.ask(2, m.WatchNode, NODE, Watch.VM_STATE)
    talk.received.clear()
    talk.ask(1, m.RegisterEvents, NODE, (m.EventDescription("seen"),))
    talk.from_node(0, [p.UserMessage(1, 0), p.ExecutionStateChanged(1, 0, 2)])
    talk.exchange()
    assert [type(message) for message in talk.received[2]] == [m.EventsDescriptionsChanged, m.VMExecutionStateChanged]
    talk.ask(2, m.WatchNode, GROUP, Watch.NONE)
    talk.received.clear()
    talk.ask(1, m.RegisterEvents, NODE, ())
    assert talk.received[2] == []


def test_a_watch_of_the_machine_begins_with_its_state(talk: Talk) -> None:
    talk.from_node(0, [p.ExecutionStateChanged(1, 0, 0)])
    talk.ask(2, m.WatchNode, NODE, Watch.VM_STATE)
    assert talk.take(2, m.VMExecutionStateChanged) == [m.VMExecutionStateChanged(NODE, VMState.RUNNING)]


def test_a_slow_client_gets_all_variables_once_instead_of_all_changes(talk: Talk) -> None:
    talk.ask(2, m.WatchNode, NODE, Watch.VARIABLES)
    talk.received.clear()
    talk.manager.set_congested(2, is_congested=True)
    node = talk.networks[0][0]
    for number in range(5):
        node.handle(p.SetVariables(5, 1, node.vm.target.addresses["acc"][0], (number,)))
        talk.advance(100)
    assert talk.take(2, m.VariablesChanged) == []
    talk.manager.set_congested(2, is_congested=False)
    talk.exchange()
    (dump,) = talk.take(2, m.VariablesChanged)
    assert values(dump)["acc"] == (4, 0, 0)
    assert len(dump.vars) == len(node.vm.target.addresses)


def test_a_node_that_does_not_answer_completes_the_watch_with_what_is_known(talk: Talk) -> None:
    talk.is_silent = True
    talk.send(2, m.WatchNode(9, NODE, Watch.VARIABLES))
    assert talk.received[2] == []
    talk.advance(4000)
    answers = [message for message in talk.received[2] if getattr(message, "request_id", None) == 9]
    assert len(answers) == 1


def test_many_requests_for_all_variables_are_answered_by_one_dump(talk: Talk) -> None:
    talk.is_silent = True
    for number in range(1, 201):
        talk.send(2, m.WatchNode(number, NODE, Watch.VARIABLES))
    talk.is_silent = False
    talk.advance(4000)
    assert len(talk.take(2, m.RequestCompleted)) == 200
    assert len(talk.take(2, m.VariablesChanged)) <= 2  # what was known, and what arrived later
