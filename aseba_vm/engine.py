"""The engine: decides what runs interpreted and what translated, and keeps the two at one state.

Translated code runs whole statements. It leaves before a statement that it cannot do, that would fail, or that the
budget does not cover; the interpreter then does that statement as always, so that every fault, every address and every
count is the interpreter's own. What branches remember is kept beside the bytecode while translated code runs
and written into it (:meth:`Engine.settle`) before anybody else looks.

Programs start interpreted; a place where runs begin often, or a run that is long, is translated. Machines with the same
program share its translation.
"""

from __future__ import annotations

import logging
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple, Protocol

from aseba_vm import engine_python, engine_wasm
from aseba_vm.blocks import Blocks, Known, Memories, find_blocks
from aseba_vm.bytecode import WAS_TRUE
from aseba_vm.codememory import CodeMemory
from aseba_vm.engine_python import Function
from aseba_vm.nativecall import Native, Signature
from aseba_vm.natives import NATIVES
from aseba_vm.outbox import Emitted, Message
from aseba_vm.structure import INTERPRET, STOPPED, Structure
from aseba_vm.target import TargetDescription

AUTO = "auto"
INTERPRETER = "interpreter"
PYTHON = "python"
WASM = "wasm"
ENGINES = (AUTO, INTERPRETER, PYTHON, WASM)
"""Names of engines: the best there is, once a program proves hot; no translation; translation at once, to Python or
WebAssembly (which needs wasmtime)."""

_ACTIVE = 1
_KEPT_PROGRAMS = 64
_WARM_RUNS = 2
_WARM_INSTRUCTIONS = 2000
_WEIRD_STRETCH = 256


class Machine(Protocol):
    """What the engine needs of a machine: its state, its interpreter, its natives."""

    target: TargetDescription
    variables: list[int]
    stack: list[int]
    pc: int
    sp: int
    flags: int
    instructions: int
    outbox: list[Message]
    code: CodeMemory

    @property
    def bytecode(self) -> tuple[int, ...]:
        """The words of the bytecode memory, settled."""

    def interpret(self, limit: int) -> int:
        """Execute at most ``limit`` instructions; return how many were."""

    def invoke(self, number: int, pc: int, popped: Sequence[int]) -> bool:
        """Call a native; return False if its arguments lie outside memory."""


class Entry(NamedTuple):
    """Translated code: what makes the function of one machine, the budget it needs to begin, the words it may push."""

    make: Callable[[], Function]
    need: int
    depth: int


class Translation:
    """A program and its translations by address; None where it cannot be translated."""

    def __init__(
        self, words: tuple[int, ...], memories: Memories, natives: tuple[Known, ...], *, is_wasm: bool
    ) -> None:
        """Find the blocks of a program; what they become is made when asked for."""
        self._is_wasm = is_wasm
        self.natives = natives
        self.blocks: Blocks | None = find_blocks(words, memories)
        self._entries: dict[int, Entry | None] = {}
        self.canonical = self.without_memory(words)

    def without_memory(self, words: tuple[int, ...]) -> tuple[int, ...]:
        """Return words as they are when no branch remembers anything."""
        kept = list(words)
        for pc in self.blocks.branches if self.blocks is not None else ():
            kept[pc] &= ~WAS_TRUE
        return tuple(kept)

    def entry(self, pc: int) -> Entry | None:
        """Return the translation of the block at ``pc`` and what follows."""
        if pc not in self._entries:
            self._entries[pc] = self._translate(pc)
        return self._entries[pc]

    def _translate(self, pc: int) -> Entry | None:
        assert self.blocks is not None
        structure = Structure(self.blocks, pc)
        if structure.is_too_large:
            return None
        translate = engine_wasm.translate if self._is_wasm else engine_python.translate
        try:
            make = translate(self.blocks, structure, self.natives)
        except Exception:  # a defect of ours, or a wasmtime that we don't know: the interpreter can run everything
            logging.getLogger(__name__).exception("no translation at %d: the interpreter runs it", pc)
            return None
        return Entry(make, structure.main.need, structure.main.depth)


_NOTHING = Translation((), Memories(0, 0, 0, ()), (), is_wasm=False)
_translations: OrderedDict[object, Translation] = OrderedDict()


def _translation(
    words: tuple[int, ...], memories: Memories, natives: tuple[Known, ...], *, is_wasm: bool
) -> Translation:
    """Return the translation of a program, the same for the same program."""
    key = (words, memories, natives, is_wasm)
    found = _translations.pop(key, None)
    if found is None:
        found = Translation(words, memories, natives, is_wasm=is_wasm)
        while len(_translations) >= _KEPT_PROGRAMS:
            _translations.popitem(last=False)
    _translations[key] = found
    return found


def _known(signature: Signature, functions: Mapping[str, Native]) -> Known:
    name = signature.native.name
    function = functions.get(name)
    is_standard = function is not None and function is NATIVES.get(name)
    return Known(signature, function is None or (is_standard and name.startswith("math.")), is_standard)


class Engine:
    """Runs the events of one machine."""

    def __init__(
        self, machine: Machine, natives: Mapping[str, Native], *, is_eager: bool, is_wasm: bool | None
    ) -> None:
        """``is_eager``: translate at once. ``is_wasm``: to WebAssembly; None: if that is possible."""
        self._machine = machine
        self._is_eager = is_eager
        self._is_wasm = is_wasm
        target = machine.target
        signatures = tuple(Signature.of(native) for native in target.natives)
        self._natives = tuple(_known(signature, natives) for signature in signatures)
        self._memories = Memories(target.variables_size, target.bytecode_size, target.stack_size, signatures)
        self._translation = _NOTHING
        self._is_known = False
        self._memory: list[int] = []
        self._is_settled = True
        self._heat: dict[int, int] = {}
        self._made: dict[int, Function] = {}

    def forget(self) -> None:
        """The bytecode may have changed."""
        self._is_known = False
        self._heat.clear()

    def settle(self) -> None:
        """Write into the bytecode what the branches remember."""
        if self._is_settled:
            return
        self._is_settled = True
        assert self._translation.blocks is not None
        self._machine.code.remember(zip(self._translation.blocks.branches, self._memory, strict=True))

    def run(self, limit: int) -> int:
        """Execute at most ``limit`` instructions of the active event; return how many were."""
        machine = self._machine
        left = limit
        if not self._is_eager and not self._is_warm(machine.pc):
            left -= self._interpret(min(left, _WARM_INSTRUCTIONS))
        while left > 0 and machine.flags & _ACTIVE:
            translation = self._translation if self._is_known else self._prepare()
            if translation.blocks is None:
                left -= self._interpret(left)
            elif machine.pc not in translation.blocks.by_address:
                left -= self._interpret(1)
            else:
                entry = translation.entry(machine.pc)
                if entry is None or machine.sp + entry.depth >= self._memories.stack:
                    left -= self._interpret(min(left, _WEIRD_STRETCH))
                elif left < entry.need:
                    left -= self._interpret(left)
                else:
                    left -= self._translated(entry, left)
        return limit - left

    def _prepare(self) -> Translation:
        """Return the translation of the program that is in the machine now."""
        self._is_known = True
        words = self._machine.bytecode
        known = self._translation
        if known.blocks is None or known.without_memory(words) != known.canonical:
            if self._is_wasm is None:
                self._is_wasm = engine_wasm.is_available()
            self._translation = _translation(words, self._memories, self._natives, is_wasm=self._is_wasm)
            self._made.clear()
        self._load()
        return self._translation

    def _load(self) -> None:
        """Read from the bytecode what the branches remember."""
        if self._translation.blocks is not None:
            words = self._machine.code.words
            self._memory = [words[pc] >> 9 & 1 for pc in self._translation.blocks.branches]

    def _is_warm(self, pc: int) -> bool:
        """Count a run that begins at ``pc``; tell whether there were many."""
        heat = self._heat.get(pc, 0) + 1
        self._heat[pc] = heat
        return heat > _WARM_RUNS

    def _interpret(self, limit: int) -> int:
        self.settle()
        done = self._machine.interpret(limit)
        blocks = self._translation.blocks
        if blocks is not None and self._is_known:
            self._load()
            if blocks.is_fragile and any(self._machine.code.words[pc] != word for pc, word in blocks.operands.items()):
                self._is_known = False
        return done

    def _translated(self, entry: Entry, left: int) -> int:
        machine = self._machine
        self._is_settled = False
        function = self._made.get(machine.pc)
        if function is None:
            function = self._made[machine.pc] = entry.make()
        rest, pc, kind, words = function(machine.variables, self._memory, left, self._call, self._emit)
        sp = machine.sp
        if words:
            machine.stack[sp + 1 : sp + 1 + len(words)] = words
            machine.sp = sp + len(words)
        machine.pc = pc
        done: int = left - rest
        machine.instructions += done
        if kind == STOPPED:
            machine.flags &= ~_ACTIVE
        elif kind == INTERPRET and machine.flags & _ACTIVE and rest:
            done += self._interpret(1)
        return done

    def _call(self, number: int, pc: int, popped: tuple[int, ...]) -> int:
        """Call a native. Return 0 if the event goes on, 1 if translated code must be left, 2 if nothing was done."""
        machine = self._machine
        if not machine.invoke(number, pc, popped):
            return 2
        return 0 if machine.flags & _ACTIVE and self._is_known else 1

    def _emit(self, number: int, words: tuple[int, ...]) -> None:
        self._machine.outbox.append(Emitted(number, words))


def new_engine(name: str, machine: Machine, natives: Mapping[str, Native]) -> Engine | None:
    """Return an engine by name, None to interpret. Raises ValueError for an unknown name."""
    if name not in ENGINES:
        raise ValueError(f"engine {name!r} is not one of {', '.join(ENGINES)}")
    if name == INTERPRETER:
        return None
    return Engine(machine, natives, is_eager=name != AUTO, is_wasm=None if name == AUTO else name == WASM)
