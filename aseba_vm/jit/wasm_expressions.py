"""Expression trees as WebAssembly text, with the range of their values.

Arithmetic is 32-bit, so every value is exact modulo 2^16. It is wrapped to 16 bits only where the value itself matters.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from aseba_vm.jit import value_ranges
from aseba_vm.jit.ir import Binary, Const, Expr, Index, Load, Temp, Unary
from aseba_vm.jit.value_ranges import WORD, Interval, is_word

_COMPARISONS = ("eq", "ne", "gt_s", "ge_s", "lt_s", "le_s")
_PLAIN = {2: "add", 3: "sub", 4: "mul", 7: "or", 8: "xor", 9: "and"}
_FIRST_COMPARISON = 10
_OR, _AND = 16, 17
_ANYTHING: Interval = (-1 << 31, 1 << 31)


class Wat(NamedTuple):
    """An expression of type i32 and its value range."""

    text: str
    interval: Interval


class WasmExpressions:
    """Generates expressions. ``emit_line`` appends code that runs before, ``bail_out`` is the code of an exit."""

    def __init__(self, emit_line: Callable[[str], None]) -> None:
        self._emit_line = emit_line
        self.temporaries = 0
        self.bail_out = ""

    def word(self, expression: Expr) -> str:
        """Return an expression wrapped to a signed 16-bit word."""
        return self._cut(self._value(expression)).text

    def low(self, expression: Expr) -> str:
        """Return an expression of which only the low 16 bits are significant."""
        return self._value(expression).text

    def condition(self, operator: int, left: Expr, right: Expr) -> str:
        """Return ``left operator right`` as an i32, nonzero if true."""
        return self._cut(self._binary(operator, left, right)).text

    def place(self, base: int, size: int, index: Expr) -> str:
        """Return the byte offset of an array element, to be added to the offset of the base, after a bounds check.

        The check compares unsigned, as the machine does; it is omitted if the value range proves it.
        """
        value = self._cut(self._value(index))
        if isinstance(index, Const) and 0 <= index.value < size:
            return f"(i32.const {2 * index.value})"
        name = self._atom(value)
        low, high = value.interval
        if low < 0 or high >= size:
            unsigned = name if low >= 0 else f"(i32.and {name} (i32.const 65535))"
            self._emit_line(f"(if (i32.ge_u {unsigned} (i32.const {size})) (then {self.bail_out}))")
        if low < 0 and size > 0x8000:
            name = f"(i32.and {name} (i32.const 65535))"
        return f"(i32.shl {name} (i32.const 1))"

    def _atom(self, value: Wat) -> str:
        self.temporaries += 1
        name = f"$t{self.temporaries}"
        self._emit_line(f"(local.set {name} {value.text})")
        return f"(local.get {name})"

    def _cut(self, value: Wat) -> Wat:
        return value if is_word(value.interval) else Wat(f"(i32.extend16_s {value.text})", WORD)

    def _value(self, expression: Expr) -> Wat:
        match expression:
            case Const(value):
                return Wat(f"(i32.const {value})", (value, value))
            case Load(address):
                return Wat(f"(i32.load16_s offset={2 * address} (i32.const 0))", WORD)
            case Temp(number):
                return Wat(f"(local.get $s{number})", WORD)
            case Index(base, size, place):
                return Wat(f"(i32.load16_s offset={2 * base} {self.place(base, size, place)})", WORD)
            case Unary(operator, operand):
                return self._unary(operator, operand)
            case Binary(operator, left, right):
                return self._binary(operator, left, right)

    def _unary(self, operator: int, operand: Expr) -> Wat:
        value = self._value(operand)
        low, high = value.interval
        if operator == 0:
            return Wat(f"(i32.sub (i32.const 0) {value.text})", _moderate((-high, -low)))
        if operator == 2:
            return Wat(f"(i32.xor {value.text} (i32.const -1))", _moderate((~high, ~low)))
        name = self._atom(self._cut(value))
        negative = f"(i32.sub (i32.const 0) {name})"
        return Wat(f"(select {name} {negative} (i32.ge_s {name} (i32.const 0)))", (0, 32768))

    def _binary(self, operator: int, left: Expr, right: Expr) -> Wat:
        if operator in (_OR, _AND):
            one, two = (f"(i32.ne (i32.const 0) {self.word(side)})" for side in (left, right))
            return Wat(f"(i32.{'or' if operator == _OR else 'and'} {one} {two})", (0, 1))
        if operator >= _FIRST_COMPARISON:
            name = _COMPARISONS[operator - _FIRST_COMPARISON]
            return Wat(f"(i32.{name} {self.word(left)} {self.word(right)})", (0, 1))
        if operator in (5, 6):
            return self._division(operator, left, right)
        if operator in (0, 1):
            one = self.low(left) if operator == 0 else self.word(left)
            return Wat(
                f"(i32.{'shr_s' if operator else 'shl'} {one} {self.low(right)})", WORD if operator else _ANYTHING
            )
        a, b = self._value(left), self._value(right)
        if operator == 2:
            interval = value_ranges.of_sum(a.interval, b.interval)
        elif operator == 3:
            interval = value_ranges.of_difference(a.interval, b.interval)
        elif operator == 4:
            interval = value_ranges.of_product(a.interval, b.interval)
        else:
            interval = value_ranges.of_bits(operator, a.interval, b.interval)
        return Wat(f"(i32.{_PLAIN[operator]} {a.text} {b.text})", _moderate(interval))

    def _division(self, operator: int, left: Expr, right: Expr) -> Wat:
        one, two = self.word(left), self._cut(self._value(right))
        divisor = two.text
        if not isinstance(right, Const) or right.value == 0:
            divisor = self._atom(two)
            self._emit_line(f"(if (i32.eqz {divisor}) (then {self.bail_out}))")
        if operator == 5:
            return Wat(f"(i32.div_s {one} {divisor})", (-32768, 32768))
        return Wat(f"(i32.rem_s {one} {divisor})", WORD)


def _moderate(interval: Interval) -> Interval:
    """Return the range, or the full 32-bit range if the operation could overflow 32 bits."""
    return interval if interval[0] >= _ANYTHING[0] and interval[1] < _ANYTHING[1] else _ANYTHING
