"""The context of an error: the tokens around it, and the queries of recognizers about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from aseba_vm.errors import CompileError, Edit, Hint
from aseba_vm.frontend.lexer import Token, tokenize
from aseba_vm.frontend.parser import COMPOUND
from aseba_vm.frontend.symbols import SymbolTable
from aseba_vm.frontend.token_spacing import token_begin, token_end
from aseba_vm.target import NativeFunction

TOKENS, GRAMMAR, LATER_PASSES = 0, 1, 2
"""Stages of an attempt."""

CONDITIONS = frozenset(("if", "elseif", "when", "while"))
STATEMENTS = frozenset(("if", "when", "while", "for", "emit", "_emit", "call", "callsub", "return"))
HANDLER_ENDS = ("onevent", "sub", "end-of-input")
"""Tokens that end a handler or subroutine."""
CONNECTORS = frozenset(
    ("+", "-", "*", "/", "%", "<", ">", "==", "!=", "<=", ">=", "|", "^", "&", "<<", ">>", "and", "or")
)
"""Operators with a left and a right operand."""
BEFORE_VALUE = CONNECTORS | CONDITIONS | COMPOUND | frozenset(("=", "(", "[", ",", ":", "~", "not", "abs"))
"""Tokens that a value follows."""
_AFTER_STATEMENT = frozenset(("then", "do", "else", "end", "return", "integer", ")", "]", "++", "--"))


@dataclass(frozen=True, slots=True)
class Attempt:
    """A rejected text: the pass that found the error (TOKENS, GRAMMAR or LATER_PASSES), the error, the known names."""

    stage: int
    error: CompileError
    symbols: SymbolTable

    @property
    def offset(self) -> int:
        """Offset of the error, 0 if it has no position."""
        return 0 if self.error.pos is None else self.error.pos.offset


@dataclass(frozen=True, slots=True)
class Word:
    """A token with its range in the text."""

    kind: str
    text: str
    start: int
    end: int
    row: int


@dataclass(frozen=True, slots=True)
class ErrorContext:
    """An error with the tokens of its text.

    Methods count in tokens from the error: distance 0 is the rejected token, -1 the one before it.

    Attributes:
        source: the rejected text.
        words: its tokens; only those before the error if the lexer rejected it. The last one is `end-of-input`.
        at: index of the rejected token in `words`.
        offset: index of its first character in `source`.
        error: the error.
        symbols: the names of the target, and those of the program before the error.
        natives: native functions of the target by name.
    """

    source: str
    words: Sequence[Word]
    at: int
    offset: int
    error: CompileError
    symbols: SymbolTable
    natives: Mapping[str, NativeFunction]

    def kind(self, distance: int = 0) -> str:
        """The kind of a token near the error; empty before the first and after the last."""
        index = self.at + distance
        return self.words[index].kind if 0 <= index < len(self.words) else ""

    def word(self, distance: int = 0) -> Word:
        """A token near the error. Raises IndexError after the last one."""
        return self.words[self.at + distance]

    def is_adjacent(self, distance: int) -> bool:
        """Whether a token near the error touches the next one."""
        first = self.at + distance
        return 0 <= first < len(self.words) - 1 and self.words[first].end == self.words[first + 1].start

    def replaced(self, kind: str, first: int, last: int, text: str, *arguments: str | int) -> Hint:
        """A hint with an edit that replaces the tokens from one distance to another."""
        return Hint(kind, arguments, Edit(self.word(first).start, self.word(last).end, text))

    @property
    def subs(self) -> set[str]:
        """The names of the subroutines of the program."""
        return {name.text for keyword, name in pairwise(self.words) if keyword.kind == "sub"}

    @property
    def declared(self) -> set[str]:
        """The names of all variables of the program, also of those below the error."""
        return {name.text for keyword, name in pairwise(self.words) if keyword.kind == "var"}

    @property
    def is_statement_expected(self) -> bool:
        """Whether the error is an unexpected token where a statement may start."""
        keywords = ("call", "callsub", "onevent", "sub", "emit", "_emit", "for", "in", ":", "step")
        return self.error.arguments[:1] == ("identifier",) and self.kind(-1) not in keywords

    def condition(self, *, with_assignment: bool = False) -> str:
        """The keyword of the condition that contains the error, empty if there is none.

        `with_assignment`: an `=` does not end the condition.
        """
        ends = {"then", "do", "else", "end", "onevent", "sub", "call", "callsub", "emit", "return", "var", "const"}
        for word in reversed(self.words[: self.at]):
            if word.kind in CONDITIONS:
                return word.kind
            if word.kind in ends or (word.kind == "=" and not with_assignment):
                return ""
        return ""

    def is_statement(self, distance: int = 0) -> bool:
        """Whether a token near the error is the first of a statement."""
        before = self.kind(distance - 1)
        if before == "identifier":
            return self.kind(distance - 2) not in ("emit", "_emit", "call", "for")
        return before == "" or before in _AFTER_STATEMENT

    def closing(self, distance: int) -> int | None:
        """The distance of the parenthesis that closes the one at a distance, None if there is none."""
        return self._closing(distance, {"(": 1, ")": -1})

    def bracket(self, distance: int) -> int | None:
        """The distance of the bracket that closes the one at a distance, None if there is none."""
        return self._closing(distance, {"[": 1, "]": -1})

    def _closing(self, distance: int, steps: Mapping[str, int]) -> int | None:
        depth = 0
        for index in range(self.at + distance, len(self.words)):
            depth += steps.get(self.words[index].kind, 0)
            if depth == 0:
                return index - self.at
        return None


def locate_error(source: str, attempt: Attempt) -> ErrorContext | None:
    """The context of the error of an attempt, None if the position of the error is not that of a token.

    Raises no error: a text whose beginning cannot be tokenized has no context.
    """
    error, offset = attempt.error, attempt.offset
    is_token = attempt.stage == TOKENS
    try:
        tokens = tokenize(source[:offset] if is_token else source)
    except CompileError:
        return None
    words = [_word(source, token) for token in tokens[:-1]]
    words.append(Word("end-of-input", "", len(source), len(source), words[-1].row + 1 if words else 0))
    at: int | None = len(words) - 1
    if not is_token:
        found = [index for index, token in enumerate(tokens) if token.pos == error.pos]
        # The end of input has the position of the last character, which may belong to a token.
        ends = [index for index in found if tokens[index].kind in error.arguments]
        at = next(iter(ends or found), None)
    if at is None:
        return None
    natives = {native.name: native for native in attempt.symbols.native_functions}
    start = offset if is_token else words[at].start
    return ErrorContext(source, words, at, start, error, attempt.symbols, natives)


def _word(source: str, token: Token) -> Word:
    return Word(token.kind, token.text, token_begin(token), token_end(source, token), token.pos.row)


def spaced(source: str, start: int, end: int, word: str) -> str:
    """A word in place of symbols, with spaces where it would touch its neighbors."""
    if not word:
        return ""
    before = " " if start > 0 and not source[start - 1].isspace() and source[start - 1] != "(" else ""
    after = " " if end < len(source) and not source[end].isspace() and source[end] != ")" else ""
    return f"{before}{word}{after}"
