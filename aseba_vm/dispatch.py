"""How events reach a machine, without a robot: two policies, one interface.

Source: docs/spec/aseba-bytecode-vm.md section 10.5.

``raise_local(name)`` and ``receive(event, source, arguments)`` tell what happens; ``turn(limit)`` is one turn of the
main loop. The robot itself lets a global event kill a handler; here it waits, as pupils expect of a queue.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import Protocol

from aseba_vm.vm import VirtualMachine

TURN = 65535
"""Instructions of one turn of the firmware's main loop."""

STEP = 1000
"""Instructions of one step of the reference's playground; a longer handler goes on.

Source: docs/spec/thymio-robot.md section 3.
"""

MOST_WAITING = 100
"""Global events that may wait; more are refused."""


class Dispatch(Protocol):
    """What both policies offer."""

    def raise_local(self, name: str) -> None:
        """Tell that a local event of the target happened. Raises KeyError for a name that the target lacks."""

    def receive(self, event: int, source: int = 0, arguments: Sequence[int] = ()) -> bool:
        """Take a global event from the network; tell whether there was room for it."""

    def turn(self, limit: int = ...) -> bool:
        """Execute at most ``limit`` instructions of each handler that is due; tell whether anything was done."""


class FirmwareDispatch:
    """As the robot: nothing interrupts a handler. Local events wait as one flag each, global ones in line."""

    def __init__(self, machine: VirtualMachine) -> None:
        """Serve a machine; forget what waits with :meth:`clear`, as the robot does in a reset."""
        self.machine = machine
        self._pending: set[int] = set()
        self._incoming: deque[tuple[int, int, tuple[int, ...]]] = deque()

    @property
    def pending(self) -> tuple[str, ...]:
        """Local events that wait, the next one first."""
        return tuple(self.machine.target.local_events[index].name for index in sorted(self._pending))

    def clear(self) -> None:
        """Forget all events that wait."""
        self._pending.clear()
        self._incoming.clear()

    def raise_local(self, name: str) -> None:
        """Flag a local event; occurrences that wait together are one."""
        self._pending.add(0xFFFE - self.machine.target.local_event_number(name))

    def receive(self, event: int, source: int = 0, arguments: Sequence[int] = ()) -> bool:
        """Put a global event in line."""
        if len(self._incoming) >= MOST_WAITING:
            return False
        self._incoming.append((event, source, tuple(arguments)))
        return True

    def turn(self, limit: int = TURN) -> bool:
        """Continue the active handler; if there is none any more, start what waits: global events, then local ones."""
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
    """As the simulated robot of the reference: an event starts at once and kills the handler that is active."""

    def __init__(self, machine: VirtualMachine) -> None:
        """Serve a machine."""
        self.machine = machine

    def raise_local(self, name: str) -> None:
        """Start a local event; nothing happens while the machine is paused inside a handler."""
        machine = self.machine
        number = machine.target.local_event_number(name)
        machine.receive(number, machine.node_id, ())

    def receive(self, event: int, source: int = 0, arguments: Sequence[int] = ()) -> bool:
        """Start a global event; nothing happens while the machine is paused inside a handler."""
        self.machine.receive(event, source, arguments)
        return True

    def turn(self, limit: int = STEP) -> bool:
        """Execute the active handler."""
        return self.machine.run(limit)
