"""Pass 2, expressions: tokens to vectors (docs/spec/aseba-language.md sections 4 and 6).

A recursive-descent parser with one method per grammar rule; the docstring of each method is its rule. Names are
resolved and constant indexes evaluated while parsing.
"""

from __future__ import annotations

from collections.abc import Mapping

from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.frontend.folding import simplify
from aseba_vm.frontend.lexer import Token
from aseba_vm.frontend.symbols import SymbolTable
from aseba_vm.frontend.syntax_tree import Access, Binary, Expression, ListLiteral, Number, Subscript, Unary
from aseba_vm.frontend.token_stream import TokenStream
from aseba_vm.frontend.trampoline import Task
from aseba_vm.frontend.vectors import first_constant

_OPERATORS: Mapping[str, int] = {
    symbol: power
    for power, symbols in enumerate(
        ("or", "and", "", "== != < <= > >=", "|", "^", "&", "<< >>", "+ -", "* / %"), start=1
    )
    for symbol in symbols.split()
}
"""Precedence of each binary operator, lowest first; `not` is between `and` and the comparisons."""

_CONDITION = _OPERATORS["or"]
_NOT = _OPERATORS["and"] + 1
_EXPRESSION = _OPERATORS["|"]

_PRIMARY = ("(", "[", "-", "~", "abs", "identifier", "integer")


class ExpressionParser:
    """Parses expressions from a token stream; shares stream and symbol table with the parser of statements.

    A rule is a generator that the trampoline runs (`aseba_vm.frontend.trampoline`), so that deep nesting needs no
    deep stack. Each rule raises CompileError at the first token that does not fit; its docstring is its grammar.
    """

    def __init__(self, stream: TokenStream, symbols: SymbolTable) -> None:
        self.stream = stream
        self.symbols = symbols

    def condition(self) -> Task[Expression]:
        """condition = and , { "or" , and }"""
        return self.expression(_CONDITION)

    def expression(self, level: int = _EXPRESSION) -> Task[Expression]:
        """
        condition = and , { "or" , and }                and = not , { "and" , not }
        not = { "not" } , comparison                    comparison = expr , { ( "==" | … ) , expr }
        expr = bitxor , { "|" , bitxor }   and so on down to   product = unary , { ( "*" | "/" | "%" ) , unary }
        """
        left: Expression
        if self.stream.token.kind == "not" and level <= _NOT:
            pos = self.stream.advance().pos
            left = Unary("not", (yield self.expression(_NOT)), pos)
        else:
            left = yield self.unary()
        while _OPERATORS.get(self.stream.token.kind, 0) >= level:
            symbol = self.stream.advance()
            right: Expression = yield self.expression(_OPERATORS[symbol.kind] + 1)
            left = Binary(symbol.kind, left, right, symbol.pos)
        return left

    def unary(self) -> Task[Expression]:
        """unary = "(" , condition , ")" | list | ( "-" | "~" | "abs" ) , unary | INTEGER | IDENT | variable"""
        token = self.stream.token
        kind = token.kind
        if kind == "integer":
            self.stream.advance()
            return literal(token, token.value)
        if kind == "identifier":
            self.stream.advance()
            if token.text in self.symbols.constants:
                return self.symbols.constant(token.text, token.pos)
            variable: Expression = yield self.variable(token)
            return variable
        if kind == "[":
            listing: ListLiteral = yield self.listing()
            return listing
        if kind == "(":
            self.stream.advance()
            inner: Expression = yield self.condition()
            self.stream.expect(")")
            return inner
        if kind not in ("-", "~", "abs"):
            raise CompileError("expected-one-of", (_PRIMARY, kind), token.pos)
        self.stream.advance()
        if kind == "-" and self.stream.token.kind == "integer":
            number = self.stream.advance()
            return literal(number, -number.value)
        return Unary(kind, (yield self.unary()), token.pos)

    def listing(self) -> Task[ListLiteral]:
        """list = "[" , element , { "," , element } , "]\""""
        start = self.stream.expect("[")
        items: list[Expression] = [(yield self.element())]
        while self.stream.token.kind == ",":
            self.stream.advance()
            items.append((yield self.element()))
        self.stream.expect("]")
        return ListLiteral(tuple(items), start.pos)

    def element(self) -> Task[Expression]:
        """element = list | expr"""
        return self.listing() if self.stream.token.kind == "[" else self.expression()

    def variable(self, name: Token) -> Task[Expression]:
        """variable = IDENT , [ "[" , expr , [ ":" , expr ] , "]" ]"""
        variable = self.symbols.variable(name.text, name.pos)
        if self.stream.token.kind != "[":
            return Access(variable, 0, variable.size - 1, name.pos)
        self.stream.advance()
        index: Expression = yield self.expression()
        value, fault = _attempt(index)
        if value is None:
            self.stream.expect("]")
            return Subscript(variable, index, fault, name.pos)
        last = value
        is_slice = self.stream.token.kind == ":"
        if is_slice:
            colon = self.stream.advance()
            end: Expression = yield self.expression()
            end_value, _ = _attempt(end)
            if end_value is None:
                raise CompileError("slice-end-not-constant", (), colon.pos)
            if end_value < value:
                raise CompileError("slice-reversed", (), self.stream.token.pos)
            last = end_value
        self.stream.expect("]")
        return Access(variable, value, last, name.pos, is_slice)


def literal(token: Token, value: int) -> Number:
    """A number that was written with or without a minus sign. Raises CompileError if it is out of range."""
    if not -32768 <= value <= 32767:
        raise CompileError("int16-range", (abs(value),), token.pos)
    return Number(value, token.pos)


def constant_value(expression: Expression, pos: SourcePos) -> int:
    """The value of a constant expression (docs/spec/aseba-language.md section 9.3). Raises CompileError."""
    simple = simplify(first_constant(expression))
    if not isinstance(simple, Number):
        raise CompileError("not-constant", (), pos)
    return simple.value


def _attempt(expression: Expression) -> tuple[int | None, CompileError | None]:
    """The value of a constant index; else None, and the error if the evaluation failed."""
    try:
        simple = simplify(first_constant(expression))
    except CompileError as error:
        return None, error.with_traceback(None)
    return (simple.value if isinstance(simple, Number) else None), None
