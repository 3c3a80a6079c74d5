"""Declarations of a program and their places, for editors; also of a text that does not compile."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

from aseba_vm import CompileError, aesl
from aseba_vm.frontend.lexer import Token, tokenize

__all__ = ["Symbol", "outline"]


@dataclass(frozen=True, slots=True)
class Symbol:
    """A declared name; line and column count from 1 in the file."""

    name: str
    line: int
    column: int


@lru_cache(maxsize=32)
def outline(node: aesl.Node) -> Mapping[str, tuple[Symbol, ...]]:
    """Keyword (`var`, `sub`, `onevent`) → what it declares, in order, as far as the text can be read."""
    found: dict[str, list[Symbol]] = {"var": [], "sub": [], "onevent": []}
    for keyword, name in pairwise(_tokens(node.code)):
        if keyword.kind in found and name.kind == "identifier":
            row, column = node.place(name.pos.offset)
            found[keyword.kind].append(Symbol(name.text, row + 1, column + 1))
    return {keyword: tuple(symbols) for keyword, symbols in found.items()}


def _tokens(code: str) -> Sequence[Token]:
    try:
        return tokenize(code)
    except CompileError as error:
        if error.pos is None or not 0 < error.pos.offset < len(code):
            return ()
        return _tokens(code[: error.pos.offset])
