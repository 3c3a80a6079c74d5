"""The engine: decides what runs interpreted and what translated, and keeps the two at one state.

Translated code runs whole statements. It leaves before a statement that it cannot do, that would fail, or that the
budget does not cover; the interpreter then does that statement as always, so that every fault, every address and every
count is the interpreter's own. What branches remember is kept beside the bytecode while translated code runs
and written into it (:meth:`Engine.settle`) before anybody else looks.

Programs start interpreted; a place where runs begin often, or a run that is long, is translated. Machines with the same
program share its translation.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from aseba_vm.blocks import Blocks, Memories, find_blocks
from aseba_vm.bytecode import WAS_TRUE
from aseba_vm.engine_python import Function, translate
from aseba_vm.nativecall import Native, Signature
from aseba_vm.natives import NATIVES
from aseba_vm.outbox import Emitted
from aseba_vm.structure import INTERPRET, STOPPED, Structure

if TYPE_CHECKING:
    from aseba_vm.vm import VirtualMachine

AUTO = "auto"
INTERPRETER = "interpreter"
PYTHON = "python"
ENGINES = (AUTO, INTERPRETER, PYTHON)
"""Names of engines: the best there is, once a program proves hot; no translation; translation at once."""

_ACTIVE = 1
_KEPT_PROGRAMS = 64
_WARM_RUNS = 2
_WARM_INSTRUCTIONS = 2000
_WEIRD_STRETCH = 256


class Entry(NamedTuple):
    """Translated code: what to call, the budget it needs to begin, the words of stack it may use."""

    function: Function
    need: int
    depth: int


class Translation:
    """A program and its translations by address; None where it cannot be translated."""

    def __init__(self, words: tuple[int, ...], memories: Memories, natives: tuple[tuple[Signature, bool], ...]) -> None:
        """Find the blocks of a program; what they become is made when asked for."""
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

    def is_block(self, pc: int) -> bool:
        """Tell whether a block begins at ``pc``."""
        return self.blocks is not None and pc in self.blocks.by_address

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
        function = translate(self.blocks, structure, self.natives)
        return Entry(function, structure.main.need, structure.main.depth)


_translations: OrderedDict[object, Translation] = OrderedDict()


def _translation(
    words: tuple[int, ...], memories: Memories, natives: tuple[tuple[Signature, bool], ...]
) -> Translation:
    """Return the translation of a program, the same for the same program."""
    key = (words, memories, tuple(is_confined for _, is_confined in natives))
    found = _translations.pop(key, None)
    if found is None:
        found = Translation(words, memories, natives)
        while len(_translations) >= _KEPT_PROGRAMS:
            _translations.popitem(last=False)
    _translations[key] = found
    return found


class Engine:
    """Runs the events of one machine. ``is_eager``: translate at once."""

    def __init__(self, machine: VirtualMachine, natives: Mapping[str, Native], *, is_eager: bool = False) -> None:
        self._machine = machine
        self._is_eager = is_eager
        target = machine.target
        signatures = tuple(Signature.of(native) for native in target.natives)
        self._functions = [natives.get(native.name) for native in target.natives]
        self._natives = tuple(
            (
                signature,
                function is None
                or (signature.native.name[:5] == "math." and function is NATIVES.get(signature.native.name)),
            )
            for signature, function in zip(signatures, self._functions, strict=True)
        )
        self._memories = Memories(target.variables_size, target.bytecode_size, target.stack_size, signatures)
        self._translation: Translation | None = None
        self._is_known = False
        self._memory: list[int] = []
        self._is_settled = True
        self._heat: dict[int, int] = {}

    def forget(self) -> None:
        """The bytecode may have changed."""
        self._is_known = False
        self._heat.clear()

    def settle(self) -> None:
        """Write into the bytecode what the branches remember."""
        if self._is_settled:
            return
        self._is_settled = True
        assert self._translation is not None
        assert self._translation.blocks is not None
        self._machine.remember(zip(self._translation.blocks.branches, self._memory, strict=True))

    def run(self, limit: int) -> int:
        """Execute at most ``limit`` instructions of the active event; return how many were."""
        machine = self._machine
        left = limit
        translation = self._prepare()
        interpreted = 0
        is_warm = self._is_eager or self._warm(machine.pc)
        while left > 0 and machine.flags & _ACTIVE:
            if not is_warm:
                done = self._interpret(min(left, _WARM_INSTRUCTIONS))
                interpreted += done
                is_warm = interpreted >= _WARM_INSTRUCTIONS
            elif translation is None:
                done = self._interpret(left)
            elif not translation.is_block(machine.pc):
                done = self._interpret(1)
            else:
                entry = translation.entry(machine.pc)
                if entry is None or machine.sp + entry.depth >= self._memories.stack:
                    done = self._interpret(min(left, _WEIRD_STRETCH))
                elif left < entry.need:
                    done = self._interpret(left)
                else:
                    done = self._translated(entry, left)
            if not self._is_known:
                translation = self._prepare()
            left -= done
        return limit - left

    def _prepare(self) -> Translation | None:
        """Return the translation of the program in the machine, None if it cannot have any."""
        if not self._is_known:
            self._is_known = True
            words = self._machine.bytecode
            known = self._translation
            if known is None or known.without_memory(words) != known.canonical:
                self._translation = _translation(words, self._memories, self._natives)
            self._load()
        translation = self._translation
        return translation if translation is not None and translation.blocks is not None else None

    def _load(self) -> None:
        """Read from the bytecode what the branches remember."""
        translation = self._translation
        if translation is not None and translation.blocks is not None:
            words = self._machine.words
            self._memory = [words[pc] >> 9 & 1 for pc in translation.blocks.branches]

    def _warm(self, pc: int) -> bool:
        """Count a run that begins at ``pc``; tell whether there were many."""
        heat = self._heat.get(pc, 0) + 1
        self._heat[pc] = heat
        return heat > _WARM_RUNS

    def _interpret(self, limit: int) -> int:
        self.settle()
        done = self._machine.interpret(limit)
        blocks = self._translation.blocks if self._translation is not None else None
        if blocks is not None and self._is_known:
            self._load()
            if blocks.is_fragile and any(self._machine.words[pc] != word for pc, word in blocks.operands.items()):
                self._is_known = False
        return done

    def _translated(self, entry: Entry, left: int) -> int:
        machine = self._machine
        self._is_settled = False
        rest, pc, kind, words = entry.function(machine.variables, self._memory, left, self._call, self._emit)
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


def new_engine(name: str, machine: VirtualMachine, natives: Mapping[str, Native]) -> Engine | None:
    """Return an engine by name, None to interpret. Raises ValueError for an unknown name."""
    if name not in ENGINES:
        raise ValueError(f"engine {name!r} is not one of {', '.join(ENGINES)}")
    return None if name == INTERPRETER else Engine(machine, natives, is_eager=name != AUTO)
