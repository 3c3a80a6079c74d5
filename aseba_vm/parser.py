"""Second pass: tokens to tree (language spec, sections 4 to 7 and 10).

A recursive-descent parser, one method per rule of the grammar, which stands above it. Names are looked up, constants
evaluated and the temporary words of events and natives allocated on the way, as the order of errors demands.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.lexer import Token
from aseba_vm.optimise import simplify
from aseba_vm.recursion import Task, run
from aseba_vm.symbols import Symbols
from aseba_vm.target import TargetDescription
from aseba_vm.tree import (
    Access,
    Argument,
    Assignment,
    Binary,
    Block,
    Call,
    CallSub,
    Compound,
    ElementArgument,
    Emit,
    Expression,
    For,
    If,
    Listing,
    Memory,
    Number,
    OnEvent,
    Return,
    Statement,
    Sub,
    Subscript,
    Tree,
    Unary,
    While,
)
from aseba_vm.vectors import check_address, first_element, size_of

_OPERATORS: Mapping[str, int] = {
    symbol: power
    for power, symbols in enumerate(
        ("or", "and", "", "== != < <= > >=", "|", "^", "&", "<< >>", "+ -", "* / %"), start=1
    )
    for symbol in symbols.split()
}
"""How strongly each binary operator binds; ``not`` stands between ``and`` and the comparisons."""

_CONDITION = _OPERATORS["or"]
_NOT = _OPERATORS["and"] + 1
_EXPRESSION = _OPERATORS["|"]

_COMPOUND = frozenset(("+=", "-=", "*=", "/=", "%=", "|=", "^=", "&=", "<<=", ">>="))
_PRIMARY = ("(", "[", "-", "~", "abs", "identifier", "integer")


def parse(
    tokens: Sequence[Token],
    target: TargetDescription,
    events: Sequence[tuple[str, int]] = (),
    constants: Sequence[tuple[str, int]] = (),
) -> Tree:
    """Return the tree of a program. Raises CompileError."""
    return run(_Parser(tokens, Symbols(target, events, constants)).program())


class _Parser:
    def __init__(self, tokens: Sequence[Token], symbols: Symbols) -> None:
        self.tokens = tokens
        self.at = 0
        self.token = tokens[0]
        self.symbols = symbols

    # -- tokens

    def advance(self) -> Token:
        token = self.token
        if self.at + 1 < len(self.tokens):
            self.at += 1
            self.token = self.tokens[self.at]
        return token

    def peek(self, distance: int) -> str:
        return self.tokens[min(self.at + distance, len(self.tokens) - 1)].kind

    def expect(self, kind: str) -> Token:
        if self.token.kind != kind:
            raise CompileError("expected-token", (kind, self.token.kind), self.token.pos)
        return self.advance()

    # -- program

    def program(self) -> Task[Tree]:
        """program = { constdef } , { vardef } , { statement | onevent | sub }"""
        statements: list[Statement] = []
        while self.token.kind == "const":
            yield self.constdef()
        while self.token.kind == "var":
            statement: Statement | None = yield self.vardef()
            if statement is not None:
                statements.append(statement)
        while self.token.kind != "end-of-input":
            self.symbols.temporaries = 0
            if self.token.kind == "var":
                raise CompileError("misplaced-var", (), self.token.pos)
            if self.token.kind == "onevent":
                statements.append(self.onevent())
            elif self.token.kind == "sub":
                statements.append(self.sub())
            else:
                statements.append((yield self.statement()))
        symbols = self.symbols
        return Tree(
            Block(tuple(statements)),
            symbols.declared,
            symbols.allocated,
            symbols.temporaries,
            tuple(symbols.subs.values()),
        )

    def constdef(self) -> Task[None]:
        """constdef = "const" , IDENT , "=" , expr"""
        self.advance()
        name = self.declared_name()
        if self.token.kind != "=":
            raise CompileError("expected-assignment", (self.token.described,), self.token.pos)
        self.advance()
        if name.text in self.symbols.constants:
            raise CompileError("duplicate-constant", (name.text,), name.pos)
        expression: Expression = yield self.expression()
        self.symbols.constants[name.text] = _constant(expression, name.pos)

    def vardef(self) -> Task[Statement | None]:
        """vardef = "var" , IDENT , [ "[" , [ expr ] , "]" ] , [ "=" , ( oldlist | expr ) ]"""
        self.advance()
        name = self.declared_name()
        size: int | None = 1
        if self.token.kind == "[":
            size = yield self.array_size()
        self.symbols.check_new_variable(name.text, name.pos)
        statement: Statement | None = None
        assign = self.token
        if assign.kind == "=":
            self.advance()
            value: Expression = yield self.initial_value()
            if size is None:
                size = size_of(value)
            variable = self.symbols.declare(name.text, size, name.pos)
            statement = Assignment(Access(variable, 0, size - 1, name.pos), value, assign.pos)
        elif size is None:
            raise CompileError("unknown-array-size", (name.text,), name.pos)
        else:
            self.symbols.declare(name.text, size, name.pos)
        return statement

    def declared_name(self) -> Token:
        if self.token.kind != "identifier":
            raise CompileError("expected-identifier", (self.token.described,), self.token.pos)
        return self.advance()

    def array_size(self) -> Task[int | None]:
        bracket = self.advance()
        size: int | None = None
        if self.token.kind != "]":
            expression: Expression = yield self.expression()
            size = _constant(expression, bracket.pos)
            if size < 0:
                raise CompileError("negative-array-size", (size,), bracket.pos)
            if size == 0:
                raise CompileError("zero-array-size", (), bracket.pos)
        self.expect("]")
        return size

    def initial_value(self) -> Task[Expression]:
        """oldlist = element , "," , element , { "," , element }   (language spec, section 5.2)"""
        if self.peek(1) != "," and not (self.token.kind == "-" and self.peek(2) == ","):
            value: Expression = yield self.expression()
            return value
        start = self.token.pos
        items: list[Expression] = [(yield self.element())]
        while self.token.kind == ",":
            self.advance()
            items.append((yield self.element()))
        return Listing(tuple(items), start)

    def onevent(self) -> OnEvent:
        """onevent = "onevent" , IDENT"""
        self.advance()
        name = self.expect("identifier")
        return self.symbols.open_event(name.text, name.pos)

    def sub(self) -> Sub:
        """sub = "sub" , IDENT"""
        keyword = self.advance()
        name = self.expect("identifier")
        return self.symbols.open_sub(name.text, name.pos, keyword.pos)

    # -- statements

    def statement(self) -> Task[Statement]:
        """statement = if | when | while | for | emit | call | callsub | "return" | assignment"""
        kind = self.token.kind
        if kind in ("if", "when"):
            return self.if_or_when()
        if kind == "while":
            return self.while_loop()
        if kind == "for":
            return self.for_loop()
        if kind in ("emit", "_emit"):
            return self.emit()
        if kind == "call":
            return self.call()
        return self.assignment() if kind not in ("callsub", "return") else self.transfer()

    def transfer(self) -> Task[Statement]:
        """callsub = "callsub" , IDENT"""
        keyword = self.advance()
        if keyword.kind == "return":
            return Return(keyword.pos)
        return CallSub(self.expect("identifier").text, keyword.pos)
        yield

    def block(self, *ends: str) -> Task[Block]:
        """Statements up to one of the given keywords, which stays."""
        statements: list[Statement] = []
        while self.token.kind not in ends:
            statements.append((yield self.statement()))
        return Block(tuple(statements))

    def if_or_when(self) -> Task[If]:
        """
        if = "if" , condition , "then" , { statement } , iftail
        iftail = "end" | "else" , { statement } , "end" | "elseif" , condition , "then" , { statement } , iftail
        when = "when" , condition , "do" , { statement } , "end"
        """
        keyword = self.advance()
        is_edge = keyword.kind == "when"
        condition: Expression = yield self.expression(_CONDITION)
        self.expect("do" if is_edge else "then")
        then: Block = yield self.block("end", "else", "elseif")
        otherwise: Block | If | None = None
        if is_edge:
            end = self.expect("end")
            return If(is_edge, condition, then, otherwise, keyword.pos, end.pos.row)
        if self.token.kind == "elseif":
            otherwise = yield self.if_or_when()
            return If(is_edge, condition, then, otherwise, keyword.pos, None)
        if self.token.kind == "else":
            self.advance()
            otherwise = yield self.block("end")
        end = self.advance()
        return If(is_edge, condition, then, otherwise, keyword.pos, end.pos.row)

    def while_loop(self) -> Task[While]:
        """while = "while" , condition , "do" , { statement } , "end\""""
        keyword = self.advance()
        condition: Expression = yield self.expression(_CONDITION)
        self.expect("do")
        body: Block = yield self.block("end")
        self.advance()
        return While(condition, body, keyword.pos)

    def for_loop(self) -> Task[For]:
        """for = "for" , variable , "in" , bound , ":" , bound , [ "step" , bound ] , "do" , { statement } , "end\""""
        keyword = self.advance()
        variable: Expression = yield self.variable(self.expect("identifier"))
        self.expect("in")
        start = self.bound()
        self.expect(":")
        end = self.bound()
        step = 1
        if self.token.kind == "step":
            self.advance()
            number = self.bound()
            step = number.value
            if step == 0:
                raise CompileError("for-zero-step", (), number.pos)
        if step > 0 and start.value > end.value:
            raise CompileError("for-range-not-increasing", (), start.pos)
        if step < 0 and start.value < end.value:
            raise CompileError("for-range-not-decreasing", (), start.pos)
        if step > 0 and end.value == 32767:
            raise CompileError("for-end-32767", (), end.pos)
        if step < 0 and end.value == -32768:
            raise CompileError("for-end-minus-32768", (), end.pos)
        self.expect("do")
        body: Block = yield self.block("end")
        self.advance()
        return For(variable, start, end, step, body, keyword.pos)

    def bound(self) -> Number:
        """bound = [ "-" ] , INTEGER | IDENT"""
        is_negative = self.token.kind == "-"
        if is_negative:
            self.advance()
        elif self.token.kind != "integer":
            name = self.expect("identifier")
            return self.symbols.constant(name.text, name.pos)
        token = self.expect("integer")
        if is_negative and token.value < 0:
            raise CompileError("int16-range", (token.value,), token.pos)
        return _literal(token, -token.value if is_negative else token.value)

    def emit(self) -> Task[Emit]:
        """emit = ( "emit" | "_emit" ) , IDENT , [ expr ]"""
        keyword = self.advance()
        name = self.expect("identifier")
        number, declared = self.symbols.global_event(name.text, name.pos)
        if declared == 0:
            return Emit(number, 0, 0, (), keyword.pos)
        value: Expression = yield self.expression()
        if isinstance(value, Access):
            check_address(value)
        size = size_of(value)
        if keyword.kind == "emit" and size != declared:
            raise CompileError("event-argument-size", (name.text, declared, size), keyword.pos)
        if size > declared:
            raise CompileError("event-argument-too-large", (name.text, declared, size), keyword.pos)
        if isinstance(value, Access):
            return Emit(number, value.variable.address + value.first, size, (), keyword.pos)
        address, setup = self.temporary(value, size, keyword.pos)
        return Emit(number, address, size, setup, keyword.pos)

    def call(self) -> Task[Call]:
        """call = "call" , IDENT , "(" , [ expr , { "," , expr } ] , ")\""""
        keyword = self.advance()
        name = self.expect("identifier")
        number, native = self.symbols.native(name.text, keyword.pos)
        self.expect("(")
        count = len(native.parameters)
        arguments: list[Argument | ElementArgument] = []
        sizes: list[int] = []
        if count == 0 and self.token.kind != ")":
            raise CompileError("function-takes-no-argument", (native.name,), self.token.pos)
        templates: dict[int, int] = {}
        for index, parameter in enumerate(native.parameters):
            if self.token.kind == ")":
                raise CompileError("too-few-arguments", (native.name, count, index), self.token.pos)
            start = self.token.pos
            expression: Expression = yield self.expression()
            check_address(expression)
            size = size_of(expression)
            arguments.append(self.argument(expression, size, start, keyword.pos))
            about = (index, parameter.name, native.name, size)
            if parameter.size > 0 and size != parameter.size:
                raise CompileError("argument-size", (*about, parameter.size), start)
            if parameter.size < 0 and templates.setdefault(parameter.size, size) != size:
                raise CompileError("argument-size-template", (*about, templates[parameter.size]), start)
            sizes.append(size)
            if index + 1 < count and self.token.kind != ")":
                self.expect(",")
            elif self.token.kind == ",":
                raise CompileError("too-many-arguments", (native.name, count), self.token.pos)
        self.expect(")")
        return Call(number, tuple(sizes[index] for index in native.free_sizes), tuple(arguments), keyword.pos)

    def argument(
        self, expression: Expression, size: int, start: SourcePos, keyword: SourcePos
    ) -> Argument | ElementArgument:
        if isinstance(expression, Access):
            return Argument(expression.variable.address + expression.first, (), start)
        if isinstance(expression, Subscript):
            word = self.symbols.allocate(1, start)
            return ElementArgument(expression.variable, expression.index, word, expression.pos)
        address, setup = self.temporary(expression, size, keyword)
        return Argument(address, setup, start)

    def temporary(self, value: Expression, size: int, pos: SourcePos) -> tuple[int, tuple[Assignment, ...]]:
        """Allocate words for a value; return their address and the assignment that computes them."""
        address = self.symbols.allocate(size, pos)
        left = Access(Memory("", address, size), 0, size - 1, pos)
        return address, (Assignment(left, value, pos, is_typed=False),)

    def assignment(self) -> Task[Statement]:
        """assignment = expr , ( "=" , expr | "++" | "--" | compound , expr )"""
        if self.token.kind != "identifier":
            raise CompileError("expected-token", ("identifier", self.token.kind), self.token.pos)
        left: Expression = yield self.expression()
        token = self.token
        if token.kind in ("++", "--"):
            self.advance()
            return Compound(token.kind[0], left, None, token.pos)
        if token.kind != "=" and token.kind not in _COMPOUND:
            raise CompileError("expected-assignment", (token.described,), token.pos)
        self.advance()
        right: Expression = yield self.expression()
        if token.kind == "=":
            return Assignment(left, right, token.pos)
        return Compound(token.kind[:-1], left, right, token.pos)

    # -- expressions

    def expression(self, level: int = _EXPRESSION) -> Task[Expression]:
        """
        condition = and , { "or" , and }                and = not , { "and" , not }
        not = { "not" } , comparison                    comparison = expr , { ( "==" | … ) , expr }
        expr = bitxor , { "|" , bitxor }   and so on down to   product = unary , { ( "*" | "/" | "%" ) , unary }
        """
        left: Expression
        if self.token.kind == "not" and level <= _NOT:
            pos = self.advance().pos
            left = Unary("not", (yield self.expression(_NOT)), pos)
        else:
            left = yield self.unary()
        while _OPERATORS.get(self.token.kind, 0) >= level:
            symbol = self.advance()
            right: Expression = yield self.expression(_OPERATORS[symbol.kind] + 1)
            left = Binary(symbol.kind, left, right, symbol.pos)
        return left

    def unary(self) -> Task[Expression]:
        """unary = "(" , condition , ")" | list | ( "-" | "~" | "abs" ) , unary | INTEGER | IDENT | variable"""
        token = self.token
        kind = token.kind
        if kind == "integer":
            self.advance()
            return _literal(token, token.value)
        if kind == "identifier":
            self.advance()
            if token.text in self.symbols.constants:
                return self.symbols.constant(token.text, token.pos)
            variable: Expression = yield self.variable(token)
            return variable
        if kind == "[":
            listing: Listing = yield self.listing()
            return listing
        if kind == "(":
            self.advance()
            inner: Expression = yield self.expression(_CONDITION)
            self.expect(")")
            return inner
        if kind not in ("-", "~", "abs"):
            raise CompileError("expected-one-of", (_PRIMARY, kind), token.pos)
        self.advance()
        if kind == "-" and self.token.kind == "integer":
            number = self.advance()
            return _literal(number, -number.value)
        return Unary(kind, (yield self.unary()), token.pos)

    def listing(self) -> Task[Listing]:
        """list = "[" , element , { "," , element } , "]\""""
        start = self.expect("[")
        items: list[Expression] = [(yield self.element())]
        while self.token.kind == ",":
            self.advance()
            items.append((yield self.element()))
        self.expect("]")
        return Listing(tuple(items), start.pos)

    def element(self) -> Task[Expression]:
        """element = list | expr"""
        return self.listing() if self.token.kind == "[" else self.expression()

    def variable(self, name: Token) -> Task[Expression]:
        """variable = IDENT , [ "[" , expr , [ ":" , expr ] , "]" ]"""
        variable = self.symbols.variable(name.text, name.pos)
        if self.token.kind != "[":
            return Access(variable, 0, variable.size - 1, name.pos)
        self.advance()
        index: Expression = yield self.expression()
        value, fault = _attempt(index)
        if value is None:
            self.expect("]")
            return Subscript(variable, index, fault, name.pos)
        last = value
        is_slice = self.token.kind == ":"
        if is_slice:
            colon = self.advance()
            end: Expression = yield self.expression()
            end_value, _ = _attempt(end)
            if end_value is None:
                raise CompileError("slice-end-not-constant", (), colon.pos)
            if end_value < value:
                raise CompileError("slice-reversed", (), self.token.pos)
            last = end_value
        self.expect("]")
        return Access(variable, value, last, name.pos, is_slice)


def _literal(token: Token, value: int) -> Number:
    if not -32768 <= value <= 32767:
        raise CompileError("int16-range", (abs(value),), token.pos)
    return Number(value, token.pos)


def _constant(expression: Expression, pos: SourcePos) -> int:
    """Return the value of a constant expression (language spec, section 9.3). Raises CompileError."""
    simple = simplify(first_element(expression))
    if not isinstance(simple, Number):
        raise CompileError("not-constant", (), pos)
    return simple.value


def _attempt(expression: Expression) -> tuple[int | None, CompileError | None]:
    """Return the value of a constant index, or None and what went wrong, if anything did."""
    try:
        simple = simplify(first_element(expression))
    except CompileError as error:
        return None, error
    return (simple.value if isinstance(simple, Number) else None), None
