"""Requests about nodes and values: one function for each; `HANDLERS` has them by the class of the message.

Each request is answered by exactly one RequestCompleted, Error or reply of its own (docs/spec/aseba-protocol.md
section 2.3). A client must have locked the node that it changes. Requests about programs are in `program_requests`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from aseba_vm.protocol.messages import SetDeviceInfo, UserMessage, device_name, printable
from thymio_sim_ros.network.tdm.conversation import program_requests
from thymio_sim_ros.network.tdm.conversation.breakpoints import clear_breakpoints
from thymio_sim_ros.network.tdm.conversation.clients import Client
from thymio_sim_ros.network.tdm.conversation.directory import Directory
from thymio_sim_ros.network.tdm.conversation.managed_node import ManagedNode
from thymio_sim_ros.network.tdm.conversation.programs import Compilation
from thymio_sim_ros.network.tdm.conversation.reports import publish_values
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.constants import ErrorCode, Watch
from thymio_sim_ros.network.tdm.protocol.errors import ValueTypeError
from thymio_sim_ros.network.tdm.protocol.values import decode_value

__all__ = ["HANDLERS", "Handler", "release"]

Handler = Callable[[Directory, Client, Any], Compilation | None]
"""Answers a request; a compilation is to be executed, and its result to be passed to `finish_compilation`."""

MAX_NAME_BYTES = 54
"""Longest name of a device on the network."""
_DEVICE_NAME = 2
"""Kind of the device's information."""
MAX_WATCHED = 1000
"""Nodes and groups that a client may watch."""


def _list_nodes(directory: Directory, client: Client, message: m.RequestListOfNodes) -> None:
    directory.clients.send(client.number, directory.nodes_message(client))


def _describe_node(directory: Directory, client: Client, message: m.RequestNodeAsebaVMDescription) -> None:
    node = directory.node(message.node_id)
    if node is None:
        return  # the reference does not answer either
    target = node.remote.description
    variables, address = [], 0
    for variable in target.variables:
        variables.append(m.AsebaNamedVariable(address, variable.name, variable.size))
        address += variable.size
    events = (m.AsebaEvent(index, event.name, event.description) for index, event in enumerate(target.local_events))
    functions = (
        m.AsebaNativeFunction(
            index,
            native.name,
            native.description,
            tuple(m.AsebaNativeParameter(part.name, part.size & 0xFFFFFFFF) for part in native.parameters),
        )
        for index, native in enumerate(target.natives)
    )
    description = m.NodeAsebaVMDescription(
        message.request_id, node.id, target.bytecode_size, target.variables_size, target.stack_size,
        tuple(variables), tuple(events), tuple(functions),
    )  # fmt: skip
    directory.clients.send(client.number, description)


def _lock(directory: Directory, client: Client, message: m.LockNode) -> None:
    node = directory.node(message.node_id)
    if node is None or node.locker is not None:
        error = ErrorCode.UNKNOWN_NODE if node is None else ErrorCode.NODE_BUSY
        directory.clients.fail(client.number, message.request_id, error)
        return
    directory.lock(node, client)  # first, so that the client knows the new status when its request is done
    directory.clients.complete(client.number, message.request_id)


def _unlock(directory: Directory, client: Client, message: m.UnlockNode) -> None:
    node = directory.locked_node(client, message.node_id)
    if node is None:
        directory.clients.fail(client.number, message.request_id, ErrorCode.UNKNOWN_NODE)
        return
    release(directory, node)
    directory.clients.complete(client.number, message.request_id)


def release(directory: Directory, node: ManagedNode) -> None:
    """Take a node back from the client that has locked it. Its program runs on, without breakpoints."""
    clear_breakpoints(directory, node)
    directory.unlock(node)


def _rename(directory: Directory, client: Client, message: m.RenameNode) -> None:
    node = directory.node(message.node_id)
    name = printable(message.new_name)
    if node is None or not client.is_local or not 0 < len(name.encode()) <= MAX_NAME_BYTES:
        directory.clients.fail(client.number, message.request_id, ErrorCode.UNKNOWN_NODE)
        return
    node.name = name
    node.link.send(SetDeviceInfo(node.link.source, node.number, _DEVICE_NAME, device_name(name)))
    directory.announce(node)
    directory.clients.complete(client.number, message.request_id)


def _watch(directory: Directory, client: Client, message: m.WatchNode) -> None:
    key, group = message.node_or_group_id, directory.group(message.node_or_group_id)
    is_full = len(client.watched) >= MAX_WATCHED and key not in client.watched
    if key is None or group is None or is_full:
        directory.clients.fail(client.number, message.request_id, ErrorCode.UNKNOWN_NODE)
        return
    wanted = Watch(message.info_type & (Watch.OF_NODE | Watch.OF_GROUP))
    node = directory.node(key)
    if node is None:
        client.watched[group.id] = wanted & Watch.OF_GROUP
    else:
        client.watched[node.id] = wanted & Watch.OF_NODE
        client.watched[group.id] = client.watched.get(group.id, Watch.NONE) | (wanted & Watch.OF_GROUP)
    send = directory.clients.send
    if wanted & Watch.SHARED_EVENTS:
        send(client.number, group.events_message())
    if wanted & Watch.SHARED_VARIABLES:
        send(client.number, group.variables_message(directory.time_ms))
    if wanted & Watch.SCRATCHPADS:
        for scratchpad in group.scratchpads.values():
            send(client.number, scratchpad)
    if node is not None and wanted & Watch.VM_STATE:
        send(client.number, node.vm)
    if node is not None and wanted & Watch.VARIABLES:
        node.waiting_for_values.append((client.number, message.request_id))
        node.request_values()
        if not node.remote.is_reading:  # it has no variables
            publish_values(directory, node)
    else:
        directory.clients.complete(client.number, message.request_id)


def _set_variables(directory: Directory, client: Client, message: m.SetVariables) -> None:
    node = directory.locked_node(client, message.node_or_group_id)
    if node is not None:
        error = _write(node, message.vars)
    elif directory.locked_nodes(client, message.node_or_group_id):
        error = _share(directory, message)
    else:
        error = ErrorCode.UNKNOWN_NODE
    directory.clients.finish(client.number, message.request_id, error)


def _write(node: ManagedNode, values: tuple[m.NamedValue, ...]) -> ErrorCode:
    """Write variables of a node: all, or none if one has another size or an unknown name."""
    found = {}
    for value in values:
        try:
            found[value.name] = decode_value(value.value)
            _, size = node.remote.addresses[value.name]
        except (KeyError, ValueTypeError):
            return ErrorCode.UNSUPPORTED_VARIABLE_TYPE
        if len(found[value.name]) != size:
            return ErrorCode.UNSUPPORTED_VARIABLE_TYPE
    for name, words in found.items():
        node.link.write(node.number, name, words)
    return ErrorCode.NONE


def _share(directory: Directory, message: m.SetVariables) -> ErrorCode:
    """Set the variables that a group shares."""
    group = directory.group(message.node_or_group_id)
    if group is None or not group.set_variables(message.vars):
        return ErrorCode.UNSUPPORTED_VARIABLE_TYPE
    directory.clients.notify(group.id, Watch.SHARED_VARIABLES, group.variables_message(directory.time_ms))
    return ErrorCode.NONE


def _register_events(directory: Directory, client: Client, message: m.RegisterEvents) -> None:
    error = ErrorCode.UNKNOWN_NODE
    if directory.locked_nodes(client, message.node_or_group_id):
        group = directory.group(message.node_or_group_id)
        error = ErrorCode.UNKNOWN
        if group is not None and group.set_events(
            [(printable(event.name), event.fixed_sized) for event in message.events]
        ):
            error = ErrorCode.NONE
            directory.clients.notify(group.id, Watch.SHARED_EVENTS, group.events_message())
    directory.clients.finish(client.number, message.request_id, error)


def _send_events(directory: Directory, client: Client, message: m.SendEvents) -> None:
    nodes = directory.locked_nodes(client, message.node_id)
    if not nodes:
        directory.clients.fail(client.number, message.request_id, ErrorCode.UNKNOWN_NODE)
        return
    node = nodes[0]
    sent = []
    for event in message.events:
        name = printable(event.name)
        size = node.group.event_size(name)
        if size is None:
            continue  # the reference ignores it too
        try:
            words = decode_value(event.value)
        except ValueTypeError:
            words = ()
        if len(words) != size:
            directory.clients.fail(client.number, message.request_id, ErrorCode.UNSUPPORTED_VARIABLE_TYPE)
            return
        sent.append(UserMessage(node.link.source, node.group.event_number(name), words))
    node.link.send(*sent)
    directory.clients.complete(client.number, message.request_id)


def _update_scratchpad(directory: Directory, client: Client, message: m.ScratchpadUpdate) -> None:
    node = directory.locked_node(client, message.node_id) or directory.locked_node(client, message.scratchpad_id)
    if node is None:
        directory.clients.fail(client.number, message.request_id, ErrorCode.UNKNOWN_NODE)
        return
    key = message.scratchpad_id or node.id
    kept = replace(message, request_id=0, scratchpad_id=key, group_id=node.group.id, node_id=node.id)
    if message.deleted:
        node.group.scratchpads.pop(node.id, None)
    else:
        node.group.scratchpads[node.id] = kept
    directory.clients.notify(node.group.id, Watch.SCRATCHPADS, kept)
    directory.clients.complete(client.number, message.request_id)


def _reject(directory: Directory, client: Client, message: Any) -> None:
    """Reject what this device manager cannot do: the simulator ends it, and simulated robots have no firmware."""
    directory.clients.fail(client.number, message.request_id, ErrorCode.UNKNOWN)


HANDLERS: Mapping[type[m.Message], Handler] = MappingProxyType(
    {
        m.RequestListOfNodes: _list_nodes,
        m.RequestNodeAsebaVMDescription: _describe_node,
        m.LockNode: _lock,
        m.UnlockNode: _unlock,
        m.RenameNode: _rename,
        m.WatchNode: _watch,
        m.SetVariables: _set_variables,
        m.RegisterEvents: _register_events,
        m.SendEvents: _send_events,
        m.ScratchpadUpdate: _update_scratchpad,
        m.DeviceManagerShutdownRequest: _reject,
        m.FirmwareUpgradeRequest: _reject,
        m.DonglePairingRequest: _reject,
        m.CompileAndSave: _reject,
        **program_requests.HANDLERS,
    }
)
"""The handler of each request. Other messages of a client need no answer and are ignored."""
