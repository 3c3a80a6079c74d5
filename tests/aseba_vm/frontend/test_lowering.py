import pytest

from aseba_vm import CompileError
from aseba_vm.frontend.lexer import tokenize
from aseba_vm.frontend.lowering import lower
from aseba_vm.frontend.parser import parse
from aseba_vm.frontend.symbols import SymbolTable
from aseba_vm.frontend.syntax_tree import While, Word
from aseba_vm.targets import THYMIO_II


def expanded(source):
    return lower(parse(tokenize(source), SymbolTable(THYMIO_II, (), ())), THYMIO_II.variables_size)


def stores(source):
    return [statement.left.address for statement in expanded(source).body.statements]


def test_a_vector_becomes_one_assignment_for_each_word():
    assert stores("var t[3] t = acc") == [128, 129, 130]


def test_a_variable_on_both_sides_goes_through_temporary_words():
    assert stores("var t[2] t = [t[1], t[0]]") == [638, 639, 128, 129]


def test_a_scalar_never_needs_temporary_words():
    assert stores("var a a = a + 1") == [128]


def test_temporary_words_are_never_given_back():
    tree = expanded("var t[2] t += t t += t")
    assert tree.temporaries == 4


def test_a_counted_loop_becomes_a_while():
    first, loop = expanded("var i for i in 3:1 step -1 do end").body.statements
    assert first.right.value == 3
    assert isinstance(loop, While)
    assert loop.condition.operator == ">="
    assert loop.body.statements[-1].right.right.value == -1


def test_a_loop_over_one_value_is_its_body():
    assert len(expanded("var i for i in 2:2 do i = 7 end").body.statements) == 2


def test_the_right_side_is_checked_before_the_left():
    with pytest.raises(CompileError) as caught:
        expanded("var t[4] t[5] = t[6]")
    assert caught.value.arguments == ("t", 6, 4)


def test_elements_are_checked_in_order():
    with pytest.raises(CompileError) as caught:
        expanded("var t[4] var u[2] u = [t[7], t[9]]")
    assert caught.value.arguments == ("t", 7, 4)


def test_only_places_can_be_assigned():
    with pytest.raises(CompileError) as caught:
        expanded("var a a + 1 = 3")
    assert caught.value.arguments == ("binary-operation",)


def test_the_work_of_expanding_is_limited():
    with pytest.raises(CompileError) as caught:
        expanded("var t[200] var u[200] t = u" + " + u" * 9000)
    assert caught.value.kind == "too-many-elements"


def test_words_have_the_position_of_their_name():
    assert expanded("var a\nvar b\nb = a").body.statements[0].right == Word(
        128, expanded("var a\nvar b\nb = a").body.statements[0].right.pos
    )
