"""Notices of a device to its user."""

from __future__ import annotations

__all__ = ["MAX_NOTICES", "Notices"]

MAX_NOTICES = 50
"""Limit of different notices of a device, because a program can cause any number of them."""


class Notices:
    """Notices of one device. Invariant: each text is returned at most once."""

    def __init__(self) -> None:
        self._known: set[str] = set()
        self._pending: list[str] = []

    def add(self, text: str) -> None:
        """Add a notice, unless the same text was added before or `MAX_NOTICES` texts were."""
        if text not in self._known and len(self._known) < MAX_NOTICES:
            self._known.add(text)
            self._pending.append(text)

    def pop(self) -> list[str]:
        """Return the notices added since the last call, in order."""
        pending, self._pending = self._pending, []
        return pending
