"""Expression trees as WebAssembly text.

Arithmetic is 32-bit: sums, products and bit operations are exact modulo 2^16 for any operands that are. A value is
wrapped to a signed 16-bit word only where the value itself matters: comparison, division, right shift, index, store.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from aseba_vm.jit.ir import Binary, Const, Expr, Index, Load, Temp, Unary

_COMPARISONS = ("eq", "ne", "gt_s", "ge_s", "lt_s", "le_s")
_ARITHMETIC = {0: "shl", 2: "add", 3: "sub", 4: "mul"}
_BITS = {7: "or", 8: "xor", 9: "and"}
_FIRST_COMPARISON = 10
_OR, _AND = 16, 17


class Wat(NamedTuple):
    """An expression of type i32, and whether its value is a signed word."""

    text: str
    is_word: bool


class WasmExpressions:
    """Generates expressions. `emit_line` appends code that runs before, `bail_out` is the code of an exit."""

    def __init__(self, emit_line: Callable[[str], None]) -> None:
        self._emit_line = emit_line
        self.temporaries = 0
        self.bail_out = ""

    def word(self, expression: Expr) -> str:
        """An expression wrapped to a signed 16-bit word."""
        text, is_word = self._value(expression)
        return text if is_word else f"(i32.extend16_s {text})"

    def low(self, expression: Expr) -> str:
        """An expression of which only the low 16 bits are significant."""
        return self._value(expression).text

    def condition(self, operator: int, left: Expr, right: Expr) -> str:
        """`left operator right` as an i32, nonzero if true."""
        return self.word(Binary(operator, left, right))

    def place(self, base: int, size: int, index: Expr) -> str:
        """The byte offset of an array element, to be added to the offset of the base, after a bounds check."""
        if isinstance(index, Const) and 0 <= index.value < size:
            return f"(i32.const {2 * index.value})"
        # unsigned, as in the machine
        name = self._temporary(f"(i32.and {self.low(index)} (i32.const 65535))")
        self._emit_line(f"(if (i32.ge_u {name} (i32.const {size})) (then {self.bail_out}))")
        return f"(i32.shl {name} (i32.const 1))"

    def _temporary(self, text: str) -> str:
        self.temporaries += 1
        name = f"$t{self.temporaries}"
        self._emit_line(f"(local.set {name} {text})")
        return f"(local.get {name})"

    def _value(self, expression: Expr) -> Wat:
        match expression:
            case Const(value):
                return Wat(f"(i32.const {value})", is_word=True)
            case Load(address):
                return Wat(f"(i32.load16_s offset={2 * address} (i32.const 0))", is_word=True)
            case Temp(number):
                return Wat(f"(local.get $s{number})", is_word=True)
            case Index(base, size, place):
                return Wat(f"(i32.load16_s offset={2 * base} {self.place(base, size, place)})", is_word=True)
            case Unary(operator, operand):
                return self._unary(operator, operand)
            case Binary(operator, left, right):
                return self._binary(operator, left, right)

    def _unary(self, operator: int, operand: Expr) -> Wat:
        if operator == 0:
            return Wat(f"(i32.sub (i32.const 0) {self.low(operand)})", is_word=False)
        if operator == 2:
            text, is_word = self._value(operand)
            return Wat(f"(i32.xor {text} (i32.const -1))", is_word)
        name = self._temporary(self.word(operand))
        negative = f"(i32.sub (i32.const 0) {name})"
        return Wat(f"(select {name} {negative} (i32.ge_s {name} (i32.const 0)))", is_word=False)

    def _binary(self, operator: int, left: Expr, right: Expr) -> Wat:
        if operator in (_OR, _AND):
            one, two = (f"(i32.ne (i32.const 0) {self.word(side)})" for side in (left, right))
            return Wat(f"(i32.{'or' if operator == _OR else 'and'} {one} {two})", is_word=True)
        if operator >= _FIRST_COMPARISON:
            name = _COMPARISONS[operator - _FIRST_COMPARISON]
            return Wat(f"(i32.{name} {self.word(left)} {self.word(right)})", is_word=True)
        if operator in (5, 6):
            return self._division(operator, left, right)
        if operator == 1:
            return Wat(f"(i32.shr_s {self.word(left)} {self.low(right)})", is_word=True)
        a, b = self._value(left), self._value(right)
        if operator in _BITS:
            return Wat(f"(i32.{_BITS[operator]} {a.text} {b.text})", a.is_word and b.is_word)
        return Wat(f"(i32.{_ARITHMETIC[operator]} {a.text} {b.text})", is_word=False)

    def _division(self, operator: int, left: Expr, right: Expr) -> Wat:
        dividend, divisor = self.word(left), self.word(right)
        if not isinstance(right, Const) or right.value == 0:
            divisor = self._temporary(divisor)
            self._emit_line(f"(if (i32.eqz {divisor}) (then {self.bail_out}))")
        if operator == 5:
            # -32768 / -1 is 32768, which has no word, but is an i32: no trap, and the wrap makes it -32768.
            return Wat(f"(i32.div_s {dividend} {divisor})", is_word=False)
        return Wat(f"(i32.rem_s {dividend} {divisor})", is_word=True)
