"""How much a program asks of its robot, and whether that is more than can be served."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from thymio_sim_ros.device.costs import COSTS

__all__ = ["Load", "LoadMeter"]

MIN_CUTS = 3
"""Runs in a period of observation that calls use up, before the program counts as too fast; or two of three, where
many robots share the machine."""
MIN_REPLACED = 10
"""Commands of the same period that were replaced, before that is said."""
MAX_NAMED = 3
"""Natives or events that a warning names."""


@dataclass(frozen=True, slots=True)
class Load:
    """A period of observation: calls by native, events by name, and events that were lost as too many waited.

    `cuts`: those of the `runs` that ended because natives and events had used up the budget. `replaced`: commands that
    were not sent as later ones took their place.
    """

    cuts: int = 0
    runs: int = 0
    calls: Mapping[str, int] = field(default_factory=dict)
    emitted: Mapping[str, int] = field(default_factory=dict)
    lost: Mapping[str, int] = field(default_factory=dict)
    replaced: int = 0

    @property
    def warning(self) -> str:
        """What is too fast, what became of it and what to do; empty if all could be served."""
        parts = []
        if self.cuts >= MIN_CUTS or (self.cuts and self.cuts * 3 >= self.runs * 2):
            demand = Counter({f"emit {name}": count for name, count in self.emitted.items()})
            demand.update({f"call {name}": count for name, count in self.calls.items()})
            parts.append(
                f"the program does more than the robot can carry out ({_listed(demand)}) and is slowed down; "
                "do it less often, for example in a timer event"
            )
        if self.replaced >= MIN_REPLACED:
            parts.append(f"commands replaced by later ones before they were sent: {self.replaced}")
        if self.lost:
            parts.append(
                f"events lost, as more arrive than the program can handle ({_listed(Counter(self.lost))}); "
                "emit them less often, or make their handlers shorter"
            )
        return "; ".join(parts)


class LoadMeter:
    """Counts calls and events of one device. `charged` never goes back; the rest is taken by `take`."""

    def __init__(self) -> None:
        self.charged = 0
        """Instructions charged for natives that reach the robot and for events, since the beginning."""
        self._cuts = self._runs = 0
        self._calls: Counter[str] = Counter()
        self._emitted: Counter[str] = Counter()
        self._lost: Counter[str] = Counter()

    def count_call(self, native: str, words: int) -> None:
        """A native was called with so many words of arguments together."""
        self._calls[native] += 1
        self.charged += COSTS.of(native).of(words)

    def count_event(self, event: str, words: int) -> None:
        """An event was emitted."""
        self._emitted[event] += 1
        self.charged += COSTS.emit.of(words)

    def count_lost(self, event: str) -> None:
        """An event could not wait any more."""
        self._lost[event] += 1

    def count_run(self, *, is_cut: bool) -> None:
        """A run ended; `is_cut`: because natives and events had used up its budget."""
        self._runs += 1
        self._cuts += is_cut

    def pop(self) -> Load:
        """Return what was counted since the last time."""
        load = Load(self._cuts, self._runs, dict(self._calls), dict(self._emitted), dict(self._lost))
        self._cuts = self._runs = 0
        for counter in (self._calls, self._emitted, self._lost):
            counter.clear()
        return load


def _listed(counts: Counter[str]) -> str:
    named = [f"{name}: {count}" for name, count in counts.most_common(MAX_NAMED)]
    return ", ".join([*named, *(["…"] if len(counts) > MAX_NAMED else [])])
