"""The open connections of a server: their maximum number, their time limits, and which one is evicted at the limit.

Bookkeeping only, without sockets and clock. A connection that waits for its client is closed when the time limit of its
phase is over. When all slots are in use, a new connection gets the slot of one that has been idle for some time: first
of the address with the most connections, then by phase, then the oldest. No single address can therefore block others,
and among the connections of one address those with requests are kept. Until a slot can be freed, new connections wait
in the queue of the kernel.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from math import inf

__all__ = ["EVICTED_AT_ONCE", "MIN_WAIT_S", "TIME_LIMIT_S", "ConnectionSlot", "Connections", "Phase"]


class Phase(IntEnum):
    """State of a connection, in the order in which connections are evicted; the last two are never evicted."""

    SILENT = 0
    """Its client has sent nothing yet."""
    IDLE = 1
    """Its last request has been answered."""
    READING = 2
    """A part of a request has been received."""
    STALLED = 3
    """Its client does not read the answer."""
    ANSWERING = 4
    """An answer is being created or sent."""
    STREAMING = 5
    """An answer without end is being sent."""


TIME_LIMIT_S = {
    Phase.SILENT: 5.0,
    Phase.IDLE: 20.0,
    Phase.READING: 10.0,
    Phase.STALLED: 20.0,
    Phase.ANSWERING: 120.0,
}
"""Time limit of each phase that has one."""

MIN_WAIT_S = {Phase.SILENT: 1.5, Phase.IDLE: 0.2, Phase.READING: 1.5, Phase.STALLED: 2.0}
"""Time after which a connection in this phase may be evicted."""

EVICTED_AT_ONCE = {Phase.SILENT: 0.0, Phase.READING: 0.0}
"""`MIN_WAIT_S` of servers whose connections begin with a handshake: until it is complete, which takes milliseconds, a
connection may be evicted."""


@dataclass(slots=True, eq=False)
class ConnectionSlot:
    """The slot of a connection, which sets both functions: `close` closes it at once; `has_pending_io` returns whether
    its socket has input or room that the server has not processed yet."""

    address: str
    since_s: float
    phase: Phase = Phase.SILENT
    close: Callable[[], object] = lambda: None
    has_pending_io: Callable[[], bool] = lambda: False


class Connections:
    """At most `max_connections` slots. Not thread-safe."""

    def __init__(self, max_connections: int, now_s: Callable[[], float]) -> None:
        self._max_connections = max_connections
        self._now_s = now_s
        self._slots: dict[ConnectionSlot, None] = {}
        self._by_address: Counter[str] = Counter()

    def __len__(self) -> int:
        return len(self._slots)

    @property
    def is_full(self) -> bool:
        """Whether all slots are in use, so that a new connection needs the slot of another."""
        return len(self._slots) >= self._max_connections

    def add(self, address: str) -> ConnectionSlot:
        """Add a connection; only allowed while `is_full` is false."""
        assert not self.is_full
        slot = ConnectionSlot(address, self._now_s())
        self._slots[slot] = None
        self._by_address[address] += 1
        return slot

    def remove(self, slot: ConnectionSlot) -> None:
        """Remove a connection; a second call has no effect."""
        if slot in self._slots:
            del self._slots[slot]
            self._by_address[slot.address] -= 1
            if not self._by_address[slot.address]:
                del self._by_address[slot.address]

    def set_phase(self, slot: ConnectionSlot, phase: Phase) -> None:
        """Set the phase of a connection; its time restarts only if the phase changes."""
        if slot.phase is not phase:
            slot.phase = phase
            slot.since_s = self._now_s()

    def close_overdue(self) -> int:
        """Close connections over their time limit; return their number."""
        now_s = self._now_s()
        overdue = [slot for slot in self._slots if now_s - slot.since_s > TIME_LIMIT_S.get(slot.phase, inf)]
        for slot in overdue:
            self.remove(slot)
            slot.close()
        return len(overdue)

    def close_all(self) -> None:
        """Close all connections."""
        for slot in list(self._slots):
            slot.close()

    def eviction_candidate(self, min_wait_s: Mapping[Phase, float] = MIN_WAIT_S) -> ConnectionSlot | None:
        """The connection to close for a new one if it stays idle, or None if there is none at the moment.

        `min_wait_s`: time after which a connection in each phase may be evicted; in other phases it never is.
        """
        now_s = self._now_s()
        waiting = [
            slot for slot in self._slots if slot.phase in min_wait_s and now_s - slot.since_s >= min_wait_s[slot.phase]
        ]
        waiting.sort(key=lambda slot: (-self._by_address[slot.address], slot.phase, slot.since_s))
        return next((slot for slot in waiting if not slot.has_pending_io()), None)

    def make_room(self, min_wait_s: Mapping[Phase, float] = EVICTED_AT_ONCE) -> bool:
        """Free a slot at once if all are in use; return whether there is a free slot now."""
        if self.is_full and (slot := self.eviction_candidate(min_wait_s)) is not None:
            self.remove(slot)
            slot.close()
        return not self.is_full

    def evict(self, slot: ConnectionSlot, since_s: float) -> None:
        """Close a connection if it has done nothing since then."""
        if slot in self._slots and slot.since_s == since_s and not slot.has_pending_io():
            self.remove(slot)
            slot.close()
