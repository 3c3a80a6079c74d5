"""The open connections of a server: how many there may be, how long each may wait, which one goes when all are taken.

Bookkeeping only: no socket and no clock of its own. A connection that waits for nothing but its client is closed after
the time of its phase. When all places are taken, a newcomer gets that of one that has waited for a while, of the
address that has the most, the oldest first: so no address can keep the others out, and of one address the connections
that ask for something win. Until there is such a slot, newcomers wait in the kernel's queue.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

__all__ = ["MIN_WAIT_S", "TIME_LIMIT_S", "ConnectionSlot", "Connections", "Phase"]


class Phase(IntEnum):
    """What a connection does; those that may lose their slot to a newcomer first, in the order in which they do."""

    SILENT = 0
    """It has sent nothing yet."""
    IDLE = 1
    """Its last request has been answered."""
    READING = 2
    """A part of a request has come."""
    STALLED = 3
    """Its client does not read what it asked for."""
    ANSWERING = 4
    """An answer is being made or sent."""


TIME_LIMIT_S = {
    Phase.SILENT: 5.0,
    Phase.IDLE: 20.0,
    Phase.READING: 10.0,
    Phase.STALLED: 20.0,
    Phase.ANSWERING: 120.0,
}
"""How long a connection may stay in a phase."""

MIN_WAIT_S = {Phase.SILENT: 1.5, Phase.IDLE: 0.2, Phase.READING: 1.5, Phase.STALLED: 2.0}
"""How long a connection has been in its phase, at least, when a newcomer gets its slot."""


@dataclass(slots=True, eq=False)
class ConnectionSlot:
    """A connection's slot. The connection itself sets the two functions: `close` ends it at once, `has_pending_io` says
    whether its client has done something that the server has not got round to."""

    address: str
    since_s: float
    phase: Phase = Phase.SILENT
    close: Callable[[], None] = lambda: None
    has_pending_io: Callable[[], bool] = lambda: False


class Connections:
    """At most `most` places. Belongs to one thread."""

    def __init__(self, max_connections: int, now_s: Callable[[], float]) -> None:
        self._max_connections = max_connections
        self._now_s = now_s
        self._slots: dict[ConnectionSlot, None] = {}
        self._by_address: Counter[str] = Counter()

    def __len__(self) -> int:
        return len(self._slots)

    @property
    def is_full(self) -> bool:
        """Whether a newcomer needs the slot of another."""
        return len(self._slots) >= self._max_connections

    def add(self, address: str) -> ConnectionSlot:
        """A slot for a new connection; there must be one."""
        assert not self.is_full
        slot = ConnectionSlot(address, self._now_s())
        self._slots[slot] = None
        self._by_address[address] += 1
        return slot

    def remove(self, slot: ConnectionSlot) -> None:
        """The connection is gone; twice does no harm."""
        if slot in self._slots:
            del self._slots[slot]
            self._by_address[slot.address] -= 1
            if not self._by_address[slot.address]:
                del self._by_address[slot.address]

    def set_phase(self, slot: ConnectionSlot, phase: Phase) -> None:
        """The connection is in another phase now; the time of a phase that goes on goes on."""
        if slot.phase is not phase:
            slot.phase = phase
            slot.since_s = self._now_s()

    def close_overdue(self) -> int:
        """End what has waited for too long; how many these were."""
        now_s = self._now_s()
        overdue = [slot for slot in self._slots if now_s - slot.since_s > TIME_LIMIT_S[slot.phase]]
        for slot in overdue:
            self.remove(slot)
            slot.close()
        return len(overdue)

    def eviction_candidate(self) -> ConnectionSlot | None:
        """The slot that a newcomer may have, if its connection goes on waiting; None: there is none at the moment."""
        now_s = self._now_s()
        waiting = [
            slot for slot in self._slots if slot.phase in MIN_WAIT_S and now_s - slot.since_s >= MIN_WAIT_S[slot.phase]
        ]
        waiting.sort(key=lambda slot: (-self._by_address[slot.address], slot.phase, slot.since_s))
        return next((slot for slot in waiting if not slot.has_pending_io()), None)

    def evict(self, slot: ConnectionSlot, since_s: float) -> None:
        """End a connection that has done nothing since then."""
        if slot in self._slots and slot.since_s == since_s and not slot.has_pending_io():
            self.remove(slot)
            slot.close()
