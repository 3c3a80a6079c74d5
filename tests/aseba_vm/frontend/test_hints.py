"""Hints: typical errors of beginners, what was meant, and the edit that corrects them."""

import random
import re

import pytest

from aseba_vm import CompileError, compile
from aseba_vm.languages import texts
from aseba_vm.messages import MESSAGES
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.vectors import load

FOUND = {
    "hint-comment": [
        ("// it's a comment\nvar a", "# it's a comment\nvar a"),
        ("var a // don't\na = 1", "var a # don't\na = 1"),
        ("var a\na = 1\n// one\na = 2", "var a\na = 1\n# one\na = 2"),
        ("/* isn't\nit */\nvar a", "#* isn't\nit *#\nvar a"),
    ],
    "hint-semicolon": [
        ("var a;\na = 1; # x;y\na = 2;a = 3;", "var a\na = 1 # x;y\na = 2 a = 3"),
    ],
    "hint-braces": [
        ("var a\nif (a == 1) {\na = 2 end", "var a\nif (a == 1) then\na = 2 end"),
        ("var a\nif (a = 1){\na = 2 end", "var a\nif (a = 1) then\na = 2 end"),
        ("var a\nwhile a < 3 {a++ end", "var a\nwhile a < 3 do a++ end"),
        ("var a\nfor a in 0:3 {end", "var a\nfor a in 0:3 do end"),
        ("var a\nif a == 1 then a = 2 }", "var a\nif a == 1 then a = 2 end"),
        ("var a\nif a == 1 then a = 2 } else a = 3 end", "var a\nif a == 1 then a = 2  else a = 3 end"),
        ("var a\nif a == 1 then a = 2 else { a = 3 end", "var a\nif a == 1 then a = 2 else  a = 3 end"),
        ("onevent prox {\n", "onevent prox \n"),
        ("var t = {1, 2}", None),
    ],
    "hint-text": [('var a = "no"', None), ("var a = 'no'", None), ("var a = “no”", None)],
    "hint-look-alike": [("var a = 3 – 2", "var a = 3 - 2"), ("var a\nif a ≤ 2 then end", "var a\nif a <= 2 then end")],
    "hint-invisible": [("var a\u00a0= 3", "var a = 3"), ("\ufeffvar a", "var a")],
    "hint-not-equal": [("var a\nif a ! = 1 then end", "var a\nif a != 1 then end")],
    "hint-not": [
        ("var a\nif !a then end", "var a\nif a == 0 then end"),
        ("var a[2]\nif a[0] == 1 and !a[1] then end", "var a[2]\nif a[0] == 1 and a[1] == 0 then end"),
        ("var a\nif !(a == 1) then end", "var a\nif not (a == 1) then end"),
    ],
    "hint-decimals": [("var a = 1.5", None), ("var a = 0.5", None)],
    "hint-comparison": [
        ("var a\nif a => 2 then end", "var a\nif a >= 2 then end"),
        ("var a\nif a =< 2 then end", "var a\nif a <= 2 then end"),
        ("var a\nif a <> 2 then end", "var a\nif a != 2 then end"),
        ("var a\nif a === 2 then end", "var a\nif a == 2 then end"),
        ("var a\nif a !== 2 then end", "var a\nif a != 2 then end"),
    ],
    "hint-equals-in-condition": [
        ("var a\nif a = 1 then end", "var a\nif a == 1 then end"),
        ("var a\nif a == 1 then elseif a = 2 then end", "var a\nif a == 1 then elseif a == 2 then end"),
        ("var a\nwhen a = 1 do end", "var a\nwhen a == 1 do end"),
        ("var a\nwhile a = 1 do end", "var a\nwhile a == 1 do end"),
        ("var a\nif a == 1 and (a = 2) then end", "var a\nif a == 1 and (a == 2) then end"),
    ],
    "hint-and": [("var a\nif a == 1 && a == 2 then end", "var a\nif a == 1 and a == 2 then end")],
    "hint-or": [("var a\nif a == 1||a == 2 then end", "var a\nif a == 1 or a == 2 then end")],
    "hint-assignment": [
        ("var a\na == 3", "var a\na = 3"),
        ("var a\na := 3", "var a\na = 3"),
        ("var a == 3", "var a = 3"),
        ("var a := 3", "var a = 3"),
        ("const A == 3", "const A = 3"),
    ],
    "hint-step": [("var i\n++i", "var i\ni++"), ("var i\ni = 1\n--i", "var i\ni = 1\ni--")],
    "hint-elseif": [("var a\nif a == 1 then\nelif a == 2 then\nend", "var a\nif a == 1 then\nelseif a == 2 then\nend")],
    "hint-small-letters": [
        ("var a\nIf a == 1 then end", "var a\nif a == 1 then end"),
        ("onEvent prox", "onevent prox"),
        ("Var a", "var a"),
    ],
    "hint-truth": [
        ("var a = true", "var a = 1"),
        ("var a\nif a == False then end", "var a\nif a == 0 then end"),
        ("var a\nwhile true do a = 1 end", None),
    ],
    "hint-call": [
        ("sound.freq(440, 1)", "call sound.freq(440, 1)"),
        ("onevent tap\nleds.top(32, 0, 0)", "onevent tap\ncall leds.top(32, 0, 0)"),
        ("callsub sound.freq(440, 1)", "call sound.freq(440, 1)"),
        ("callsub leds.top", None),
    ],
    "hint-callsub": [
        ("sub turn\nonevent tap\ncall turn", "sub turn\nonevent tap\ncallsub turn"),
        ("sub turn\nonevent tap\ncall turn()", "sub turn\nonevent tap\ncallsub turn"),
        ("sub turn\nonevent tap\nturn()", "sub turn\nonevent tap\ncallsub turn"),
        ("onevent tap\nturn\nsub turn", "onevent tap\ncallsub turn\nsub turn"),
    ],
    "hint-sub-arguments": [
        ("sub turn\nonevent tap\ncallsub turn(3)", None),
        ("sub turn\nonevent tap\ncall turn(3)", None),
        ("sub turn\nonevent tap\nturn(3)", None),
    ],
    "hint-native-in-expression": [
        ("var x\nx = math.rand()", "var x\ncall math.rand(x)"),
        ("var x\nx = math.sqrt(4)", "var x\ncall math.sqrt(x, 4)"),
        ("var x\nx = math.rand() % 10", None),
        ("var x\nif math.rand() > 3 then end", None),
        ("var x = math.rand()", None),
        ("var x\nx = deque.size(x)", None),
    ],
    "hint-callsub-parentheses": [("sub turn\nonevent tap\ncallsub turn()", "sub turn\nonevent tap\ncallsub turn")],
    "hint-parentheses": [("call _poweroff", "call _poweroff()"), ("call sound.freq 440, 1", None)],
    "hint-else-if": [
        (
            "var a\nif a == 1 then\na = 2\nelse if a == 2 then\na = 3\nelse if a == 3 then\na = 4\nelse\na = 5\nend",
            "var a\nif a == 1 then\na = 2\nelseif a == 2 then\na = 3\nelseif a == 3 then\na = 4\nelse\na = 5\nend",
        ),
    ],
    "hint-missing-end": [
        (
            "onevent prox\n  if acc[0] > 3 then\n    acc[0] = 1 # one\n\n# two\nonevent tap\n",
            "onevent prox\n  if acc[0] > 3 then\n    acc[0] = 1 # one\n  end\n\n# two\nonevent tap\n",
        ),
        (
            "var a\nif a > 3 then\n  while a < 9 do\n    a++\nend\nsub s",
            "var a\nif a > 3 then\n  while a < 9 do\n    a++\n  end\nend\nsub s",
        ),
        ("var a\nwhile a < 3 do a++", "var a\nwhile a < 3 do a++\nend"),
        ("var a\nwhile a < 3 do a++ onevent tap", "var a\nwhile a < 3 do a++ end onevent tap"),
        ("var a\nif a > 3 then\r\n a++\r\nsub s", "var a\nif a > 3 then\r\n a++\r\nend\r\nsub s"),
        (
            "var a\nif a == 1 then\nwhile a < 3 do\na++\nelse\nend",
            "var a\nif a == 1 then\nwhile a < 3 do\na++\nend\nelse\nend",
        ),
    ],
    "hint-extra-end": [
        ("onevent prox\n  acc[0] = 1\nend\nonevent tap", "onevent prox\n  acc[0] = 1\nonevent tap"),
        ("var a\nif a == 1 then end end", "var a\nif a == 1 then end "),
    ],
    "hint-block-word": [
        ("var a\nif a == 1\n  a = 2\nend", "var a\nif a == 1 then\n  a = 2\nend"),
        ("var a\nif a == 1:\n  a = 2\nend", "var a\nif a == 1 then\n  a = 2\nend"),
        ("var a\nif a == 1 do\nend", "var a\nif a == 1 then\nend"),
        ("var a\nwhile a < 3 then a++ end", "var a\nwhile a < 3 do a++ end"),
        ("var a\nfor a in 0:9\nend", "var a\nfor a in 0:9 do\nend"),
    ],
    "hint-for": [("var i\nfor i = 0 to 9\nend", None), ("var i\nfor (i = 0)\nend", None)],
    "hint-late-var": [
        ("acc[0] = 1\nvar a = 3\na = 4", "var a\nacc[0] = 1\na = 3\na = 4"),
        ("var b # b\nonevent prox\n  var n[2] = [b, 0]\n", "var b # b\nvar n[2]\nonevent prox\n  n = [b, 0]\n"),
        (
            "onevent tap\n\tif acc[0] == 1 then\n\t\tvar n\n\t\tn = 2\n\tend",
            "var n\nonevent tap\n\tif acc[0] == 1 then\n\t\tn = 2\n\tend",
        ),
        ("onevent tap\nvar n[] = [1, 2]", None),
    ],
    "hint-late-const": [("var a\nconst B = 3", None)],
    "hint-truth-of-number": [
        ("var a\nif a then end", "var a\nif a != 0 then end"),
        ("var a[2]\nwhile a[1] do a[1]-- end", "var a[2]\nwhile a[1] != 0 do a[1]-- end"),
    ],
    "hint-name": [
        ("motor.left.traget = 100", "motor.left.target = 100"),
        ("MOTOR.LEFT.TARGET = 3", "motor.left.target = 3"),
        ("var a = prox.horiz[2]", "var a = prox.horizontal[2]"),
        ("if buton.forward == 1 then end", "if button.forward == 1 then end"),
        ("call leds.tpo(0, 0, 0)", "call leds.top(0, 0, 0)"),
        ("call leds.tpo(0, 0)", "call leds.top(0, 0)"),
        ("call Leds.Top(0, 0, 0)", "call leds.top(0, 0, 0)"),
        ("timer = 3", "timer.period = 3"),
        ("led.top(0, 0, 0)", "leds.top(0, 0, 0)"),
        ("onevent porx", "onevent prox"),
        ("onevent button", "onevent buttons"),
        ("onevent TIMER0", "onevent timer0"),
        ("sub turn\nonevent tap\ncallsub trun", "sub turn\nonevent tap\ncallsub turn"),
        ("const LAST = 3\nvar i\nfor i in 0:LATS do end", "const LAST = 3\nvar i\nfor i in 0:LAST do end"),
        ("onevnt prox", "onevent prox"),
        ("var a\nwhlie a > 3 do a++ end", "var a\nwhile a > 3 do a++ end"),
        ("var a\nif a > 3 then a = 2 esle a = 4 end", "var a\nif a > 3 then a = 2 else a = 4 end"),
        ("var a\nif a > 3 then a = 2 edn", "var a\nif a > 3 then a = 2 end"),
        ("cal leds.top(0, 0, 0)", "call leds.top(0, 0, 0)"),
        ("cosnt X = 3", "const X = 3"),
        ("var a\nif a > 3 thne a = 2 end", "var a\nif a > 3 then a = 2 end"),
        ("var a\nif a > 3 adn a < 5 then end", "var a\nif a > 3 and a < 5 then end"),
        ("var a\nfor a in 0:9 stpe 2 do end", "var a\nfor a in 0:9 step 2 do end"),
        ("var a\nif nto (a > 3) then end", "var a\nif not (a > 3) then end"),
    ],
    "hint-part-of-name": [
        ("call leds.bottom(0, 32, 0)", None),
        ("leds.bottom(0, 32, 0)", None),
        ("motor.target = 3", None),
        ("motor.left = 3", None),
        ("if prox > 3 then end", None),
    ],
    "hint-constant-bound": [
        ("var n = 3\nvar i\nfor i in 0:n do end", None),
        ("var n = 3\nvar i\nfor i in n:9 do end", None),
        ("var n = 3\nvar i\nfor i in 0:-n do end", None),
        ("var n = 3\nvar i\nfor i in 0:9 step n do end", None),
        ("var i\nfor i in 0:prox.horizontal[2] do end", None),
    ],
    "hint-constant-size": [
        ("var n = 3\nvar a[n]", None),
        ("var n = 3\nvar a[2 * n + 1]", None),
        ("var a[n]\nvar n = 3", None),
    ],
    "hint-constant-value": [("const A = motor.left.target * 2", None), ("const A = n\nvar n = 3", None)],
    "hint-constant-slice": [
        ("var n\nvar a[9]\na[0:n] = [1, 2]", None),
        ("var n\nvar a[9]\na[n:3] = [1, 2]", None),
        ("var n\nvar a[9]\ncall math.fill(a[0:n + 1], 3)", None),
    ],
    "hint-calculated-bound": [
        ("const N = 3\nvar i\nfor i in 0:N-1 do end", None),
        ("const N = 3\nvar i\nfor i in 0:-N do end", None),
        ("var i\nfor i in 0:(3) do end", None),
    ],
    "hint-whole-array": [
        ("if prox.horizontal > 2000 then end", None),
        ("if 2000 < prox.horizontal then end", None),
        ("if prox.horizontal then end", None),
        ("while acc do end", None),
        ("when acc > [1, 2, 3] do end", None),
        ("motor.left.target = prox.ground.delta", None),
        ("var a\na += 2 * prox.horizontal", None),
        ("prox.horizontal = 0", None),
        ("if prox.horizontal[0:1] > 3 then end", None),
        ("call sound.freq(prox.horizontal, 1)", None),
        ("var d\ncall math.muldiv(d, prox.horizontal, 2, 3)", None),
        ("for acc in 0:3 do end", None),
    ],
}


def refused(source, events=(), constants=(), target=THYMIO_II):
    """Return the error of a program, or None."""
    try:
        compile(source, target, events, constants)
    except CompileError as error:
        return error
    return None


@pytest.mark.parametrize(
    ("kind", "source", "repaired"), [(kind, *case) for kind, cases in FOUND.items() for case in cases]
)
def test_a_beginner_s_error_has_a_hint_and_an_edit_that_corrects_it(kind, source, repaired):
    error = refused(source)
    assert error is not None
    assert error.hint is not None
    assert error.hint.kind == kind
    edit = error.hint.edit
    assert (None if edit is None else edit.applied(source)) == repaired


def test_every_hint_of_the_tables_is_given_and_every_given_one_is_in_the_tables():
    assert {kind for kind in MESSAGES if kind.startswith("hint-")} == FOUND.keys()


@pytest.mark.parametrize(
    "source",
    [
        "var a\na = = 3",
        "onevent nothing",
        "emit ping 3",
        "var a = 1 2",
        "var a[2]\na[1:] = 3",
        "var a\na = (1",
        "if a == 1",
        "var t[2] = [1; 2]",
        "x turn\nsub turn",
        "var a\na = (b = 1)",
        "var a\nif a == 1 a = 2 end",
        "var truth\ntruth = tru",
        "call nothing(3)",
        "callsub",
        "for",
        "if",
        "var a\na = 1 / / 2",
        "var a = $",
        "a = 3",
        "speed = 3",
        "fo = 3",
        "const N = 3\nvar i\nfor i in 0:M do end",
        "var b[3] = 0",
        "if acc == [1, 2, prox.horizontal] then end",
        "onevent button.left.pressed",
    ],
)
def test_an_error_that_is_not_understood_has_no_hint(source):
    error = refused(source)
    assert error is not None
    assert error.hint is None


def test_a_hint_names_the_line_of_the_open_block_in_the_file():
    hint = refused("var a\nif a == 1 then\n a = 2").hint
    assert str(hint) == "the 'if' of line 2 has no 'end'"
    assert hint.message(rows=(10, 11, 12)) == "the 'if' of line 12 has no 'end'"
    assert hint.message(texts("compiler", "de")) == "dem 'if' von Zeile 2 fehlt ein 'end'"


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("call leds.bottom(0, 32, 0)", ("leds.bottom.left", "leds.bottom.right")),
        ("motor.target = 3", ("motor.left.target", "motor.right.target")),
        ("if prox > 3 then end", ("prox.horizontal", "prox.ground.delta")),
        ("var n = 3\nvar i\nfor i in 0:n do end", ("numbers or constants", "const n = 3", "while")),
        ("var i\nfor i in 0:prox.horizontal[2] do end", ("'prox.horizontal' is a variable", "const N = 3")),
        ("if prox.horizontal > 2000 then end", ("7 values", "prox.horizontal[2]")),
        ("var a = acc[0] * prox.ground.delta", ("2 values", "prox.ground.delta[1]")),
        ("if prox.horizontal[0:1] > 3 then end", ("2 values", "prox.horizontal[0]")),
    ],
)
@pytest.mark.parametrize("language", ["en", "de", "fr", "it"])
def test_a_hint_names_what_can_be_written_in_every_language(source, words, language):
    said = refused(source).hint.message(texts("compiler", language))
    names = [word for word in words if language == "en" or not re.search("[0-9a-z] [a-z]", word)]
    assert [word for word in names if word not in said] == []


def test_a_whole_array_in_an_event_of_one_value_has_a_hint():
    assert "acc[2]" in str(refused("emit level acc", events=[("level", 1)]).hint)


def test_the_name_of_an_event_to_emit_is_corrected():
    error = refused("emit levle 1", events=[("level", 1)])
    assert error.hint.edit.applied("emit levle 1") == "emit level 1"


# -- every edit helps --------------------------------------------------------------------------------------------------

MISTAKES = {
    "one = in a condition": (r"==", "="),
    "no end": (r"\bend\b", ""),
    "one end more": (r"\bend\b", "end end"),
    "no then": (r"\bthen\b", ""),
    "no do": (r"\bdo\b", ""),
    "then for do": (r"\bdo\b", "then"),
    "do for then": (r"\bthen\b", "do"),
    "no call": (r"\bcall\b", ""),
    "call for callsub": (r"\bcallsub\b", "call"),
    "&&": (r"\band\b", "&&"),
    "||": (r"\bor\b", "||"),
    "!": (r"\bnot\b", "!"),
    "elif": (r"\belseif\b", "elif"),
    "else if": (r"\belseif\b", "else if"),
    "semicolon": (r"\n", ";\n"),
    "two = in an assignment": (r"(?<![=<>!+*/%|^&-])=(?!=)", "=="),
    "comment": (r"#", "//"),
    "capital": (r"\bif\b", "If"),
    "brace": (r"\bthen\b", "{"),
    "swapped letters": (r"\bmotor\.left\b", "motor.lfet"),
    "misspelled keyword": (r"\bonevent\b", "onevetn"),
    "misspelled connector": (r"\bdo\b", "od"),
}
PROGRAMS = [vector for vector in load("aseba-compile") if vector["target"] == "thymio2"]


@pytest.mark.parametrize("mistake", MISTAKES)
def test_an_edit_removes_the_error_that_it_was_offered_for(mistake):
    pattern, by = MISTAKES[mistake]
    dice = random.Random(mistake)
    offered = 0
    for vector in PROGRAMS:
        places = list(re.finditer(pattern, vector["source"]))
        if not places:
            continue
        place = dice.choice(places)
        source = vector["source"][: place.start()] + by + vector["source"][place.end() :]
        definitions = [tuple(map(tuple, vector[name])) for name in ("events", "constants")]
        error = refused(source, *definitions)
        if error is None or error.hint is None or error.hint.edit is None:
            continue
        offered += 1
        edit = error.hint.edit
        after = refused(edit.applied(source), *definitions)
        assert after is None or is_further(error, after, edit), (source, error, edit, after)
    assert offered


def is_further(before, after, edit):
    """Return whether another error is reported, or the same one after the corrected position."""
    moved = before.pos.offset + len(edit.text) - (edit.end - edit.start) * (edit.start <= before.pos.offset)
    same = (after.kind, after.pos and after.pos.offset) == (before.kind, before.pos.offset)
    return not same or (after.pos is not None and after.pos.offset >= min(moved, edit.start + len(edit.text)))


@pytest.mark.parametrize("cut", [0.3, 0.6, 0.9])
def test_a_text_that_is_cut_off_anywhere_raises_nothing_else(cut):
    dice = random.Random(cut)
    for vector in dice.sample(PROGRAMS, 60):
        source = vector["source"]
        at = int(len(source) * cut)
        for text in (source[:at], source[:at] + dice.choice('!;{}"&|=(') + source[at:]):
            error = refused(text)
            assert error is None or error.hint is None or str(error.hint)
