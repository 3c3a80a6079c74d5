"""Instructions and words: operation table, encoding, linking and disassembly.

Source: docs/spec/aseba-bytecode-vm.md sections 1 and 2.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum

from aseba_vm.errors import SourcePos

MAX_EMITTED = 516
"""Maximum number of words in an event (docs/spec/aseba-bytecode-vm.md section 10.1)."""


class Op(IntEnum):
    """The top 4 bits of an instruction."""

    STOP = 0x0
    PUSH = 0x1
    PUSHL = 0x2
    LOAD = 0x3
    STORE = 0x4
    LOADX = 0x5
    STOREX = 0x6
    UNARY = 0x7
    BINARY = 0x8
    JUMP = 0x9
    BRANCH = 0xA
    EMIT = 0xB
    NATIVE = 0xC
    CALL = 0xD
    RET = 0xE
    UNKNOWN = 0xF


#: Length of each operation in words, by its number.
LENGTH: Sequence[int] = (1, 1, 2, 1, 1, 2, 2, 1, 1, 1, 2, 3, 1, 1, 1, 1)

BINARY_OPERATORS: Sequence[str] = (
    *("<<", ">>", "+", "-", "*", "/", "%", "|", "^", "&"),
    *("==", "!=", ">", ">=", "<", "<=", "or", "and"),
)
UNARY_OPERATORS: Sequence[str] = ("-", "abs", "~", "not")

BINARY_NUMBER: Mapping[str, int] = {symbol: number for number, symbol in enumerate(BINARY_OPERATORS)}
UNARY_NUMBER: Mapping[str, int] = {symbol: number for number, symbol in enumerate(UNARY_OPERATORS)}

EDGE = 0x100
"""Flag of a BRANCH (`when`): branch only when the condition becomes true."""
WAS_TRUE = 0x200
"""Flag of a BRANCH in bytecode memory: the condition was true when last evaluated."""


@dataclass(frozen=True, slots=True)
class Instruction:
    """An operation, its 12-bit operand, the words after it, and the source row of its words (None: undefined)."""

    op: Op
    operand: int
    more: tuple[int, ...] = ()
    row: int | None = 0

    @property
    def words(self) -> tuple[int, ...]:
        """The instruction as unsigned words. The operand is or-ed without a mask, as linking requires."""
        return ((self.op << 12 | self.operand) & 0xFFFF, *(word & 0xFFFF for word in self.more))

    def __str__(self) -> str:
        return describe(self.words)


@dataclass(frozen=True, slots=True)
class Segment:
    """The code of an event or a subroutine.

    `number` is the event number or the subroutine index, `depth` the estimated stack depth, `row` the row of
    `sub`. `falls_through`: the last instruction may be skipped, so execution runs on into the next segment.
    `far_blocks`: starts of blocks too long for the 12 bits of a jump (docs/spec/aseba-language.md section 12).
    """

    is_sub: bool
    number: int
    name: str
    code: tuple[Instruction, ...]
    depth: int
    row: int
    falls_through: bool = False
    far_blocks: tuple[SourcePos, ...] = ()

    @property
    def size(self) -> int:
        """Number of words."""
        return sum(LENGTH[instruction.op] for instruction in self.code)

    def dump(self) -> str:
        """A heading and one line per instruction, with the row counted from 1."""
        heading = f"{'sub' if self.is_sub else 'event'} {self.name or 'init'} ({self.number}), stack {self.depth}"
        rows = ("-" if code.row is None else code.row + 1 for code in self.code)
        return "\n".join([heading, *(f"  {row:>4}  {code}" for row, code in zip(rows, self.code, strict=True))])


@dataclass(frozen=True, slots=True)
class EventEntry:
    """An entry of the event table: number, address of the code, name (empty for the initialization)."""

    number: int
    address: int
    name: str


@dataclass(frozen=True, slots=True)
class SubEntry:
    """A subroutine: name, address of the code, row of the declaration."""

    name: str
    address: int
    row: int


@dataclass(frozen=True, slots=True)
class Image:
    """A linked program: words, the source row of each word, and the entries of events and subroutines."""

    words: tuple[int, ...]
    lines: tuple[int | None, ...]
    events: tuple[EventEntry, ...]
    subs: tuple[SubEntry, ...]


def link(segments: Sequence[Segment]) -> Image:
    """Lay out the segments (events by number, then subroutines) and resolve the calls."""
    events = sorted((segment for segment in segments if not segment.is_sub), key=lambda segment: segment.number)
    subs = [segment for segment in segments if segment.is_sub]
    address = 2 * len(events) + 1
    addresses: list[int] = []
    for segment in (*events, *subs):
        addresses.append(address)
        address += segment.size
    table = tuple(EventEntry(event.number, place, event.name) for event, place in zip(events, addresses, strict=False))
    places = addresses[len(events) :]
    entries = tuple(SubEntry(sub.name, place, sub.row) for sub, place in zip(subs, places, strict=True))
    words: list[int] = [2 * len(events) + 1]
    for entry in table:
        words += (entry.number, entry.address)
    lines: list[int | None] = [0] * len(words)
    for segment in (*events, *subs):
        for code in segment.code:
            encoded = code.words
            if code.op is Op.CALL:
                encoded = ((Op.CALL << 12 | places[code.operand]) & 0xFFFF,)
            words += encoded
            lines += [code.row] * len(encoded)
    return Image(tuple(words), tuple(lines), table, entries)


def signed(word: int) -> int:
    """A word as a signed number."""
    return word - 0x10000 if word & 0x8000 else word


def signed12(word: int) -> int:
    """The low 12 bits of a word as a signed number."""
    return ((word & 0xFFF) ^ 0x800) - 0x800


def instructions(words: Sequence[int], start: int = 0) -> Iterator[tuple[int, tuple[int, ...]]]:
    """Address and words of each instruction from `start` to the end; the last may be cut short."""
    pc = start
    while pc < len(words):
        length = LENGTH[words[pc] >> 12 & 0xF]
        yield pc, tuple(words[pc : pc + length])
        pc += length


def describe(words: Sequence[int]) -> str:
    """One instruction as text; jump targets are relative."""
    op, operand = Op(words[0] >> 12), words[0] & 0xFFF
    more = [*words[1:], 0, 0]
    match op:
        case Op.PUSH:
            return f"push {signed12(operand)}"
        case Op.PUSHL:
            return f"pushl {signed(more[0])}"
        case Op.LOAD | Op.STORE:
            return f"{op.name.lower()} {operand}"
        case Op.LOADX | Op.STOREX:
            return f"{op.name.lower()} {operand} size {more[0]}"
        case Op.UNARY | Op.BINARY:
            names = UNARY_OPERATORS if op is Op.UNARY else BINARY_OPERATORS
            return f"{op.name.lower()} {names[operand] if operand < len(names) else operand}"
        case Op.JUMP:
            return f"jump {signed12(operand):+d}"
        case Op.BRANCH:
            number = operand & 0xFF
            symbol = BINARY_OPERATORS[number] if number < len(BINARY_OPERATORS) else str(number)
            kind = "when" if operand & EDGE else "if"
            state = " (was true)" if operand & WAS_TRUE else ""
            return f"branch {kind} {symbol} else {signed(more[0]):+d}{state}"
        case Op.EMIT:
            return f"emit {operand} from {more[0]} size {more[1]}"
        case Op.NATIVE | Op.CALL:
            return f"{op.name.lower()} {operand}"
        case Op.UNKNOWN:
            return f"unknown {words[0]:#06x}"
    return op.name.lower()


def disassemble(words: Sequence[int]) -> str:
    """A program image as text: the event table, then one line per instruction with its address."""
    start = min(words[0], len(words)) if words else 0
    return "\n".join([*table_lines(words), *(line_of_code(pc, code) for pc, code in instructions(words, start))])


def table_lines(words: Sequence[int]) -> list[str]:
    """The event table of an image as lines of text."""
    if not words:
        return []
    lines = [f"{0:5}  {words[0]:04X}            code at {words[0]}"]
    return lines + [
        f"{at:5}  {words[at]:04X} {words[at + 1]:04X}       event {words[at]} at {words[at + 1]}"
        for at in range(1, min(words[0], len(words)) - 1, 2)
    ]


def line_of_code(pc: int, words: Sequence[int]) -> str:
    """One instruction as a line of text: address, words, meaning."""
    return f"{pc:5}  {' '.join(f'{word:04X}' for word in words):14}  {describe(words)}{_destination(pc, words)}"


def _destination(pc: int, words: Sequence[int]) -> str:
    op = words[0] >> 12
    if op == Op.JUMP:
        return f" -> {pc + signed12(words[0])}"
    return f" -> {pc + signed(words[1])}" if op == Op.BRANCH and len(words) == 2 else ""
