"""Errors for unknown names, with a suggestion if a known name is similar (docs/spec/aseba-language.md section 5.3)."""

from __future__ import annotations

from collections.abc import Iterable

from aseba_vm.errors import CompileError, SourcePos

_MAX_DISTANCE = 2


def unknown_name_error(kind: str, name: str, known: Iterable[str], pos: SourcePos) -> CompileError:
    """The error `kind`, or `kind-hint` with the most similar known name."""
    hint = suggestion(name, known)
    return CompileError(kind, (name,), pos) if hint is None else CompileError(f"{kind}-hint", (name, hint), pos)


def suggestion(name: str, known: Iterable[str], most: int = _MAX_DISTANCE) -> str | None:
    """The known name at the smallest distance from 1 to `most`, at most 2; the first in code point order."""
    best = None
    best_distance = min(most, _MAX_DISTANCE) + 1
    for candidate in sorted(known):
        if abs(len(candidate) - len(name)) < best_distance:
            distance = _distance(name, candidate)
            if 0 < distance < best_distance:
                best, best_distance = candidate, distance
    return best


def _distance(one: str, two: str) -> int:
    """The Levenshtein distance, or a larger number than the maximum.

    Only a band around the diagonal of the matrix can stay below the maximum, so only that is computed.
    """
    far = _MAX_DISTANCE + 1
    previous = {column: column for column in range(far)}
    for row, left in enumerate(one, start=1):
        current: dict[int, int] = {}
        for column in range(max(row - _MAX_DISTANCE, 0), min(row + _MAX_DISTANCE, len(two)) + 1):
            best = min(previous.get(column, far), current.get(column - 1, far)) + 1
            if column > 0:
                best = min(best, previous.get(column - 1, far) + (left != two[column - 1]))
            current[column] = best
        if min(current.values(), default=far) >= far:
            return far
        previous = current
    return previous.get(len(two), far)
