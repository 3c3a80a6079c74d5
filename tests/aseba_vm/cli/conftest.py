"""Files and folders of programs for the tests of the command line."""

import pytest

from tests.aseba_vm.cli.samples import AESL


@pytest.fixture(autouse=True)
def in_english(monkeypatch):
    monkeypatch.setenv("LC_ALL", "C")


@pytest.fixture
def file(tmp_path):
    def write(text, name="robot.aseba"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8", newline="\n")
        return str(path)

    return write


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
