"""Exceptions of the bridge."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["BridgeError", "FrameError"]


class BridgeError(ThymioSimError):
    """Base of the exceptions of the bridge."""


class FrameError(BridgeError):
    """A frame violates the protocol: `where` in the frame, what was `expected` and what was `found`."""

    def __init__(self, where: str, expected: str, found: str) -> None:
        super().__init__(f"{where}: expected {expected}, found {found}")
        self.where = where
        self.expected = expected
        self.found = found
