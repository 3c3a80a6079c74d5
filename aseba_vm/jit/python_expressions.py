"""Expression trees as Python source, with the range of their values."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from aseba_vm.jit import value_ranges
from aseba_vm.jit.ir import Binary, Const, Expr, Index, Load, Temp, Unary
from aseba_vm.jit.value_ranges import WORD, Interval, is_word

_LARGE = 1 << 31
_COMPARISONS = ("==", "!=", ">", ">=", "<", "<=", "or", "and")
_PLAIN = {2: "+", 3: "-", 4: "*", 7: "|", 8: "^", 9: "&"}
_FIRST_COMPARISON = 10


class Text(NamedTuple):
    """An expression: source (usable as an operand without parentheses), value range, whether it is a truth value."""

    text: str
    interval: Interval
    is_truth: bool = False

    @property
    def is_atom(self) -> bool:
        """Whether the source may be repeated without evaluating anything twice."""
        return self.text.isidentifier() or self.text.lstrip("(-").rstrip(")").isdigit()


class Expressions:
    """Generates expressions.

    ``emit_line`` appends a line that must run before the expression; ``name`` returns the source for a word of memory.
    ``bail_out`` is the statement that leaves translated code; it is set once for each statement of the program.
    """

    def __init__(self, emit_line: Callable[[str], None], name: Callable[[int], str]) -> None:
        self._emit_line = emit_line
        self._name = name
        self._temporaries = 0
        self.bail_out = ""
        self.known: dict[int, Interval] = {}

    def word(self, expression: Expr) -> Text:
        """Return an expression wrapped to a signed 16-bit word."""
        return self._cut(self._value(expression))

    def condition(self, operator: int, left: Expr, right: Expr) -> str:
        """Return ``left operator right`` as a truth value."""
        return self._truth(self._binary(operator, left, right))

    def index(self, index: Expr, size: int) -> str:
        """Return an index after generating its bounds check, which is omitted if the value range proves it."""
        text = self.word(index)
        low, high = text.interval
        if low < 0 or high >= size:
            text = self._atom(text)
            test = f"not 0 <= {text.text} < {size}"
            if low >= 0:
                test = f"{text.text} >= {size}"
            elif high < size:
                test = f"{text.text} < 0"
            self._emit_line(f"if {test}: {self.bail_out}")
        return text.text

    def _new(self) -> str:
        self._temporaries += 1
        return f"t{self._temporaries}"

    def _atom(self, value: Text) -> Text:
        """Return a value that may be repeated, through a temporary variable if necessary."""
        if value.is_atom:
            return value
        name = self._new()
        self._emit_line(f"{name} = {value.text}")
        return Text(name, value.interval)

    def _cut(self, value: Text) -> Text:
        """Return a value wrapped to 16 bits.

        The cheapest form that covers the value range is used: nothing, one conditional correction by 65536, or masking.
        """
        low, high = value.interval
        if value.is_truth:
            return Text(f"(1 if {value.text} else 0)", (0, 1))
        if is_word(value.interval):
            return value
        if low >= value_ranges.LOW and high <= value_ranges.HIGH + 0x10000:
            name = self._new()
            return Text(f"({name} if ({name} := {value.text}) <= 32767 else {name} - 65536)", WORD)
        if high <= value_ranges.HIGH and low >= value_ranges.LOW - 0x10000:
            name = self._new()
            return Text(f"({name} if ({name} := {value.text}) >= -32768 else {name} + 65536)", WORD)
        return Text(f"(({value.text} + 32768 & 65535) - 32768)", WORD)

    def _number(self, expression: Expr) -> Text:
        """Return a value modulo 2^16 that is below 2^31 in magnitude and not a truth value."""
        value = self._value(expression)
        large = max(-value.interval[0], value.interval[1]) >= _LARGE
        return self._cut(value) if value.is_truth or large else value

    def _truth(self, value: Text) -> str:
        return value.text if value.is_truth else self._cut(value).text

    def _value(self, expression: Expr) -> Text:
        match expression:
            case Const(value):
                return Text(str(value) if value >= 0 else f"({value})", (value, value))
            case Load(address):
                return Text(self._name(address), self.known.get(address, WORD))
            case Temp(number):
                return Text(f"s{number}", WORD)
            case Index(base, size, index):
                place = self.index(index, size)
                return Text(f"V[{place} + {base}]" if base else f"V[{place}]", WORD)
            case Unary(operator, operand):
                return self._unary(operator, operand)
            case Binary(operator, left, right):
                return self._binary(operator, left, right)

    def _unary(self, operator: int, operand: Expr) -> Text:
        if operator == 1:
            value = self._atom(self.word(operand))
            low, high = value.interval
            if low >= 0:
                return value
            return Text(f"({value.text} if {value.text} >= 0 else -{value.text})", (0, max(-low, high)))
        value = self._number(operand)
        low, high = value.interval
        if operator == 0:
            return Text(f"(-{value.text})", (-high, -low))
        return Text(f"(~{value.text})", (~high, ~low))

    def _binary(self, operator: int, left: Expr, right: Expr) -> Text:
        if operator >= _FIRST_COMPARISON:
            return self._comparison(operator, left, right)
        if operator in (5, 6):
            return self._division(operator, left, right)
        if operator in (0, 1):
            return self._shift(operator, left, right)
        one, two = self._number(left), self._number(right)
        value = self._plain(operator, one, two)
        if max(-value.interval[0], value.interval[1]) >= _LARGE:
            value = self._plain(operator, self._cut(one), self._cut(two))
        return value

    def _plain(self, operator: int, one: Text, two: Text) -> Text:
        if operator == 2:
            interval = value_ranges.of_sum(one.interval, two.interval)
        elif operator == 3:
            interval = value_ranges.of_difference(one.interval, two.interval)
        elif operator == 4:
            interval = value_ranges.of_product(one.interval, two.interval)
        else:
            interval = value_ranges.of_bits(operator, one.interval, two.interval)
        return Text(f"({one.text} {_PLAIN[operator]} {two.text})", interval)

    def _comparison(self, operator: int, left: Expr, right: Expr) -> Text:
        symbol = _COMPARISONS[operator - _FIRST_COMPARISON]
        if symbol in ("or", "and"):
            one, two = self._truth(self._value(left)), self._truth(self._value(right))
        else:
            one, two = self.word(left).text, self.word(right).text
        return Text(f"({one} {symbol} {two})", (0, 1), True)

    def _shift(self, operator: int, left: Expr, right: Expr) -> Text:
        value = self._number(left) if operator == 0 else self.word(left)
        low, high = value.interval
        if isinstance(right, Const):
            count = right.value & 31
            if operator == 1:
                return Text(f"({value.text} >> {count})", (low >> count, high >> count))
            return Text(f"({value.text} << {count})", (low << count, high << count))
        count_text = f"({self._number(right).text} & 31)"
        if operator == 1:
            return Text(f"({value.text} >> {count_text})", (min(low, 0), max(high, 0)))
        return self._cut(Text(f"({value.text} << {count_text})", (-1 << 63, 1 << 63)))

    def _division(self, operator: int, left: Expr, right: Expr) -> Text:
        one, two = self.word(left), self._atom(self.word(right))
        if two.interval[0] <= 0 <= two.interval[1]:
            self._emit_line(f"if not {two.text}: {self.bail_out}")
        one = self._atom(one)
        a, b = one.text, two.text
        # Python rounds towards minus infinity, Aseba towards 0. They differ if exactly one operand is negative; there
        # -(-a // b) truncates. A remainder has the sign of the dividend, and the sign of the divisor does not matter.
        is_positive = two.interval[0] >= 0
        if operator == 5:
            interval = value_ranges.of_quotient(one.interval, two.interval)
            if one.interval[0] >= 0 and is_positive:
                return Text(f"({a} // {b})", interval)
            sign = f"{a} >= 0" if is_positive else f"({a} ^ {b}) >= 0"
            return Text(f"({a} // {b} if {sign} else -(-{a} // {b}))", interval)
        interval = value_ranges.of_remainder(one.interval, two.interval)
        if not is_positive:
            b = self._atom(Text(f"({b} if {b} >= 0 else -{b})", WORD)).text
        if one.interval[0] >= 0:
            return Text(f"({a} % {b})", interval)
        return Text(f"({a} % {b} if {a} >= 0 else -(-{a} % {b}))", interval)
