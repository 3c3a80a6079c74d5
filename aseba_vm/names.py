"""Look-up of names, with the suggestion for one that is not found (language spec, section 5.3)."""

from __future__ import annotations

from collections.abc import Iterable

from aseba_vm.errors import CompileError, SourcePos

_MAX_DISTANCE = 2


def not_found(kind: str, name: str, known: Iterable[str], pos: SourcePos) -> CompileError:
    """Return the error ``kind``, or ``kind-hint`` with the nearest known name."""
    hint = suggestion(name, known)
    return CompileError(kind, (name,), pos) if hint is None else CompileError(f"{kind}-hint", (name, hint), pos)


def suggestion(name: str, known: Iterable[str]) -> str | None:
    """Return the known name at the smallest distance 1 or 2; of several, the first in code point order."""
    best = None
    best_distance = _MAX_DISTANCE + 1
    for candidate in sorted(known):
        if abs(len(candidate) - len(name)) < best_distance:
            distance = _distance(name, candidate)
            if 0 < distance < best_distance:
                best, best_distance = candidate, distance
    return best


def _distance(one: str, two: str) -> int:
    """Levenshtein distance, or anything above the maximum as soon as that is certain."""
    previous = list(range(len(two) + 1))
    for row, left in enumerate(one, start=1):
        current = [row]
        for column, right in enumerate(two, start=1):
            current.append(min(previous[column] + 1, current[-1] + 1, previous[column - 1] + (left != right)))
        if min(current) > _MAX_DISTANCE:
            return _MAX_DISTANCE + 1
        previous = current
    return previous[-1]
