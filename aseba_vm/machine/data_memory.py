"""Variable memory: signed words at addresses, in whatever storage the active engine needs."""

from __future__ import annotations

from collections.abc import Iterable, MutableSequence, Sequence
from typing import Any, overload

MIN_WORD, MAX_WORD = -32768, 32767


class Variables(Sequence[int]):
    """A fixed number of words in -32768…32767.

    `words` is the storage: faster to access, and not range-checked. Read the attribute again after every run, since
    an engine may have moved the words.
    """

    __slots__ = ("_owner", "words")

    words: MutableSequence[int]

    def __init__(self, size: int) -> None:
        """Create a memory of `size` zeros."""
        self.words = [0] * size
        self._owner: object = None

    def move_to(self, words: MutableSequence[int], owner: object = None) -> None:
        """Copy the words to a storage of the same size and use it; `owner` is kept alive meanwhile."""
        words[:] = self.words[:]
        self.words, self._owner = words, owner

    def move_back(self) -> None:
        """Copy the words from the storage of an engine back into a list."""
        if self._owner is not None:
            self.words, self._owner = self.words[:], None

    @overload
    def __getitem__(self, place: int) -> int: ...
    @overload
    def __getitem__(self, place: slice) -> list[int]: ...
    def __getitem__(self, place: Any) -> Any:
        """A word or a list of words."""
        return self.words[place]

    @overload
    def __setitem__(self, place: int, value: int) -> None: ...
    @overload
    def __setitem__(self, place: slice, value: Iterable[int]) -> None: ...
    def __setitem__(self, place: Any, value: Any) -> None:
        """Store a word, or as many words as the slice has. Raises ValueError for another number or beyond 16 bits."""
        if isinstance(place, slice):
            value = list(value)
            expected = len(range(*place.indices(len(self.words))))
            if len(value) != expected:
                raise ValueError(f"{len(value)} words found, expected {expected}")
            wrong = [word for word in value if not MIN_WORD <= word <= MAX_WORD]
        else:
            wrong = [] if MIN_WORD <= value <= MAX_WORD else [value]
        if wrong:
            raise ValueError(f"{wrong[0]} found, expected {MIN_WORD} to {MAX_WORD}")
        self.words[place] = value

    def __len__(self) -> int:
        """The number of words."""
        return len(self.words)

    def __eq__(self, other: object) -> bool:
        """Whether the words are equal to those of any sequence."""
        if not isinstance(other, Sequence):
            return NotImplemented
        return self.words[:] == list(other)

    __hash__ = None  # type: ignore[assignment]  # mutable

    def __repr__(self) -> str:
        """The words as text."""
        return f"Variables({self.words[:]})"
