"""Load that a program causes by native calls and events, and whether it exceeds the capacity."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from thymio_sim_ros.device.costs import COSTS

__all__ = ["Load", "LoadMeter"]

MIN_CUTS = 3
"""Runs per period of observation that native calls and events must end before a warning. Two of three runs are enough,
because a robot has few runs where many robots share the computer."""
MIN_REPLACED = 10
"""Replaced commands per period before a warning."""
MAX_NAMED = 3
"""Largest number of native functions or events in a warning."""


@dataclass(frozen=True, slots=True)
class Load:
    """Counts of a period of observation: calls, emitted events, and events lost because the queue was full, by name.

    `cuts` is the number of `runs` that ended because native calls and events had used up the budget, `replaced` that of
    commands that were replaced by later ones before they were sent.
    """

    cuts: int = 0
    runs: int = 0
    calls: Mapping[str, int] = field(default_factory=dict)
    emitted: Mapping[str, int] = field(default_factory=dict)
    lost: Mapping[str, int] = field(default_factory=dict)
    replaced: int = 0

    @property
    def warning(self) -> str:
        """Message for the user with the cause, the effect and what to do; empty if the capacity was not exceeded."""
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
    """Counts calls and events of one device. `pop` clears all counts but `charged`, which never decreases."""

    def __init__(self) -> None:
        self.charged = 0
        """Instructions charged for native calls and events since the start."""
        self._cuts = self._runs = 0
        self._calls: dict[str, int] = {}
        self._emitted: Counter[str] = Counter()
        self._lost: Counter[str] = Counter()

    def count_call(self, native: str, cost: int) -> None:
        """Count a native call and its cost in instructions."""
        self._calls[native] = self._calls.get(native, 0) + 1
        self.charged += cost

    def count_event(self, event: str, words: int) -> None:
        """Count an emitted event with arguments of `words` words."""
        self._emitted[event] += 1
        self.charged += COSTS.emit.of(words)

    def count_lost(self, event: str) -> None:
        """Count an event that was dropped because the queue was full."""
        self._lost[event] += 1

    def count_run(self, *, is_cut: bool) -> None:
        """Count a run; `is_cut`: native calls and events have used up its budget."""
        self._runs += 1
        self._cuts += is_cut

    def pop(self) -> Load:
        """Return and clear the counts."""
        load = Load(self._cuts, self._runs, dict(self._calls), dict(self._emitted), dict(self._lost))
        self._cuts = self._runs = 0
        for counts in (self._calls, self._emitted, self._lost):
            counts.clear()
        return load


def _listed(counts: Counter[str]) -> str:
    named = [f"{name}: {count}" for name, count in counts.most_common(MAX_NAMED)]
    return ", ".join([*named, *(["…"] if len(counts) > MAX_NAMED else [])])
