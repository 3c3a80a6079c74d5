"""Translations of programs, shared by all machines of the process that execute the same program."""

from __future__ import annotations

import logging
from collections import OrderedDict
from typing import NamedTuple

from aseba_vm.bytecode import WAS_TRUE
from aseba_vm.jit import wasm_backend
from aseba_vm.jit.basic_blocks import Memories, find_blocks
from aseba_vm.jit.ir import KnownNative
from aseba_vm.jit.structured_ir import StructuredProgram
from aseba_vm.jit.wasm_host import WasmCode
from aseba_vm.machine.code_memory import CodeMemory

_CACHE_SIZE = 64
"""Programs whose translations are kept."""


class EntryCode(NamedTuple):
    """A translated block and what follows it, the budget it needs to start, the words it may push."""

    code: WasmCode
    need: int
    depth: int


class Translation:
    """A program and its translations by address; None where it cannot be translated."""

    def __init__(self, words: tuple[int, ...], memories: Memories, natives: tuple[KnownNative, ...]) -> None:
        """Find the basic blocks of a program; each one is translated on demand."""
        self._natives = natives
        self._blocks = find_blocks(words, memories)
        self._entries: dict[int, EntryCode | None] = {}
        self._canonical = self._without_edges(words)

    def matches(self, words: tuple[int, ...]) -> bool:
        """Whether this is the translation of a program. Edge flags change as it runs and do not count."""
        return self._without_edges(words) == self._canonical

    def is_modified(self, code: CodeMemory) -> bool:
        """Whether the interpreter has changed an operand, by executing it as a BRANCH."""
        blocks = self._blocks
        return (
            blocks is not None
            and blocks.is_fragile
            and any(code.word(pc) != word for pc, word in blocks.operands.items())
        )

    def entry(self, pc: int) -> EntryCode | None:
        """The translation of the block at `pc` and of what follows it."""
        if pc not in self._entries:
            self._entries[pc] = self._translate(pc)
        return self._entries[pc]

    def _without_edges(self, words: tuple[int, ...]) -> tuple[int, ...]:
        kept = list(words)
        for pc in self._blocks.branches if self._blocks is not None else ():
            kept[pc] &= ~WAS_TRUE
        return tuple(kept)

    def _translate(self, pc: int) -> EntryCode | None:
        if self._blocks is None or pc not in self._blocks.by_address:
            return None
        structure = StructuredProgram(self._blocks, pc)
        if structure.is_too_large:
            return None
        try:
            code = wasm_backend.translate(self._blocks, structure, self._natives)
        except Exception:  # a bug here or an unsupported wasmtime: the interpreter can run everything
            logging.getLogger(__name__).exception(
                "internal error (please report): no translation at %d, interpreting it", pc
            )
            return None
        return EntryCode(code, structure.main.need, structure.main.depth)


_translations: OrderedDict[object, Translation] = OrderedDict()


def find_translation(words: tuple[int, ...], memories: Memories, natives: tuple[KnownNative, ...]) -> Translation:
    """The translation of a program from the cache; least recently used ones are dropped."""
    key = (words, memories, natives)
    translation = _translations.pop(key, None)
    if translation is None:
        translation = Translation(words, memories, natives)
        while len(_translations) >= _CACHE_SIZE:
            _translations.popitem(last=False)
    _translations[key] = translation
    return translation
