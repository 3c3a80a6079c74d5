import pytest

from aseba_vm import CompileError
from aseba_vm.frontend.formatter import format_program

BEFORE = """

# first
var a
  var t[4] = 1,2,3,4


onevent prox   \r
if a == 1 then
a = 2
elseif a == 2 then
for a in 0:3 do while t[a] > 0 do
t[a]--
end end
else
t = [1,
2, 3, 4]
end
#* a comment
   that stays *#
  sub s
return"""

AFTER = """\
# first
var a
var t[4] = 1, 2, 3, 4

onevent prox
\tif a == 1 then
\t\ta = 2
\telseif a == 2 then
\t\tfor a in 0:3 do while t[a] > 0 do
\t\t\t\tt[a]--
\t\tend end
\telse
\t\tt = [1,
\t\t\t2, 3, 4]
\tend
\t#* a comment
   that stays *#
sub s
\treturn
"""


def test_lines_are_indented_by_their_depth():
    assert format_program(BEFORE) == AFTER


def test_formatted_text_stays():
    assert format_program(AFTER) == AFTER


@pytest.mark.parametrize(
    ("line", "regular"),
    [
        ("a=1", "a = 1"),
        ("a  =  -1+b*- 2", "a = -1 + b * -2"),
        ("a = - - b", "a = - -b"),
        ("a=b - - -c", "a = b - - -c"),
        ("t [ 1 : 2 ]=[ 1,2 ]", "t[1:2] = [1, 2]"),
        ("emit e[1,a]", "emit e [1, a]"),
        ("emit e-1", "emit e -1"),
        ("_emit e(a==1)", "_emit e (a == 1)"),
        ("call f ( a,b )", "call f(a, b)"),
        ("call f( )", "call f()"),
        ("a ++ b --", "a++ b--"),
        ("a<<=~ b>>2", "a <<= ~b >> 2"),
        ("for i in 0 : -3 step-1 do end", "for i in 0:-3 step -1 do end"),
        ("if(a==1)and not(b!=0x1F)then end", "if (a == 1) and not (b != 0x1F) then end"),
        ("var t [ ]=1,2", "var t[] = 1, 2"),
        ("a=(1)b=2", "a = (1) b = 2"),
        ("a = abs(b)", "a = abs (b)"),
        ("a=1# why  not", "a = 1 # why  not"),
        ("a=1   # in a column", "a = 1   # in a column"),
        ("a=1 \t # not", "a = 1 # not"),
        ("a =  [1,   20,300 ,  4  ]", "a =  [1,   20, 300,  4]"),
        ("#* x *#a=#* y *# 1#*z*#", "#* x *# a = #* y *# 1 #*z*#"),
        ("if.x=é", "if.x = é"),
    ],
)
def test_spaces_are_regular(line, regular):
    assert format_program(line) == regular + "\n"
    assert format_program(regular) == regular + "\n"


def test_a_sign_at_the_beginning_of_a_line_knows_the_line_before():
    assert format_program("a = b\n- c\nd = (\n- c)") == "a = b\n- c\nd = (\n\t-c)\n"


def test_another_indent_may_be_chosen():
    assert format_program("onevent tap\nreturn", "  ") == "onevent tap\n  return\n"


@pytest.mark.parametrize("source", ["", "\n\n", "   "])
def test_an_empty_program_stays_empty(source):
    assert format_program(source) == ""


def test_text_without_tokens_is_refused():
    with pytest.raises(CompileError):
        format_program("a = $")
