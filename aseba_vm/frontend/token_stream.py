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
        """Move to the next token and return the one before it."""
        token = self.token
        if self.at + 1 < len(self.tokens):
            self.at += 1
            self.token = self.tokens[self.at]
        return token

    def peek(self, distance: int) -> str:
        """The kind of the token `distance` positions ahead."""
        return self.tokens[min(self.at + distance, len(self.tokens) - 1)].kind

    def expect(self, kind: str) -> Token:
        """Move to the next token and return the one before it. Raises CompileError if that is of another kind."""
        if self.token.kind != kind:
            raise CompileError("expected-token", (kind, self.token.kind), self.token.pos)
        return self.advance()
