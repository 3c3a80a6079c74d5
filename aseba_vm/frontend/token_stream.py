"""Token stream with look-ahead."""

from __future__ import annotations

from collections.abc import Sequence

from aseba_vm.errors import CompileError
from aseba_vm.frontend.lexer import Token


class TokenStream:
    """A position in a sequence of tokens that ends with end-of-input; it never moves past that."""

    def __init__(self, tokens: Sequence[Token]) -> None:
        self.tokens = tokens
        self.at = 0
        self.token = tokens[0]

    def advance(self) -> Token:
        """Return the current token and move to the next one."""
        token = self.token
        if self.at + 1 < len(self.tokens):
            self.at += 1
            self.token = self.tokens[self.at]
        return token

    def peek(self, distance: int) -> str:
        """Return the kind of the token ``distance`` positions ahead."""
        return self.tokens[min(self.at + distance, len(self.tokens) - 1)].kind

    def expect(self, kind: str) -> Token:
        """Return the current token and move on. Raises CompileError if it is not of this kind."""
        if self.token.kind != kind:
            raise CompileError("expected-token", (kind, self.token.kind), self.token.pos)
        return self.advance()
