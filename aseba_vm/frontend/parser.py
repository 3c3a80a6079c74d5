"""Pass 2, statements: tokens to tree (docs/spec/aseba-language.md sections 4 to 7 and 10).

A recursive-descent parser with one method per grammar rule; the docstring of each method is its rule. Names are
resolved, constants evaluated, and temporary words of events and natives allocated while parsing, because that
determines which error comes first.
"""

from __future__ import annotations

from collections.abc import Sequence

from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.frontend.expression_parser import ExpressionParser, constant_value, literal
from aseba_vm.frontend.lexer import Token
from aseba_vm.frontend.symbols import SymbolTable
from aseba_vm.frontend.syntax_tree import (
    Access,
    Argument,
    Assignment,
    Block,
    Call,
    CallSub,
    Compound,
    ElementArgument,
    Emit,
    Expression,
    For,
    If,
    ListLiteral,
    Memory,
    Number,
    OnEvent,
    Return,
    Statement,
    Sub,
    Subscript,
    Tree,
    While,
)
from aseba_vm.frontend.token_stream import TokenStream
from aseba_vm.frontend.trampoline import Task, run
from aseba_vm.frontend.vectors import check_address, size_of

COMPOUND = frozenset(("+=", "-=", "*=", "/=", "%=", "|=", "^=", "&=", "<<=", ">>="))


def parse(tokens: Sequence[Token], symbols: SymbolTable) -> Tree:
    """Parse a program into its tree, and add its names to the table. Raises CompileError."""
    return run(_Parser(tokens, symbols).program())


class _Parser:
    def __init__(self, tokens: Sequence[Token], symbols: SymbolTable) -> None:
        self.stream = TokenStream(tokens)
        self.symbols = symbols
        self.expressions = ExpressionParser(self.stream, symbols)

    # -- program

    def program(self) -> Task[Tree]:
        """program = { constdef } , { vardef } , { statement | onevent | sub }"""
        statements: list[Statement] = []
        while self.stream.token.kind == "const":
            yield self.constdef()
        while self.stream.token.kind == "var":
            statement: Statement | None = yield self.vardef()
            if statement is not None:
                statements.append(statement)
        while self.stream.token.kind != "end-of-input":
            self.symbols.temporaries = 0
            if self.stream.token.kind == "var":
                raise CompileError("misplaced-var", (), self.stream.token.pos)
            if self.stream.token.kind == "onevent":
                statements.append(self.onevent())
            elif self.stream.token.kind == "sub":
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
        self.stream.advance()
        name = self.declared_name()
        if self.stream.token.kind != "=":
            raise CompileError("expected-assignment", (self.stream.token.described,), self.stream.token.pos)
        self.stream.advance()
        if name.text in self.symbols.constants:
            raise CompileError("duplicate-constant", (name.text,), name.pos)
        expression: Expression = yield self.expressions.expression()
        self.symbols.constants[name.text] = constant_value(expression, name.pos)

    def vardef(self) -> Task[Statement | None]:
        """vardef = "var" , IDENT , [ "[" , [ expr ] , "]" ] , [ "=" , ( oldlist | expr ) ]"""
        self.stream.advance()
        name = self.declared_name()
        size: int | None = 1
        if self.stream.token.kind == "[":
            size = yield self.array_size()
        self.symbols.check_new_variable(name.text, name.pos)
        statement: Statement | None = None
        assign = self.stream.token
        if assign.kind == "=":
            self.stream.advance()
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
        if self.stream.token.kind != "identifier":
            raise CompileError("expected-identifier", (self.stream.token.described,), self.stream.token.pos)
        return self.stream.advance()

    def array_size(self) -> Task[int | None]:
        bracket = self.stream.advance()
        size: int | None = None
        if self.stream.token.kind != "]":
            expression: Expression = yield self.expressions.expression()
            size = constant_value(expression, bracket.pos)
            if size < 0:
                raise CompileError("negative-array-size", (size,), bracket.pos)
            if size == 0:
                raise CompileError("zero-array-size", (), bracket.pos)
        self.stream.expect("]")
        return size

    def initial_value(self) -> Task[Expression]:
        """oldlist = element , "," , element , { "," , element }   (docs/spec/aseba-language.md section 5.2)"""
        if self.stream.peek(1) != "," and not (self.stream.token.kind == "-" and self.stream.peek(2) == ","):
            value: Expression = yield self.expressions.expression()
            return value
        start = self.stream.token.pos
        items: list[Expression] = [(yield self.expressions.element())]
        while self.stream.token.kind == ",":
            self.stream.advance()
            items.append((yield self.expressions.element()))
        return ListLiteral(tuple(items), start)

    def onevent(self) -> OnEvent:
        """onevent = "onevent" , IDENT"""
        self.stream.advance()
        name = self.stream.expect("identifier")
        return self.symbols.open_event(name.text, name.pos)

    def sub(self) -> Sub:
        """sub = "sub" , IDENT"""
        keyword = self.stream.advance()
        name = self.stream.expect("identifier")
        return self.symbols.open_sub(name.text, name.pos, keyword.pos)

    # -- statements

    def statement(self) -> Task[Statement]:
        """statement = if | when | while | for | emit | call | callsub | "return" | assignment"""
        kind = self.stream.token.kind
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
        keyword = self.stream.advance()
        if keyword.kind == "return":
            return Return(keyword.pos)
        return CallSub(self.stream.expect("identifier").text, keyword.pos)
        yield  # unreachable, but makes this function a generator, which a Task has to be

    def block(self, *ends: str) -> Task[Block]:
        """Parse statements up to one of the given keywords, which is not consumed."""
        statements: list[Statement] = []
        while self.stream.token.kind not in ends:
            statements.append((yield self.statement()))
        return Block(tuple(statements))

    def if_or_when(self) -> Task[If]:
        """
        if = "if" , condition , "then" , { statement } , iftail
        iftail = "end" | "else" , { statement } , "end" | "elseif" , condition , "then" , { statement } , iftail
        when = "when" , condition , "do" , { statement } , "end"
        """
        keyword = self.stream.advance()
        is_edge = keyword.kind == "when"
        condition: Expression = yield self.expressions.condition()
        self.stream.expect("do" if is_edge else "then")
        then: Block = yield self.block("end", "else", "elseif")
        otherwise: Block | If | None = None
        if is_edge:
            end = self.stream.expect("end")
            return If(is_edge, condition, then, otherwise, keyword.pos, end.pos.row)
        if self.stream.token.kind == "elseif":
            otherwise = yield self.if_or_when()
            return If(is_edge, condition, then, otherwise, keyword.pos, None)
        if self.stream.token.kind == "else":
            self.stream.advance()
            otherwise = yield self.block("end")
        end = self.stream.advance()
        return If(is_edge, condition, then, otherwise, keyword.pos, end.pos.row)

    def while_loop(self) -> Task[While]:
        """while = "while" , condition , "do" , { statement } , "end\""""
        keyword = self.stream.advance()
        condition: Expression = yield self.expressions.condition()
        self.stream.expect("do")
        body: Block = yield self.block("end")
        self.stream.advance()
        return While(condition, body, keyword.pos)

    def for_loop(self) -> Task[For]:
        """for = "for" , variable , "in" , bound , ":" , bound , [ "step" , bound ] , "do" , { statement } , "end\""""
        keyword = self.stream.advance()
        variable: Expression = yield self.expressions.variable(self.stream.expect("identifier"))
        self.stream.expect("in")
        start = self.bound()
        self.stream.expect(":")
        end = self.bound()
        step = 1
        if self.stream.token.kind == "step":
            self.stream.advance()
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
        self.stream.expect("do")
        body: Block = yield self.block("end")
        self.stream.advance()
        return For(variable, start, end, step, body, keyword.pos)

    def bound(self) -> Number:
        """bound = [ "-" ] , INTEGER | IDENT"""
        is_negative = self.stream.token.kind == "-"
        if is_negative:
            self.stream.advance()
        elif self.stream.token.kind != "integer":
            name = self.stream.expect("identifier")
            return self.symbols.constant(name.text, name.pos)
        token = self.stream.expect("integer")
        if is_negative and token.value < 0:
            raise CompileError("int16-range", (token.value,), token.pos)
        return literal(token, -token.value if is_negative else token.value)

    def emit(self) -> Task[Emit]:
        """emit = ( "emit" | "_emit" ) , IDENT , [ expr ]"""
        keyword = self.stream.advance()
        name = self.stream.expect("identifier")
        number, declared = self.symbols.global_event(name.text, name.pos)
        if declared == 0:
            return Emit(number, 0, 0, (), keyword.pos)
        value: Expression = yield self.expressions.expression()
        setup: tuple[Assignment, ...] = ()
        if isinstance(value, Access):
            check_address(value)
            address, size = value.variable.address + value.first, size_of(value)
        else:
            size = size_of(value)
            address, setup = self.temporary(value, size, keyword.pos)
        if keyword.kind == "emit" and size != declared:
            raise CompileError("event-argument-size", (name.text, declared, size), keyword.pos)
        if size > declared:
            raise CompileError("event-argument-too-large", (name.text, declared, size), keyword.pos)
        return Emit(number, address, size, setup, keyword.pos)

    def call(self) -> Task[Call]:
        """call = "call" , IDENT , "(" , [ expr , { "," , expr } ] , ")\""""
        keyword = self.stream.advance()
        name = self.stream.expect("identifier")
        number, native = self.symbols.native(name.text, keyword.pos)
        self.stream.expect("(")
        count = len(native.parameters)
        arguments: list[Argument | ElementArgument] = []
        sizes: list[int] = []
        if count == 0 and self.stream.token.kind != ")":
            raise CompileError("function-takes-no-argument", (native.name,), self.stream.token.pos)
        templates: dict[int, int] = {}
        for index, parameter in enumerate(native.parameters):
            if self.stream.token.kind == ")":
                raise CompileError("too-few-arguments", (native.name, count, index), self.stream.token.pos)
            start = self.stream.token.pos
            expression: Expression = yield self.expressions.expression()
            check_address(expression)
            size = size_of(expression)
            arguments.append(self.argument(expression, size, start, keyword.pos))
            about = (index, parameter.name, native.name, size)
            if parameter.size > 0 and size != parameter.size:
                raise CompileError("argument-size", (*about, parameter.size), start)
            if parameter.size < 0 and templates.setdefault(parameter.size, size) != size:
                raise CompileError("argument-size-template", (*about, templates[parameter.size]), start)
            sizes.append(size)
            if index + 1 < count and self.stream.token.kind != ")":
                self.stream.expect(",")
            elif self.stream.token.kind == ",":
                raise CompileError("too-many-arguments", (native.name, count), self.stream.token.pos)
        self.stream.expect(")")
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
        """Allocate words for a value.

        Returns:
            Their address, and the assignments that compute them.
        """
        address = self.symbols.allocate(size, pos)
        left = Access(Memory("", address, size), 0, size - 1, pos)
        return address, (Assignment(left, value, pos),)

    def assignment(self) -> Task[Statement]:
        """assignment = expr , ( "=" , expr | "++" | "--" | compound , expr )"""
        if self.stream.token.kind != "identifier":
            raise CompileError("expected-token", ("identifier", self.stream.token.kind), self.stream.token.pos)
        left: Expression = yield self.expressions.expression()
        token = self.stream.token
        if token.kind in ("++", "--"):
            self.stream.advance()
            return Compound(token.kind[0], left, None, token.pos)
        if token.kind != "=" and token.kind not in COMPOUND:
            raise CompileError("expected-assignment", (token.described,), token.pos)
        self.stream.advance()
        right: Expression = yield self.expressions.expression()
        if token.kind == "=":
            return Assignment(left, right, token.pos)
        return Compound(token.kind[:-1], left, right, token.pos)
