"""`aseba check`: errors, warnings, hints and notes with their positions; many files; JSON."""

import io
import json
import os
import re

import pytest

from aseba_vm.cli.main import main
from tests.aseba_vm.cli.samples import AESL, GOOD


def test_a_good_program_passes_the_check_silently(file, capsys):
    assert main(["check", file(GOOD), "--global", "ping=1"]) == 0
    assert capsys.readouterr() == ("", "")


def test_an_error_is_reported_with_file_line_and_column(file, capsys):
    name = file("var n\nn = m")
    assert main(["check", name]) == 1
    assert capsys.readouterr().err == f"{name}:2:5: no variable is called 'm'; perhaps you meant 'n'\nn = m\n    ^\n"


def test_an_error_in_an_aesl_file_has_its_position_in_the_file(file, capsys):
    name = file(AESL.format(code="nothing"), "robot.aesl")
    assert main(["check", name]) == 1
    assert capsys.readouterr().err == f"{name}:7:5: no variable is called 'nothing'\nn = nothing\n    ^\n"


def test_a_broken_aesl_file_is_refused(file, capsys):
    name = file("<network>", "robot.aesl")
    assert main(["check", name]) == 1
    assert capsys.readouterr().err.startswith(f"{name}:1:")


def test_warnings_are_reported_and_do_not_fail(file, capsys):
    name = file("sub s")
    assert main(["check", name]) == 0
    assert capsys.readouterr().err == f"{name}:1:1: warning: subroutine 's' is never called\nsub s\n^\n"


def test_a_terminal_gets_color_unless_no_color_is_set(file, capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    monkeypatch.delenv("NO_COLOR", raising=False)
    main(["check", file("n = 1")])
    assert "\x1b[" in capsys.readouterr().err
    monkeypatch.setenv("NO_COLOR", "1")
    main(["check", file("n = 1")])
    assert "\x1b[" not in capsys.readouterr().err


TWO_NODES = """<network>
<node name="thymio-II" nodeId="1">var a
</node>
<node name="thymio-II" nodeId="2">var b
b = &lt; 1</node>
</network>
"""


def test_every_program_of_a_file_for_the_target_is_checked(file, capsys):
    name = file(TWO_NODES, "two.aesl")
    assert main(["check", name]) == 1
    assert capsys.readouterr().err.startswith(f"{name}:5:5: expected one of ")


def test_a_file_that_breaks_a_rule_is_refused_with_its_line(file, capsys):
    name = file('<network>\n<event name="e" size="999"/>\n<node name="thymio-II"/></network>', "robot.aesl")
    assert main(["check", name]) == 1
    assert capsys.readouterr().err.splitlines() == [
        f"{name}:2:23: found size 999 for event 'e', expected 0 to 258 words",
        '<event name="e" size="999"/>',
        "                      ^",
    ]


def test_the_column_after_a_line_comment_is_that_of_an_editor(file, capsys):
    name = file("# the reference counts one too many on the next line\nx = 1")
    assert main(["check", name]) == 1
    assert capsys.readouterr().err.startswith(f"{name}:2:1: ")


def test_the_standard_input_is_read(monkeypatch, capsys):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO("var é = q".encode())))
    assert main(["check", "-"]) == 1
    assert capsys.readouterr().err.startswith("-:1:9: ")


HOSTILE = {
    "deep nesting": "var a\na = " + "(" * 50_000,
    "a megabyte": "a = 1\n" * 180_000,
    "more than a megabyte": "#" * 3_000_000,
    "variables": "".join(f"var v{number}\n" for number in range(10_000)),
    "zero bytes": "\0" * 1000,
    "deep XML": "<network>" + "<a>" * 100_000,
    "entities": '<!DOCTYPE a [<!ENTITY b "bbbb"><!ENTITY c "&b;&b;&b;">]><network>&c;</network>',
    "many nodes": "<network>" + '<node name="thymio-II">var a</node>' * 20_000 + "</network>",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_ends_in_one_message_with_a_position(name, file, capsys):
    path = file(HOSTILE[name])
    assert main(["check", path]) == 1
    first, *rest = capsys.readouterr().err.splitlines()
    assert re.match(rf"{re.escape(path)}:\d+:\d+: ", first)
    assert len(rest) == 2
    assert max(map(len, rest)) <= 100


def test_every_file_of_a_folder_is_checked_in_order(folder, capsys):
    assert main(["check", str(folder), str(folder / "b.aesl")]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    places = re.findall(rf"(?m)^{re.escape(str(folder) + os.sep)}(\S+?):\d+:\d+: (warning)?", err)
    places = [(name.replace(os.sep, "/"), kind) for name, kind in places]
    assert places == [("a.aseba", "warning"), ("b.aesl", ""), ("sub/broken.aesl", ""), ("sub/bytes.aesl", "")]
    assert err.endswith("5 files checked: 3 with errors, 1 with warnings\n")


def test_the_exit_code_is_that_of_the_worst_file(file, capsys):
    good, wrong = file("var a", "good.aseba"), file("a", "wrong.aseba")
    assert main(["check", good, wrong]) == 1
    assert main(["check", good, good]) == 0
    assert main(["check", good, f"{good}.none", wrong]) == 2
    err = capsys.readouterr().err
    assert f"aseba: {good}.none: No such file or directory\n" in err
    assert f"{wrong}:1:1: no variable is called 'a'" in err.partition("none")[2]


def test_errors_and_warnings_are_written_as_json(folder, file, capsys):
    name = file("var a\nif a = 1 then\nend", "hint.aseba")
    assert main(["check", "--format", "json", str(folder / "a.aseba"), name]) == 1
    out, err = capsys.readouterr()
    warning, error = json.loads(out)
    assert (warning["severity"], warning["kind"]) == ("warning", "warning-uncalled-subroutine")
    assert (error["file"], error["line"], error["column"], error["severity"]) == (name, 2, 6, "error")
    assert (error["kind"], error["message"]) == ("expected-token", "expected 'then' but found '='")
    assert error["hint"].startswith("'=' gives a variable a new value")
    assert error["edit"] == {"line": 2, "column": 6, "end_line": 2, "end_column": 7, "text": "=="}
    assert err == "2 files checked: 1 with errors, 1 with warnings\n"


def test_a_hint_follows_the_error(file, capsys):
    name = file("var a\nif a = 1 then\nend")
    assert main(["check", name]) == 1
    assert capsys.readouterr().err.splitlines() == [
        f"{name}:2:6: expected 'then' but found '='",
        "if a = 1 then",
        "     ^",
        "Hint: '=' gives a variable a new value; to compare two values write '=='. Right: if a == 1 then",
    ]


def test_a_guessed_node_is_a_note(file, capsys):
    text = AESL.format(code="1").replace("thymio-II", "Thymio_4 on LAPTOP - 8636")
    name = file(text, "suite.aesl")
    assert main(["check", name]) == 0
    node = "node 'Thymio_4 on LAPTOP - 8636'"
    assert capsys.readouterr().err == f"{name}:5:51: note: {node} is checked as a program for 'thymio-II'\n"
    both = text.replace("</network>", '<node name="thymio-II">var a</node></network>')
    assert main(["check", file(both.replace("n = 1", "n = x y"), "both.aesl")]) == 0
    assert f"note: {node} is left out, as it does not compile for a Thymio" in capsys.readouterr().err


def test_vpl_files_are_checked_with_the_events_of_vpl(file, capsys):
    vpl = "emit pair_run 0<toolsPlugins><ThymioVisualProgramming><vplroot/></ThymioVisualProgramming></toolsPlugins>"
    assert main(["check", file(f"<network><node>{vpl}</node></network>", "vpl.aesl")]) == 0
    assert "no event" not in capsys.readouterr().err
