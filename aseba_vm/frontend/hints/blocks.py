"""Blocks: missing and extra `end`, `then` and `do`, braces, `else if`, the form of loops."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from aseba_vm.errors import Edit, Hint
from aseba_vm.frontend.hints.context import HANDLER_ENDS, STATEMENTS, ErrorContext, Word, spaced

_BLOCKS = frozenset(("if", "when", "while", "for"))


@dataclass(slots=True)
class Block:
    """An open block: index of its keyword, and of its last `else`."""

    opener: int
    other: int | None = None


def find_blocks(words: Sequence[Word]) -> tuple[list[Block], list[tuple[Block, int]]]:
    """The blocks that are open after the tokens, and the closed ones, each with the index of its end."""
    stack: list[Block] = []
    closed: list[tuple[Block, int]] = []
    for index, word in enumerate(words):
        if word.kind in _BLOCKS:
            stack.append(Block(index))
        elif word.kind == "else" and stack:
            stack[-1].other = index
        elif word.kind == "end" and stack:
            closed.append((stack.pop(), index))
        elif word.kind in ("onevent", "sub"):
            closed.clear()
    return stack, closed


def brace(context: ErrorContext) -> Hint | None:
    """Recognize `{` and `}`; the edit writes `then`, `do` or `end` where it is clear which of them."""
    source, at = context.source, context.offset
    if source[at] not in "{}":
        return None
    hint = Hint("hint-braces")
    keyword = context.condition(with_assignment=True) or ("for" if _is_loop_head(context.words[:-1]) else "")
    if source[at] == "}":
        is_open = bool(find_blocks(context.words)[0]) and re.match(r"\}\s*else(?:if)?\b", source[at:]) is None
        word = "end" if is_open else ""
    elif keyword:
        word = "then" if keyword in ("if", "elseif") else "do"
    elif context.kind(-1) == "else" or context.kind(-2) in ("onevent", "sub"):
        word = ""
    else:
        return hint
    return replace(hint, edit=Edit(at, at + 1, spaced(source, at, at + 1, word)))


def else_if(context: ErrorContext) -> Hint | None:
    """Recognize `else if` without its own `end`."""
    if not context.is_statement_expected or context.kind() not in HANDLER_ENDS:
        return None
    words = context.words
    pairs = [
        (words[block.other], words[block.other + 1])
        for block in find_blocks(words[: context.at])[0]
        if block.other is not None and words[block.other + 1].kind == "if"
        if words[block.other].row == words[block.other + 1].row
    ]
    if not pairs:
        return None
    text, previous = "", pairs[0][0].start
    for first, second in pairs:
        text += context.source[previous : first.start] + "elseif"
        previous = second.end
    return Hint("hint-else-if", (), Edit(pairs[0][0].start, previous, text), pairs[0][0].row)


def missing_end(context: ErrorContext) -> Hint | None:
    """Recognize a block that is still open at a handler, a subroutine or the end of the text.

    It is the last one opened, unless the `end` of a block inside it is indented like an outer block: then that block
    has taken the `end` of the outer one.
    """
    found = context.kind()
    words = context.words[: context.at]
    stack, closed = find_blocks(words)
    if not stack or not context.is_statement_expected or found not in (*HANDLER_ENDS, "else", "elseif"):
        return None
    if found in ("else", "elseif") and context.words[stack[-1].opener].kind == "if":
        return None
    opener, before = stack[-1].opener, context.at
    outer = {_indent(context.source, context.words[block.opener]) for block in stack}
    for block, end in closed:
        indent, own = (_indent(context.source, context.words[index]) for index in (end, block.opener))
        if indent is None or own is None:
            continue
        if len(indent) < len(own) and own.startswith(indent) and indent in outer and end > stack[-1].opener:
            opener, before = block.opener, end
            break
    word = context.words[opener]
    edit = _new_end(context, _line_indent(context.source, word), before)
    return Hint("hint-missing-end", (word.kind,), edit, word.row)


def extra_end(context: ErrorContext) -> Hint | None:
    """Recognize an `end` where no block is open, often meant for an `onevent`."""
    if context.kind() != "end" or not context.is_statement_expected or find_blocks(context.words[: context.at])[0]:
        return None
    word, source = context.word(), context.source
    start, end = word.start, word.end
    line_start = source.rfind("\n", 0, start) + 1
    if source[line_start:start].strip() == "" and re.match(r"[ \t]*\r?\n", source[end:]):
        start, end = line_start, source.index("\n", end) + 1
    return Hint("hint-extra-end", (), Edit(start, end, ""))


def block_word(context: ErrorContext) -> Hint | None:
    """Recognize `then` or `do` that is missing, written as `:`, or confused with the other."""
    wanted, found = context.error.arguments[0], context.kind()
    if not isinstance(wanted, str) or wanted not in ("then", "do"):
        return None
    if found in ("then", "do", ":"):
        before = "" if found != ":" or context.source[context.offset - 1 : context.offset].isspace() else " "
        return context.replaced("hint-block-word", 0, 0, before + wanted, wanted)
    if found in STATEMENTS or found in ("identifier", "end"):
        last = context.word(-1)
        if found == "identifier" and context.word().row == last.row:
            return None
        return Hint("hint-block-word", (wanted,), Edit(last.end, last.end, f" {wanted}"))
    return None


def loop_form(context: ErrorContext) -> Hint | None:
    """Recognize `for i = 0 to 9` and `for (i = 0; …)`."""
    is_head = context.kind(-1) == "for" or context.kind(-2) == "for"
    return Hint("hint-for", ()) if is_head and context.kind() in ("=", "(", "identifier", "integer") else None


def _is_loop_head(words: Sequence[Word]) -> bool:
    for word in reversed(words):
        if word.kind == "for":
            return True
        if word.kind in ("do", "then", "end", "else", "onevent", "sub"):
            return False
    return False


def _new_end(context: ErrorContext, indent: str, before: int) -> Edit:
    """The edit that inserts `end` between two tokens, on its own line if they are on different lines."""
    last = context.words[before - 1]
    if context.words[before].row == last.row:
        return Edit(last.end, last.end, " end")
    newline = "\r\n" if "\r\n" in context.source else "\n"
    line_end = context.source.find("\n", last.end)
    line_end = len(context.source) if line_end < 0 else line_end - (newline == "\r\n")
    return Edit(line_end, line_end, f"{newline}{indent}end")


def _line_indent(source: str, word: Word) -> str:
    line = source[source.rfind("\n", 0, word.start) + 1 : word.start]
    return line[: len(line) - len(line.lstrip(" \t"))]


def _indent(source: str, word: Word) -> str | None:
    """The white space before the first token of a line; None for other tokens."""
    line = source[source.rfind("\n", 0, word.start) + 1 : word.start]
    return line if line.strip(" \t") == "" else None
