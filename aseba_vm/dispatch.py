"""Delivery of events to a machine without a robot: two policies with one interface.

Source: docs/spec/aseba-bytecode-vm.md section 10.5.

`raise_local(name)` and `receive(event, source, arguments)` deliver events; `run(limit)` is one iteration of the
main loop. On the robot a global event kills the active handler; FirmwareDispatch queues it instead, as pupils expect.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import Protocol

from aseba_vm.vm import VirtualMachine

FIRMWARE_BUDGET = 65535
"""Instructions per iteration of the firmware's main loop."""

PLAYGROUND_BUDGET = 1000
"""Instructions per step of the reference's playground; a longer handler continues in the next step.

Source: docs/spec/thymio-robot.md section 3.
"""

MAX_QUEUED_EVENTS = 100
"""Capacity of the queue of global events; further events are rejected."""


class Dispatch(Protocol):
    """Interface of both policies."""

    def raise_local(self, name: str) -> None:
        """Raise a local event of the target. Raises KeyError for a name that the target lacks."""

    def receive(self, event: int, source: int = 0, arguments: Sequence[int] = ()) -> bool:
        """Accept a global event from the network.

        Returns:
            Whether there was room for it.
        """

    def run(self, limit: int = ...) -> bool:
        """Execute at most `limit` instructions of each handler that is due.

        Returns:
            Whether any instruction was executed.
        """


class FirmwareDispatch:
    """Dispatch of the robot: handlers are never interrupted. Local events are flags, global events are queued."""

    def __init__(self, machine: VirtualMachine) -> None:
        """Dispatch events to a machine. Call `clear` when it is reset, as the robot does."""
        self.machine = machine
        self._pending: set[int] = set()
        self._incoming: deque[tuple[int, int, tuple[int, ...]]] = deque()

    @property
    def pending(self) -> tuple[str, ...]:
        """Names of the pending local events, the next one first."""
        return tuple(self.machine.target.local_events[index].name for index in sorted(self._pending))

    def clear(self) -> None:
        """Discard all pending events."""
        self._pending.clear()
        self._incoming.clear()

    def raise_local(self, name: str) -> None:
        """Set the flag of a local event; several occurrences before it is handled count as one."""
        self._pending.add(0xFFFE - self.machine.target.local_event_number(name))

    def receive(self, event: int, source: int = 0, arguments: Sequence[int] = ()) -> bool:
        """Append a global event to the queue.

        Returns:
            False if the queue is full; the event is dropped then.
        """
        if len(self._incoming) >= MAX_QUEUED_EVENTS:
            return False
        self._incoming.append((event, source, tuple(arguments)))
        return True

    def run(self, limit: int = FIRMWARE_BUDGET) -> bool:
        """Continue the active handler; if none is left, start the next global event, else the next local one."""
        has_run = self.machine.run(limit)
        if self.machine.is_active:
            return has_run
        if self._incoming:
            self.machine.receive(*self._incoming.popleft())
            has_run = True
        if self._pending and not self.machine.is_active:
            index = min(self._pending)
            self._pending.remove(index)
            self.machine.start_local(index)
            has_run = True
        return has_run


class PlaygroundDispatch:
    """Dispatch of the reference's simulated robot: an event starts at once and kills the active handler."""

    def __init__(self, machine: VirtualMachine) -> None:
        """Dispatch events to a machine."""
        self.machine = machine

    def raise_local(self, name: str) -> None:
        """Start a local event. Does nothing while the machine is paused inside a handler."""
        machine = self.machine
        number = machine.target.local_event_number(name)
        machine.receive(number, machine.node_id, ())

    def receive(self, event: int, source: int = 0, arguments: Sequence[int] = ()) -> bool:
        """Start a global event. Does nothing while the machine is paused inside a handler."""
        self.machine.receive(event, source, arguments)
        return True

    def run(self, limit: int = PLAYGROUND_BUDGET) -> bool:
        """Execute at most `limit` instructions of the active handler."""
        return self.machine.run(limit)
