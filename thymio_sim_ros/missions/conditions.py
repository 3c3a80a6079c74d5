"""Conditions of a mission: facts combined over time.

In a file, a condition is the name of a fact, or an object with one of these words:

    {"all": [...]}                 all of them are true
    {"any": [...]}                 one of them is true
    {"not": condition}             it is not true
    {"once": condition}            it has been true
    {"then": [...]}                each has been true after the one before it
    {"hold": condition, "for_s": 2}     it has been true for so long without a break
    {"at_most": 3, "of": condition}     it has become true so often at most

A condition has a state; `update` is called once in each tick.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Protocol

from thymio_sim_ros.sim.model.fields import FieldError, describe, join, nearest

__all__ = ["MAX_PARTS", "MAX_SECONDS", "MAX_TIMES", "Condition", "Facts", "names_in", "read_condition"]

Facts = Mapping[str, bool]
"""Whether each fact is true in a tick, by name."""

MAX_PARTS, MAX_DEPTH = 30, 8
MAX_NAMES = 200
"""Names of facts in a condition, which is judged in each tick."""
MAX_SECONDS, MAX_TIMES = 3600.0, 1000


class Condition(Protocol):
    """A condition with its state."""

    def update(self, facts: Facts, now_s: float) -> bool:
        """Take the facts of a tick; return whether it is true now."""


class _Is:
    def __init__(self, fact: str) -> None:
        self.fact = fact

    def update(self, facts: Facts, now_s: float) -> bool:
        return facts[self.fact]


class _Several:
    """Every part is updated in every tick, because parts have a state."""

    def __init__(self, parts: Sequence[Condition], combine: Callable[[list[bool]], bool]) -> None:
        self._parts, self._combine = parts, combine

    def update(self, facts: Facts, now_s: float) -> bool:
        return self._combine([part.update(facts, now_s) for part in self._parts])


class _Not:
    def __init__(self, part: Condition) -> None:
        self._part = part

    def update(self, facts: Facts, now_s: float) -> bool:
        return not self._part.update(facts, now_s)


class _Then:
    """A part that is waited for is the only one that is updated."""

    def __init__(self, parts: Sequence[Condition]) -> None:
        self._parts = parts
        self._done = 0

    def update(self, facts: Facts, now_s: float) -> bool:
        while self._done < len(self._parts) and self._parts[self._done].update(facts, now_s):
            self._done += 1
        return self._done == len(self._parts)


class _Hold:
    def __init__(self, part: Condition, seconds: float) -> None:
        self._part, self._seconds = part, seconds
        self._since_s = math.inf

    def update(self, facts: Facts, now_s: float) -> bool:
        self._since_s = min(self._since_s, now_s) if self._part.update(facts, now_s) else math.inf
        return now_s - self._since_s >= self._seconds


class _AtMost:
    def __init__(self, times: int, part: Condition) -> None:
        self._left, self._part = times, part
        self._was_true = False

    def update(self, facts: Facts, now_s: float) -> bool:
        is_true = self._part.update(facts, now_s)
        self._left -= is_true and not self._was_true
        self._was_true = is_true
        return self._left >= 0


def read_condition(data: object, key: str, facts: Collection[str]) -> Condition:
    """Read a condition over facts of these names. Raises FieldError with the path of what is wrong."""
    condition = _read_condition(data, key, facts, 0)
    if (names := sum(1 for _ in names_in(data))) > MAX_NAMES:
        raise FieldError(key, f"{names} names of facts", f"at most {MAX_NAMES}")
    return condition


def _read_condition(data: object, key: str, facts: Collection[str], depth: int) -> Condition:
    if isinstance(data, str):
        if data not in facts:
            raise FieldError(key, f"'{data}'", f"a fact: {nearest(data, tuple(facts))}" if facts else "a fact")
        return _Is(data)
    if not isinstance(data, Mapping) or depth > MAX_DEPTH:
        raise FieldError(key, describe(data), f"the name of a fact or an object, at most {MAX_DEPTH} deep")
    words = [word for word in _WORDS if word in data]
    if len(words) != 1:
        raise FieldError(key, ", ".join(words) or describe(data), f"one of {', '.join(_WORDS)}")
    (word,) = words
    read, others = _WORDS[word]
    for name in data:
        if name != word and name not in others:
            raise FieldError(join(key, str(name)), "an unknown key", nearest(str(name), (word, *others)))
    return read(data, key, lambda part, place: _read_condition(part, place, facts, depth + 1))


def names_in(data: object) -> Iterator[str]:
    """The names of the facts in a condition as a file has it, in order."""
    if isinstance(data, str):
        yield data
    elif isinstance(data, Mapping):
        for word, part in data.items():
            if word != "for_s":
                yield from names_in(part)
    elif isinstance(data, list):
        for part in data:
            yield from names_in(part)


_ReadPart = Callable[[object, str], Condition]


def _parts(data: Mapping[str, object], key: str, word: str, read: _ReadPart) -> list[Condition]:
    found = data[word]
    if not isinstance(found, list) or not 1 <= len(found) <= MAX_PARTS:
        raise FieldError(join(key, word), describe(found), f"a list of 1 to {MAX_PARTS} conditions")
    return [read(part, f"{join(key, word)}[{index}]") for index, part in enumerate(found)]


def _read_hold(data: Mapping[str, object], key: str, read: _ReadPart) -> Condition:
    seconds = data.get("for_s")
    if isinstance(seconds, bool) or not isinstance(seconds, int | float) or not 0 < seconds <= MAX_SECONDS:
        raise FieldError(join(key, "for_s"), describe(seconds), f"seconds above 0, up to {MAX_SECONDS:g}")
    return _Hold(read(data["hold"], join(key, "hold")), float(seconds))


def _read_at_most(data: Mapping[str, object], key: str, read: _ReadPart) -> Condition:
    times = data["at_most"]
    if isinstance(times, bool) or not isinstance(times, int) or not 0 <= times <= MAX_TIMES:
        raise FieldError(join(key, "at_most"), describe(times), f"a whole number from 0 to {MAX_TIMES}")
    if "of" not in data:
        raise FieldError(join(key, "of"), "nothing", "a condition")
    return _AtMost(times, read(data["of"], join(key, "of")))


_WORDS: Mapping[str, tuple[Callable[[Mapping[str, object], str, _ReadPart], Condition], tuple[str, ...]]] = {
    "all": (lambda data, key, read: _Several(_parts(data, key, "all", read), all), ()),
    "any": (lambda data, key, read: _Several(_parts(data, key, "any", read), any), ()),
    "not": (lambda data, key, read: _Not(read(data["not"], join(key, "not"))), ()),
    "once": (lambda data, key, read: _Then([read(data["once"], join(key, "once"))]), ()),
    "then": (lambda data, key, read: _Then(_parts(data, key, "then", read)), ()),
    "hold": (_read_hold, ("for_s",)),
    "at_most": (_read_at_most, ("of",)),
}
"""How each word is read, and the keys that belong to it."""
