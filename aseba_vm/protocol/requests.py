"""Requests that need several messages, because a message carries at most `MAX_WORDS` words."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from aseba_vm.protocol.messages import MAX_WORDS, GetVariables, SetBytecode, SetVariables

__all__ = ["read_ranges", "set_bytecode", "set_variables"]


def set_bytecode(node: int, words: Sequence[int], *, source: int = 0) -> list[SetBytecode]:
    """The messages that load a program; an empty one is a message without words."""
    starts = range(0, max(len(words), 1), MAX_WORDS)
    return [SetBytecode(source, node, start, tuple(words[start : start + MAX_WORDS])) for start in starts]


def set_variables(node: int, start: int, values: Sequence[int], *, source: int = 0) -> list[SetVariables]:
    """The messages that write values (int16) from an address on."""
    return [
        SetVariables(source, node, start + begin, tuple(values[begin : begin + MAX_WORDS]))
        for begin in range(0, len(values), MAX_WORDS)
    ]


def read_ranges(node: int, places: Iterable[tuple[int, int]], *, source: int = 0) -> list[GetVariables]:
    """The fewest messages that read all places, which are pairs of address and size in words.

    Adjacent places share a message. A place is cut only if it is longer than a message can carry, so that the values of
    one variable are of the same moment.
    """
    messages: list[GetVariables] = []
    begin = end = 0

    def finish() -> None:
        messages.extend(
            GetVariables(source, node, start, min(end - start, MAX_WORDS)) for start in range(begin, end, MAX_WORDS)
        )

    for address, size in sorted(place for place in places if place[1] > 0):
        place_end = address + size
        if begin <= address <= end and max(end, place_end) - begin <= MAX_WORDS:
            end = max(end, place_end)
            continue
        finish()
        begin, end = address, place_end
    finish()
    return messages
