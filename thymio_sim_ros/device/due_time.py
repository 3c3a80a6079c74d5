"""The time at which a device has work next."""

from __future__ import annotations

__all__ = ["DueTime"]


class DueTime:
    """The simulated time in ns from which a device has work, if nothing else happens before.

    The parts of a device bring it forward whenever they get work; the device computes it anew when all work is done.
    """

    __slots__ = ("ns",)

    def __init__(self) -> None:
        self.ns = 0

    def set_now(self) -> None:
        """Make the device due at once."""
        self.ns = 0

    def bring_forward(self, time_ns: int) -> None:
        """Make the device due at this time, unless it is due earlier."""
        if time_ns < self.ns:
            self.ns = time_ns
