"""What all commands share: usage errors, exit codes, languages, standard streams."""

import subprocess
import sys

import pytest

from aseba_vm.cli.main import main
from tests.aseba_vm.cli.samples import AESL
from tests.patience import PATIENCE_S
from tests.systems import posix


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
def test_help_is_printed(arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 0
    assert "usage: aseba" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["check", "compile", "dis", "run", "fmt"])
def test_a_position_after_entities_and_comments_is_that_in_the_file(command, file, capsys):
    name = file(
        '<network><node name="thymio-II">var a # &lt;\n<!-- \n -->a = 1 &lt;&lt; $\n</node></network>', "r.aesl"
    )
    assert main([command, name]) == 1
    assert capsys.readouterr().err.startswith(f"{name}:3:20: character U+24 cannot start a word\n")


def test_a_folder_without_programs_is_code_2(tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("no program")
    assert main(["check", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"aseba: {tmp_path}: no program (.aesl, .aseba) in this folder\n"


def test_only_check_and_fmt_accept_a_folder(tmp_path, capsys):
    assert main(["compile", str(tmp_path)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"aseba: {tmp_path}: ")  # the text of the system


def test_undecodable_bytes_are_reported_with_their_position(tmp_path, capsys):
    path = tmp_path / "x"
    path.write_bytes(b"var a\na = \xff")
    assert main(["check", str(path)]) == 2
    assert capsys.readouterr().err == f"{path}:2:5: found byte ff, expected text in UTF-8\n"


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


@posix
@pytest.mark.process
@pytest.mark.parametrize(
    ("arguments", "closed", "code"),
    [("run {}", ">&-", 0), ("check {}", "<&- >&- 2>&-", 0), ("check -", "<&-", 0), ("run {}.not", "2>&-", 2)],
)
def test_closed_standard_streams_are_opened_to_the_null_device(tmp_path, arguments, closed, code):
    program = tmp_path / "program.aseba"
    program.write_text("var n = 1\n")
    command = f'"{sys.executable}" -m aseba_vm {arguments.format(program)} {closed}'
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (code, "", "")
