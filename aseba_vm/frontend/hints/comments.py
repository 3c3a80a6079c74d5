"""Comments as other languages write them: `//` and `/* */`."""

from __future__ import annotations

from itertools import pairwise

from aseba_vm.errors import Edit, Hint
from aseba_vm.frontend.hints.context import ErrorContext


def foreign_comment(context: ErrorContext) -> Hint | None:
    """Recognize `//` before the error in the same line, or `/*` around it."""
    for first, second in reversed(list(pairwise(context.words))):
        if first.kind != "/" or first.end != second.start or second.kind not in ("/", "*", "*="):
            continue
        hint = _rewritten(context.source, first.start)
        is_line = second.kind == "/"
        if hint is not None and hint.edit is not None:
            end = context.source.find("\n", first.start) if is_line else hint.edit.end
            if end < 0 or context.offset < end:
                return hint
    return None


def comment_as_statement(context: ErrorContext) -> Hint | None:
    """Recognize `// comment`: the first half is rejected where a statement may start, the second in an expression."""
    at = 0 if context.kind() == "/" and context.is_adjacent(0) else -1
    if context.kind(at) != "/" or not context.is_adjacent(at) or context.kind(at + 1) not in ("/", "*", "*="):
        return None
    return _rewritten(context.source, context.word(at).start)


def _rewritten(source: str, start: int) -> Hint | None:
    """The hint that writes `//` or `/* */` as an Aseba comment."""
    if source.startswith("//", start):
        return Hint("hint-comment", ("//", "#"), Edit(start, start + 2, "#"))
    end = source.find("*/", start + 2)
    if end < 0:
        return None
    return Hint("hint-comment", ("/*", "#*"), Edit(start, end + 2, f"#*{source[start + 2 : end]}*#"))
