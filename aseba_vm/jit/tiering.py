"""Tiered execution: selects the code that is translated; the interpreter executes the rest.

Translated code executes whole statements on the state of the machine itself. It exits before a statement that cannot be
translated, that would fail, or that the budget does not cover. The interpreter then executes that statement, so every
fault, address and instruction count comes from the interpreter.

Programs start in the interpreter. An address where runs often begin, or a long run, is translated. Machines with the
same program share the translation.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, MutableSequence, Sequence
from typing import NamedTuple, Protocol

from aseba_vm.jit.basic_blocks import Memories
from aseba_vm.jit.ir import KnownNative
from aseba_vm.jit.program_state import TRANSITIONS, Change, State
from aseba_vm.jit.structured_ir import CONTINUE, INTERPRET, STOPPED
from aseba_vm.jit.translation import Translation, find_translation
from aseba_vm.jit.wasm_host import CallSite, EmitSite, Run, WasmHost
from aseba_vm.kernel.wasm_runtime import is_usable
from aseba_vm.machine.interpreter import interpret
from aseba_vm.machine.machine_messages import Emitted
from aseba_vm.machine.native_call import Native, NativeCall, Signature
from aseba_vm.machine.native_faults import FAULTS, OK, NativeFault
from aseba_vm.machine.natives import StandardNative
from aseba_vm.machine.reference import ACTIVE, InterpretedMachine

AUTO = "auto"
INTERPRETER = "interpreter"
WASM = "wasm"
ENGINES = (AUTO, INTERPRETER, WASM)
"""Names of engines: `auto` translates hot code to WebAssembly where wasmtime works, `interpreter` never translates,
`wasm` translates at once.
"""

_WARM_RUNS = 2
"""Runs that begin at an address before it is translated."""
_WARM_INSTRUCTIONS = 2000
"""Budget that the interpreter gets first in a run that begins at a cold address; a longer run is translated."""
_UNTRANSLATED_SLICE = 256
"""Budget that the interpreter gets before it is tested again whether translated code starts at the next address."""
_MAX_SLICE = 10_000_000
"""Instructions after which translated code returns, so that a user can interrupt an endless program."""


class TieredMachine(InterpretedMachine, Protocol):
    """The part of a machine that the tiering uses: state, interpreter and natives."""

    node_id: int
    random: MutableSequence[int]

    def charge(self, instructions: int) -> None:
        """Add to the cost of the native that is being called."""


class ReadyCode(NamedTuple):
    """Translated code of one machine: its function, the budget it needs, the highest stack index it may start with."""

    run: Run
    need: int
    highest: int


class Tiering:
    """Executes the events of one machine."""

    def __init__(self, machine: TieredMachine, *, is_eager: bool) -> None:
        """`is_eager`: translate at once."""
        self.state = State.COLD
        self._machine = machine
        self._is_eager = is_eager
        target = machine.target
        self._natives = tuple(_known(*machine.natives[number]) for number in range(len(machine.natives)))
        signatures = tuple(native.signature for native in self._natives)
        self._memories = Memories(
            target.variables_size, target.bytecode_size, target.stack_size, signatures, machine.costs.emit
        )
        self._host: WasmHost | None = None
        self._translation: Translation | None = None
        self._run_counts: dict[int, int] = {}
        self._ready: dict[int, ReadyCode | None] = {}
        """Translated code by address, None where there is none."""
        self._runnable: Mapping[int, ReadyCode | None] = {}
        """The same in the state TRANSLATED, otherwise empty."""
        self._failure: BaseException | None = None

    def apply(self, change: Change) -> None:
        """Make the transition of the state for a change."""
        self.state = TRANSITIONS[self.state, change]
        self._runnable = self._ready if self.state is State.TRANSLATED else {}

    def close(self) -> None:
        """Move the state of the machine back into its own memory."""
        if self._host is not None:
            self._host.close()
            self._host = None

    def run(self, limit: int) -> int:
        """Execute the active event up to `limit` instructions, and return the budget used.

        Raises:
            Exception: Whatever a native raises, unchanged.
            RuntimeError: Translated code trapped, which is an internal error.
        """
        machine = self._machine
        ready = self._runnable.get(machine.pc)
        left = limit
        if ready is None and not self._is_eager and not self._is_warm(machine.pc):
            left -= self._interpret(min(left, _WARM_INSTRUCTIONS))
        while left > 0 and machine.flags & ACTIVE:
            if ready is None:
                ready = self._ready_code(machine.pc)
            # Not translated, or the stack might overflow in translated code, which does not check it: interpret. With
            # a budget too small for translated code to start, interpret the rest.
            if ready is None or machine.sp > ready.highest:
                left -= self._interpret(min(left, _UNTRANSLATED_SLICE))
            elif left < ready.need:
                left -= self._interpret(left)
            else:
                left -= self._run_translated(ready.run, left if left < _MAX_SLICE else _MAX_SLICE)
            ready = None
        return limit - left

    def _is_warm(self, pc: int) -> bool:
        """Count a run that starts at `pc`.

        Returns:
            Whether enough runs have started there to translate the code.
        """
        if self.state is State.INTERPRETED:
            return False
        count = self._run_counts.get(pc, 0) + 1
        self._run_counts[pc] = count
        return count > _WARM_RUNS

    def _ready_code(self, pc: int) -> ReadyCode | None:
        """The translated code that starts at `pc`; None if it must be interpreted."""
        if self.state is State.WRITTEN:
            self._compare()
        if self.state is State.COLD:
            self._translate()
        if self.state is State.INTERPRETED:
            return None
        if pc not in self._ready:
            self._ready[pc] = self._instantiate(pc)
        return self._ready[pc]

    def _compare(self) -> None:
        """Find out whether the program is still the one that was translated."""
        assert self._translation is not None
        if self._translation.matches(self._machine.code.words):
            self.apply(Change.FOUND_EQUAL)
            return
        self._run_counts.clear()
        self.apply(Change.FOUND_DIFFERENT)

    def _translate(self) -> None:
        """Prepare the translation of the program."""
        try:
            if not is_usable():
                self.apply(Change.FAILED)
                return
            self.close()  # with the code of the program before: a store frees its instances only all at once
            self._host = WasmHost(self._machine, self)
        except Exception:
            if self._is_eager:
                raise
            logging.getLogger(__name__).exception("no memory for WebAssembly, programs are interpreted")
            self.apply(Change.FAILED)
            return
        self._translation = find_translation(self._machine.code.words, self._memories, self._natives)
        self._ready.clear()
        self.apply(Change.TRANSLATED)

    def _instantiate(self, pc: int) -> ReadyCode | None:
        assert self._translation is not None
        assert self._host is not None
        entry = self._translation.entry(pc)
        if entry is None:
            return None
        return ReadyCode(self._host.instantiate(entry.code), entry.need, self._memories.stack - entry.depth - 1)

    def _interpret(self, limit: int) -> int:
        """Interpret up to `limit` instructions, and return the budget used."""
        machine = self._machine
        # Translated code does not decode again what may contain a BRANCH whose edge flag it has changed.
        for pc in machine.code.overlapped:
            machine.code.refresh(pc)
        try:
            return interpret(machine, limit)
        finally:
            # Also after an exception of a native: the program may have modified itself before.
            translation = self._translation if self.state is State.TRANSLATED else None
            if translation is not None and translation.is_modified(machine.code):
                self.apply(Change.WRITTEN)

    def _run_translated(self, run: Run, left: int) -> int:
        """Run translated code with a budget of `left`, apply its exit to the machine, and return the budget used."""
        machine = self._machine
        # Translated code counts its own instructions. Costs that natives added are not in its budget, so a call that
        # adds some exits at once (`_prepare_call`), and they are charged here.
        rest, machine.pc, kind, words = run(left)
        done = left - rest
        if machine.extra_cost:
            done += machine.extra_cost
            machine.extra_cost = 0
        machine.instructions += done
        if words:
            sp = machine.sp
            machine.stack[sp + 1 : sp + 1 + len(words)] = words
            machine.sp = sp + len(words)
        if kind == STOPPED:
            machine.flags &= ~ACTIVE
        elif kind == INTERPRET:
            if self._failure is not None:
                failure, self._failure = self._failure, None
                raise failure
            # Translated code left before a statement that it cannot execute: the interpreter executes its first
            # instruction, and reports the fault if there is one.
            if machine.flags & ACTIVE and left > done:
                done += self._interpret(1)
        elif kind != CONTINUE:
            raise RuntimeError(f"internal error (please report): translated code trapped at {machine.pc}")
        return done

    # -- called by translated code (aseba_vm.jit.wasm_host.Caller)

    def prepare(self, site: CallSite | EmitSite) -> Callable[[Sequence[int]], int]:
        """The function that executes a native call, or that emits an event."""
        return self._prepare_call(site) if isinstance(site, CallSite) else self._prepare_event(site)

    def _prepare_event(self, site: EmitSite) -> Callable[[Sequence[int]], int]:
        memory, outbox = self._machine.variables.words, self._machine.outbox
        number, start, end = site.number, site.address, site.address + site.words

        def emit(_popped: Sequence[int]) -> int:
            outbox.append(Emitted(number, tuple(memory[start:end])))
            return 0

        return emit

    def _prepare_call(self, site: CallSite) -> Callable[[Sequence[int]], int]:
        """The function that executes a native call. An exception of the native is raised after the exit."""
        machine, number, pc = self._machine, site.number, site.pc

        # No exception may cross translated code (`Caller`), so it is kept until the exit. Translated code also exits
        # after a native that ended the event, wrote bytecode (`_runnable` is empty then) or added to its cost.
        def call(popped: Sequence[int]) -> int:
            try:
                if not machine.natives.call(number, pc, popped[: site.words]):
                    return 2
            except BaseException as failure:
                self._failure = failure
                return 1
            return 0 if machine.flags & ACTIVE and self._runnable and not machine.extra_cost else 1

        if site.popped is None:
            return call
        function, signature = machine.natives[number]
        prepared = NativeCall(machine, signature, site.popped)

        def call_prepared(_popped: Sequence[int]) -> int:
            try:
                function(prepared)
            except NativeFault as fault:
                machine.natives.stop_on(pc, fault)
                return 1
            except BaseException as failure:
                self._failure = failure
                return 1
            return 0 if machine.flags & ACTIVE and self._runnable and not machine.extra_cost else 1

        return call_prepared

    def finish(self, site: CallSite, result: int, cost: int) -> None:
        """Account for a translated native that returned a fault, or added to its cost."""
        self._machine.charge(cost)
        if result != OK:
            self._machine.natives.stop_on(site.pc, FAULTS[result]())


def _known(function: Native, signature: Signature) -> KnownNative:
    """The translator's view of a native."""
    return KnownNative(signature, function.kernel if isinstance(function, StandardNative) else None)


def create_tiering(name: str, machine: TieredMachine) -> Tiering | None:
    """The tiering for an engine name, None for the interpreter.

    Raises ValueError for an unknown name, or for `wasm` without wasmtime.
    """
    if name not in ENGINES:
        raise ValueError(f"engine: found {name!r}, expected one of {', '.join(ENGINES)}")
    if name == WASM and not is_usable():
        raise ValueError(f"engine {name!r} needs the package wasmtime, which does not work here")
    return None if name == INTERPRETER else Tiering(machine, is_eager=name == WASM)
