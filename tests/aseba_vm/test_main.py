import json

import pytest

from aseba_vm.__main__ import main

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


def test_an_error_is_told_with_file_line_and_column(file, capsys):
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


def test_doubts_are_told_and_do_no_harm(file, capsys):
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


@pytest.mark.parametrize("stage", ["tokens", "tree", "expanded", "optimised", "code", "words"])
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


def test_a_fault_is_told_with_its_line(file, capsys):
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
