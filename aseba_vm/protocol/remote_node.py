"""One node of a network as a client knows it: description, variables as last read, state of the machine."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from aseba_vm.frontend.pipeline import Program
from aseba_vm.protocol.messages import GetVariables
from aseba_vm.protocol.reports import ExecutionState
from aseba_vm.target import TargetDescription

__all__ = ["RemoteNode"]


@dataclass(slots=True)
class _Read:
    """A request for variables that is not answered yet."""

    start: int
    count: int
    sent_ns: int
    written: set[int] = field(default_factory=set)
    """Addresses that were written after the request: the answer has older values."""


class RemoteNode:
    """The data that has been read from a node. Only `NodeClient` writes it; it is read-only for all other code."""

    def __init__(self, number: int, version: int, description: TargetDescription) -> None:
        """Create a node of which no variable has been read yet."""
        self.number = number
        """Its id on the network."""
        self.version = version
        """The version of the protocol that it has announced."""
        self.description = description
        """Memories, variables, local events and native functions."""
        self.state: ExecutionState | None = None
        """The state that it has reported last."""
        self.addresses: Mapping[str, tuple[int, int]] = {}
        """Address and size in words of each variable by name, those of the known program included."""
        self._memory: list[int | None] = [None] * description.variables_size
        self._reads: list[_Read] = []
        self.set_program(None)

    @property
    def is_reading(self) -> bool:
        """Whether values that were requested have not arrived yet."""
        return bool(self._reads)

    def value(self, name: str) -> tuple[int, ...] | None:
        """Words (int16) of a variable as last read or written; None before. Raises KeyError for an unknown name."""
        address, size = self.addresses[name]
        words = self._memory[address : address + size]
        known = tuple(word for word in words if word is not None)
        return known if len(known) == size else None

    def values(self) -> dict[str, tuple[int, ...]]:
        """Words of all variables that have been read, by name in order of address."""
        values = {name: self.value(name) for name in self.addresses}
        return {name: words for name, words in values.items() if words is not None}

    def places(self, names: Iterable[str] | None = None) -> list[tuple[int, int]]:
        """Address and size of these variables, or of all. Raises KeyError for an unknown name."""
        return [self.addresses[name] for name in (self.addresses if names is None else names)]

    def set_program(self, program: Program | None) -> None:
        """Replace the variables of the program; their values are unknown. None: the program is not known."""
        end = self.description.variables_end
        self._memory[end:] = [None] * (self.description.variables_size - end)
        addresses = {**self.description.addresses, **(program.addresses if program is not None else {})}
        inside = {name: place for name, place in addresses.items() if sum(place) <= len(self._memory)}
        self.addresses = dict(sorted(inside.items(), key=lambda item: item[1]))

    def expect(self, request: GetVariables, now_ns: int) -> None:
        """Note a request for variables."""
        self._reads.append(_Read(request.start, request.count, now_ns))

    def overdue(self, sent_before_ns: int) -> list[tuple[int, int]]:
        """Forget the requests sent before a time.

        Returns:
            Start address and number of words of each.
        """
        overdue = [(read.start, read.count) for read in self._reads if read.sent_ns < sent_before_ns]
        self._reads = [read for read in self._reads if read.sent_ns >= sent_before_ns]
        return overdue

    def write(self, start: int, values: Sequence[int]) -> None:
        """Store values that are written; answers to earlier requests do not replace them."""
        self.store(start, values)
        for read in self._reads:
            read.written.update(range(start, start + len(values)))

    def store(self, start: int, values: Sequence[int], kept: Collection[int] = ()) -> tuple[str, ...]:
        """Store values except at the `kept` addresses.

        Returns:
            Names of the variables that have changed, in order of address.
        """
        end = min(start + len(values), len(self._memory))
        before = self._memory[start:end]
        after = [
            known if start + index in kept else value
            for index, (known, value) in enumerate(zip(before, values, strict=False))
        ]
        if before == after:
            return ()
        self._memory[start:end] = after
        return tuple(
            name
            for name, (address, size) in self.addresses.items()
            if address < end
            and start < address + size
            and before[max(0, address - start) : address + size - start]
            != self._memory[max(address, start) : min(address + size, end)]
        )

    def finish_read(self, start: int, count: int) -> Collection[int]:
        """Note that values arrived: all or the first ones of the oldest request from this address on.

        Returns:
            The addresses that were written since that request.
        """
        for index, read in enumerate(self._reads):
            if read.start == start:
                # a robot on the radio answers in pieces
                rest = [_Read(start + count, read.count - count, read.sent_ns, read.written)]
                self._reads[index : index + 1] = rest if 0 < count < read.count else []
                return read.written
        return ()
