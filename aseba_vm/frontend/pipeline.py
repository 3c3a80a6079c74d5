"""The compiler pipeline: source text to program, with every stage (docs/spec/aseba-bytecode-vm.md section 3)."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

from aseba_vm.bytecode import EventEntry, Segment, SubEntry, instructions, link
from aseba_vm.errors import CompileError
from aseba_vm.frontend.codegen import check_stack, generate
from aseba_vm.frontend.folding import optimize
from aseba_vm.frontend.hints.context import GRAMMAR, LATER_PASSES, TOKENS, Attempt
from aseba_vm.frontend.hints.finder import find_hint
from aseba_vm.frontend.lexer import Token, tokenize
from aseba_vm.frontend.lint import CompileWarning, find_warnings
from aseba_vm.frontend.lowering import lower
from aseba_vm.frontend.parser import parse
from aseba_vm.frontend.symbols import SymbolTable
from aseba_vm.frontend.syntax_tree import Memory, Tree
from aseba_vm.frontend.type_check import check_sizes, check_types
from aseba_vm.target import TargetDescription


@dataclass(frozen=True, slots=True)
class Stages:
    """The result of each pass."""

    tokens: tuple[Token, ...]
    tree: Tree
    expanded: Tree
    optimized: Tree
    segments: tuple[Segment, ...]

    def dump(self, stage: str) -> str:
        """A stage as text: `tokens`, `tree`, `expanded`, `optimized` or `code`. Raises ValueError."""
        match stage:
            case "tokens":
                return "\n".join(map(str, self.tokens))
            case "tree":
                return self.tree.dump()
            case "expanded":
                return self.expanded.dump()
            case "optimized":
                return self.optimized.dump()
            case "code":
                return "\n".join(segment.dump() for segment in self.segments)
        raise ValueError(f"stage: found {stage!r}, expected tokens, tree, expanded, optimized or code")


@dataclass(frozen=True, slots=True)
class Program:
    """A compiled program.

    Attributes:
        words: unsigned words of the bytecode.
        lines: source row (from 0) of each word, None where the reference has no value.
        variables: variables of the program by address.
        events: entries of the event table.
        subs: entries of the subroutines.
        allocated: words of variable memory in use, including the variables of the target.
        stack: estimated depth of each event (in table order), then of each subroutine.
        stack_need: estimated depth of the deepest event with all its calls.
        warnings: suspicious constructs; they do not change the bytecode.
    """

    words: tuple[int, ...]
    lines: tuple[int | None, ...]
    variables: tuple[Memory, ...]
    events: tuple[EventEntry, ...]
    subs: tuple[SubEntry, ...]
    allocated: int
    stack: tuple[int, ...]
    stack_need: int = 0
    warnings: tuple[CompileWarning, ...] = ()

    @property
    def addresses(self) -> dict[str, tuple[int, int]]:
        """Address and size of each variable of the program by name."""
        return {variable.name: (variable.address, variable.size) for variable in self.variables}

    def row_of(self, pc: int) -> int | None:
        """The source row of a word of bytecode, None outside the code or where there is no row."""
        first = 2 * len(self.events) + 1
        return self.lines[pc] if first <= pc < len(self.lines) else None

    def addresses_of(self, row: int) -> tuple[int, ...]:
        """The addresses of the instructions of a source row in order; breakpoints use the first."""
        start = 2 * len(self.events) + 1
        return tuple(pc for pc, _ in instructions(self.words, start) if self.lines[pc] == row)

    def segment_of(self, pc: int) -> EventEntry | SubEntry | None:
        """The event or subroutine whose code contains the address, None outside the code."""
        entries: list[EventEntry | SubEntry] = sorted((*self.events, *self.subs), key=lambda entry: entry.address)
        place = bisect_right([entry.address for entry in entries], pc)
        return entries[place - 1] if place and pc < len(self.words) else None


def compile_stages(
    source: str,
    target: TargetDescription,
    events: Sequence[tuple[str, int]] = (),
    constants: Sequence[tuple[str, int]] = (),
) -> Stages:
    """The results of all passes. Raises CompileError, with a hint if there is one."""
    result = _attempt(source, target, events, constants)
    if isinstance(result, Stages):
        return result

    def again(text: str) -> Attempt | None:
        other = _attempt(text, target, events, constants)
        return other if isinstance(other, Attempt) else None

    result.error.hint = find_hint(source, result, again)
    raise result.error


def _attempt(
    source: str,
    target: TargetDescription,
    events: Sequence[tuple[str, int]],
    constants: Sequence[tuple[str, int]],
) -> Attempt | Stages:
    """The results of all passes, or the error and the pass that found it.

    Raises CompileError if the variables of the target do not fit into its memory.
    """
    stage = TOKENS
    symbols = SymbolTable(target, events, constants)
    try:
        tokens = tokenize(source)
        stage = GRAMMAR
        tree = parse(tokens, symbols)
        stage = LATER_PASSES
        check_sizes(tree)
        expanded = lower(tree, target.variables_size)
        check_types(expanded)
        optimized = optimize(expanded)
        segments = generate(optimized)
        check_stack(segments, target.stack_size)
    except CompileError as error:
        return Attempt(stage, error, symbols)
    return Stages(tokens, tree, expanded, optimized, segments)


def compile(  # noqa: A001  # the standard term; shadows the built-in function in this module only
    source: str,
    target: TargetDescription,
    events: Sequence[tuple[str, int]] = (),
    constants: Sequence[tuple[str, int]] = (),
) -> Program:
    """The program of a source text for a target.

    Args:
        source: text of one program, not of an `.aesl` file.
        target: the kind of node that will execute it.
        events: global events that the nodes of a network share: name, number of words.
        constants: constants that they share: name, value.

    Raises:
        CompileError: The first error, with a hint if there is one.
    """
    return assemble(compile_stages(source, target, events, constants), target)


def assemble(stages: Stages, target: TargetDescription) -> Program:
    """Link the code of a program. Raises CompileError if it does not fit into the memory of the target."""
    image = link(stages.segments)
    if len(image.words) > target.bytecode_size:
        raise CompileError("bytecode-too-large")
    events = sorted((segment for segment in stages.segments if not segment.is_sub), key=lambda part: part.number)
    subs = [segment for segment in stages.segments if segment.is_sub]
    return Program(
        words=image.words,
        lines=image.lines,
        variables=stages.tree.variables,
        events=image.events,
        subs=image.subs,
        allocated=stages.tree.allocated,
        stack=tuple(segment.depth for segment in (*events, *subs)),
        stack_need=check_stack(stages.segments, target.stack_size),
        warnings=find_warnings(stages.tree, stages.segments),
    )
