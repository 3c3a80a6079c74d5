"""Hints for errors whose message does not help a beginner: what was probably meant, and an edit that corrects it.

Each recognizer checks the tokens around the position of an error and returns a hint or None. Kind and position of the
error do not change. A wrong hint is worse than none, so an edit is offered only if it lets the compiler get further.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from aseba_vm.errors import CompileError, Edit, Hint
from aseba_vm.frontend.lexer import KEYWORDS, Token, tokenize
from aseba_vm.frontend.parser import COMPOUND
from aseba_vm.frontend.token_spacing import token_begin, token_end
from aseba_vm.target import NativeFunction, TargetDescription


@dataclass(frozen=True, slots=True)
class Attempt:
    """A rejected text: the pass that found the error (0 tokens, 1 grammar, 2 any later one), and the error."""

    stage: int
    error: CompileError

    @property
    def offset(self) -> int:
        """Offset of the error, 0 if it has no position."""
        return 0 if self.error.pos is None else self.error.pos.offset


_TOKENS = 0
_LATER = 2

_BLOCKS = frozenset(("if", "when", "while", "for"))
_CONDITIONS = frozenset(("if", "elseif", "when", "while"))
_STATEMENTS = frozenset(("if", "when", "while", "for", "emit", "_emit", "call", "callsub", "return"))
_MARKERS = ("onevent", "sub", "end-of-input")
"""Keywords that end a handler."""
_AFTER_STATEMENT = frozenset(("then", "do", "else", "end", "return", "integer", ")", "]", "++", "--"))
_CONNECTORS = frozenset(
    ("+", "-", "*", "/", "%", "<", ">", "==", "!=", "<=", ">=", "|", "^", "&", "<<", ">>", "and", "or")
)
_BEFORE_VALUE = _CONNECTORS | _CONDITIONS | COMPOUND | frozenset(("=", "(", "[", ",", ":", "~", "not", "abs"))
_DOUBLED = {("&", "&"): "and", ("|", "|"): "or"}
_COMPARISONS = {("<", ">"): "!=", ("==", "="): "==", ("!=", "="): "!="}
_SWAPPED = {">": ">=", "<": "<="}
_ELSEIF = frozenset(("elif", "elsif", "elseIf", "elseif", "ELSEIF", "ElseIf", "Elseif"))
_TRUTH = {"true": "1", "false": "0"}
_SPACE = ("", " ", "\t", "\r", "\n")
_QUOTES = frozenset("\"'“”„«»‘’‚")
_LOOK_ALIKE = {
    "\u00a0": " ", "\u2007": " ", "\u202f": " ", "\u200b": "", "\ufeff": "", "−": "-", "–": "-", "—": "-", "×": "*",
    "·": "*", "÷": "/", "≤": "<=", "≥": ">=", "≠": "!=",
}  # fmt: skip
"""Characters that word processors and web pages substitute for those of a program."""
_COMMENTS = re.compile(r"#\*.*?\*#|#[^\r\n]*", re.DOTALL)
_DECIMAL = re.compile(r"[0-9]+\.[0-9]+(?![\w.])")
_OPERAND = re.compile(r"![ \t]*([^\W\d][\w.]*(?:\[[0-9]+\])?)(?=[ \t]*(?:\)|then\b|do\b|and\b|or\b|&&|\|\|))")


@dataclass(frozen=True, slots=True)
class _Word:
    """A token with its range in the text."""

    kind: str
    text: str
    start: int
    end: int
    row: int


@dataclass(frozen=True, slots=True)
class _Context:
    """An error and its context: the text, the tokens (up to the error if a token is invalid), and the position."""

    source: str
    words: Sequence[_Word]
    at: int
    offset: int
    error: CompileError
    natives: Mapping[str, NativeFunction]

    def kind(self, distance: int = 0) -> str:
        """Return the kind of a token near the error; empty before the first and after the last."""
        index = self.at + distance
        return self.words[index].kind if 0 <= index < len(self.words) else ""

    def word(self, distance: int = 0) -> _Word:
        return self.words[self.at + distance]

    def is_adjacent(self, distance: int) -> bool:
        """Return whether a token near the error touches the next one."""
        first = self.at + distance
        return 0 <= first < len(self.words) - 1 and self.words[first].end == self.words[first + 1].start

    def replaced(self, kind: str, first: int, last: int, text: str, *arguments: str | int) -> Hint:
        """Return a hint with an edit that replaces the tokens from one distance to another."""
        return Hint(kind, arguments, Edit(self.word(first).start, self.word(last).end, text))

    @property
    def subs(self) -> set[str]:
        """Return the names of the subroutines of the program."""
        return {name.text for keyword, name in pairwise(self.words) if keyword.kind == "sub"}

    @property
    def is_statement_expected(self) -> bool:
        """Return whether the error is an unexpected token where a statement may start."""
        keywords = ("call", "callsub", "onevent", "sub", "emit", "_emit", "for", "in", ":", "step")
        return self.error.arguments[:1] == ("identifier",) and self.kind(-1) not in keywords

    def condition(self, *, with_assignment: bool = False) -> str:
        """Return the keyword of the condition that contains the error, empty if there is none.

        ``with_assignment``: an ``=`` does not end the condition.
        """
        ends = {"then", "do", "else", "end", "onevent", "sub", "call", "callsub", "emit", "return", "var", "const"}
        for word in reversed(self.words[: self.at]):
            if word.kind in _CONDITIONS:
                return word.kind
            if word.kind in ends or (word.kind == "=" and not with_assignment):
                return ""
        return ""

    def is_statement(self, distance: int = 0) -> bool:
        """Return whether a token near the error is the first of a statement."""
        before = self.kind(distance - 1)
        if before == "identifier":
            return self.kind(distance - 2) not in ("emit", "_emit", "call", "for")
        return before == "" or before in _AFTER_STATEMENT

    def closing(self, distance: int) -> int | None:
        """Return the distance of the parenthesis that closes the one at a distance, None if there is none."""
        depth = 0
        for index in range(self.at + distance, len(self.words)):
            depth += {"(": 1, ")": -1}.get(self.words[index].kind, 0)
            if depth == 0:
                return index - self.at
        return None


Recognizer = Callable[[_Context], Hint | None]


def find_hint(
    source: str, target: TargetDescription, attempt: Attempt, compile_again: Callable[[str], Attempt | None]
) -> Hint | None:
    """Return the hint for a rejected text, None if there is none.

    Args:
        source: text of the program.
        target: target of the program.
        attempt: how far the compiler got.
        compile_again: compiles another text to try an edit; None means success.
    """
    recognizers = _RECOGNIZERS.get(attempt.error.kind, ())
    place = _context(source, target, attempt) if recognizers and attempt.error.pos is not None else None
    if place is None:
        return None
    for recognize in recognizers:
        hint = recognize(place)
        if hint is None or hint.edit is None:
            if hint is not None:
                return hint
        elif _is_better(attempt, compile_again(hint.edit.applied(source)), hint.edit):
            return hint
        elif hint.kind in _STAND_ALONE:
            return replace(hint, edit=None)
    return None


def _context(source: str, target: TargetDescription, attempt: Attempt) -> _Context | None:
    error, offset = attempt.error, attempt.offset
    is_token = attempt.stage == _TOKENS
    try:
        tokens = tokenize(source[:offset] if is_token else source)
    except CompileError:
        return None
    words = [_word(source, token) for token in tokens[:-1]]
    words.append(_Word("end-of-input", "", len(source), len(source), words[-1].row + 1 if words else 0))
    at: int | None = len(words) - 1
    if not is_token:
        found = [index for index, token in enumerate(tokens) if token.pos == error.pos]
        # The end of input has the position of the last character, which may belong to a token.
        ends = [index for index in found if tokens[index].kind in error.arguments]
        at = next(iter(ends or found), None)
    if at is None:
        return None
    natives = {native.name: native for native in target.natives}
    return _Context(source, words, at, offset if is_token else words[at].start, error, natives)


def _word(source: str, token: Token) -> _Word:
    return _Word(token.kind, token.text, token_begin(token), token_end(source, token), token.pos.row)


def _is_better(before: Attempt, after: Attempt | None, edit: Edit) -> bool:
    """Return whether the edited text compiles, or is rejected by a later pass, or after edit and old position."""
    if after is None or after.stage != before.stage:
        return after is None or after.stage > before.stage
    is_behind = edit.start <= before.offset
    moved = before.offset + len(edit.text) - (edit.end - edit.start) if is_behind else before.offset
    if before.stage == _LATER:
        return (after.error.kind, after.offset) != (before.error.kind, moved)
    if edit.start <= before.offset < max(edit.end, edit.start + 1):
        return after.offset >= edit.start + len(edit.text)
    return after.offset > moved


# -- characters that start no token ------------------------------------------------------------------------------------


def _foreign_comment(place: _Context) -> Hint | None:
    """Recognize ``//`` before the error in the same line, or ``/*`` around it."""
    for first, second in reversed(list(pairwise(place.words))):
        if first.kind != "/" or first.end != second.start or second.kind not in ("/", "*", "*="):
            continue
        hint = _comment(place.source, first.start)
        is_line = second.kind == "/"
        if hint is not None and hint.edit is not None:
            end = place.source.find("\n", first.start) if is_line else hint.edit.end
            if end < 0 or place.offset < end:
                return hint
    return None


def _comment(source: str, start: int) -> Hint | None:
    """Return the hint that writes ``//`` or ``/* */`` as an Aseba comment."""
    if source.startswith("//", start):
        return Hint("hint-comment", ("//", "#"), Edit(start, start + 2, "#"))
    end = source.find("*/", start + 2)
    if end < 0:
        return None
    return Hint("hint-comment", ("/*", "#*"), Edit(start, end + 2, f"#*{source[start + 2 : end]}*#"))


def _semicolon(place: _Context) -> Hint | None:
    """Recognize ``;``; the edit removes all of them."""
    source = place.source
    if source[place.offset] != ";" or sum((word.kind == "[") - (word.kind == "]") for word in place.words) > 0:
        return None
    code = _COMMENTS.sub(lambda comment: " " * len(comment[0]), source)
    first, last = code.index(";"), code.rindex(";")
    text = "".join(
        letter if code[at] != ";" else "" if source[at + 1 : at + 2] in _SPACE else " "
        for at, letter in enumerate(source[first : last + 1], start=first)
    )
    return Hint("hint-semicolon", (), Edit(first, last + 1, text))


def _brace(place: _Context) -> Hint | None:
    source, at = place.source, place.offset
    if source[at] not in "{}":
        return None
    hint = Hint("hint-braces")
    keyword = place.condition(with_assignment=True) or ("for" if _is_loop_head(place.words[:-1]) else "")
    if source[at] == "}":
        is_open = bool(_blocks(place.words)[0]) and re.match(r"\}\s*else(?:if)?\b", source[at:]) is None
        word = "end" if is_open else ""
    elif keyword:
        word = "then" if keyword in ("if", "elseif") else "do"
    elif place.kind(-1) == "else" or place.kind(-2) in ("onevent", "sub"):
        word = ""
    else:
        return hint
    return replace(hint, edit=Edit(at, at + 1, _spaced(source, at, at + 1, word)))


def _text(place: _Context) -> Hint | None:
    return Hint("hint-text", ()) if place.source[place.offset] in _QUOTES else None


def _look_alike(place: _Context) -> Hint | None:
    letter = place.source[place.offset]
    right = _LOOK_ALIKE.get(letter)
    if right is None:
        return None
    edit = Edit(place.offset, place.offset + 1, right)
    if not right.strip():
        return Hint("hint-invisible", (f"U+{ord(letter):04X}",), edit)
    return Hint("hint-look-alike", (right,), edit)


def _negation(place: _Context) -> Hint | None:
    """Recognize ``!`` in a condition, or ``! =``."""
    source, at = place.source, place.offset
    spaced = re.match(r"![ \t]+=(?!=)", source[at:])
    if spaced is not None:
        return Hint("hint-not-equal", (), Edit(at, at + spaced.end(), "!="))
    if not place.condition() or place.kind(-1) not in (*_CONDITIONS, "and", "or", "not", "(", "&", "|"):
        return None
    value = _OPERAND.match(source, at)
    if value is not None:
        return Hint("hint-not", (), Edit(at, value.end(), f"{value[1]} == 0"))
    return Hint("hint-not", (), Edit(at, at + 1, "not " if source[at + 1 : at + 2] == "(" else "not"))


def _decimals(place: _Context) -> Hint | None:
    number = _DECIMAL.match(place.source, place.offset)
    return Hint("hint-decimals", (number[0],)) if number is not None else None


# -- operators ---------------------------------------------------------------------------------------------------------


def _equals_in_condition(place: _Context) -> Hint | None:
    """Recognize ``if a = 1`` and ``if a => 1``."""
    if place.kind() != "=" or not place.condition():
        return None
    if place.is_adjacent(0) and place.kind(1) in _SWAPPED:
        right = _SWAPPED[place.kind(1)]
        return place.replaced("hint-comparison", 0, 1, right, right)
    return place.replaced("hint-equals-in-condition", 0, 0, "==")


def _doubled(place: _Context) -> Hint | None:
    """Recognize ``&&``, ``||``, ``<>``, ``===`` and ``!==``, whose second half was rejected."""
    if not place.is_adjacent(-1):
        return None
    pair = (place.kind(-1), place.kind())
    if pair in _DOUBLED:
        word = _DOUBLED[pair]
        first, second = place.word(-1), place.word()
        text = _spaced(place.source, first.start, second.end, word)
        return Hint(f"hint-{word}", (), Edit(first.start, second.end, text))
    if pair in _COMPARISONS:
        return place.replaced("hint-comparison", -1, 0, _COMPARISONS[pair], _COMPARISONS[pair])
    return None


def _comparison_as_statement(place: _Context) -> Hint | None:
    """Recognize ``a == 1`` or ``a := 1`` in place of an assignment."""
    if place.kind() == "==":
        return place.replaced("hint-assignment", 0, 0, "=")
    if place.kind() == ":" and place.kind(1) == "=" and place.is_adjacent(0):
        return place.replaced("hint-assignment", 0, 1, "=")
    return None


def _declared_with_comparison(place: _Context) -> Hint | None:
    return _comparison_as_statement(place) if place.kind(-1) in ("identifier", "]") else None


def _step_in_front(place: _Context) -> Hint | None:
    """Recognize ``++i``."""
    if place.kind() not in ("++", "--") or place.kind(1) != "identifier" or not place.is_statement_expected:
        return None
    name, mark = place.word(1), place.word()
    return place.replaced("hint-step", 0, 1, f"{name.text}{mark.kind}", f"{name.text}{mark.kind}")


def _comment_as_statement(place: _Context) -> Hint | None:
    """Recognize ``// comment``: the first half is rejected where a statement may start, the second in an expression."""
    at = 0 if place.kind() == "/" and place.is_adjacent(0) else -1
    if place.kind(at) != "/" or not place.is_adjacent(at) or place.kind(at + 1) not in ("/", "*", "*="):
        return None
    return _comment(place.source, place.word(at).start)


# -- names -------------------------------------------------------------------------------------------------------------


def _other_keyword(place: _Context) -> Hint | None:
    """Recognize ``elif`` and ``If``."""
    name = place.word().text
    if name in _ELSEIF:
        return place.replaced("hint-elseif", 0, 0, "elseif", name)
    small = name.lower()
    if name not in KEYWORDS and small in KEYWORDS:
        return place.replaced("hint-small-letters", 0, 0, small, name, small)
    return None


def _truth(place: _Context) -> Hint | None:
    value = _TRUTH.get(place.word().text.lower())
    if value is None or place.kind(-1) not in _BEFORE_VALUE:
        return None
    is_compared = place.kind(-1) not in (*_CONDITIONS, "and", "or", "not")
    if is_compared and place.kind(1) not in ("==", "!="):
        return place.replaced("hint-truth", 0, 0, value, place.word().text)
    return Hint("hint-truth", (place.word().text,))


def _called_name(place: _Context) -> int:
    """Return the distance of the rejected name, or of the name before the rejected parenthesis."""
    return -1 if place.kind() == "(" else 0


def _native_as_statement(place: _Context) -> Hint | None:
    """Recognize ``sound.freq(440, 1)`` without ``call``."""
    at = _called_name(place)
    if place.kind(at) != "identifier" or place.kind(at + 1) != "(" or not place.is_statement(at):
        return None
    name = place.word(at)
    if name.text in place.natives:
        return Hint("hint-call", (name.text,), Edit(name.start, name.start, "call "))
    return None


def _native_with_variable(place: _Context) -> Hint | None:
    """Recognize the same where a variable has the name of the function, as ``leds.top`` does."""
    return _native_as_statement(place) if place.kind() == "(" else None


def _sub_as_statement(place: _Context) -> Hint | None:
    """Recognize ``turn`` or ``turn()`` without ``callsub``."""
    at = _called_name(place)
    if place.kind(at) != "identifier" or place.word(at).text not in place.subs or not place.is_statement(at):
        return None
    name = place.word(at).text
    if place.kind(at + 1) != "(":
        is_alone = place.kind(at + 1) in (*_STATEMENTS, *_MARKERS, "identifier", "end", "else", "elseif")
        return place.replaced("hint-callsub", at, at, f"callsub {name}", name) if is_alone else None
    if place.kind(at + 2) == ")":
        return place.replaced("hint-callsub", at, at + 2, f"callsub {name}", name)
    return Hint("hint-sub-arguments", (name,))


def _native_in_expression(place: _Context) -> Hint | None:
    """Recognize ``x = math.sqrt(y)``."""
    name = place.word()
    if name.text not in place.natives or place.kind(1) != "(" or place.kind(-1) not in _BEFORE_VALUE:
        return None
    hint = Hint("hint-native-in-expression", (name.text,))
    close = place.closing(1)
    parameters = place.natives[name.text].parameters
    is_result = bool(parameters) and parameters[0].name == "dest"
    is_assigned = place.kind(-1) == "=" and place.kind(-2) == "identifier" and place.is_statement(-2)
    if close is None or not is_result or not is_assigned or place.kind(-3) in ("var", "const"):
        return hint
    if place.kind(close + 1) in _CONNECTORS:
        return hint
    inside = place.source[place.word(1).end : place.word(close).start].strip()
    left = place.word(-2)
    text = f"call {name.text}({left.text}{', ' + inside if inside else ''})"
    return replace(hint, edit=Edit(left.start, place.word(close).end, text))


def _call_of_sub(place: _Context) -> Hint | None:
    """Recognize ``call turn`` or ``call turn()``."""
    if place.kind() != "call" or place.kind(1) != "identifier" or place.word(1).text not in place.subs:
        return None
    name = place.word(1).text
    if place.kind(2) == "(" and place.kind(3) == ")":
        return place.replaced("hint-callsub", 0, 3, f"callsub {name}", name)
    if place.kind(2) == "(":
        return Hint("hint-sub-arguments", (name,))
    return place.replaced("hint-callsub", 0, 0, "callsub", name)


def _callsub_with_parentheses(place: _Context) -> Hint | None:
    """Recognize ``callsub turn()`` and ``callsub sound.freq(440, 1)``."""
    if place.kind() != "(" or place.kind(-1) != "identifier" or place.kind(-2) != "callsub":
        return None
    name = place.word(-1).text
    if name in place.subs:
        if place.kind(1) == ")":
            return place.replaced("hint-callsub-parentheses", 0, 1, "", name)
        return Hint("hint-sub-arguments", (name,))
    if name in place.natives:
        return place.replaced("hint-call", -2, -2, "call", name)
    return None


def _callsub_of_native(place: _Context) -> Hint | None:
    if place.kind() != "callsub" or place.kind(1) != "identifier" or place.word(1).text not in place.natives:
        return None
    return Hint("hint-call", (place.word(1).text,))


def _call_without_parentheses(place: _Context) -> Hint | None:
    if place.kind(-1) != "identifier" or place.kind(-2) != "call":
        return None
    name = place.word(-1)
    if name.text not in place.natives:
        return None
    hint = Hint("hint-parentheses", (name.text,))
    return hint if place.natives[name.text].parameters else replace(hint, edit=Edit(name.end, name.end, "()"))


# -- blocks ------------------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class _Block:
    """An open block: index of its keyword, and of its last ``else``."""

    opener: int
    other: int | None = None


def _blocks(words: Sequence[_Word]) -> tuple[list[_Block], list[tuple[_Block, int]]]:
    """Return the blocks that are open after the tokens, and the closed ones, each with the index of its end."""
    stack: list[_Block] = []
    closed: list[tuple[_Block, int]] = []
    for index, word in enumerate(words):
        if word.kind in _BLOCKS:
            stack.append(_Block(index))
        elif word.kind == "else" and stack:
            stack[-1].other = index
        elif word.kind == "end" and stack:
            closed.append((stack.pop(), index))
        elif word.kind in ("onevent", "sub"):
            closed.clear()
    return stack, closed


def _else_if(place: _Context) -> Hint | None:
    """Recognize ``else if`` without its own ``end``."""
    if not place.is_statement_expected or place.kind() not in _MARKERS:
        return None
    words = place.words
    pairs = [
        (words[block.other], words[block.other + 1])
        for block in _blocks(words[: place.at])[0]
        if block.other is not None and words[block.other + 1].kind == "if"
        if words[block.other].row == words[block.other + 1].row
    ]
    if not pairs:
        return None
    text, previous = "", pairs[0][0].start
    for first, second in pairs:
        text += place.source[previous : first.start] + "elseif"
        previous = second.end
    return Hint("hint-else-if", (), Edit(pairs[0][0].start, previous, text), pairs[0][0].row)


def _missing_end(place: _Context) -> Hint | None:
    """Recognize a block that is still open at a handler, a subroutine or the end of the text.

    It is the last one opened, unless the ``end`` of a block inside it is indented like an outer block: then that block
    has taken the ``end`` of the outer one.
    """
    found = place.kind()
    words = place.words[: place.at]
    stack, closed = _blocks(words)
    if not stack or not place.is_statement_expected or found not in (*_MARKERS, "else", "elseif"):
        return None
    if found in ("else", "elseif") and place.words[stack[-1].opener].kind == "if":
        return None
    opener, before = stack[-1].opener, place.at
    outer = {_indent(place.source, place.words[block.opener]) for block in stack}
    for block, end in closed:
        indent, own = (_indent(place.source, place.words[index]) for index in (end, block.opener))
        if indent is None or own is None:
            continue
        if len(indent) < len(own) and own.startswith(indent) and indent in outer and end > stack[-1].opener:
            opener, before = block.opener, end
            break
    word = place.words[opener]
    edit = _new_end(place, _line_indent(place.source, word), before)
    return Hint("hint-missing-end", (word.kind,), edit, word.row)


def _new_end(place: _Context, indent: str, before: int) -> Edit:
    """Return the edit that inserts ``end`` between two tokens, on its own line if they are on different lines."""
    last = place.words[before - 1]
    if place.words[before].row == last.row:
        return Edit(last.end, last.end, " end")
    newline = "\r\n" if "\r\n" in place.source else "\n"
    line_end = place.source.find("\n", last.end)
    line_end = len(place.source) if line_end < 0 else line_end - (newline == "\r\n")
    return Edit(line_end, line_end, f"{newline}{indent}end")


def _extra_end(place: _Context) -> Hint | None:
    """Recognize an ``end`` where no block is open, often meant for an ``onevent``."""
    if place.kind() != "end" or not place.is_statement_expected or _blocks(place.words[: place.at])[0]:
        return None
    word, source = place.word(), place.source
    start, end = word.start, word.end
    line_start = source.rfind("\n", 0, start) + 1
    if source[line_start:start].strip() == "" and re.match(r"[ \t]*\r?\n", source[end:]):
        start, end = line_start, source.index("\n", end) + 1
    return Hint("hint-extra-end", (), Edit(start, end, ""))


def _block_word(place: _Context) -> Hint | None:
    """Recognize ``then`` or ``do`` that is missing, written as ``:``, or confused with the other."""
    wanted, found = place.error.arguments[0], place.kind()
    if not isinstance(wanted, str) or wanted not in ("then", "do"):
        return None
    if found in ("then", "do", ":"):
        before = "" if found != ":" or place.source[place.offset - 1 : place.offset].isspace() else " "
        return place.replaced("hint-block-word", 0, 0, before + wanted, wanted)
    if found in _STATEMENTS or found in ("identifier", "end"):
        last = place.word(-1)
        if found == "identifier" and place.word().row == last.row:
            return None
        return Hint("hint-block-word", (wanted,), Edit(last.end, last.end, f" {wanted}"))
    return None


def _loop_form(place: _Context) -> Hint | None:
    """Recognize ``for i = 0 to 9`` and ``for (i = 0; …)``."""
    is_head = place.kind(-1) == "for" or place.kind(-2) == "for"
    return Hint("hint-for", ()) if is_head and place.kind() in ("=", "(", "identifier", "integer") else None


def _is_loop_head(words: Sequence[_Word]) -> bool:
    for word in reversed(words):
        if word.kind == "for":
            return True
        if word.kind in ("do", "then", "end", "else", "onevent", "sub"):
            return False
    return False


def _late_declaration(place: _Context) -> Hint | None:
    """Recognize ``var`` after the first statement; the edit declares it above and assigns the value in place."""
    keyword = place.kind()
    is_refused = place.error.kind == "misplaced-var" or place.is_statement_expected
    if keyword not in ("var", "const") or not is_refused:
        return None
    hint = Hint(f"hint-late-{keyword}", (place.word(1).text if place.kind(1) == "identifier" else keyword,))
    if keyword == "const" or place.kind(1) != "identifier":
        return hint
    size = 2
    if place.kind(2) == "[":
        while place.kind(size) not in ("]", ""):
            size += 1
        if size == 3 or place.kind(size) == "":
            return hint
        size += 1
    source, name, last = place.source, place.word(1), place.word(size - 1)
    hint = replace(hint, arguments=(source[name.start : last.end],))
    top = _end_of_declarations(place)
    head, tail = source[top : place.word().start], source[last.end :]
    declaration = source[place.word().start : last.end]
    newline = "\r\n" if "\r\n" in source else "\n"
    declared = f"{newline}{declaration}" if top else f"{declaration}{newline}"
    if place.kind(size) == "=":
        return replace(hint, edit=Edit(top, last.end, f"{declared}{head}{name.text}"))
    end = last.end
    if head.rpartition("\n")[2].strip() == "" and re.match(r"[ \t]*(?:\r?\n|$)", tail):
        head = head[: head.rfind("\n") + 1]
        end = source.find("\n", end) + 1 or len(source)
    return replace(hint, edit=Edit(top, end, f"{declared}{head}"))


def _end_of_declarations(place: _Context) -> int:
    """Return the end of the last line of the declarations at the beginning; 0 if there are none."""
    top = depth = 0
    row = -1
    is_declared = False
    for word in place.words[: place.at]:
        if word.row != row and depth == 0:
            is_declared = word.kind in ("var", "const")
            if not is_declared:
                break
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(word.kind, 0)
        row = word.row
        top = word.end
    if not top:
        return 0
    line_end = place.source.find("\n", top)
    return len(place.source) if line_end < 0 else line_end - (place.source[line_end - 1] == "\r")


def _truth_of_number(place: _Context) -> Hint | None:
    """Recognize ``if a then`` where ``a`` is a number."""
    if place.kind() not in _CONDITIONS or place.error.arguments != ("boolean", "integer"):
        return None
    size = 1
    if place.kind(size) != "identifier":
        return None
    size += 3 if (place.kind(2), place.kind(3), place.kind(4)) == ("[", "integer", "]") else 0
    if place.kind(size + 1) not in ("then", "do"):
        return None
    last = place.word(size)
    shown = place.source[place.word(1).start : last.end]
    return Hint("hint-truth-of-number", (shown,), Edit(last.end, last.end, " != 0"))


# -- text --------------------------------------------------------------------------------------------------------------


def _spaced(source: str, start: int, end: int, word: str) -> str:
    """Return a word in place of symbols, with spaces where it would touch its neighbors."""
    if not word:
        return ""
    before = " " if start > 0 and not source[start - 1].isspace() and source[start - 1] != "(" else ""
    after = " " if end < len(source) and not source[end].isspace() and source[end] != ")" else ""
    return f"{before}{word}{after}"


def _line_indent(source: str, word: _Word) -> str:
    line = source[source.rfind("\n", 0, word.start) + 1 : word.start]
    return line[: len(line) - len(line.lstrip(" \t"))]


def _indent(source: str, word: _Word) -> str | None:
    """Return the white space before the first token of a line; None for other tokens."""
    line = source[source.rfind("\n", 0, word.start) + 1 : word.start]
    return line if line.strip(" \t") == "" else None


_UNKNOWN_NAME: Sequence[Recognizer] = (
    _other_keyword,
    _truth,
    _native_as_statement,
    _sub_as_statement,
    _native_in_expression,
)
_RECOGNIZERS: Mapping[str, Sequence[Recognizer]] = {
    "illegal-character": (_foreign_comment, _semicolon, _brace, _text, _look_alike),
    "lone-exclamation": (_foreign_comment, _negation),
    "bad-number": (_foreign_comment, _decimals),
    "bad-number-base": (_foreign_comment, _decimals),
    "unknown-variable": _UNKNOWN_NAME,
    "unknown-variable-hint": _UNKNOWN_NAME,
    "unknown-function": (_call_of_sub,),
    "unknown-function-hint": (_call_of_sub,),
    "unknown-subroutine": (_callsub_of_native,),
    "unknown-subroutine-hint": (_callsub_of_native,),
    "misplaced-var": (_late_declaration,),
    "expected-assignment": (_comparison_as_statement, _native_with_variable),
    "expected-one-of": (_doubled, _comment_as_statement),
    "type-mismatch": (_truth_of_number,),
    "expected-token": (
        _equals_in_condition,
        _block_word,
        _loop_form,
        _callsub_with_parentheses,
        _call_without_parentheses,
        _declared_with_comparison,
        _step_in_front,
        _comment_as_statement,
        _late_declaration,
        _else_if,
        _missing_end,
        _extra_end,
    ),
}
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
"""Recognizers whose hint is valid even if its edit alone does not help."""
