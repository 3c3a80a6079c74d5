"""The listing shows bytecode and source side by side."""

from aseba_vm import compile
from aseba_vm.cli.listing import listing
from aseba_vm.targets import THYMIO_II

SOURCE = """var n = 1
var t[2]
onevent ping
  t[n] = 2
  call math.fill(t, n)
  callsub s
  emit ping n
sub s
  return"""


def test_a_program_is_listed_with_its_lines_and_names():
    events = [("ping", 1)]
    program = compile(SOURCE, THYMIO_II, events)
    assert listing(program, SOURCE, THYMIO_II, events, range(11, 20)).splitlines() == [
        "    0  0005            code at 5",
        "    1  0000 0005       event 0 at 5",
        "    3  FFFF 0012       event 65535 at 18",
        "",
        "onevent ping",
        "    5  1002            push 2                        |   14  t[n] = 2",
        "    6  3080            load 128 (n)",
        "    7  6081 0002       storex 129 size 2 (t)",
        "    9  1002            push 2                        |   15  call math.fill(t, n)",
        "   10  1080            push 128",
        "   11  1081            push 129",
        "   12  C005            native 5 (math.fill)",
        "   13  D015            call 21 (s)                   |   16  callsub s",
        "   14  B000 0080 0001  emit 0 from 128 size 1 (ping) |   17  emit ping n",
        "   17  0000            stop",
        "",
        "initialization",
        "   18  1001            push 1                        |   11  var n = 1",
        "   19  4080            store 128 (n)",
        "   20  0000            stop",
        "",
        "sub s",
        "   21  E000            ret                           |   19  return",
        "",
        "bytecode      22 of  1534 words",
        "variables    131 of   640 words",
        "stack          3 of    32 words",
    ]


def test_an_empty_program_has_a_listing():
    assert listing(compile("", THYMIO_II), "", THYMIO_II).splitlines()[0] == "    0  0001            code at 1"
