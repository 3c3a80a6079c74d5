"""`aseba fmt`: files that are rewritten, checked, compared."""

import codecs
import errno
import io
import os
import pathlib
import subprocess

import pytest

from aseba_vm.cli.main import main
from tests.aseba_vm.cli.samples import AESL, ASCII, ASEBA
from tests.disk import FailingDisk
from tests.systems import links


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


def test_formatting_changes_nothing_else_in_a_file(file):
    text = AESL.format(code="1").replace("<event", "<!-- kept -->\r\n<event color='red'").replace("\n", "\r\n")
    path = pathlib.Path(file("", "robot.aesl"))
    path.write_bytes(codecs.BOM_UTF8 + text.encode())
    assert main(["fmt", "--write", str(path)]) == 0
    expected = text.replace("\r\nn = 1", "\r\n\tn = 1")
    assert path.read_bytes() == codecs.BOM_UTF8 + expected.encode()


@pytest.mark.process
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1"])
def test_formatted_text_keeps_its_encoding_on_the_output(tmp_path, encoding):
    path = tmp_path / "robot.aesl"
    text = f"<?xml version='1.0' encoding='{encoding}'?>\n{AESL}".format(code="1 # grün")
    path.write_bytes(text.encode(encoding))
    formatted = subprocess.run([*ASEBA, "fmt", str(path)], stdout=subprocess.PIPE, check=True, env=ASCII).stdout
    assert main(["fmt", "--write", str(path)]) == 0
    assert formatted == path.read_bytes()
    assert "\tn = 1 # grün\n" in formatted.decode(encoding)


def test_a_file_is_unchanged_if_its_new_text_cannot_be_written(file, capsys):
    name = file(AESL.format(code="1"), "robot.aesl")
    before = pathlib.Path(name).read_bytes()
    with FailingDisk(pathlib.Path(name).parent, 3, errno.ENOSPC).failing():
        assert main(["fmt", "--write", name]) == 2
    assert capsys.readouterr().err == f"aseba: {name}: No space left on device\n"
    assert pathlib.Path(name).read_bytes() == before
    assert os.listdir(pathlib.Path(name).parent) == ["robot.aesl"]


@links
def test_a_file_behind_a_link_is_formatted_and_keeps_its_permissions(file, tmp_path):
    path = pathlib.Path(file(AESL.format(code="1"), "robot.aesl"))
    path.chmod(0o640)
    link = tmp_path / "link.aesl"
    link.symlink_to(path)
    assert main(["fmt", "--write", str(link)]) == 0
    assert link.is_symlink()
    assert "\tn = 1\n" in path.read_text()
    assert path.stat().st_mode & 0o777 == 0o640


def test_a_refused_file_is_not_rewritten(file):
    name = file("onevent tap\n a = $")
    assert main(["fmt", "--write", name]) == 1
    with open(name, encoding="utf-8") as lines:
        assert lines.read() == "onevent tap\n a = $"


def test_line_ends_of_a_bare_program_are_kept(tmp_path):
    path = tmp_path / "good.aseba"
    path.write_bytes(b"var a\r\nif a==1 then\r\na=2\r\nend\r\n")
    assert main(["fmt", "--write", str(path)]) == 0
    assert path.read_bytes() == b"var a\r\nif a == 1 then\r\n\ta = 2\r\nend\r\n"
    assert main(["fmt", "--check", str(path)]) == 0


def test_many_files_are_formatted_and_a_broken_one_is_left_unchanged(folder, capsys):
    (folder / "a.aseba").write_text("sub   s\n")
    assert main(["fmt", "--check", str(folder)]) == 2
    err = capsys.readouterr().err
    assert f"{folder / 'a.aseba'}: the layout is not regular\n" in err
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
