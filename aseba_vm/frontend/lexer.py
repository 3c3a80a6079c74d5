"""Pass 1: text to tokens (docs/spec/aseba-language.md sections 2 and 3).

One regular expression matches the longest next token, including comments and white space. The column is the offset
minus `base`, which is the offset of column 0. Each of the irregular columns of section 2 is then one assignment to
`base`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.frontend.identifiers import LETTER_OR_DIGIT

KEYWORDS = frozenset(
    re.findall(
        r"\w+",
        """
        when emit _emit for in step while do if then else elseif end
        var const call sub callsub onevent abs return or and not
        """,
    )
)

SYMBOLS = (
    *("<<=", ">>=", "<<", ">>", "==", "!=", "<=", ">=", "+=", "-=", "*=", "/=", "%=", "|=", "^=", "&=", "++", "--"),
    *("(", ")", "[", "]", ":", ",", "=", "+", "-", "*", "/", "%", "|", "^", "&", "~", "<", ">"),
)

#: Limit of this compiler: longer programs fit no node and would only take time.
MAX_TOKENS = 32_768

_LARGEST = 2**63 - 1
_SHIFTS = frozenset(("<<", ">>", "<<=", ">>="))

_TOKEN = re.compile(
    rf"(?P<word>[{LETTER_OR_DIGIT}_][{LETTER_OR_DIGIT}_.]*)"
    r"|(?P<space>[ \t\r\n]+)"
    r"|(?P<block>\#\*)"
    r"|(?P<comment>\#[^\r\n]*[\r\n]?)"
    rf"|(?P<symbol>{'|'.join(map(re.escape, SYMBOLS))})"
)


@dataclass(frozen=True, slots=True)
class Token:
    """A word or symbol. `kind` is the keyword or symbol itself, `identifier`, `integer` or `end-of-input`."""

    kind: str
    pos: SourcePos
    text: str = ""
    value: int = 0

    @property
    def described(self) -> tuple[str | int, ...]:
        """The kind, and the name or number if there is one: an argument of some errors."""
        if self.kind == "identifier":
            return (self.kind, self.text)
        return (self.kind, self.value) if self.kind == "integer" else (self.kind,)

    def __str__(self) -> str:
        return f"{self.pos} {' '.join(map(str, self.described))}"


def tokenize(text: str) -> tuple[Token, ...]:
    """The tokens of a program, including the end of input. Raises CompileError."""
    tokens: list[Token] = []
    match = _TOKEN.match
    length = len(text)
    offset = row = base = 0
    last = None
    while offset < length:
        found = match(text, offset)
        pos = SourcePos(offset, row, offset - base)
        if found is None:
            if text[offset] == "!":
                raise CompileError("lone-exclamation", (), pos)
            raise CompileError("illegal-character", (f"{ord(text[offset]):x}",), pos)
        kind = found.lastgroup
        offset = found.end()
        if kind == "word":
            tokens.append(_word(found.group(), pos))
        elif kind == "symbol":
            symbol = found.group()
            if symbol in _SHIFTS:
                pos = SourcePos(pos.offset + 1, row, pos.col + 1)
            tokens.append(Token(symbol, pos))
        elif kind == "space":
            row += text.count("\n", pos.offset, offset)
            end = max(text.rfind("\n", pos.offset, offset), text.rfind("\r", pos.offset, offset))
            if end >= 0:
                base = end + 1
        elif kind == "comment":
            comment = found.group()
            tabs = 3 * comment.count("\t")
            if comment[-1] in "\r\n":
                base = offset - 1  # the line end counts as column 0: one column too many, as in the reference
                row += comment[-1] == "\n"
            elif len(comment) > 1:
                last = SourcePos(offset, row, offset - base + tabs)
        elif kind == "block":
            close = text.find("*#", offset)
            if close < 0:
                raise CompileError("unterminated-comment", (), pos)
            rows = text.count("\n", offset, close)
            if rows:
                row += rows
                base = text.rindex("\n", offset, close) + 1
            base -= 3 * text.count("\t", max(base, offset) if rows else offset, close)
            offset = close + 2
        if len(tokens) > MAX_TOKENS:
            raise CompileError("too-many-tokens", (MAX_TOKENS,), pos)
    tokens.append(Token("end-of-input", last or SourcePos(length - 1, row, length - 1 - base)))
    return tuple(tokens)


def is_name(text: str) -> bool:
    """Whether a text can be an identifier in a program."""
    found = _TOKEN.fullmatch(text)
    return found is not None and found.lastgroup == "word" and not "0" <= text[0] <= "9" and text not in KEYWORDS


def _word(text: str, pos: SourcePos) -> Token:
    if "0" <= text[0] <= "9":
        return Token("integer", pos, value=_number(text, pos))
    return Token(text, pos) if text in KEYWORDS else Token("identifier", pos, text)


def _number(text: str, pos: SourcePos) -> int:
    """The value of a number; hexadecimal and binary numbers above 32767 are negative. Raises CompileError."""
    prefix = text[1:2]
    if text[0] == "0" and prefix and not "0" <= prefix <= "9":
        if prefix not in "xb":
            raise CompileError("bad-number-base", (), pos)
        base, digits, kind = (16, "0-9a-fA-F", "bad-hex-number") if prefix == "x" else (2, "01", "bad-binary-number")
        if not re.fullmatch(f"[{digits}]*", text[2:]):
            raise CompileError(kind, (), pos)
        value = int(text[2:] or "0", base)
    else:
        if not re.fullmatch("[0-9]+", text):
            raise CompileError("bad-number", (), pos)
        base = 10
        significant = text.lstrip("0") or "0"
        value = int(significant) if len(significant) < 20 else _LARGEST
    if value > 65535:
        raise CompileError("int16-range", (min(value, _LARGEST),), pos)
    return value - 65536 if base != 10 and value > 32767 else value
