"""Declarations of variables and constants below the first statement."""

from __future__ import annotations

import re
from dataclasses import replace

from aseba_vm.errors import Edit, Hint
from aseba_vm.frontend.hints.context import ErrorContext


def late_declaration(context: ErrorContext) -> Hint | None:
    """Recognize `var` after the first statement; the edit declares it above and leaves the assignment in place."""
    keyword = context.kind()
    is_refused = context.error.kind == "misplaced-var" or context.is_statement_expected
    if keyword not in ("var", "const") or not is_refused:
        return None
    hint = Hint(f"hint-late-{keyword}", (context.word(1).text if context.kind(1) == "identifier" else keyword,))
    if keyword == "const" or context.kind(1) != "identifier":
        return hint
    size = 2
    if context.kind(2) == "[":
        while context.kind(size) not in ("]", ""):
            size += 1
        if size == 3 or context.kind(size) == "":
            return hint
        size += 1
    source, name, last = context.source, context.word(1), context.word(size - 1)
    hint = replace(hint, arguments=(source[name.start : last.end],))
    top = _end_of_declarations(context)
    head, tail = source[top : context.word().start], source[last.end :]
    declaration = source[context.word().start : last.end]
    newline = "\r\n" if "\r\n" in source else "\n"
    declared = f"{newline}{declaration}" if top else f"{declaration}{newline}"
    if context.kind(size) == "=":
        return replace(hint, edit=Edit(top, last.end, f"{declared}{head}{name.text}"))
    end = last.end
    if head.rpartition("\n")[2].strip() == "" and re.match(r"[ \t]*(?:\r?\n|$)", tail):
        head = head[: head.rfind("\n") + 1]
        end = source.find("\n", end) + 1 or len(source)
    return replace(hint, edit=Edit(top, end, f"{declared}{head}"))


def _end_of_declarations(context: ErrorContext) -> int:
    """The end of the last line of the declarations at the beginning; 0 if there are none."""
    top = depth = 0
    row = -1
    is_declared = False
    for word in context.words[: context.at]:
        if word.row != row and depth == 0:
            is_declared = word.kind in ("var", "const")
            if not is_declared:
                break
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(word.kind, 0)
        row = word.row
        top = word.end
    if not top:
        return 0
    line_end = context.source.find("\n", top)
    return len(context.source) if line_end < 0 else line_end - (context.source[line_end - 1] == "\r")
