"""The syntax tree: immutable nodes, and their dump.

In the tree of the parser, an expression is a vector. `aseba_vm.frontend.lowering` converts it to a tree of
scalars: `Assignment` replaces `Compound` and the assignments of `For`, `Word` replaces `Access`, `Element`
replaces `Subscript`, and `ListLiteral` disappears. Positions are those that errors and source rows need.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import get_args

from aseba_vm.errors import CompileError, SourcePos

COMPARISONS = frozenset(("==", "!=", "<", "<=", ">", ">="))
CONNECTIVES = frozenset(("or", "and"))


@dataclass(frozen=True, slots=True)
class Memory:
    """A named range of the variable memory: a variable, or temporary words (without a name)."""

    name: str
    address: int
    size: int

    def __str__(self) -> str:
        return f"{self.name or 'temporary'}@{self.address}[{self.size}]"


# -- expressions -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Number:
    """A constant, 32 bits signed."""

    value: int
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Access:
    """The words first..last of a variable, constant and not yet checked; a whole variable is 0..size-1."""

    variable: Memory
    first: int
    last: int
    pos: SourcePos
    is_slice: bool = False


@dataclass(frozen=True, slots=True)
class Subscript:
    """One word at an index computed at run time. `fault` is the error if constant evaluation of the index failed."""

    variable: Memory
    index: Expression
    fault: CompileError | None
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class ListLiteral:
    """A list: the words of its items, concatenated."""

    items: tuple[Expression, ...]
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Unary:
    """`-`, `~`, `abs` or `not` of each word."""

    operator: str
    operand: Expression
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Binary:
    """An operation, comparison or connective, applied word by word."""

    operator: str
    left: Expression
    right: Expression
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Word:
    """Scalar stage: the word at an address."""

    address: int
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Element:
    """Scalar stage: one word of a variable at a computed index."""

    variable: Memory
    index: Expression
    pos: SourcePos


Expression = Number | Access | Subscript | ListLiteral | Unary | Binary | Word | Element


# -- statements --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Block:
    """Statements in order."""

    statements: tuple[Statement, ...] = ()


@dataclass(frozen=True, slots=True)
class Assignment:
    """left = right."""

    left: Expression
    right: Expression
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Compound:
    """left op= right; without right side, left++ or left--."""

    operator: str
    left: Expression
    right: Expression | None
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class If:
    """`if` or `when`. An `elseif` is an If in `otherwise`; `end_row` is known only without `elseif`."""

    is_edge: bool
    condition: Expression
    then: Block
    otherwise: Block | If | None
    pos: SourcePos
    end_row: int | None


@dataclass(frozen=True, slots=True)
class While:
    """A loop; `pos` is the position of its keyword."""

    condition: Expression
    body: Block
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class For:
    """A counted loop over constants, before it is lowered to a While."""

    variable: Expression
    start: Number
    end: Number
    step: int
    body: Block
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Emit:
    """A global event with the words at an address, which `setup` computes."""

    number: int
    address: int
    size: int
    setup: tuple[Assignment, ...]
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a native: its address; `setup` computes the words."""

    address: int
    setup: tuple[Assignment, ...]
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class ElementArgument:
    """An argument of a native: an element at a computed index, checked by means of a temporary word."""

    variable: Memory
    index: Expression
    temporary: int
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Call:
    """A native call: number, sizes in list order (docs/spec/aseba-bytecode-vm.md section 6), arguments."""

    number: int
    sizes: tuple[int, ...]
    arguments: tuple[Argument | ElementArgument, ...]
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class CallSub:
    """A call of a subroutine by name."""

    name: str
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Return:
    """`return` from the handler or subroutine."""

    pos: SourcePos


@dataclass(frozen=True, slots=True)
class OnEvent:
    """Marker: the following statements belong to the event."""

    number: int
    name: str
    pos: SourcePos


@dataclass(frozen=True, slots=True)
class Sub:
    """Marker: the following statements belong to the subroutine."""

    index: int
    name: str
    pos: SourcePos


Statement = Block | Assignment | Compound | If | While | For | Emit | Call | CallSub | Return | OnEvent | Sub
Node = Expression | Statement | Argument | ElementArgument

#: The fields of each kind of node that may hold nodes.
_FIELDS: Mapping[type, tuple[str, ...]] = {
    kind: tuple(field.name for field in fields(kind) if field.name not in ("operator", "pos", "number", "name"))
    for kind in get_args(Node)
}


@dataclass(frozen=True, slots=True)
class Tree:
    """A program between two passes.

    `variables` are those of the program, `allocated` is the number of words in use including those of the target,
    `temporaries` the number of words in use at the end of the memory, `subs` the markers of the subroutines in
    order.
    """

    body: Block
    variables: tuple[Memory, ...]
    allocated: int
    temporaries: int
    subs: tuple[Sub, ...]

    def dump(self) -> str:
        """One line per node, indented by depth, with the position (from 1) where there is one."""
        return "\n".join(_lines(self.body))


def children(node: Node) -> tuple[Node, ...]:
    """The nodes directly below a node, in order."""
    nodes: list[Node] = []
    for name in _FIELDS[type(node)]:
        value = getattr(node, name)
        if isinstance(value, Node):
            nodes.append(value)
        elif isinstance(value, tuple):
            nodes.extend(item for item in value if isinstance(item, Node))
    return tuple(nodes)


def walk(root: Node) -> Iterator[Node]:
    """A node and all its descendants in order, parents first."""
    stack = [root]
    while stack:
        node = stack.pop()
        yield node
        stack.extend(reversed(children(node)))


def position_of(node: Node) -> SourcePos | None:
    """The position of a node; a block has none."""
    return None if isinstance(node, Block) else node.pos


def _lines(root: Node) -> Iterator[str]:
    stack: list[tuple[int, Node]] = [(0, root)]
    while stack:
        depth, node = stack.pop()
        words = [type(node).__name__]
        for field in fields(node):
            value = getattr(node, field.name)
            is_child = isinstance(value, Node) or (isinstance(value, tuple) and value and isinstance(value[0], Node))
            if (
                not is_child
                and field.name not in ("pos", "fault")
                and value is not None
                and value is not False
                and value != ()
            ):
                words.append(f"{field.name}={value}")
        pos = position_of(node)
        yield f"{'  ' * depth}{' '.join(words)}{f'  ({pos})' if pos else ''}"
        stack.extend((depth + 1, child) for child in reversed(children(node)))
