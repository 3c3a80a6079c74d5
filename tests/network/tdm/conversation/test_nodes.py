"""Handshake, list of nodes, locks, descriptions, names, pings."""

from __future__ import annotations

from uuid import UUID

import pytest

from aseba_vm import targets
from tests.network.tdm.machine_node import MachineNode
from tests.network.tdm.talk import Talk
from thymio_sim_ros.network.tdm.conversation.handshake import ManagerSettings
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.constants import ErrorCode, NodeType, Status

GROUP, NODE = UUID(int=1), UUID(int=2)
UNKNOWN = UUID(int=999)


def _statuses(talk: Talk, client: int) -> list[int]:
    return [node.status for message in talk.take(client, m.NodesChanged) for node in message.nodes]


def test_a_handshake_is_answered_and_followed_by_all_nodes() -> None:
    talk = Talk(MachineNode(), MachineNode(), settings=ManagerSettings(UUID(int=7), ws_port=8597))
    talk.join(1)
    hello, nodes = talk.received[1]
    assert hello == m.ConnectionHandshake(1, 1, 102400, b"", True, 8597, UUID(int=7))
    assert isinstance(nodes, m.NodesChanged)
    first, second = nodes.nodes
    assert first == m.Node(NODE, GROUP, Status.AVAILABLE, NodeType.SIMULATED_THYMIO, "thymio_0", 3, "0", "0")
    assert (second.node_id, second.group_id, second.name) == (UUID(int=4), UUID(int=3), "thymio_1")


def test_a_client_on_another_computer_gets_no_capabilities() -> None:
    talk = Talk(MachineNode())
    talk.join(1, is_local=False)
    (nodes,) = talk.take(1, m.NodesChanged)
    assert nodes.nodes[0].capabilities == 0


@pytest.mark.parametrize(
    ("message", "reason"),
    [
        (m.RequestListOfNodes(), "expected a handshake first, found RequestListOfNodes"),
        (m.ConnectionHandshake(2, 3), "expected version 1 of the protocol, found 2 to 3"),
        (m.ConnectionHandshake(0, 0), "expected version 1 of the protocol, found 0 to 0"),
    ],
)
def test_other_first_messages_end_the_connection(message: m.Message, reason: str) -> None:
    talk = Talk(MachineNode())
    talk.manager.join(1, is_local=True)
    talk.send(1, message)
    assert talk.closed == {1: reason}
    assert talk.received[1] == []


def test_other_computers_need_the_password() -> None:
    talk = Talk(MachineNode(), settings=ManagerSettings(password="sésame"))
    talk.join(1, is_local=False, password="wrong")
    talk.join(2, is_local=False)
    talk.join(3, is_local=False, password="sésame")
    talk.join(4)
    assert talk.closed == dict.fromkeys((1, 2), "wrong or missing password")
    assert [bool(talk.take(client, m.NodesChanged)) for client in (1, 2, 3, 4)] == [False, False, True, True]


def test_the_password_is_not_told_to_clients_that_do_not_know_it() -> None:
    talk = Talk(MachineNode(), settings=ManagerSettings(password="secret"))
    talk.join(1)
    assert talk.take(1, m.ConnectionHandshake)[0].password == ""


def test_a_silent_client_is_disconnected() -> None:
    talk = Talk(MachineNode())
    talk.manager.join(1, is_local=True)
    talk.join(2)
    talk.advance(10_000)
    assert talk.closed == {1: "no handshake within 10 s"}


def test_clients_are_pinged_every_two_and_a_half_seconds() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    talk.advance(10_000)
    assert len(talk.take(1, m.Ping)) == 4


def test_the_list_of_nodes_can_be_requested() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    talk.take(1, m.NodesChanged)
    talk.send(1, m.RequestListOfNodes())
    assert [node.name for node in talk.take(1, m.NodesChanged)[0].nodes] == ["thymio_0"]


def test_a_lock_is_seen_by_all_clients_and_excludes_the_others() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    talk.join(2)
    _statuses(talk, 1), _statuses(talk, 2)
    assert isinstance(talk.ask(1, m.LockNode, NODE), m.RequestCompleted)
    assert (_statuses(talk, 1), _statuses(talk, 2)) == ([Status.READY], [Status.BUSY])
    assert talk.ask(2, m.LockNode, NODE).error == ErrorCode.NODE_BUSY
    assert talk.ask(2, m.UnlockNode, NODE).error == ErrorCode.UNKNOWN_NODE
    assert isinstance(talk.ask(1, m.UnlockNode, NODE), m.RequestCompleted)
    assert (_statuses(talk, 1), _statuses(talk, 2)) == ([Status.AVAILABLE], [Status.AVAILABLE])
    assert isinstance(talk.ask(2, m.LockNode, NODE), m.RequestCompleted)


def test_a_closed_connection_gives_its_nodes_back() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    talk.join(2)
    talk.ask(1, m.LockNode, NODE)
    _statuses(talk, 2)
    talk.manager.leave(1)
    talk.exchange()
    assert _statuses(talk, 2) == [Status.AVAILABLE]


@pytest.mark.parametrize(
    "kind", [m.LockNode, m.UnlockNode, m.WatchNode, m.SendEvents, m.SetVariables, m.RegisterEvents]
)
def test_requests_for_unknown_nodes_are_rejected(kind: type[m.Message]) -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    assert talk.ask(1, kind, UNKNOWN).error == ErrorCode.UNKNOWN_NODE


@pytest.mark.parametrize("kind", [m.FirmwareUpgradeRequest, m.DonglePairingRequest, m.CompileAndSave])
def test_requests_that_are_not_supported_are_rejected(kind: type[m.Message]) -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    talk.ask(1, m.LockNode, NODE)
    assert talk.ask(1, kind, NODE).error == ErrorCode.UNKNOWN


def test_a_client_cannot_end_the_simulator() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    talk.send(1, m.DeviceManagerShutdownRequest(5))
    assert talk.take(1, m.Error) == [m.Error(5, ErrorCode.UNKNOWN)]


def test_a_node_is_described_without_a_lock() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    found = talk.ask(1, m.RequestNodeAsebaVMDescription, NODE)
    target = targets.THYMIO_II
    assert (found.bytecode_size, found.data_size, found.stack_size) == (1534, target.variables_size, 32)
    addresses = {variable.name: (variable.index, variable.size) for variable in found.variables}
    assert addresses == target.addresses
    assert [event.name for event in found.events] == [event.name for event in target.local_events]
    fill = next(function for function in found.functions if function.name == "math.fill")
    assert [(part.name, part.size) for part in fill.parameters] == [("dest", 2**32 - 1), ("value", 1)]


def test_an_unknown_node_is_not_described() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    before = list(talk.received[1])
    talk.send(1, m.RequestNodeAsebaVMDescription(3, UNKNOWN))
    assert talk.received[1] == before


def test_a_new_name_reaches_the_node_and_all_clients() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    talk.join(2, is_local=False)
    talk.take(2, m.NodesChanged)
    assert talk.ask(2, m.RenameNode, NODE, "mine").error == ErrorCode.UNKNOWN_NODE
    assert talk.ask(1, m.RenameNode, NODE, "n" * 56).error == ErrorCode.UNKNOWN_NODE
    assert talk.ask(1, m.RenameNode, NODE, "\x1b\x07\n").error == ErrorCode.UNKNOWN_NODE
    assert isinstance(talk.ask(1, m.RenameNode, NODE, "\x1b[2JÉ\nm\x9bil\u202e"), m.RequestCompleted)
    assert talk.networks[0][0].name == talk.take(2, m.NodesChanged)[0].nodes[0].name == "[2JÉmil"
    assert isinstance(talk.ask(1, m.RenameNode, NODE, "Émile"), m.RequestCompleted)
    assert talk.networks[0][0].name == "Émile"
    assert talk.take(2, m.NodesChanged)[0].nodes[0].name == "Émile"


def test_a_node_that_falls_silent_is_disconnected_and_keeps_its_id_when_it_returns() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    talk.ask(1, m.LockNode, NODE)
    _statuses(talk, 1)
    talk.is_silent = True
    talk.advance(4000)
    assert _statuses(talk, 1) == [Status.DISCONNECTED]
    assert talk.ask(1, m.LockNode, NODE).error == ErrorCode.UNKNOWN_NODE
    talk.is_silent = False
    talk.advance(2000)
    (nodes, *_) = talk.take(1, m.NodesChanged)
    assert (nodes.nodes[0].node_id, nodes.nodes[0].status) == (NODE, Status.AVAILABLE)


def test_the_nodes_of_one_network_form_a_group() -> None:
    talk = Talk()
    talk.add_network([MachineNode(1), MachineNode(2)])
    talk.join(1)
    nodes = talk.take(1, m.NodesChanged)[0].nodes
    assert {node.group_id for node in nodes} == {GROUP}
    assert len({node.node_id for node in nodes}) == 2


def test_a_removed_network_ends_its_nodes() -> None:
    talk = Talk(MachineNode(), MachineNode())
    talk.join(1)
    _statuses(talk, 1)
    talk.manager.remove_network(0, "the robot was removed")
    talk.exchange()
    assert _statuses(talk, 1) == [Status.DISCONNECTED]


def test_messages_that_only_servers_send_are_ignored() -> None:
    talk = Talk(MachineNode())
    talk.join(1)
    before = list(talk.received[1])
    talk.send(1, m.NodesChanged())
    talk.send(1, m.Ping())
    assert talk.received[1] == before


def test_a_real_robot_is_shown_as_one_with_its_own_name() -> None:
    talk = Talk()
    talk.add_network([MachineNode()], NodeType.THYMIO)
    talk.join(1)
    (node,) = talk.take(1, m.NodesChanged)[0].nodes
    assert (node.type, node.name) == (NodeType.THYMIO, "a real one")
