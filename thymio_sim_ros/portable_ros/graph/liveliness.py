"""The liveliness of a publisher that asserts it itself, with the policy MANUAL_BY_TOPIC."""

from __future__ import annotations

import threading
from typing import Protocol

from thymio_sim_ros.portable_ros.graph.protocols import EndEvents

__all__ = ["Lease", "LeaseTimer"]


class LeaseTimer(Protocol):
    """A timer that runs once after each `reset`, and then calls `Lease.end`."""

    def reset(self) -> None:
        """Start the lease."""

    def cancel(self) -> None:
        """Wait for the next start."""

    def destroy(self) -> None:
        """End it."""


class Lease:
    """A publisher is alive from each message or assertion on for the lease. Thread-safe.

    As with Fast DDS, a subscription counts a publisher from its first assertion on.
    """

    def __init__(self) -> None:
        self.timer: LeaseTimer | None = None
        self._lock = threading.Lock()
        self._known: dict[EndEvents, bool] = {}
        """Whether the publisher is alive for each subscription that counts it."""

    def begin(self, readers: list[EndEvents]) -> None:
        """Start the lease anew for the present subscriptions."""
        with self._lock:
            for reader in readers:
                before = self._known.get(reader)
                self._known[reader] = True
                if not before:
                    reader.report_liveliness(1, 0 if before is None else -1)
        if self.timer is not None:
            self.timer.reset()

    def end(self) -> None:
        """Note that the lease is over."""
        if self.timer is not None:
            self.timer.cancel()
        with self._lock:
            for reader, is_alive in self._known.items():
                self._known[reader] = False
                if is_alive:
                    reader.report_liveliness(-1, 1)

    def forget(self, reader: EndEvents) -> None:
        """Count no more in a subscription that ends."""
        with self._lock:
            self._known.pop(reader, None)

    def destroy(self) -> None:
        """Count no more in any subscription: the publisher is destroyed."""
        if self.timer is not None:
            self.timer.destroy()
        with self._lock:
            while self._known:
                reader, is_alive = self._known.popitem()
                reader.report_liveliness(-1 if is_alive else 0, 0 if is_alive else -1)
