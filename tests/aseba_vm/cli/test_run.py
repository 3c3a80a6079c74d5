"""`aseba run`: events, trace, faults, limits, definitions."""

import json
import signal
import subprocess
import sys

import pytest

from aseba_vm.cli.main import main
from tests.aseba_vm.cli.samples import ASCII, ASEBA, GOOD
from tests.patience import PATIENCE_S
from tests.systems import posix


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


def test_a_fault_is_reported_with_its_line(file, capsys):
    name = file("var n\nn = 1 / n")
    assert main(["run", name]) == 1
    assert capsys.readouterr().err == f"{name}:2: stopped: division by zero\n"


def test_an_endless_event_is_stopped(file, capsys):
    name = file("var n\nwhile n == 0 do n = 0 end")
    assert main(["run", name, "--limit", "100"]) == 0
    assert "still running after 100 instructions" in capsys.readouterr().err


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
def test_a_usage_error_is_one_line_and_code_2(arguments, message, file, capsys):
    name = file("var n")
    assert main(["run", name, *(name if word == "FILE" else word for word in arguments)]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.process
def test_letters_outside_the_encoding_of_the_output_are_escaped(file):
    command = [*ASEBA, "run", file("var höhe = 3")]
    printed = subprocess.run(command, stdout=subprocess.PIPE, check=True, env=ASCII).stdout
    assert printed.splitlines() == [b"h\\xf6he 3"]


@posix
@pytest.mark.process
def test_ctrl_c_ends_a_run_silently(file):
    command = [*ASEBA, "run", "--limit", "999999999999", "--trace", file("var n\nwhile n == 0 do n = 0 end")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        running.stdout.readline()  # it runs
        running.send_signal(signal.SIGINT)
        _, errors = running.communicate(timeout=PATIENCE_S)
    assert (running.returncode, errors) == (-signal.SIGINT, b"")


@pytest.mark.parametrize(
    "arguments", [["--global", "e=259"], ["--global", "1=1"], ["--constant", "A=32768"], ["--raise", "e=x"]]
)
def test_definitions_of_the_command_line_obey_the_rules_of_files(arguments, file, capsys):
    with pytest.raises(SystemExit) as caught:
        main(["run", file("var a"), *arguments])
    assert caught.value.code == 2
    assert "expected" in capsys.readouterr().err


@posix
@pytest.mark.process
def test_a_closed_output_pipe_causes_no_traceback(file):
    name = file("var a\nwhile a < 30000 do a++ end")
    command = f"{sys.executable} -m aseba_vm run {name} --trace | head -1"
    ended = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert len(ended.stdout.splitlines()) == 1
    assert ended.stderr == ""


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
