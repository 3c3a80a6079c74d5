"""Programs with their expected results in comments, in every engine; they also serve as examples."""

import pytest

from aseba_vm.bytecode import BINARY_OPERATORS, UNARY_OPERATORS, Op, instructions
from aseba_vm.errors import CompileError
from aseba_vm.frontend.lexer import KEYWORDS, SYMBOLS, tokenize
from aseba_vm.frontend.pipeline import compile
from aseba_vm.machine.natives import NATIVES
from aseba_vm.messages import MESSAGES
from tests.aseba_vm.engines import AVAILABLE
from tests.aseba_vm.expectations import FOLDER, Scenario

PROGRAMS = sorted(path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("*.a*s*") if path.is_file())


def scenario(name):
    return Scenario(name, (FOLDER / name).read_text("utf-8"))


@pytest.mark.parametrize("engine", AVAILABLE)
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_does_what_its_comments_say(name, engine):
    scenario(name).check(engine)


# -- coverage of all programs


def compiled():
    for name in PROGRAMS:
        one = scenario(name)
        try:
            yield one, compile(one.node.code, one.target, one.events, one.constants)
        except CompileError:
            continue


def test_every_word_and_symbol_of_the_language_is_used():
    used = {token.kind for one, _ in compiled() for token in tokenize(one.node.code)}
    assert (KEYWORDS | set(SYMBOLS)) - used == set()


def test_every_instruction_and_operator_is_executed_somewhere():
    codes = {
        (Op(code[0] >> 12), code[0] & 0xFF if code[0] >> 12 in (Op.UNARY, Op.BINARY) else 0)
        for _, program in compiled()
        for _, code in instructions(program.words, 2 * len(program.events) + 1)
    }
    assert set(Op) - {op for op, _ in codes} == {Op.UNKNOWN}
    branches = {BINARY_OPERATORS.index(sign) for sign in ("==", "!=", ">", ">=", "<", "<=", "or", "and")}
    assert set(range(len(BINARY_OPERATORS))) - {number for op, number in codes if op is Op.BINARY} - branches == set()
    known = set(range(len(UNARY_OPERATORS))) - {UNARY_OPERATORS.index("not")}  # "not" is always pushed inside
    assert known - {number for op, number in codes if op is Op.UNARY} == set()


def test_every_native_function_is_called():
    called = {
        one.target.natives[code[0] & 0xFFF].name
        for one, program in compiled()
        for _, code in instructions(program.words, 2 * len(program.events) + 1)
        if code[0] >> 12 == Op.NATIVE
    }
    assert set(NATIVES) - called == set()


#: Kinds of errors that no program is known to provoke: the parser finds these places as index-out-of-bounds already
#: (docs/spec/aseba-language.md section 9.1, rule 8).
UNREACHABLE = {"static-read-out-of-bounds", "static-write-out-of-bounds"}
#: Limits of our own and faults of the machine's user have tests elsewhere (test_limits.py, test_vm.py),
#: as have hints (test_hints.py), files of other programs (test_foreign_files.py) and the words of the command line
#: (cli/test_main.py).
ELSEWHERE = (
    "too-many-tokens",
    "too-many-elements",
    "fault-",
    "aesl-",
    "foreign-",
    "xml-",
    "text-",
    "hint-",
    "check-",
    "note-",
    "label-",
    "fmt-",
)
#: Words inside of messages (test_messages.py).
TOKENS = ("token-", "valued-")


def test_every_error_and_warning_is_provoked_by_a_program():
    provoked = {
        order.words[0] for name in PROGRAMS for order in scenario(name).orders if order.verb in ("error", "warning")
    }
    assert {kind for kind in MESSAGES if not kind.startswith(ELSEWHERE + TOKENS)} - UNREACHABLE - provoked == set()


# -- the runner of expectations


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("var a = 2\n#! expect a = 3", "p:2\nexpected: #! expect a = 3\nfound: a = 2"),
        (
            "#! error lone-exclamation at 1:1\nvar a",
            "p:1: #! error lone-exclamation at 1:1\nfound: a program that compiles",
        ),
        ("xyz = 1", "p\nexpected: nothing of the kind\nfound: unknown-variable at 1:1 no variable is called 'xyz'"),
        (
            "#! error unknown-variable at 2:2\nb = 1",
            "p:1\nexpected: #! error unknown-variable at 2:2\nfound: unknown-var",
        ),
        ("call leds.top(1,2,3)", "p:1\nexpected: nothing\nfound: more than that: #! calls leds.top 1 2 3"),
        ("#! emits e 1\nvar a", "p:1\nexpected: #! emits e 1\nfound: nothing"),
        ("sub s", "p: expected warnings []\nfound: ['#! warning warning-uncalled-subroutine at 1:1"),
        ("#! nonsense", "p:1: '#! nonsense' is not one of calls, "),
    ],
)
def test_a_difference_is_reported_with_its_line(text, complaint):
    with pytest.raises(AssertionError) as caught:
        Scenario("p", text).check("interpreter")
    assert complaint in str(caught.value)
