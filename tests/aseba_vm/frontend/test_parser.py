import pytest

from aseba_vm import CompileError
from aseba_vm.frontend.lexer import tokenize
from aseba_vm.frontend.parser import parse
from aseba_vm.frontend.symbols import SymbolTable
from aseba_vm.frontend.syntax_tree import For, If, Number
from aseba_vm.targets import THYMIO_II


def tree(source, events=(), constants=()):
    return parse(tokenize(source), SymbolTable(THYMIO_II, events, constants))


def shape(source):
    """Return the dump of the only statement, without positions."""
    lines = tree(f"var a var b var t[4] {source}").dump().splitlines()
    return [line.partition("  (")[0].strip() for line in lines[1:]]


def refusal(source, **definitions):
    with pytest.raises(CompileError) as caught:
        tree(source, **definitions)
    return caught.value


def test_operators_bind_as_in_the_grammar():
    assert shape("a = 1 + 2 * 3")[2:] == [
        "Binary operator=+",
        "Number value=1",
        "Binary operator=*",
        "Number value=2",
        "Number value=3",
    ]


def test_bit_operators_bind_stronger_than_comparisons():
    kinds = [line.split()[0:2] for line in shape("if a & 1 == 1 then end")[1:3]]
    assert kinds == [["Binary", "operator==="], ["Binary", "operator=&"]]


def test_not_covers_the_whole_comparison():
    assert shape("if not a == b then end")[1:3] == ["Unary operator=not", "Binary operator==="]


def test_operators_of_one_level_associate_to_the_left():
    assert shape("a = 1 - 2 - 3")[2:4] == ["Binary operator=-", "Binary operator=-"]


def test_a_minus_before_a_number_belongs_to_it():
    assert shape("a = - 32768")[2:] == ["Number value=-32768"]
    assert shape("a = - -5")[2:] == ["Unary operator=-", "Number value=-5"]


def test_an_old_list_needs_no_brackets():
    statements = tree("var v[3] = -1, 2, 3").body.statements
    assert [item.value for item in statements[0].right.items] == [-1, 2, 3]


def test_the_size_of_an_array_may_come_from_its_value():
    assert [variable.size for variable in tree("var v[] = acc + acc var w[] = 5").variables] == [3, 1]


def test_a_constant_hides_a_variable_of_the_target():
    assert isinstance(tree("const temperature = 5 var a a = temperature").body.statements[0].right, Number)


def test_an_elseif_is_an_if_in_place_of_else():
    statement = tree("var a if a == 1 then elseif a == 2 then else end").body.statements[0]
    assert isinstance(statement.otherwise, If)
    assert statement.end_row is None
    assert statement.otherwise.end_row == 0


def test_the_step_of_a_loop_may_be_a_constant():
    statement = tree("var i for i in 10:S step D do end", constants=[("S", 2), ("D", -3)]).body.statements[0]
    assert isinstance(statement, For)
    assert (statement.end.value, statement.step) == (2, -3)


def test_of_two_definitions_with_one_name_the_last_counts():
    statement = tree("emit e 1", events=[("e", 2), ("e", 1)]).body.statements[0]
    assert statement.number == 1


@pytest.mark.parametrize(
    ("source", "kind", "offset"),
    [
        ("a b", "unknown-variable-hint", 0),
        ("acc acc", "expected-assignment", 4),
        ("acc[0:1", "expected-token", 6),
        ("acc[temperature:1] = 1", "expected-token", 15),
        ("acc = [[1, 2] + [3, 4]]", "expected-token", 14),
        ("if temperature == 1 do", "expected-token", 20),
        ("if temperature == 1 then else elseif", "expected-token", 30),
        ("onevent 5", "expected-token", 8),
        ("onevent nothing", "unknown-event", 8),
        ("emit prox", "emit-of-local-event", 5),
        ("call nothing()", "unknown-function", 0),
        ("call leds.top(1)", "too-few-arguments", 15),
        ("call leds.rc(1 2)", "expected-token", 15),
        ("var a[-1]", "negative-array-size", 5),
        ("var a[0]", "zero-array-size", 5),
        ("var a[acc]", "not-constant", 5),
        ("const a", "expected-assignment", 6),
    ],
)
def test_what_breaks_the_grammar_is_refused_in_place(source, kind, offset):
    error = refusal(source)
    assert (error.kind, error.pos.offset) == (kind, offset)
