"""Tiered execution: decides what is interpreted and what is translated, and keeps both at the same state.

Translated code executes whole statements. It exits before a statement that cannot be translated, that would fail, or
that the budget does not cover. The interpreter then executes that statement, so every fault, address and instruction
count comes from the interpreter. While translated code runs, the edge flags of branches are kept beside the bytecode;
:meth:`Tiering.flush_edges` writes them into it before anything else reads it.

Programs start in the interpreter. An address where runs often begin, or a long run, is translated. Machines with the
same program share the translation.
"""

from __future__ import annotations

import logging
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from aseba_vm.bytecode import WAS_TRUE
from aseba_vm.jit import python_backend, wasm_backend
from aseba_vm.jit.basic_blocks import Blocks, Memories, find_blocks
from aseba_vm.jit.host import JitHost, PythonHost, Run
from aseba_vm.jit.ir import KnownNative
from aseba_vm.jit.structured_ir import CONTINUE, INTERPRET, STOPPED, StructuredProgram
from aseba_vm.jit.wasm_host import WasmHost
from aseba_vm.jit.wasm_natives import FAULTS
from aseba_vm.machine.code_memory import CodeMemory
from aseba_vm.machine.costs import Costs
from aseba_vm.machine.data_memory import Variables
from aseba_vm.machine.interpreter import ACTIVE
from aseba_vm.machine.machine_messages import Emitted, Message
from aseba_vm.machine.native_call import Native, NativeFault, Signature
from aseba_vm.machine.natives import NATIVES
from aseba_vm.target import TargetDescription

AUTO = "auto"
INTERPRETER = "interpreter"
PYTHON = "python"
WASM = "wasm"
ENGINES = (AUTO, INTERPRETER, PYTHON, WASM)
"""Names of engines: ``auto`` translates hot code to the fastest form available, ``interpreter`` never translates,
``python`` and ``wasm`` translate at once (``wasm`` needs wasmtime).
"""


_CACHE_SIZE = 64
"""Programs whose translations are kept for the whole process."""
_WARM_RUNS = 2
"""Runs that begin at an address before it is translated."""
_WARM_INSTRUCTIONS = 2000
"""Budget that the interpreter gets first in a run that begins at a cold address; a longer run is translated."""
_UNTRANSLATED_SLICE = 256
"""Budget that the interpreter gets before it is tested again whether translated code starts at the next address."""
_MAX_SLICE = 10_000_000
"""Instructions after which translated code returns, so that a user can interrupt an endless program."""


class TieredMachine(Protocol):
    """What the tiering needs of a machine: its state, interpreter and natives."""

    target: TargetDescription
    costs: Costs
    variables: Variables
    stack: list[int]
    pc: int
    sp: int
    flags: int
    instructions: int
    extra_cost: int
    random_state: int
    outbox: list[Message]
    code: CodeMemory

    @property
    def bytecode(self) -> tuple[int, ...]:
        """The words of the bytecode memory, with all edge flags written back."""

    def interpret(self, limit: int) -> int:
        """Execute up to ``limit``; return the budget used."""

    def invoke(self, number: int, pc: int, popped: Sequence[int]) -> bool:
        """Call a native; return False if an argument lies outside memory."""

    def stop_on_native_fault(self, pc: int, fault: NativeFault) -> None:
        """Stop because a native called at ``pc`` raised ``fault``."""


class EntryCode(NamedTuple):
    """Translated code for :meth:`JitHost.instantiate`, the budget it needs to start, the words it may push."""

    code: Any
    need: int
    depth: int


class ReadyCode(NamedTuple):
    """Translated code of one machine: its function, the budget it needs, the highest stack index it may start with."""

    run: Run
    need: int
    highest: int


class Translation:
    """A program and its translations by address; None where it cannot be translated."""

    def __init__(
        self, words: tuple[int, ...], memories: Memories, natives: tuple[KnownNative, ...], *, is_wasm: bool
    ) -> None:
        """Find the basic blocks of a program; each one is translated on demand."""
        self._is_wasm = is_wasm
        self.natives = natives
        self.blocks: Blocks | None = find_blocks(words, memories)
        self._entries: dict[int, EntryCode | None] = {}
        self.canonical = self.without_edges(words)

    def without_edges(self, words: tuple[int, ...]) -> tuple[int, ...]:
        """Return the words with all edge flags cleared."""
        kept = list(words)
        for pc in self.blocks.branches if self.blocks is not None else ():
            kept[pc] &= ~WAS_TRUE
        return tuple(kept)

    def entry(self, pc: int) -> EntryCode | None:
        """Return the translation of the block at ``pc`` and of what follows it."""
        if pc not in self._entries:
            self._entries[pc] = self._translate(pc)
        return self._entries[pc]

    def _translate(self, pc: int) -> EntryCode | None:
        assert self.blocks is not None
        structure = StructuredProgram(self.blocks, pc)
        if structure.is_too_large:
            return None
        translate = wasm_backend.translate if self._is_wasm else python_backend.translate
        try:
            code = translate(self.blocks, structure, self.natives)
        except Exception:  # a bug here or an unsupported wasmtime: the interpreter can run everything
            logging.getLogger(__name__).exception(
                "internal error (please report): no translation at %d, interpreting it", pc
            )
            return None
        return EntryCode(code, structure.main.need, structure.main.depth)


_NO_TRANSLATION = Translation((), Memories(0, 0, 0, ()), (), is_wasm=False)
_translations: OrderedDict[object, Translation] = OrderedDict()


def _translation(
    words: tuple[int, ...], memories: Memories, natives: tuple[KnownNative, ...], *, is_wasm: bool
) -> Translation:
    """Return the translation of a program from the cache; least recently used ones are dropped."""
    key = (words, memories, natives, is_wasm)
    found = _translations.pop(key, None)
    if found is None:
        found = Translation(words, memories, natives, is_wasm=is_wasm)
        while len(_translations) >= _CACHE_SIZE:
            _translations.popitem(last=False)
    _translations[key] = found
    return found


def _known(signature: Signature, functions: Mapping[str, Native]) -> KnownNative:
    """Return what the translators may assume about a native."""
    name = signature.native.name
    function = functions.get(name)
    is_standard = function is not None and function is NATIVES.get(name)
    return KnownNative(signature, function is None or (is_standard and name.startswith("math.")), is_standard)


class Tiering:
    """Executes the events of one machine.

    ``_is_current``: the translation matches the bytecode memory. ``_is_flushed``: the edge flags in the bytecode memory
    are up to date. ``_instances`` has the code instantiated for this machine; ``_ready`` is the part of it that may run
    now.
    """

    def __init__(
        self, machine: TieredMachine, natives: Mapping[str, Native], *, is_eager: bool, is_wasm: bool | None
    ) -> None:
        """``is_eager``: translate at once. ``is_wasm``: to WebAssembly; None: to WebAssembly if it is available."""
        self._machine = machine
        self._is_eager = is_eager
        self._is_wasm = is_wasm
        target = machine.target
        signatures = tuple(Signature.of(native, machine.costs.of(native.name)) for native in target.natives)
        self._natives = tuple(_known(signature, natives) for signature in signatures)
        self._memories = Memories(
            target.variables_size, target.bytecode_size, target.stack_size, signatures, machine.costs.emit
        )
        self._translation = _NO_TRANSLATION
        self._host: JitHost | None = None
        self._is_current = False
        self._is_flushed = True
        self._run_counts: dict[int, int] = {}
        self._instances: dict[int, ReadyCode] = {}
        self._ready: dict[int, ReadyCode] = {}
        self._failure: BaseException | None = None

    def invalidate(self) -> None:
        """Handle a possible change of the bytecode: mark the translation as stale and reset the run counts."""
        self.mark_stale()
        self._run_counts.clear()

    def flush_edges(self) -> None:
        """Write the edge flags of the branches into the bytecode."""
        if self._is_flushed:
            return
        self._is_flushed = True
        assert self._translation.blocks is not None
        assert self._host is not None
        self._machine.code.store_edges(zip(self._translation.blocks.branches, self._host.edges, strict=True))

    def close(self) -> None:
        """Flush the edge flags and move the variables back to the machine's own memory."""
        self.flush_edges()
        self.invalidate()
        if self._host is not None:
            self._host.close()
            self._host = None

    def run(self, limit: int) -> int:
        """Execute the active event up to ``limit``; return the budget used.

        Raises the exception of a native that raised one, and RuntimeError if translated code trapped (a bug).
        """
        # States of an address: cold (interpreted, runs counted), translated (`Translation.entry`), instantiated for
        # this machine (`_instances`), ready (`_ready`: also certain to match the bytecode).
        machine = self._machine
        ready = self._ready.get(machine.pc)
        left = limit
        if ready is None and not self._is_eager and not self._is_warm(machine.pc):
            left -= self._interpret(min(left, _WARM_INSTRUCTIONS))
            ready = None
        while left > 0 and machine.flags & ACTIVE:
            if ready is None:
                ready = self._ready.get(machine.pc) or self._ready_code(machine.pc)
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

    def _ready_code(self, pc: int) -> ReadyCode | None:
        """Return the translated code that starts at ``pc``; None if it must be interpreted."""
        translation = self._translation if self._is_current else self._update_translation()
        entry = (
            translation.entry(pc) if translation.blocks is not None and pc in translation.blocks.by_address else None
        )
        if entry is None:
            return None
        if pc not in self._instances:
            assert self._host is not None
            self._instances[pc] = ReadyCode(
                self._host.instantiate(entry.code), entry.need, self._memories.stack - entry.depth - 1
            )
        self._ready[pc] = self._instances[pc]
        return self._instances[pc]

    def _update_translation(self) -> Translation:
        """Return the translation of the program that is in the machine now."""
        self._is_current = True
        words = self._machine.bytecode
        # Running changes the edge flags in the bytecode, so programs are compared without them.
        known = self._translation
        if known.blocks is None or self._host is None or known.without_edges(words) != known.canonical:
            if self._is_wasm is None:
                self._is_wasm = wasm_backend.is_available()
            self._translation = _translation(words, self._memories, self._natives, is_wasm=self._is_wasm)
            self._instances.clear()
            if self._translation.blocks is not None:
                if self._host is None:
                    self._host = self._new_host(words)
                self._host.reserve_edges(len(self._translation.blocks.branches))
        self._load_edges()
        return self._translation

    def _new_host(self, words: tuple[int, ...]) -> JitHost:
        """Return the host for translated code.

        If WebAssembly fails and was not requested by name, fall back to Python.
        """
        if self._is_wasm:
            try:
                return WasmHost(self)
            except Exception:
                if self._is_eager:
                    raise
                logging.getLogger(__name__).exception("no memory for WebAssembly, translating to Python instead")
                self._is_wasm = False
                self._translation = _translation(words, self._memories, self._natives, is_wasm=False)
        return PythonHost(self)

    def _load_edges(self) -> None:
        """Read the edge flags of the branches from the bytecode."""
        if self._translation.blocks is not None and self._host is not None:
            words = self._machine.code.words
            self._host.edges[:] = [words[pc] >> 9 & 1 for pc in self._translation.blocks.branches]

    def mark_stale(self) -> None:
        """Compare the bytecode again before translated code runs: it may have been executed or changed elsewhere."""
        self._is_current = False
        self._ready.clear()

    def _is_warm(self, pc: int) -> bool:
        """Count a run that starts at ``pc``; return whether there were enough to translate it."""
        count = self._run_counts.get(pc, 0) + 1
        self._run_counts[pc] = count
        return count > _WARM_RUNS

    def _interpret(self, limit: int) -> int:
        """Interpret up to ``limit`` with the edge flags written back; return the budget used."""
        self.flush_edges()
        try:
            return self._machine.interpret(limit)
        finally:
            self._resync()

    def _resync(self) -> None:
        """Take over the changes that the interpreter made in the bytecode.

        Interpreted code can overwrite operands only where an operand is executed as a BRANCH (``is_fragile``).
        """
        blocks = self._translation.blocks
        if blocks is not None and self._is_current:
            self._load_edges()
            if blocks.is_fragile and any(self._machine.code.words[pc] != word for pc, word in blocks.operands.items()):
                self.mark_stale()

    def _run_translated(self, run: Run, left: int) -> int:
        """Run translated code with a budget of ``left`` and apply its exit to the machine; return the budget used."""
        machine = self._machine
        # From here on the edge flags are in the host, not in the bytecode.
        self._is_flushed = False
        rest, pc, kind, words = run(left)
        machine.pc = pc
        if machine.extra_cost:
            rest -= machine.extra_cost
            machine.extra_cost = 0
        done = left - rest
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
            if machine.flags & ACTIVE and rest > 0:
                done += self._interpret(1)
        elif kind != CONTINUE:
            raise RuntimeError(f"internal error (please report): translated code trapped at {pc}")
        return done

    # -- called by translated code (aseba_vm.jit.host.TranslatedMachine)

    @property
    def variables(self) -> Variables:
        """The variables of the machine."""
        return self._machine.variables

    @property
    def random_state(self) -> int:
        """State of the random number generator of the machine."""
        return self._machine.random_state

    @random_state.setter
    def random_state(self, value: int) -> None:
        self._machine.random_state = value

    def call_native(self, number: int, pc: int, popped: tuple[int, ...]) -> int:
        """Call a native. An exception it raises is kept and raised again after translated code has exited."""
        machine = self._machine
        try:
            if not machine.invoke(number, pc, popped):
                return 2
        except BaseException as failure:
            self._failure = failure
            return 1
        return 0 if machine.flags & ACTIVE and self._is_current and not machine.extra_cost else 1

    def stop_on_translated_fault(self, pc: int, reason: int) -> None:
        """Stop the event with entry ``reason`` of ``FAULTS``, counted from 1."""
        for fault in FAULTS[reason - 1]():
            self._machine.stop_on_native_fault(pc, fault)

    def emit(self, number: int, words: tuple[int, ...]) -> None:
        """Emit an event."""
        self._machine.outbox.append(Emitted(number, words))


def create_tiering(name: str, machine: TieredMachine, natives: Mapping[str, Native]) -> Tiering | None:
    """Return the tiering for an engine name, None for the interpreter.

    Raises ValueError for an unknown name, or for ``wasm`` without wasmtime.
    """
    if name not in ENGINES:
        raise ValueError(f"engine: found {name!r}, expected one of {', '.join(ENGINES)}")
    if name == WASM and not wasm_backend.is_available():
        raise ValueError(f"engine {name!r} needs the package wasmtime, which the extra [fast] installs")
    if name == INTERPRETER:
        return None
    return Tiering(machine, natives, is_eager=name != AUTO, is_wasm=None if name == AUTO else name == WASM)
