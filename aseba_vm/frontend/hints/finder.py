"""Hints for errors whose message does not help a beginner: the probable intention, and an edit that corrects the error.

Each recognizer of this package checks the tokens around the position of an error and returns a hint or None. Kind and
position of the error do not change. A wrong hint is worse than none, so an edit is offered only if it lets the compiler
get further.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from aseba_vm.errors import Edit, Hint
from aseba_vm.frontend.hints import blocks, calls, characters, comments, declarations, names, operators, values, words
from aseba_vm.frontend.hints.context import LATER_PASSES, Attempt, ErrorContext, locate_error

Recognizer = Callable[[ErrorContext], Hint | None]

_UNKNOWN_NAME: Sequence[Recognizer] = (
    words.keyword_spelling,
    words.truth_value,
    calls.native_as_statement,
    calls.subroutine_as_statement,
    calls.native_in_expression,
    values.later_variable_as_size,
    names.misspelled_keyword,
    names.spelling,
    names.part_of_name,
)
_UNKNOWN_CONSTANT: Sequence[Recognizer] = (values.variable_as_bound, names.spelling, names.part_of_name)
_UNKNOWN_FUNCTION: Sequence[Recognizer] = (calls.call_of_subroutine, names.spelling, names.part_of_name)
_UNKNOWN_SUBROUTINE: Sequence[Recognizer] = (calls.callsub_of_native, names.spelling, names.part_of_name)
_UNKNOWN_EVENT: Sequence[Recognizer] = (names.spelling, names.part_of_name)
_WHOLE_ARRAY: Sequence[Recognizer] = (values.whole_array,)
_RECOGNIZERS: Mapping[str, Sequence[Recognizer]] = {
    "illegal-character": (
        comments.foreign_comment,
        characters.semicolon,
        blocks.brace,
        characters.quotation_mark,
        characters.look_alike,
    ),
    "lone-exclamation": (comments.foreign_comment, operators.negation),
    "bad-number": (comments.foreign_comment, characters.decimals),
    "bad-number-base": (comments.foreign_comment, characters.decimals),
    "unknown-variable": _UNKNOWN_NAME,
    "unknown-variable-hint": _UNKNOWN_NAME,
    "unknown-constant": _UNKNOWN_CONSTANT,
    "unknown-constant-hint": _UNKNOWN_CONSTANT,
    "unknown-function": _UNKNOWN_FUNCTION,
    "unknown-function-hint": _UNKNOWN_FUNCTION,
    "unknown-subroutine": _UNKNOWN_SUBROUTINE,
    "unknown-subroutine-hint": _UNKNOWN_SUBROUTINE,
    "unknown-event": _UNKNOWN_EVENT,
    "unknown-event-hint": _UNKNOWN_EVENT,
    "not-constant": (values.variable_as_size,),
    "slice-end-not-constant": (values.variable_in_slice,),
    "size-mismatch": _WHOLE_ARRAY,
    "vector-condition-if": _WHOLE_ARRAY,
    "vector-condition-while": _WHOLE_ARRAY,
    "event-argument-size": _WHOLE_ARRAY,
    "event-argument-too-large": _WHOLE_ARRAY,
    "argument-size": _WHOLE_ARRAY,
    "argument-size-template": _WHOLE_ARRAY,
    "misplaced-var": (declarations.late_declaration,),
    "expected-assignment": (operators.comparison_as_statement, calls.native_with_variable),
    "expected-one-of": (operators.doubled_operator, comments.comment_as_statement),
    "type-mismatch": (operators.number_as_condition,),
    "expected-token": (
        operators.equals_in_condition,
        names.misspelled_connector,
        values.variable_in_slice,
        values.calculated_bound,
        blocks.block_word,
        blocks.loop_form,
        calls.callsub_with_parentheses,
        calls.call_without_parentheses,
        operators.comparison_in_declaration,
        operators.step_in_front,
        comments.comment_as_statement,
        declarations.late_declaration,
        blocks.else_if,
        blocks.missing_end,
        blocks.extra_end,
    ),
}
"""Recognizers by kind of error. The order matters: the first hint wins."""

_STAND_ALONE = frozenset(
    (
        "hint-semicolon",
        "hint-braces",
        "hint-truth",
        "hint-native-in-expression",
        "hint-missing-end",
        "hint-late-var",
        "hint-late-const",
        "hint-not",
    )
)
"""Kinds of hints that are given without their edit if the edit alone does not get the compiler further."""


def find_hint(source: str, attempt: Attempt, compile_again: Callable[[str], Attempt | None]) -> Hint | None:
    """The hint for a rejected text, None if there is none.

    Args:
        source: text of the program.
        attempt: how far the compiler got.
        compile_again: compiles another text to try an edit; None means success.
    """
    recognizers = _RECOGNIZERS.get(attempt.error.kind, ())
    context = locate_error(source, attempt) if recognizers and attempt.error.pos is not None else None
    if context is None:
        return None
    for recognize in recognizers:
        hint = recognize(context)
        if hint is None or hint.edit is None:
            if hint is not None:
                return hint
        elif _is_better(attempt, compile_again(hint.edit.applied(source)), hint.edit):
            return hint
        elif hint.kind in _STAND_ALONE:
            return replace(hint, edit=None)
    return None


def _is_better(before: Attempt, after: Attempt | None, edit: Edit) -> bool:
    """Whether the edited text compiles, or is rejected by a later pass, or after edit and old position."""
    if after is None or after.stage != before.stage:
        return after is None or after.stage > before.stage
    is_behind = edit.start <= before.offset
    moved = before.offset + len(edit.text) - (edit.end - edit.start) if is_behind else before.offset
    if before.stage == LATER_PASSES:
        return (after.error.kind, after.offset) != (before.error.kind, moved)
    if edit.start <= before.offset < max(edit.end, edit.start + 1):
        return after.offset >= edit.start + len(edit.text)
    return after.offset > moved
