"""Messages to clients about events on the networks: one function for each report; `handle` calls it.

Source: docs/spec/aseba-protocol.md section 2.3.
"""

from __future__ import annotations

from aseba_vm.protocol import reports
from aseba_vm.protocol.messages import SetBytecode, Step, printable
from thymio_sim_ros.network.tdm.conversation.breakpoints import answer_breakpoints, record_breakpoint
from thymio_sim_ros.network.tdm.conversation.directory import Directory
from thymio_sim_ros.network.tdm.conversation.managed_node import ManagedNode
from thymio_sim_ros.network.tdm.protocol.constants import ErrorCode, Status, Watch
from thymio_sim_ros.network.tdm.protocol.messages import EventsEmitted, NamedValue, VMExecutionStateChanged
from thymio_sim_ros.network.tdm.protocol.values import encode_value

__all__ = ["handle", "publish_values", "remove_node"]

_DEVICE_NAME = 2
"""Kind of the device's information."""


def handle(directory: Directory, node: ManagedNode, report: reports.Report) -> None:
    """Process a report about a node that the directory knows."""
    match report:
        case reports.VariablesRead():
            if not node.remote.is_reading:
                publish_values(directory, node)
        case reports.EventReceived(number=number, words=words):
            _emit(directory, node, number, words)
        case reports.StateReported(state=state):
            if node.continues_line_step(state):
                node.link.send(Step(node.link.source, node.number))
            else:
                _publish_state(directory, node, node.state_message(state))
        case reports.FaultReported(message=message):
            _publish_state(directory, node, node.fault_message(message))
        case reports.ProgramLoaded():
            _confirm_load(directory, node)
        case reports.BreakpointReported(pc=pc, is_set=is_set):
            record_breakpoint(directory, node, pc, is_set=is_set)
        case reports.DeviceInfoReceived(kind=kind, data=data):
            if kind == _DEVICE_NAME and data:
                node.name = printable(data.decode(errors="replace"))
                directory.announce(node)
        case reports.RequestTimedOut(request=request):
            if isinstance(request, SetBytecode):
                _fail_loads(directory, node)
            else:
                publish_values(directory, node)


def publish_values(directory: Directory, node: ManagedNode) -> None:
    """Send changed variables to all that watch them, and all variables to those that have asked for them."""
    if node.firmware != node.announced_firmware:
        node.announced_firmware = node.firmware
        directory.announce(node)
    clients = directory.clients
    if not node.waiting_for_values and not clients.are_watching(node.id, Watch.VARIABLES):
        return
    waiting, node.waiting_for_values = node.waiting_for_values, []
    changes = node.pop_changes(directory.time_ms)
    receivers = dict.fromkeys(client for client, _ in waiting)
    if changes is not None:
        clients.notify(node.id, Watch.VARIABLES, changes, skip=receivers)
    if receivers:  # once for each client, however often it has asked
        clients.send_to(receivers, node.all_variables(directory.time_ms))
    for client, request_id in waiting:
        clients.complete(client, request_id)


def remove_node(directory: Directory, node: ManagedNode) -> None:
    """Remove a node that has left its network."""
    del directory.nodes[node.id]
    answer_breakpoints(directory, node)
    _fail_loads(directory, node)
    for client, request_id in node.waiting_for_values:
        directory.clients.fail(client, request_id, ErrorCode.UNKNOWN_NODE)
    for watching in directory.clients:
        watching.watched.pop(node.id, None)
    node.group.scratchpads.pop(node.id, None)
    directory.announce(node, Status.DISCONNECTED)


def _emit(directory: Directory, node: ManagedNode, number: int, words: tuple[int, ...]) -> None:
    """Send an event to those that watch events, if it is in the table with this size."""
    events = node.group.events
    if number < len(events) and events[number][1] == len(words):
        value = NamedValue(events[number][0], encode_value(words))
        directory.clients.notify(node.id, Watch.EVENTS, EventsEmitted(node.id, (value,), directory.time_ms))


def _publish_state(directory: Directory, node: ManagedNode, message: VMExecutionStateChanged) -> None:
    if message != node.vm:
        node.vm = message
        directory.clients.notify(node.id, Watch.VM_STATE, message)


def _confirm_load(directory: Directory, node: ManagedNode) -> None:
    loads, node.loads = node.loads, []
    for pending in loads:
        pending.waiting.discard(node.id)
        if not pending.waiting:
            directory.clients.send(pending.client, pending.answer)


def _fail_loads(directory: Directory, node: ManagedNode) -> None:
    loads, node.loads = node.loads, []
    for pending in loads:
        if pending.waiting:  # else another node of the same request has failed
            pending.waiting.clear()
            directory.clients.fail(pending.client, pending.answer.request_id, ErrorCode.UNKNOWN)
