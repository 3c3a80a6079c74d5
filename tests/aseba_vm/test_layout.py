import pytest

from aseba_vm import CompileError
from aseba_vm.layout import formatted

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
var t[4] = 1,2,3,4

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
    assert formatted(BEFORE) == AFTER


def test_formatted_text_stays():
    assert formatted(AFTER) == AFTER


def test_another_indent_may_be_chosen():
    assert formatted("onevent tap\nreturn", "  ") == "onevent tap\n  return\n"


@pytest.mark.parametrize("source", ["", "\n\n", "   "])
def test_an_empty_program_stays_empty(source):
    assert formatted(source) == ""


def test_text_without_tokens_is_refused():
    with pytest.raises(CompileError):
        formatted("a = $")
