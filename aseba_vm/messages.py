"""Texts of every error, warning and hint in English; other languages are in `messages_<language>.py`.

Kinds and arguments come from the errors. In a template, ``{0}`` is an argument, ``{t0}`` a token, ``{l0}`` a list of
tokens, ``{v0}`` a token with its value.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from aseba_vm.messages_de import GERMAN
from aseba_vm.messages_fr import FRENCH
from aseba_vm.messages_it import ITALIAN

MESSAGES: Mapping[str, str] = {
    # kinds of tokens, without and with their value
    "token-identifier": "a name",
    "token-integer": "a number",
    "token-end-of-input": "the end of the program",
    "valued-identifier": "name '{0}'",
    "valued-integer": "number {0}",
    # errors
    "target-too-small": "the target has less memory than its own variables need",
    "stack-overflow": "the program could use more stack than the target has;"
    " look for recursion or very long expressions",
    "bytecode-too-large": "the compiled program is larger than the bytecode memory of the target",
    "unknown-variable": "no variable is called '{0}'",
    "unknown-variable-hint": "no variable is called '{0}'; perhaps you meant '{1}'",
    "unknown-function": "the target has no function called '{0}'",
    "unknown-function-hint": "the target has no function called '{0}'; perhaps you meant '{1}'",
    "unknown-constant": "no constant is called '{0}'",
    "unknown-constant-hint": "no constant is called '{0}'; perhaps you meant '{1}'",
    "unknown-event": "no event is called '{0}'",
    "unknown-event-hint": "no event is called '{0}'; perhaps you meant '{1}'",
    "emit-of-local-event": "'{0}' is raised by the robot itself and cannot be emitted",
    "unknown-subroutine": "no subroutine is called '{0}'",
    "unknown-subroutine-hint": "no subroutine is called '{0}'; perhaps you meant '{1}'",
    "unterminated-comment": "this comment block is never closed",
    "lone-exclamation": "'!' must be followed by '='",
    "illegal-character": "character U+{0} cannot start a word",
    "bad-hex-number": "this hexadecimal number has a wrong digit",
    "bad-binary-number": "this binary number has a wrong digit",
    "bad-number-base": "unknown number prefix",
    "bad-number": "this number has a wrong digit",
    "expected-token": "expected {t0} but found {t1}",
    "int16-range": "{0} does not fit in 16 bits (-32768 to 32767)",
    "constant-range": "constant '{0}' is {1}, which does not fit in 16 bits",
    "expected-one-of": "expected one of {l0} but found {t1}",
    "out-of-temporary-memory": "not enough memory left for a temporary value",
    "misplaced-var": "variables must be declared before the first statement",
    "expected-identifier": "expected a name but found {v0}",
    "duplicate-constant": "constant '{0}' is declared twice",
    "duplicate-variable": "variable '{0}' is declared twice",
    "variable-constant-clash": "'{0}' is already the name of a constant",
    "unknown-array-size": "the size of array '{0}' cannot be worked out",
    "out-of-variable-memory": "no memory left for this variable",
    "expected-assignment": "expected an assignment but found {v0}",
    "for-zero-step": "the step of a loop cannot be zero",
    "for-range-not-increasing": "with a positive step the range must go up",
    "for-range-not-decreasing": "with a negative step the range must go down",
    "for-end-32767": "a rising loop cannot end at 32767",
    "for-end-minus-32768": "a falling loop cannot end at -32768",
    "duplicate-event-handler": "event '{0}' already has a handler",
    "event-argument-too-large": "event '{0}' takes at most {1} values, {2} given",
    "event-argument-size": "event '{0}' takes {1} values, {2} given",
    "duplicate-subroutine": "subroutine '{0}' is declared twice",
    "slice-end-not-constant": "the end of a slice must be a constant",
    "slice-reversed": "the end of a slice is before its start",
    "negative-array-size": "an array cannot have {0} elements",
    "zero-array-size": "an array must have at least one element",
    "not-constant": "this expression is not constant",
    "function-takes-no-argument": "function '{0}' takes no argument",
    "too-few-arguments": "function '{0}' takes {1} arguments, only {2} given",
    "argument-size": "argument {0} ({1}) of function '{2}' has size {3} instead of {4}",
    "argument-size-template": "argument {0} ({1}) of function '{2}' has size {3},"
    " but an earlier argument of the same kind has size {4}",
    "too-many-arguments": "function '{0}' takes only {1} arguments",
    "not-assignable": "cannot assign to this ({0})",
    "index-out-of-bounds": "array '{0}' has no element {1}, its size is {2}",
    "size-mismatch": "sizes differ: {0} and {1}",
    "vector-condition-if": "a condition must be a single value",
    "vector-condition-while": "a loop condition must be a single value",
    "illegal-index": "an index has one value, or two for a slice",
    "infinite-loop": "this loop never ends",
    "division-by-zero": "division by zero",
    "abs-of-minimum": "the absolute value of -32768 does not fit in 16 bits",
    "static-read-out-of-bounds": "element {0} of array '{1}' does not exist, the size is {2}",
    "static-write-out-of-bounds": "element {0} of array '{1}' does not exist, the size is {2}",
    "type-mismatch": "expected type {0} but found type {1}",
    # refused by us; the reference stops abnormally on these
    "list-as-index": "a list cannot be an index unless its first element is constant",
    "negated-number": "'not' needs a condition",
    "constant-overflow": "the result does not fit in 32 bits",
    # limits of this implementation
    "too-many-tokens": "the program is too long: more than {0} words and symbols",
    "too-many-elements": "the program is too large: more than {0} operations on single values",
    # files
    "text-undecodable": "found byte {0}, expected text in {1}",
    "text-unknown-encoding": "the file declares the encoding '{0}', which is not known; expected UTF-8",
    "aesl-too-long": "found {0} characters, expected at most {1}",
    "aesl-outer-document": "found a reference to another document, '{0}'; expected everything in this file",
    "aesl-entity": "found the declaration of entity '{0}'; expected none, as programs need none",
    "aesl-root": "found <{0}> as the outermost element, expected <network>",
    "aesl-no-node": "found no program, expected at least one <node>",
    "aesl-many-nodes": "found another <node>, expected at most {0}",
    "aesl-attribute-missing": 'found <{0}> without {1}, expected {1}="..."',
    "aesl-number": 'found {0}="{1}", expected a whole number',
    "aesl-event-size": "found size {1} for event '{0}', expected 0 to {2} words",
    "aesl-constant-value": "found value {1} for constant '{0}', expected -32768 to 32767",
    "aesl-keywords": 'found flag="{0}", expected true or false',
    "aesl-name": "found the name '{0}', expected letters, digits, '_' and '.',"
    " not a digit or '.' first, and no word of the language",
    "aesl-event-twice": "found event '{0}' again, expected it once; it is defined in line {1} already",
    "aesl-constant-twice": "found constant '{0}' again, expected it once; it is defined in line {1} already",
    "aesl-node-id": 'found nodeId="{0}", expected a number from 0 to 65535 or a UUID',
    "aesl-node-twice": "found node '{0}' with number {1} again, expected it once; it is in line {2} already",
    "aesl-other-robot": "found no program for '{0}', only for {1}; expected <node name=\"{0}\">",
    "xml-start": "found {0}, expected '<'",
    "xml-character": "found {0}, which XML does not allow here; expected text or a tag",
    "xml-bare-mark": "found a '{0}' that begins no tag or entity of XML;"
    " expected &lt; for '<' and &amp; for '&' in the text of a program",
    "xml-unfinished": "found the end of the file inside what begins here, expected its end",
    "xml-closing-tag": "found </{0}>, expected </{1}> for the <{1}> of line {2}",
    "xml-unclosed": "found the end of the file, expected </{0}> for the <{0}> of line {1}",
    "xml-attribute-twice": "found an attribute twice in one tag, expected it once",
    "xml-after-end": "found {0} after the end of the outermost element, expected the end of the file",
    "xml-entity": "found an unknown entity, expected &lt; &gt; &amp; &quot; &apos; or the number of a character",
    "xml-empty": "found nothing, expected <network>",
    "xml-other": "found XML that cannot be read, expected well-formed XML ({0})",
    # notes: what was guessed about a file
    "note-only-node": "node '{0}' runs here, as it is the only one of the file",
    "note-next-node": "node '{0}' runs here, as no robot has its name and this one was the next without a program",
    "note-guessed-node": "no robot is called '{0}': the next robot without a program runs this node",
    "note-left-out-node": "node '{0}' is left out, as it does not compile for a Thymio: {1}",
    "note-checked-as": "node '{0}' is checked as a program for '{1}'",
    "note-made-for": "the program was made for the device '{0}'",
    # faults of the machine
    "fault-index": "index {0} is outside an array of {1}",
    "fault-deque": "a deque was given a wrong index or too many values",
    "fault-division-by-zero": "division by zero",
    "fault-sqrt-of-negative": "square root of a negative number",
    "fault-stack-overflow": "the program needs more stack than there is",
    "fault-stack-underflow": "damaged program: the stack is empty",
    "fault-unknown-instruction": "damaged program: unknown instruction",
    "fault-unknown-unary-operator": "damaged program: unknown operator with one operand",
    "fault-unknown-binary-operator": "damaged program: unknown operator with two operands",
    "fault-unknown-native": "damaged program: unknown native function",
    "fault-variable-out-of-range": "damaged program: address outside the variables",
    "fault-jump-out-of-range": "damaged program: jump outside the code",
    "fault-emit-too-long": "damaged program: an event has too many values",
    "fault-breakpoint-out-of-range": "a breakpoint lies outside the code",
    # hints: what was probably meant (aseba_vm/frontend/hints.py)
    "check-summary": "{0} files checked: {1} with errors, {2} with warnings",
    "fmt-summary": "{0} files read: {1} with an irregular layout, {2} refused",
    "fmt-different": "the layout is not regular",
    "label-hint": "Hint",
    "hint-comment": "a comment is written with '{1}' instead of '{0}'",
    "hint-semicolon": "Aseba needs no ';': a space or a new line is enough",
    "hint-braces": "Aseba has no braces: a block begins with 'then' or 'do' and finishes with 'end'."
    " Right: if a == 1 then … end",
    "hint-text": "Aseba knows whole numbers only, no texts; a comment begins with '#'",
    "hint-look-alike": "this character only looks like '{0}', as it often does in text copied from a web page;"
    " write '{0}'",
    "hint-invisible": "there is an invisible character here ({0}), perhaps copied from a web page;"
    " a normal space is right",
    "hint-not-equal": "'not equal' is written '!=', without a space",
    "hint-not": "'not' is written as a word. Right: if not (a == 1) then",
    "hint-decimals": "Aseba has whole numbers only, and {0} is none. Use smaller units,"
    " such as 1500 milliseconds for 1.5 seconds",
    "hint-comparison": "this comparison is written '{0}'",
    "hint-equals-in-condition": "'=' gives a variable a new value; to compare two values write '=='."
    " Right: if a == 1 then",
    "hint-and": "'and' is written as a word. Right: if a == 1 and b == 2 then",
    "hint-or": "'or' is written as a word. Right: if a == 1 or b == 2 then",
    "hint-assignment": "a variable gets a new value with '='. Right: a = 1",
    "hint-step": "'++' and '--' stand after the variable. Right: {0}",
    "hint-elseif": "instead of '{0}' write 'elseif'. Right: elseif a == 2 then",
    "hint-small-letters": "words of the language have small letters only: write '{1}' instead of '{0}'",
    "hint-truth": "'{0}' does not exist; use 1 for true and 0 for false. Right: if a == 1 then",
    "hint-call": "'{0}' is a function of the robot, so 'call' stands before it. Right: call {0}(…)",
    "hint-callsub": "'{0}' is a subroutine. Right: callsub {0}",
    "hint-sub-arguments": "a subroutine takes no values: put them into variables before. Right: callsub {0}",
    "hint-native-in-expression": "a function gives its result to a variable that stands between its parentheses."
    " Right: call {0}(…) on a line of its own",
    "hint-callsub-parentheses": "a subroutine has no parentheses. Right: callsub {0}",
    "hint-parentheses": "a function has parentheses, with its values between them. Right: call {0}(…)",
    "hint-else-if": "'else if' in line {0} begins a second block, which needs an 'end' of its own;"
    " write 'elseif' to go on with the first",
    "hint-missing-end": "the '{0}' of line {1} has no 'end'",
    "hint-extra-end": "this 'end' closes nothing:"
    " 'if', 'when', 'while' and 'for' have an 'end', 'onevent' and 'sub' have none",
    "hint-block-word": "'{0}' belongs here. Right: if a == 1 then … end, while a < 9 do … end",
    "hint-for": "this loop is written differently. Right: for i in 0:9 do … end",
    "hint-late-var": "all variables stand at the top of the program: write 'var {0}' there",
    "hint-late-const": "all constants stand at the top of the program, before the variables: write 'const {0}' there",
    "hint-truth-of-number": "a condition compares two values. Right: {0} != 0",
    # warnings
    "warning-unreachable": "this is never executed: it comes after a return",
    "warning-constant-when": "the condition of this 'when' never changes, so there is no moment when it becomes true",
    "warning-endless-for": "this loop may never end: the value after {0} does not fit in 16 bits and wraps round",
    "warning-vector-index": "only the first element of '{0}' is used as index",
    "warning-uncalled-subroutine": "subroutine '{0}' is never called",
    "warning-far-jump": "this block is too long for a jump: the program will not run as written",
    "warning-fall-through": "subroutine '{0}' may run on into the code after it,"
    " as its last statement does not always return",
}

LANGUAGES: Mapping[str, Mapping[str, str]] = {"en": MESSAGES, "de": GERMAN, "fr": FRENCH, "it": ITALIAN}
"""Message table of each language; English is used for messages that a table lacks."""

_LONGEST = 60
"""Letters of a name that are shown; longer names are truncated."""


def format_message(kind: str, arguments: Sequence[object], messages: Mapping[str, str] = MESSAGES) -> str:
    """Return the text of an error, warning or hint; for an unknown kind, the kind itself with its arguments."""
    template = messages.get(kind, MESSAGES.get(kind))
    if template is None:
        return " ".join([kind, *map(str, arguments)])
    words: dict[str, str] = {}
    arguments = [_shortened(argument) for argument in arguments]
    for index, argument in enumerate(arguments):
        if isinstance(argument, tuple):
            words[f"l{index}"] = ", ".join(_token(messages, kind) for kind in argument)
            words[f"v{index}"] = _valued_token(messages, *argument)
        else:
            words[f"t{index}"] = _token(messages, argument)
    return template.format(*arguments, **words)


def _shortened(argument: object) -> object:
    if isinstance(argument, tuple):
        return tuple(map(_shortened, argument))
    return f"{argument[:_LONGEST]}…" if isinstance(argument, str) and len(argument) > _LONGEST else argument


def _token(messages: Mapping[str, str], kind: object) -> str:
    known = f"token-{kind}"
    return messages.get(known, MESSAGES.get(known, f"'{kind}'"))


def _valued_token(messages: Mapping[str, str], kind: object, value: object = None, *_: object) -> str:
    known = f"valued-{kind}"
    template = messages.get(known, MESSAGES.get(known))
    return _token(messages, kind) if value is None or template is None else template.format(value)
