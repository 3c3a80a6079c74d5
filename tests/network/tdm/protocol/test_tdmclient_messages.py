"""Our encoding beside that of tdmclient, the Python client (PyPI)."""

from __future__ import annotations

from uuid import UUID

import pytest

tdmclient = pytest.importorskip("tdmclient", reason="needs tdmclient (pip install tdmclient)")

from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.codec import decode, encode
from thymio_sim_ros.network.tdm.protocol.values import encode_value

ID = UUID("00112233-4455-6677-8899-aabbccddeeff")
GROUP = UUID("ffeeddcc-bbaa-9988-7766-554433221100")


def _client_with_node() -> tuple[object, object]:
    client = tdmclient.ThymioFB()
    node = m.Node(ID, GROUP, 4, 2, "thymio_0", 3, "14", "14")
    client.process_message(encode(m.NodesChanged((node,))))
    return client, client.nodes[0]


def test_its_requests_are_read() -> None:
    _, node = _client_with_node()
    sent = [
        node.create_msg_request_vm_description(),
        node.create_msg_lock_node(),
        node.create_msg_unlock_node(),
        node.create_msg_rename_node("Ämil"),
        node.create_msg_program("var a"),
        node.create_msg_program("var a", load=False),
        node.create_msg_scratchpad_update("var a"),
        node.create_msg_set_vm_execution_state(1),
        node.create_msg_watch_node(63),
        node.create_msg_register_events([("go", 2), ("stop", 0)]),
        node.create_msg_send_events({"go": [1, -300]}),
        node.create_msg_set_variables({"motor.left.target": [-300]}),
    ]
    one = encode_value((1, -300)), encode_value((-300,))
    assert [decode(message) for message in sent] == [
        m.RequestNodeAsebaVMDescription(1, ID),
        m.LockNode(2, ID),
        m.UnlockNode(3, ID),
        m.RenameNode(4, ID, "Ämil"),
        m.CompileAndLoadCodeOnVM(5, ID, 1, "var a", 2),
        m.CompileAndLoadCodeOnVM(6, ID, 1, "var a", 1),
        m.ScratchpadUpdate(7, ID, None, ID, 1, "var a"),
        m.SetVMExecutionState(8, ID, 1),
        m.WatchNode(9, ID, 63),
        m.RegisterEvents(10, ID, (m.EventDescription("go", 2), m.EventDescription("stop"))),
        m.SendEvents(11, GROUP, (m.NamedValue("go", one[0]),)),
        m.SetVariables(12, ID, (m.NamedValue("motor.left.target", one[1]),)),
    ]
    client = tdmclient.ThymioFB()
    assert decode(client.create_msg_handshake("secret")) == m.ConnectionHandshake(password="secret")
    assert decode(client.create_msg_device_manager_shutdown_request()) == m.DeviceManagerShutdownRequest(1)


def test_it_reads_our_replies() -> None:
    client, node = _client_with_node()
    assert node.props["name"] == "thymio_0"
    assert (node.id_str, node.status, node.props["type"]) == (str(ID), 4, 2)
    assert node.props["group_id_str"] == str(GROUP)
    seen: list[object] = []
    node.add_variables_changed_listener(lambda node, values: seen.append(values))
    node.add_events_received_listener(lambda node, events: seen.append(events))
    node.add_vm_state_changed_listener(lambda node, *state: seen.append(state))
    values = (m.NamedValue("a", encode_value((1, -2, 300))), m.NamedValue("b", encode_value(())))
    client.process_message(encode(m.VariablesChanged(ID, values, 12)))
    client.process_message(encode(m.EventsEmitted(ID, values[:1], 12)))
    client.process_message(encode(m.VMExecutionStateChanged(ID, 2, 7, 3, "division by zero")))
    assert seen == [{"a": [1, -2, 300], "b": []}, {"a": [1, -2, 300]}, (2, 7, 3, "division by zero")]


def test_it_reads_our_description() -> None:
    client, node = _client_with_node()
    native = m.AsebaNativeFunction(0, "math.fill", "", (m.AsebaNativeParameter("x", 2), m.AsebaNativeParameter("y", 1)))
    variables = (m.AsebaNamedVariable(0, "_id", 1), m.AsebaNamedVariable(1, "event.args", 32))
    client.process_message(
        encode(m.NodeAsebaVMDescription(1, ID, 1534, 620, 32, variables, (m.AsebaEvent(0, "tap"),), (native,)))
    )
    found = node.vm_description
    assert (found["bytecode_size"], found["data_size"], found["stack_size"]) == (1534, 620, 32)
    assert found["variables"] == {"_id": None, "event.args": 32}
    assert found["events"] == ["tap"]
    assert found["functions"] == {"math.fill": [2, 1]}
