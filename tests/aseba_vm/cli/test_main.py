import codecs
import errno
import io
import json
import os
import pathlib
import re
import signal
import subprocess
import sys

import pytest

from aseba_vm.cli.main import main

ASEBA = [sys.executable, "-m", "aseba_vm"]
ASCII = os.environ | {"PYTHONIOENCODING": "ascii"}
GOOD = "var n = 1\nonevent ping\nn = n + event.args[0]\nemit ping n\ncall leds.top(n, 0, 32)\n"

AESL = """<!DOCTYPE aesl-source>
<network>
<event size="1" name="ping"/>
<constant value="7" name="START"/>
<node nodeId="1" name="thymio-II">var n = START
onevent ping
n = {code}
</node>
</network>
"""


@pytest.fixture(autouse=True)
def in_english(monkeypatch):
    monkeypatch.setenv("LC_ALL", "C")


@pytest.fixture
def file(tmp_path):
    def write(text, name="robot.aseba"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return str(path)

    return write


def test_a_good_program_passes_the_check_silently(file, capsys):
    assert main(["check", file(GOOD), "--global", "ping=1"]) == 0
    assert capsys.readouterr() == ("", "")


def test_an_error_is_reported_with_file_line_and_column(file, capsys):
    name = file("var n\nn = m")
    assert main(["check", name]) == 1
    assert capsys.readouterr().err == f"{name}:2:5: no variable is called 'm'; perhaps you meant 'n'\nn = m\n    ^\n"


def test_an_error_in_an_aesl_file_is_placed_in_the_file(file, capsys):
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


def test_a_program_is_written_as_words(file, capsys):
    assert main(["compile", file("var n = 1")]) == 0
    assert capsys.readouterr().out.split() == ["0003", "ffff", "0003", "1001", "4080", "0000"]


def test_a_program_is_written_as_json(file, tmp_path):
    output = tmp_path / "out.json"
    assert main(["compile", file("var n = 1"), "--format", "json", "-o", str(output)]) == 0
    data = json.loads(output.read_text("utf-8"))
    assert data["words"] == [3, 65535, 3, 0x1001, 0x4080, 0]
    assert data["variables"] == [["n", 128, 1]]


@pytest.mark.parametrize("stage", ["tokens", "tree", "expanded", "optimized", "optimised", "code", "words"])
def test_every_stage_can_be_shown(stage, file, capsys):
    assert main(["dis", file(GOOD), "--global", "ping=1", "--stage", stage]) == 0
    assert capsys.readouterr().out.strip()


def test_a_program_is_run(file, capsys):
    assert main(["run", file(GOOD), "--global", "ping=1", "--raise", "ping=5", "--raise", "ping=2"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "emit ping 6",
        "call leds.top 6 0 32",
        "emit ping 8",
        "call leds.top 8 0 32",
        "n 8",
    ]


def test_each_instruction_can_be_shown(file, capsys):
    assert main(["run", file("var n\nn = 2 + n"), "--trace"]) == 0
    assert [line.split() for line in capsys.readouterr().out.splitlines()] == [
        ["3", "2", "push", "2", "[]"],
        ["4", "2", "load", "128", "[2]"],
        ["5", "2", "binary", "+", "[2", "0]"],
        ["6", "2", "store", "128", "[2]"],
        ["7", "2", "stop", "[]"],
        ["n", "2"],
    ]


def test_a_program_is_written_as_a_listing(file, capsys):
    assert main(["compile", file("var n = 1"), "--format", "listing"]) == 0
    assert "push 1" in capsys.readouterr().out


def test_a_terminal_gets_colour_unless_it_refuses(file, capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    monkeypatch.delenv("NO_COLOR", raising=False)
    main(["check", file("n = 1")])
    assert "\x1b[" in capsys.readouterr().err
    monkeypatch.setenv("NO_COLOR", "1")
    main(["check", file("n = 1")])
    assert "\x1b[" not in capsys.readouterr().err


def test_a_fault_is_reported_with_its_line(file, capsys):
    name = file("var n\nn = 1 / n")
    assert main(["run", name]) == 1
    assert capsys.readouterr().err == f"{name}:2: stopped: division by zero\n"


def test_an_endless_event_is_stopped(file, capsys):
    name = file("var n\nwhile n == 0 do n = 0 end")
    assert main(["run", name, "--limit", "100"]) == 0
    assert "still running after 100 instructions" in capsys.readouterr().err


def test_a_file_is_formatted_in_place(file):
    name = file(AESL.format(code="1"), "robot.aesl")
    assert main(["fmt", "--check", name]) == 1
    assert main(["fmt", "--write", name]) == 0
    assert main(["fmt", "--check", name]) == 0
    with open(name, encoding="utf-8") as lines:
        assert "\tn = 1\n" in lines.readlines()


def test_formatted_text_goes_to_the_output(file, capsys):
    assert main(["fmt", file("onevent tap\n  return")]) == 0
    assert capsys.readouterr().out == "onevent tap\n\treturn\n"


def test_another_target_may_be_given(file, capsys):
    target = {
        "name": "small",
        "variables_size": 8,
        "bytecode_size": 20,
        "stack_size": 4,
        "variables": [["x", 1]],
        "local_events": ["tick"],
        "natives": [],
    }
    name = file("onevent tick x = 5")
    options = ["--target", file(json.dumps(target), "small.json"), "--raise", "tick", "--show", "x"]
    assert main(["run", name, *options]) == 0
    assert capsys.readouterr().out == "x 5\n"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--raise", "nothing"], "no event is called 'nothing'"),
        (["--show", "nothing"], "no variable is called 'nothing'"),
        (["--target", "FILE"], "not JSON"),
    ],
)
def test_wrong_use_is_one_line_and_code_2(arguments, message, file, capsys):
    name = file("var n")
    assert main(["run", name, *(name if word == "FILE" else word for word in arguments)]) == 2
    assert message in capsys.readouterr().err


def test_a_missing_file_is_code_2(tmp_path, capsys):
    assert main(["check", str(tmp_path / "none.aesl")]) == 2
    assert "none.aesl" in capsys.readouterr().err


def test_a_file_that_is_not_text_is_code_2(tmp_path, capsys):
    path = tmp_path / "x"
    path.write_bytes(b"\xff\xfe\x00")
    assert main(["check", str(path)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_a_node_that_is_not_in_the_file_is_code_2(file, capsys):
    assert main(["check", file(AESL.format(code="1")), "--node", "e-puck"]) == 2
    assert "found no program for 'e-puck', only for 'thymio-II'" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [[], ["nothing"], ["run", "x", "--limit", "0"], ["check", "x", "--global", "a"]])
def test_a_wrong_command_line_is_code_2(arguments):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2


@pytest.mark.parametrize("arguments", [["--help"], ["check", "--help"], ["run", "--help"], ["fmt", "--help"]])
def test_help_is_given(arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 0
    assert "usage: aseba" in capsys.readouterr().out


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


@pytest.mark.parametrize("command", ["check", "compile", "dis", "run", "fmt"])
def test_a_place_behind_entities_and_comments_is_that_in_the_file(command, file, capsys):
    name = file(
        '<network><node name="thymio-II">var a # &lt;\n<!-- \n -->a = 1 &lt;&lt; $\n</node></network>', "r.aesl"
    )
    assert main([command, name]) == 1
    assert capsys.readouterr().err.startswith(f"{name}:3:20: character U+24 cannot start a word\n")


def test_the_column_after_a_line_comment_is_that_of_an_editor(file, capsys):
    name = file("# the reference counts one too many on the next line\nx = 1")
    assert main(["check", name]) == 1
    assert capsys.readouterr().err.startswith(f"{name}:2:1: ")


def test_the_standard_input_is_read(monkeypatch, capsys):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO("var é = q".encode())))
    assert main(["check", "-"]) == 1
    assert capsys.readouterr().err.startswith("-:1:9: ")


def test_the_listing_shows_lines_names_and_use(file, capsys):
    name = file(AESL.format(code="START + 1"), "robot.aesl")
    assert main(["compile", name, "--format", "listing"]) == 0
    shown = capsys.readouterr().out
    assert "onevent ping" in shown
    assert "store 128 (n)" in shown
    assert "|    7  n = START + 1" in shown
    assert "of  1534 words" in shown


def test_formatting_changes_nothing_else_in_a_file(file):
    text = AESL.format(code="1").replace("<event", "<!-- kept -->\r\n<event color='red'").replace("\n", "\r\n")
    path = pathlib.Path(file("", "robot.aesl"))
    path.write_bytes(codecs.BOM_UTF8 + text.encode())
    assert main(["fmt", "--write", str(path)]) == 0
    expected = text.replace("\r\nn = 1", "\r\n\tn = 1")
    assert path.read_bytes() == codecs.BOM_UTF8 + expected.encode()


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1"])
def test_formatted_text_keeps_its_encoding_on_the_output(tmp_path, encoding):
    path = tmp_path / "robot.aesl"
    text = f"<?xml version='1.0' encoding='{encoding}'?>\n{AESL}".format(code="1 # grün")
    path.write_bytes(text.encode(encoding))
    formatted = subprocess.run([*ASEBA, "fmt", str(path)], stdout=subprocess.PIPE, check=True, env=ASCII).stdout
    assert main(["fmt", "--write", str(path)]) == 0
    assert formatted == path.read_bytes()
    assert "\tn = 1 # grün\n" in formatted.decode(encoding)


def test_letters_that_the_output_lacks_are_escaped(file):
    command = [*ASEBA, "run", file("var höhe = 3")]
    assert subprocess.run(command, stdout=subprocess.PIPE, check=True, env=ASCII).stdout == b"h\\xf6he 3\n"


def test_a_file_survives_when_its_new_text_cannot_be_written(file, capsys, monkeypatch):
    def is_full(handle, mode):
        os.close(handle)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    name = file(AESL.format(code="1"), "robot.aesl")
    before = pathlib.Path(name).read_bytes()
    monkeypatch.setattr(os, "fdopen", is_full)
    assert main(["fmt", "--write", name]) == 2
    assert capsys.readouterr().err == f"aseba: {name}: No space left on device\n"
    assert pathlib.Path(name).read_bytes() == before
    assert os.listdir(pathlib.Path(name).parent) == ["robot.aesl"]


def test_a_file_behind_a_link_is_formatted_and_keeps_its_permissions(file, tmp_path):
    path = pathlib.Path(file(AESL.format(code="1"), "robot.aesl"))
    path.chmod(0o640)
    link = tmp_path / "link.aesl"
    link.symlink_to(path)
    assert main(["fmt", "--write", str(link)]) == 0
    assert link.is_symlink()
    assert "\tn = 1\n" in path.read_text()
    assert path.stat().st_mode & 0o777 == 0o640


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full here")
def test_a_full_disk_is_reported_with_the_name_of_the_output(file, capsys):
    name = file(GOOD.replace("ping", "timer0").replace("emit timer0 n\n", ""))
    assert main(["compile", name, "-o", "/dev/full"]) == 2
    assert capsys.readouterr().err == "aseba: /dev/full: No space left on device\n"
    with open("/dev/full", "w") as full:
        ended = subprocess.run([*ASEBA, "dis", name], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (2, "aseba: standard output: No space left on device\n")


def test_ctrl_c_ends_a_run_without_a_word(file):
    command = [*ASEBA, "run", "--limit", "999999999999", "--trace", file("var n\nwhile n == 0 do n = 0 end")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        running.stdout.readline()  # it runs
        running.send_signal(signal.SIGINT)
        _, errors = running.communicate(timeout=60)
    assert (running.returncode, errors) == (-signal.SIGINT, b"")


def test_a_refused_file_is_not_rewritten(file):
    name = file("onevent tap\n a = $")
    assert main(["fmt", "--write", name]) == 1
    with open(name, encoding="utf-8") as lines:
        assert lines.read() == "onevent tap\n a = $"


def test_a_folder_without_programs_is_code_2(tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("no program")
    assert main(["check", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"aseba: {tmp_path}: no program (.aesl, .aseba) in this folder\n"


def test_only_check_and_fmt_accept_a_folder(tmp_path, capsys):
    assert main(["compile", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"aseba: {tmp_path}: Is a directory\n"


def test_undecodable_bytes_are_reported_with_their_position(tmp_path, capsys):
    path = tmp_path / "x"
    path.write_bytes(b"var a\na = \xff")
    assert main(["check", str(path)]) == 2
    assert capsys.readouterr().err == f"{path}:2:5: found byte ff, expected text in UTF-8\n"


@pytest.mark.parametrize(
    "arguments", [["--global", "e=259"], ["--global", "1=1"], ["--constant", "A=32768"], ["--raise", "e=x"]]
)
def test_definitions_of_the_command_line_obey_the_rules_of_files(arguments, file, capsys):
    with pytest.raises(SystemExit) as caught:
        main(["run", file("var a"), *arguments])
    assert caught.value.code == 2
    assert "expected" in capsys.readouterr().err


def test_a_closed_output_pipe_causes_no_traceback(file):
    name = file("var a\nwhile a < 30000 do a++ end")
    command = f"{sys.executable} -m aseba_vm run {name} --trace | head -1"
    ended = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=120, check=False)
    assert len(ended.stdout.splitlines()) == 1
    assert ended.stderr == ""


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
def test_a_hostile_file_ends_in_one_message_with_a_place(name, file, capsys):
    path = file(HOSTILE[name])
    assert main(["check", path]) == 1
    first, *rest = capsys.readouterr().err.splitlines()
    assert re.match(rf"{re.escape(path)}:\d+:\d+: ", first)
    assert len(rest) == 2
    assert max(map(len, rest)) <= 100


def test_line_ends_of_a_bare_program_stay(tmp_path):
    path = tmp_path / "good.aseba"
    path.write_bytes(b"var a\r\nif a==1 then\r\na=2\r\nend\r\n")
    assert main(["fmt", "--write", str(path)]) == 0
    assert path.read_bytes() == b"var a\r\nif a == 1 then\r\n\ta = 2\r\nend\r\n"
    assert main(["fmt", "--check", str(path)]) == 0


@pytest.mark.parametrize(
    "text", ["var a\nwhile a == 0 do\na = 0\nend\nonevent tap\n", "var z\nvar a = 1 / z\nonevent tap\n"]
)
def test_a_program_that_has_stopped_is_reported_once(file, capsys, text):
    main(["run", file(text), "--limit", "1000", "--raise", "tap", "--raise", "tap"])
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_an_event_of_the_robot_hides_one_of_the_network(file, capsys):
    text = "var n = 0\nonevent tap\nn = n + 1\n"
    assert main(["run", file(text), "--global", "tap=0", "--raise", "tap"]) == 0
    assert "n 1" in capsys.readouterr().out.splitlines()


# -- many files, languages, hints --------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path):
    home = tmp_path / "programs"
    for name, text in {
        "b.aesl": AESL.format(code="nothing"),
        "a.aseba": "sub s",
        "sub/c.AESL": AESL.format(code="1"),
        "sub/broken.aesl": "<network>",
        "sub/bytes.aesl": "\udcff",
        ".hidden/d.aesl": "x",
        "notes.txt": "no program",
    }.items():
        (home / name).parent.mkdir(parents=True, exist_ok=True)
        (home / name).write_bytes(text.encode("utf-8", "surrogateescape"))
    return home


def test_every_file_of_a_folder_is_checked_in_order(folder, capsys):
    assert main(["check", str(folder), str(folder / "b.aesl")]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    places = re.findall(rf"(?m)^{re.escape(str(folder))}/(\S+?):\d+:\d+: (warning)?", err)
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


def test_findings_are_given_as_json(folder, file, capsys):
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


@pytest.mark.parametrize(
    ("environment", "word"),
    [
        ({"LC_ALL": "de_CH.UTF-8"}, "keine Variable heißt"),
        ({"LC_ALL": "", "LC_MESSAGES": "fr_FR.UTF-8", "LANG": "de_DE"}, "aucune variable"),
        ({"LC_ALL": "", "LC_MESSAGES": "", "LANG": "it"}, "nessuna variabile"),
        ({"LC_ALL": "", "LC_MESSAGES": "", "LANG": "ja_JP.UTF-8"}, "no variable"),
        ({"LC_ALL": "", "LC_MESSAGES": "", "LANG": ""}, "no variable"),
        ({"LC_ALL": "en_US.UTF-8", "LANGUAGE": "xx:it:de"}, "nessuna variabile"),
        ({"LC_ALL": "C", "LANGUAGE": "de"}, "no variable"),
        ({"LC_ALL": "deutsch"}, "no variable"),
    ],
)
def test_messages_are_in_the_language_of_the_user(environment, word, file, capsys, monkeypatch):
    for name in ("LC_ALL", "LC_MESSAGES", "LANG", "LANGUAGE"):
        monkeypatch.setenv(name, environment.get(name, ""))
    main(["check", file("zzzz = 1")])
    assert word in capsys.readouterr().err


@pytest.mark.parametrize("command", ["check", "compile", "dis", "run", "fmt"])
def test_every_command_accepts_a_language(command, file, capsys):
    assert main([command, "--lang", "de", file("var a = $")]) == 1
    assert "mit dem Zeichen U+24 kann kein Wort beginnen" in capsys.readouterr().err


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


def test_many_files_are_formatted_and_a_broken_one_is_left(folder, capsys):
    (folder / "a.aseba").write_text("sub   s\n")
    assert main(["fmt", "--check", str(folder)]) == 2
    err = capsys.readouterr().err
    assert f"{folder}/a.aseba: the layout is not regular\n" in err
    assert err.endswith("5 files read: 3 with an irregular layout, 2 refused\n")
    assert main(["fmt", "--write", str(folder)]) == 2
    assert (folder / "a.aseba").read_text() == "sub s\n"
    assert (folder / "sub/broken.aesl").read_text() == "<network>"
    assert main(["fmt", "--check", str(folder / "a.aseba"), str(folder / "b.aesl")]) == 0


def test_diff_shows_the_changes_and_writes_nothing(file, capsys):
    name = file("sub   s\nreturn")
    assert main(["fmt", "--diff", name]) == 1
    out, _ = capsys.readouterr()
    assert out.splitlines()[:4] == [f"--- {name}", f"+++ {name}", "@@ -1,2 +1,2 @@", "-sub   s"]
    assert main(["fmt", "--write", name]) == 0
    assert main(["fmt", "--diff", name]) == 0


def test_the_standard_input_is_formatted(monkeypatch, capsysbinary):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"sub   s")))
    assert main(["fmt", "-"]) == 0
    assert capsysbinary.readouterr().out == b"sub s\n"


@pytest.mark.parametrize(
    ("arguments", "closed", "code"),
    [("run {}", ">&-", 0), ("check {}", "<&- >&- 2>&-", 0), ("check -", "<&-", 0), ("run {}.not", "2>&-", 2)],
)
def test_closed_standard_streams_are_opened_to_the_null_device(tmp_path, arguments, closed, code):
    program = tmp_path / "program.aseba"
    program.write_text("var n = 1\n")
    command = f'"{sys.executable}" -m aseba_vm {arguments.format(program)} {closed}'
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (code, "", "")
