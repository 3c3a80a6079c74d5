"""Replies of the HTTP interface as values, in the forms of the reference (docs/spec/aseba-protocol.md section 3)."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field

from aseba_vm.protocol.remote_node import RemoteNode
from thymio_sim_ros.access import RefusedError

__all__ = [
    "Definitions",
    "NodeView",
    "Reply",
    "description_json",
    "done",
    "event_line",
    "json_reply",
    "refusal",
    "summary_json",
]

JSON_TYPE = "application/json"
TEXT_TYPE = "text/plain; charset=utf-8"


@dataclass(frozen=True, slots=True)
class Reply:
    """Status, body and its type."""

    status: int
    body: bytes = b""
    media_type: str = JSON_TYPE


@dataclass(frozen=True, slots=True)
class Definitions:
    """The events and constants that the programs of a network share; the number of an event is its index."""

    events: tuple[tuple[str, int], ...] = ()
    constants: tuple[tuple[str, int], ...] = ()

    def event(self, name: str) -> tuple[int, int] | None:
        """Number and size in words of an event; None for an unknown name."""
        return next(((number, size) for number, (known, size) in enumerate(self.events) if known == name), None)

    def event_name(self, number: int) -> str:
        """Name of an event; `event_<number>` if it has none."""
        return self.events[number][0] if number < len(self.events) else f"event_{number}"


@dataclass(frozen=True, slots=True)
class NodeView:
    """A node as requests see it: its number there, the name of its robot (empty: none), and its program's names."""

    number: int
    robot: str
    remote: RemoteNode
    definitions: Definitions = field(default=Definitions())


def done(notes: Sequence[str] = ()) -> Reply:
    """The reply to a request that was carried out: empty, or a line for each note."""
    return Reply(200, "".join(f"{note}\n" for note in notes).encode(), TEXT_TYPE) if notes else Reply(204)


def refusal(error: RefusedError) -> Reply:
    """The reply to a request that cannot be answered."""
    return Reply(error.status, f"{error}\n".encode(), TEXT_TYPE)


def json_reply(value: object) -> Reply:
    """A reply with a value."""
    return Reply(200, json.dumps(value, separators=(",", ":")).encode())


def summary_json(view: NodeView) -> dict[str, object]:
    """A node in the list of nodes."""
    found: dict[str, object] = {
        "node": view.number,
        "name": view.remote.description.name,
        "protocolVersion": view.remote.version,
        "aeslId": view.remote.number,
        "connected": 1,
    }
    return {**found, "robot": view.robot} if view.robot else found


def description_json(view: NodeView) -> dict[str, object]:
    """All about a node; variables are sorted by name, the rest is in order of declaration."""
    target = view.remote.description
    return {
        **summary_json(view),
        "bytecodeSize": target.bytecode_size,
        "variablesSize": target.variables_size,
        "stackSize": target.stack_size,
        "namedVariables": {name: size for name, (_, size) in sorted(view.remote.addresses.items())},
        "localEvents": {event.name: event.description for event in target.local_events},
        "constants": dict(view.definitions.constants),
        "events": dict(view.definitions.events),
    }


def event_line(name: str, words: Sequence[int]) -> bytes:
    """An event in a stream of server-sent events."""
    return f"data: {' '.join((name, *map(str, words)))}\r\n\r\n".encode()
