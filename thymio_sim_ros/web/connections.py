"""The open connections of a server: how many there may be, how long each may wait, which one goes when all are taken.

Bookkeeping only: no socket and no clock of its own. A connection that waits for nothing but its client is closed after
the time of its phase. When all places are taken, a newcomer gets that of one that has waited for a while, of the
address that has the most, the oldest first: so no address can keep the others out, and of one address the connections
that ask for something win. Until there is such a place, newcomers wait in the kernel's queue.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

__all__ = ["KEPT_S", "TIME_LIMIT_S", "Connections", "Phase", "Place"]


class Phase(IntEnum):
    """What a connection does; those that may lose their place to a newcomer first, in the order in which they do."""

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

KEPT_S = {Phase.SILENT: 1.5, Phase.IDLE: 0.2, Phase.READING: 1.5, Phase.STALLED: 2.0}
"""How long a connection has been in its phase, at least, when a newcomer gets its place."""


@dataclass(slots=True, eq=False)
class Place:
    """A connection's place. The connection itself sets the two functions: `close` ends it at once, `has_news` says
    whether its client has done something that the server has not got round to."""

    address: str
    since_s: float
    phase: Phase = Phase.SILENT
    close: Callable[[], None] = lambda: None
    has_news: Callable[[], bool] = lambda: False


class Connections:
    """At most `most` places. Belongs to one thread."""

    def __init__(self, most: int, now_s: Callable[[], float]) -> None:
        self._most = most
        self._now_s = now_s
        self._places: dict[Place, None] = {}
        self._by_address: Counter[str] = Counter()

    def __len__(self) -> int:
        return len(self._places)

    @property
    def is_full(self) -> bool:
        """Whether a newcomer needs the place of another."""
        return len(self._places) >= self._most

    def admit(self, address: str) -> Place:
        """A place for a new connection; there must be one."""
        assert not self.is_full
        place = Place(address, self._now_s())
        self._places[place] = None
        self._by_address[address] += 1
        return place

    def leave(self, place: Place) -> None:
        """The connection is gone; twice does no harm."""
        if place in self._places:
            del self._places[place]
            self._by_address[place.address] -= 1
            if not self._by_address[place.address]:
                del self._by_address[place.address]

    def enter(self, place: Place, phase: Phase) -> None:
        """The connection is in another phase now; the time of a phase that goes on goes on."""
        if place.phase is not phase:
            place.phase = phase
            place.since_s = self._now_s()

    def close_overdue(self) -> int:
        """End what has waited for too long; how many these were."""
        now_s = self._now_s()
        overdue = [place for place in self._places if now_s - place.since_s > TIME_LIMIT_S[place.phase]]
        for place in overdue:
            self.leave(place)
            place.close()
        return len(overdue)

    def longest_waiting(self) -> Place | None:
        """The place that a newcomer may have, if its connection goes on waiting; None: there is none at the moment."""
        now_s = self._now_s()
        waiting = [
            place for place in self._places if place.phase in KEPT_S and now_s - place.since_s >= KEPT_S[place.phase]
        ]
        waiting.sort(key=lambda place: (-self._by_address[place.address], place.phase, place.since_s))
        return next((place for place in waiting if not place.has_news()), None)

    def end(self, place: Place, since_s: float) -> None:
        """End a connection that has done nothing since then."""
        if place in self._places and place.since_s == since_s and not place.has_news():
            self.leave(place)
            place.close()
