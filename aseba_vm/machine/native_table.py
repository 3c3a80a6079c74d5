"""The natives of a machine by number: what they cost, and how they are called."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple, Protocol

from aseba_vm.machine.costs import Costs
from aseba_vm.machine.machine_messages import DivisionByZero, Fault, Message, NodeSpecific, OutOfBounds
from aseba_vm.machine.native_call import Native, NativeCall, NativeMachine, Signature
from aseba_vm.machine.native_faults import DequeFault, DivisionFault, NativeFault
from aseba_vm.machine.natives import StandardNative
from aseba_vm.target import NativeFunction


class NativeOwner(NativeMachine, Protocol):
    """The machine of the natives."""

    outbox: list[Message]

    def stop_on(self, fault: Fault) -> None:
        """Stop the event because of a fault."""


class _Entry(NamedTuple):
    """A native, and the last call at each place of the program with the words that it popped."""

    function: Native
    signature: Signature
    calls: dict[int, tuple[Sequence[int], NativeCall | None]]


_NO_CALL: tuple[Sequence[int], NativeCall | None] = (), None


class NativeTable:
    """The natives that the target of a machine declares."""

    def __init__(
        self, machine: NativeOwner, declared: Sequence[NativeFunction], functions: Mapping[str, Native], costs: Costs
    ) -> None:
        """A native without a function pops its arguments and leaves a NativeCalled message."""
        self._machine = machine
        self._entries = [
            _Entry(self._function(number, native, functions), Signature.of(native, costs.of(native.name)), {})
            for number, native in enumerate(declared)
        ]

    def __len__(self) -> int:
        """The number of natives."""
        return len(self._entries)

    def __getitem__(self, number: int) -> tuple[Native, Signature]:
        """A function and its signature."""
        entry = self._entries[number]
        return entry.function, entry.signature

    def count_popped(self, number: int) -> int:
        """Number of words that a native pops."""
        return self._entries[number].signature.count

    def cost(self, number: int, popped: Sequence[int]) -> int:
        """The cost of a call beyond its instruction."""
        return self._entries[number].signature.call_cost(popped)

    def call(self, number: int, pc: int, popped: Sequence[int]) -> bool:
        """Call a native from `pc` with the words it pops.

        Returns:
            False if an argument lies outside the memory; the native was not called then.
        """
        function, signature, calls = self._entries[number]
        # A place of a program nearly always pops the same words.
        known, call = calls.get(pc, _NO_CALL)
        if call is None or known != popped or call.memory is not self._machine.variables.words:
            call = NativeCall(self._machine, signature, popped)
            if not call.is_inside_memory:
                return False
            calls[pc] = popped, call
        try:
            function(call)
        except NativeFault as fault:
            self.stop_on(pc, fault)
        return True

    def stop_on(self, pc: int, fault: NativeFault) -> None:
        """Stop the event because a native called at `pc` raised `fault`."""
        machine = self._machine
        if isinstance(fault, DivisionFault):
            machine.stop_on(DivisionByZero(pc))
        elif isinstance(fault, DequeFault):
            for _ in range(fault.times):
                machine.stop_on(OutOfBounds(pc))
        else:
            machine.stop_on(NodeSpecific(pc, fault.reason))

    def _function(self, number: int, native: NativeFunction, functions: Mapping[str, Native]) -> Native:
        function = functions.get(native.name)
        if isinstance(function, StandardNative) and not function.fits(native):
            return function.adapted
        return function or (lambda call: self._machine.outbox.append(call.record(number)))
