"""A group: nodes that share events and constants, here those of one Aseba network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from uuid import UUID

from aseba_vm.protocol.messages import printable
from thymio_sim_ros.network.tdm.protocol.errors import ValueTypeError
from thymio_sim_ros.network.tdm.protocol.messages import (
    EventDescription,
    EventsDescriptionsChanged,
    NamedValue,
    ScratchpadUpdate,
    VariablesChanged,
)  # fmt: skip
from thymio_sim_ros.network.tdm.protocol.values import decode_value

__all__ = ["Group"]

MAX_EVENTS = 1000
MAX_EVENT_WORDS = 258
"""Words of the largest message of an Aseba network."""
MAX_SHARED_BYTES = 100_000
"""Names and values of the shared variables."""


@dataclass(slots=True)
class Group:
    """Events, shared variables and scratchpads of the nodes of a network."""

    id: UUID
    events: tuple[tuple[str, int], ...] = ()
    """Name and number of words of each event; its place is its number."""
    variables: dict[str, bytes] = field(default_factory=dict)
    """Values of the shared variables, in any form that a client sends."""
    scratchpads: dict[UUID, ScratchpadUpdate] = field(default_factory=dict)
    """The source text by node."""

    @property
    def constants(self) -> tuple[tuple[str, int], ...]:
        """The shared variables that programs can use as constants: single integers of 16 bits."""
        found = []
        for name, value in self.variables.items():
            try:
                words = decode_value(value)
            except ValueTypeError:
                continue
            if len(words) == 1:
                found.append((name, words[0]))
        return tuple(found)

    def set_events(self, events: Sequence[tuple[str, int]]) -> bool:
        """Replace the events; False if they are too many, too long, or not all different."""
        names = {name for name, _ in events}
        if len(names) < len(events) or "" in names or len(events) > MAX_EVENTS:
            return False
        if any(size > MAX_EVENT_WORDS for _, size in events):
            return False
        self.events = tuple(events)
        return True

    def set_variables(self, values: Sequence[NamedValue]) -> bool:
        """Set shared variables; null removes one. False if there are too many."""
        merged = {**self.variables, **{printable(value.name): value.value for value in values}}
        kept = {name: value for name, value in merged.items() if name and not _is_null(value)}
        if sum(len(name) + len(value) for name, value in kept.items()) > MAX_SHARED_BYTES:
            return False
        self.variables = kept
        return True

    def event_size(self, name: str) -> int | None:
        """Number of words of an event; None for an unknown name."""
        return dict(self.events).get(name)

    def event_number(self, name: str) -> int:
        """Number of an event on the network. Raises ValueError for an unknown name."""
        return [known for known, _ in self.events].index(name)

    def events_message(self) -> EventsDescriptionsChanged:
        """The events for clients."""
        events = (EventDescription(name, size, index) for index, (name, size) in enumerate(self.events))
        return EventsDescriptionsChanged(self.id, tuple(events))

    def variables_message(self, time_ms: int) -> VariablesChanged:
        """The shared variables for clients."""
        values = (NamedValue(name, value) for name, value in sorted(self.variables.items()))
        return VariablesChanged(self.id, tuple(values), time_ms)


def _is_null(value: bytes) -> bool:
    """Whether the type of a FlexBuffer, its last byte but one, is null."""
    return len(value) < 3 or value[-2] >> 2 == 0
