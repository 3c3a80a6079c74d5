"""Breakpoints of clients, by lines, on the nodes, by addresses of the bytecode."""

from __future__ import annotations

from aseba_vm.protocol.messages import ClearAllBreakpoints, SetBreakpoint
from thymio_sim_ros.network.tdm.conversation.clients import Client
from thymio_sim_ros.network.tdm.conversation.directory import Directory
from thymio_sim_ros.network.tdm.conversation.managed_node import ManagedNode, PendingBreakpoints
from thymio_sim_ros.network.tdm.protocol.constants import ErrorCode
from thymio_sim_ros.network.tdm.protocol.messages import SetBreakpoints, SetBreakpointsResponse

__all__ = ["answer_breakpoints", "clear_breakpoints", "record_breakpoint", "set_breakpoints"]


def set_breakpoints(directory: Directory, client: Client, message: SetBreakpoints) -> None:
    """Replace the breakpoints of a node. A line without code is replaced by the next one with code."""
    node = directory.locked_node(client, message.node_id)
    if node is None:
        directory.clients.send(client.number, SetBreakpointsResponse(message.request_id, ErrorCode.UNKNOWN_NODE))
        return
    clear_breakpoints(directory, node)
    lines = sorted({wanted.line for wanted in message.breakpoints})
    places = {} if node.program is None else dict(filter(None, map(node.program.place_of, lines)))
    node.breakpoints = PendingBreakpoints(client.number, message.request_id, directory.now_ns, places)
    if places:
        node.has_breakpoints = True
        node.link.send(*(SetBreakpoint(node.link.source, node.number, pc) for pc in places))
    else:
        answer_breakpoints(directory, node)


def record_breakpoint(directory: Directory, node: ManagedNode, pc: int, *, is_set: bool) -> None:
    """Note the reply of a node, which may belong to another client of its network."""
    pending = node.breakpoints
    if pending is not None and pc in pending.waiting:
        line = pending.waiting.pop(pc)
        if is_set:
            pending.lines.add(line)
        if not pending.waiting:
            answer_breakpoints(directory, node)


def answer_breakpoints(directory: Directory, node: ManagedNode) -> None:
    """Answer the request with the breakpoints that the node has confirmed."""
    if node.breakpoints is not None:
        directory.clients.send(node.breakpoints.client, node.breakpoints.answer())
        node.breakpoints = None


def clear_breakpoints(directory: Directory, node: ManagedNode) -> None:
    """Remove the breakpoints of a node; a request that waits is answered."""
    answer_breakpoints(directory, node)
    if node.has_breakpoints:
        node.has_breakpoints = False
        node.link.send(ClearAllBreakpoints(node.link.source, node.number))
