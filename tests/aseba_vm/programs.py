"""Random programs: a generator that follows the grammar with correct sizes and types, and occasional errors."""

from __future__ import annotations

import random

_PLACES = {
    1: ("a", "b", "motor.left.target", "t[1]", "u[2]", "t[a]", "event.args[b & 3]"),
    3: ("acc", "u", "t[1:3]", "leds.top"),
    4: ("t", "prox.horizontal[0:3]", "event.args[28:31]"),
}
_CONSTANTS = ("0", "1", "2", "3", "7", "255", "4096", "32767", "-32768", "0xFFFF", "0b101", "K", "N")
_BINARY = ("+", "-", "*", "/", "%", "|", "&", "^", "<<", ">>")
_COMPARISONS = ("==", "!=", "<", "<=", ">", ">=")
_CALLS = (
    ("math.copy", "tt"),
    ("math.fill", "t1"),
    ("math.add", "ttt"),
    ("math.div", "ttt"),
    ("math.dot", "1tt1"),
    ("math.sqrt", "11"),
    ("math.sort", "t"),
    ("leds.top", "111"),
    ("deque.push_back", "t1"),
    ("deque.pop_front", "t1"),
)
_NOISE = (
    *("end", ")", "]", "then", "!", "0x", "65536", "#*", "# c\n", "\t", "\r", "é", "\0", "=", "else", "²", "~=", ","),
    *("nowhere", "a[9]", "t", "1 / 0", "not", "(a == 1)", "callsub r", "[a]", "t[[a]]"),
)


class Writer:
    """Generates one program from a seed."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.noise = self.random.choice((0.0, 0.0, 0.001, 0.01))

    def program(self) -> str:
        lines = [
            "const K = 5 * 3",
            "var a",
            "var b = K - N",
            "var t[4] = 1, 2, 3, -4",
            "var u[] = [a, b, t[3]]",
        ]
        lines += [self.statement(0) for _ in range(self.random.randint(0, 5))]
        for marker in self.random.sample(("onevent prox", "onevent ping", "onevent tap"), 2):
            lines.append(marker)
            lines += [self.statement(0) for _ in range(self.random.randint(0, 4))]
        lines += ["sub s", *(self.statement(4) for _ in range(self.random.randint(0, 3)))]
        return "\n".join(lines)

    def pick(self, *words: str) -> str:
        return self.random.choice(_NOISE if self.random.random() < self.noise else words)

    def block(self, depth: int) -> str:
        return " ".join(self.statement(depth + 1) for _ in range(self.random.randint(0, 3)))

    def statement(self, depth: int) -> str:
        size = self.random.choice((1, 1, 1, 3, 4))
        match self.random.randint(0, 12 if depth < 4 else 5):
            case 0 | 1 | 2:
                operator = self.pick("=", "=", "+=", "-=", "*=", "/=", "<<=", "&=")
                return f"{self.pick(*_PLACES[size])} {operator} {self.expression(size, 3)}"
            case 3:
                return f"{self.pick(*_PLACES[size])}{self.pick('++', '--')}"
            case 4:
                pair = f"pair {self.expression(1, 2).join(('[', f', {self.expression(1, 1)}]'))}"
                return self.pick(f"emit ping {self.expression(1, 2)}", f"emit {pair}", "emit nothing", "_emit pair a")
            case 5:
                name, sizes = self.random.choice(_CALLS)
                values = ", ".join(self.expression(4 if size == "t" else 1, 1) for size in sizes)
                return f"call {name}({values})"
            case 6:
                return self.pick("callsub s", "return")
            case 7 | 8:
                again = f"elseif {self.condition(2)} then {self.block(depth)} end"
                tail = self.pick("end", f"else {self.block(depth)} end", again)
                return f"if {self.condition(2)} then {self.block(depth)} {tail}"
            case 9:
                return f"when {self.condition(2)} do {self.block(depth)} end"
            case 10:
                return f"while {self.condition(2)} do {self.block(depth)} end"
            case _:
                bounds = self.pick("0:3", "5:-2 step -2", "K:100 step 7", "1:1", "-3:N")
                return f"for {self.pick('a', 'b', 't[a & 3]')} in {bounds} do {self.block(depth)} end"

    def listing(self, size: int) -> str:
        return f"[{', '.join(self.expression(1, 1) for _ in range(size))}]"

    def condition(self, depth: int) -> str:
        left = f"{self.expression(1, depth)} {self.pick(*_COMPARISONS)} {self.expression(1, depth)}"
        if depth <= 0 or self.random.random() < 0.6:
            return left
        return f"{self.pick('', 'not ')}({left} {self.pick('and', 'or')} {self.condition(depth - 1)})"

    def expression(self, size: int, depth: int) -> str:
        match self.random.randint(0, 8 if depth > 0 else 3):
            case 0 | 1 if size == 1:
                return self.pick(*_CONSTANTS)
            case 0 | 1 | 2 | 3:
                return self.pick(*_PLACES[size])
            case 4:
                return f"{self.pick('-', '~', 'abs ')}({self.expression(size, depth - 1)})"
            case 5:
                return self.listing(size) if size > 1 else f"t[{self.expression(1, depth - 1)} & 3]"
            case _:
                operator = self.pick(*_BINARY)
                return f"({self.expression(size, depth - 1)} {operator} {self.expression(size, depth - 1)})"
