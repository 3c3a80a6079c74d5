"""Requests about the program of a node: compile, load, run, step, breakpoints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from aseba_vm.protocol import messages as aseba
from thymio_sim_ros.device.programs.program_assignment import RobotId
from thymio_sim_ros.network.tdm.conversation.breakpoints import clear_breakpoints, set_breakpoints
from thymio_sim_ros.network.tdm.conversation.clients import Client
from thymio_sim_ros.network.tdm.conversation.directory import Directory
from thymio_sim_ros.network.tdm.conversation.managed_node import ManagedNode, PendingLoad
from thymio_sim_ros.network.tdm.conversation.programs import (
    MOTORS,
    Compilation,
    Compiled,
    LoadableProgram,
    motor_stop,
)  # fmt: skip
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.constants import Command, CompileOption, ErrorCode, VMState, Watch
from thymio_sim_ros.network.tdm.protocol.values import encode_value

__all__ = ["HANDLERS", "finish_compilation"]

_MESSAGES: Mapping[int, type[aseba.Command]] = MappingProxyType(
    {
        Command.RUN: aseba.Run,
        Command.STEP: aseba.Step,
        Command.STEP_TO_NEXT_LINE: aseba.Step,
        Command.PAUSE: aseba.Pause,
        Command.RESET: aseba.Reset,
        Command.REBOOT: aseba.Reboot,
        Command.SUSPEND: aseba.SuspendToRam,
        Command.WRITE_PROGRAM_TO_DEVICE: aseba.WriteBytecode,
    }
)
_PAUSING = (Command.STEP, Command.STEP_TO_NEXT_LINE, Command.PAUSE)


def _compile(directory: Directory, client: Client, message: m.CompileAndLoadCodeOnVM) -> Compilation | None:
    nodes = directory.locked_nodes(client, message.node_id)
    if not nodes:
        directory.clients.fail(client.number, message.request_id, ErrorCode.UNKNOWN_NODE)
        return None
    group = nodes[0].group
    return Compilation(
        client.number,
        message.request_id,
        message.program,
        message.language,
        tuple((node.id, RobotId(node.name, node.number), node.remote.description) for node in nodes),
        group.events,
        group.constants,
        is_loaded=bool(message.options & CompileOption.LOAD_ON_TARGET),
    )


def finish_compilation(
    directory: Directory, compilation: Compilation, result: Compiled | m.CompilationResultFailure
) -> None:
    """Answer a request with the result of its compilation, once the programs are loaded if that was requested."""
    client = directory.clients.get(compilation.client)
    if client is None:
        return
    if isinstance(result, m.CompilationResultFailure):
        directory.clients.send(client.number, result)
        return
    programs = [(directory.locked_node(client, key), program) for key, program in result.programs]
    ready = [(node, program) for node, program in programs if node is not None]
    if not ready:  # it was unlocked or has left meanwhile
        directory.clients.fail(client.number, compilation.request_id, ErrorCode.UNKNOWN_NODE)
        return
    if result.events is not None:
        _share_definitions(directory, ready[0][0], result)
    answer = _success(compilation.request_id, *ready[0])
    if not compilation.is_loaded:
        directory.clients.send(client.number, answer)
        return
    pending = PendingLoad(client.number, answer, {node.id for node, _ in ready})
    for node, program in ready:
        _load(directory, node, program)
        node.loads.append(pending)


def _success(request_id: int, node: ManagedNode, program: LoadableProgram) -> m.CompilationResultSuccess:
    target, compiled = node.remote.description, program.program
    return m.CompilationResultSuccess(
        request_id, len(compiled.words), target.bytecode_size, compiled.allocated, target.variables_size
    )


def _share_definitions(directory: Directory, node: ManagedNode, result: Compiled) -> None:
    """Make the events and constants of a file those of the group."""
    group = node.group
    group.set_events(result.events or ())
    group.set_variables([m.NamedValue(name, encode_value((value,))) for name, value in result.constants])
    directory.clients.notify(group.id, Watch.SHARED_EVENTS, group.events_message())
    directory.clients.notify(group.id, Watch.SHARED_VARIABLES, group.variables_message(directory.time_ms))


def _load(directory: Directory, node: ManagedNode, program: LoadableProgram) -> None:
    clear_breakpoints(directory, node)
    directory.programs.append((node.network, program.known))
    node.load(program)
    gone = node.pop_changes(directory.time_ms)
    if gone is not None:
        directory.clients.notify(node.id, Watch.VARIABLES, gone)


def _set_execution_state(directory: Directory, client: Client, message: m.SetVMExecutionState) -> None:
    node = directory.node(message.node_id)
    is_locker = node is not None and node.locker == client.number
    is_forced = message.command == Command.STOP and client.is_local
    if node is None or not (is_locker or is_forced):
        directory.clients.fail(client.number, message.request_id, ErrorCode.UNKNOWN_NODE)
        return
    if message.command == Command.STOP:
        _stop(directory, node)
    elif message.command in _MESSAGES:
        if message.command == Command.STEP_TO_NEXT_LINE:
            node.begin_line_step()
        node.idle_state = VMState.PAUSED if message.command in _PAUSING else VMState.STOPPED
        node.link.send(_MESSAGES[message.command](node.link.source, node.number))
    else:
        directory.clients.fail(client.number, message.request_id, ErrorCode.UNKNOWN)
        return
    directory.clients.complete(client.number, message.request_id)


def _stop(directory: Directory, node: ManagedNode) -> None:
    """Stop the wheels at once, and leave a program that does nothing else."""
    for name in MOTORS:
        if name in node.remote.addresses:
            node.link.write(node.number, name, (0,))
    _load(directory, node, motor_stop(node.remote.description))
    node.link.send(aseba.Stop(node.link.source, node.number))


HANDLERS: Mapping[type[m.Message], Callable[[Directory, Client, Any], Compilation | None]] = MappingProxyType(
    {
        m.CompileAndLoadCodeOnVM: _compile,
        m.SetVMExecutionState: _set_execution_state,
        m.SetBreakpoints: set_breakpoints,
    }
)
"""The handler of each request."""
